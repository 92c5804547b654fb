#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Unpacks what the core and its tests link, for AArch64, into build/aarch64-libraries: the system's own packages stay as
# they are. Also needs g++-aarch64-linux-gnu and qemu-user.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
libraries="$PWD/build/aarch64-libraries"
rm -rf "$libraries"
mkdir -p "$libraries"/apt/{lists/partial,cache/archives/partial}
touch "$libraries/apt/status"
cd "$libraries/apt"
apt=(apt-get -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State::lists="$PWD/lists"
  -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD/cache")
"${apt[@]}" update
"${apt[@]}" download libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 libhwy-dev libhwy1 libgtest-dev libgmock-dev
for package in *.deb; do dpkg-deb --extract "$package" "$libraries"; done
rm -rf "$libraries/apt"
