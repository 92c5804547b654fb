#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# cmake/setup.sh tells a package that apt-get does not know, stops where nothing can be built without it, and installs the
# others. Programs of the same names stand for dpkg's and apt's, and for CMake.
#   bash unknown_packages.sh SOURCES FOLDER
set -euo pipefail
sources="$1" folder="$2"
fail() { printf 'unknown_packages: %s\n%s\n' "$*" "$(cat "$folder/said")" >&2; exit 1; }

rm -rf "$folder"
mkdir -p "$folder/bin" "$folder/clone/cmake"
cp "$sources/cmake/setup.sh" "$sources/cmake/packages.txt" "$folder/clone/cmake/"
program() { # NAME, its text from standard input
  { printf '#!/bin/bash\n'; cat; } >"$folder/bin/$1"
  chmod +x "$folder/bin/$1"
}
program dpkg-query <<'P'
[[ " $ABSENT " == *" ${*: -1} "* ]] || echo installed
P
program apt-cache <<'P'
if [[ "$1" == madison ]]; then echo "cmake | 3.31 | Debian"; exit; fi
for package in "${@:2}"; do
  printf 'Package: %s\nVersions: \n' "$package"
  [[ " $UNKNOWN " == *" $package "* ]] || printf '1.0 (lists)\n'
  printf '\nReverse Depends: \n  another,%s\nDependencies: \nProvides: \nReverse Provides: \n' "$package"
done
P
program apt-get <<P
echo "\$*" >>"$folder/apt"
P
program sudo <<'P'
exec "$@"
P
program cmake <<'P'
P
program ischroot <<'P'
exit 1
P
export PATH="$folder/bin:$PATH" CI=""

run() { # ABSENT UNKNOWN STATUS
  local status=0
  rm -f "$folder/apt"
  touch "$folder/apt"
  ABSENT="$1" UNKNOWN="$2" bash "$folder/clone/cmake/setup.sh" debug >"$folder/said" 2>&1 || status=$?
  [[ "$status" == "$3" ]] || fail "absent '$1', unknown '$2': exit code $status instead of $3"
}
installed() { grep -q "install .*[ ]$1\( \|$\)" "$folder/apt"; }
told() { grep -q "^$2$1: this system's package lists do not have it" "$folder/said"; }

run "" "" 0
[[ ! -s "$folder/apt" && ! -e "$folder/clone/build/not_installed.txt" ]] || fail "nothing was missing"

run "gappa doxygen" "gappa" 0
told gappa "== " || fail "gappa is unknown, and is not told"
installed doxygen || fail "doxygen is not installed"
! installed gappa || fail "gappa is unknown, and apt-get is asked for it"
grep -q '^gappa: ' "$folder/clone/build/not_installed.txt" || fail "not_installed.txt does not name gappa"

run "gappa" "gappa" 0 # nothing is left to install: no root is needed, and no network
told gappa "== " || fail "gappa alone is unknown, and is not told"
[[ ! -s "$folder/apt" ]] || fail "apt-get is called for nothing"

run "libpcl-dev mypy" "libpcl-dev" 1
told libpcl-dev "setup.sh: " || fail "libpcl-dev is unknown, and is not told"
! installed mypy || fail "packages are installed though nothing can be built"

run "mypy" "" 0
installed mypy || fail "mypy is not installed"
[[ ! -e "$folder/clone/build/not_installed.txt" ]] || fail "not_installed.txt is of another run"
echo "what apt-get does not know is told"
