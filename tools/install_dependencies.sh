#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# The one list of Debian packages that the project needs, and the installation of those that are
# missing. docs/dependencies.md has the reason for each.
#
#   tools/install_dependencies.sh [--list] GROUP...     groups: build, test, ct, viewer, python, paraview
set -euo pipefail

packages_of() {
  case "$1" in
    build)  # what it takes to compile and run the program
      echo g++ cmake ninja-build ccache \
        libfmt-dev libeigen3-dev libhdf5-dev libtomlplusplus-dev libcli11-dev libhwy-dev \
        libopenmpi-dev openmpi-bin libtrilinos-zoltan-dev zlib1g-dev libtiff-dev ;;
    test)  # what ./check needs beyond that
      echo libgtest-dev clang clang-format clang-tidy libclang-rt-14-dev libomp-dev \
        python3 git chromium fonts-dejavu-core python3-mpi4py ;;
    python)  # the optional Python package
      echo python3-dev pybind11-dev python3-numpy python3-tomli-w ;;
    ct)  # the optional component that makes grains from X-ray volumes
      echo libinsighttoolkit5-dev ;;
    paraview)  # ParaView, without a screen, to test what it makes of a run's files
      echo paraview python3-paraview python3-numpy xvfb xauth ;;
    viewer)  # what bundles the page of `reckon report`
      echo nodejs npm ;;
    *)
      echo "install_dependencies.sh: unknown group '$1'; there are: build, test, ct, viewer, python, paraview" >&2
      return 2 ;;
  esac
}

list_only=false
if [[ ${1:-} == --list ]]; then
  list_only=true
  shift
fi
[[ $# -gt 0 ]] || { echo "usage: install_dependencies.sh [--list] GROUP...   (build, test, ct, viewer, python, paraview)" >&2; exit 2; }

wanted=()
for group in "$@"; do
  packages=$(packages_of "$group")
  for package in $packages; do wanted+=("$package"); done
done

if $list_only; then
  printf '%s\n' "${wanted[@]}"
  exit 0
fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "This system has no apt; please have the equivalents of these Debian packages: ${wanted[*]}"
  exit 0
fi

# One query for all: it fails for names unknown to dpkg, but it still lists the others.
installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
  sed -n 's/^installed //p' || true)
# Node.js with npm often comes from another source, and the packages of Debian would conflict with
# it.
command -v node >/dev/null && command -v npm >/dev/null && installed+=$'\nnodejs\nnpm'
missing=()
for package in "${wanted[@]}"; do
  grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "All ${#wanted[@]} packages of '$*' are installed."
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "These Debian packages are missing: ${missing[*]}" >&2
    echo "Installing them needs root, and this system has no sudo. As root, run:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  # With a terminal sudo may ask for the password; without one it must not wait for it.
  if [[ -t 0 ]]; then as_root=(sudo); else as_root=(sudo -n); fi
fi

apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive
  apt-get -qq -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 -o Dpkg::Use-Pty=0)
echo "Installing ${#missing[@]} missing Debian packages through apt: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "${missing[@]}"; } \
  >"$log" 2>&1 </dev/null; then
  tail -n 25 "$log" >&2
  echo "apt could not install: ${missing[*]}. The last lines of its output stand above." >&2
  exit 1
fi
echo "Installed."
