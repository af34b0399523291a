#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds for arm64 and runs tests of the numerical modules, those of the NEON instructions among
# them, in an emulator. The packages of that machine are unpacked below build/arm64 and change
# nothing on this one; the cross compiler and the emulator are installed.
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  "") ;;
  -h | --help) echo "usage: tools/test_arm64.sh"; exit 0 ;;
  *) echo "test_arm64: unknown option '$1'; see tools/test_arm64.sh --help" >&2; exit 2 ;;
esac

home=$PWD/build/arm64
root=$home/root
triplet=aarch64-linux-gnu
tests=(test_math test_shape test_contact test_boundary)

apt-get install -y -qq g++-$triplet qemu-user-static >/dev/null

if [[ ! -e $home/unpacked ]]; then
  mkdir -p "$home"/{state/lists/partial,cache/archives/partial,root}
  : >"$home/status"
  apt=(apt-get -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State="$home/state"
    -o Dir::State::status="$home/status" -o Dir::Cache="$home/cache")
  "${apt[@]}" -qq update
  "${apt[@]}" -qq install --download-only -y --no-install-recommends libhdf5-dev libfmt-dev \
    libgtest-dev libhwy-dev libtomlplusplus-dev libcli11-dev libeigen3-dev libtiff-dev zlib1g-dev
  for package in "$home"/cache/archives/*.deb; do dpkg -x "$package" "$root"; done
  # The cross compiler has a C library of its own.
  rm -rf "$root/usr/lib/$triplet"/{libc,libm,libpthread,libdl}.{so,a} "$root/usr/include_c" \
    "$root/usr/lib/$triplet"/*crt*.o
  mkdir "$root/usr/include_c"
  mv "$root/usr/include"/* "$root/usr/include_c/"
  mkdir -p "$root/usr/include/$triplet"
  for library in fmt hdf5 gtest gmock hwy eigen3 CLI toml++ zlib.h \
    "$triplet"/{curl,openssl,zconf.h,tiff.h,tiffconf.h,tiffio.h,tiffvers.h}; do
    [[ ! -e $root/usr/include_c/$library ]] || mv "$root/usr/include_c/$library" "$root/usr/include/$library"
  done
  touch "$home/unpacked"
fi

libraries=$root/usr/lib/$triplet
emulator=(qemu-aarch64-static -L "/usr/$triplet" -E
  "LD_LIBRARY_PATH=$libraries:$root/lib/$triplet" -E OMP_WAIT_POLICY=passive)
cmake -S . -B "$home/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_LIBRARY_ARCHITECTURE=$triplet \
  -DCMAKE_C_COMPILER=$triplet-gcc -DCMAKE_CXX_COMPILER=$triplet-g++ \
  -DCMAKE_FIND_ROOT_PATH="$root" -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
  -DCMAKE_EXE_LINKER_FLAGS="-L$libraries -Wl,-rpath-link,$libraries:$root/lib/$triplet" \
  -DCMAKE_CROSSCOMPILING_EMULATOR="$(IFS=';'; echo "${emulator[*]}")" \
  -DHDF5_C_LIBRARY_hdf5="$libraries/libhdf5_serial.so" \
  -DHDF5_C_INCLUDE_DIR="$root/usr/include/hdf5/serial" \
  -DRECKON_MPI=OFF -DRECKON_CT=OFF -DRECKON_PYTHON=OFF
cmake --build "$home/build" --target "${tests[@]}" -j "$(nproc)"
for test in "${tests[@]}"; do
  "${emulator[@]}" "$home/build/tests/unit/$test" --gtest_brief=1
done
