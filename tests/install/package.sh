#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   package.sh BUILD_DIR
# Makes the Debian package, unpacks it into an empty folder, and uses what is in it from another
# one. Exit code 77: skipped, there is no dpkg.
set -euo pipefail
build=$1
command -v dpkg-deb >/dev/null && command -v dpkg-shlibdeps >/dev/null ||
  { echo "skipped: needs dpkg-deb and dpkg-shlibdeps (dpkg-dev)"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/package" >"$work/cpack.log" 2>&1 ||
  { cat "$work/cpack.log"; exit 1; }
package=$(echo "$work"/package/reckon_*.deb)
dpkg-deb --field "$package" Package Version Depends
dpkg-deb --field "$package" Depends | grep -q 'libhdf5'
dpkg-deb -x "$package" "$work/root"

export HOME=$work PATH=$work/root/usr/bin:$PATH
mkdir "$work/use"
cd "$work/use"
[[ $(command -v reckon) == "$work/root/usr/bin/reckon" ]]
reckon --version
documents=$work/root/usr/share/doc/reckon
reckon grains generate --count 4 --seed 7 --d50 1mm --threads 1 -o sand.h5
cp "$documents/examples/settle/scene.toml" .
reckon check scene.toml --threads 1
reckon run scene.toml --threads 1 --steps 50
[[ -s scene.run/history.csv ]]
[[ -s $documents/guide/tests.md && -s $documents/LICENSE ]]
grep -q '^\.TH RECKON 1' "$work/root/usr/share/man/man1/reckon.1"*
bash -c 'source "$1"; COMP_WORDS=(reckon gr); COMP_CWORD=1; _reckon; [[ ${COMPREPLY[0]} == grains ]]' \
  _ "$work/root/usr/share/bash-completion/completions/reckon"
echo "the package works"
