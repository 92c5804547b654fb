#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that are missing, configures and builds. Does no more than is left to do.
#   bash cmake/setup.sh [PRESET [TARGET...]]     default: release, all targets; into build/PRESET
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '== %s\n' "$*"; }
die() { printf 'setup.sh: %s\n' "$*" >&2; exit 1; }

missing_packages() {
  sed -e 's/#.*//' -e '/^[[:space:]]*$/d' cmake/packages.txt | while read -r package; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      printf '%s\n' "$package"
  done
}

as_root() {
  if [[ "$(id -u)" == 0 ]]; then "$@"; else sudo "$@"; fi
}

install_packages() {
  if [[ "$(id -u)" != 0 ]] && ! command -v sudo >/dev/null; then
    die "not root and no sudo: as root, run: apt-get install --no-install-recommends $*"
  fi
  say "installing $# Debian packages and what they need: $*"
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300)
  as_root "${apt[@]}" update || say "apt-get update failed; going on with the package lists at hand"
  as_root "${apt[@]}" install --yes --no-install-recommends "$@" || die "apt-get install failed: see the lines above"
}

preset="${1:-release}"

if command -v apt-get >/dev/null; then
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]})); then install_packages "${missing[@]}"; fi
else
  say "not a Debian system: cmake/packages.txt lists what must be there"
fi

say "configuring build/$preset"
cmake --preset "$preset" --log-level=WARNING

say "building build/$preset"
build=(cmake --build --preset "$preset")
if (($# > 1)); then build+=(--target "${@:2}"); fi
"${build[@]}"
