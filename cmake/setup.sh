#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that are missing, configures and builds. Does no more than is left to do.
#   bash cmake/setup.sh [PRESET [TARGET...]]     default: release, all targets; into build/PRESET
# Installs the sections of packages.txt which the preset and the target need. For `library` these
# are the needs of core, search and filters. The targets `demonstration`, `programs`, `python`,
# `docs` and `self_filter` have sections of their own. All others get everything except [paraview].
# The preset `paraview` needs packages that exclude those of the others: apt-get removes nothing,
# and fails. A package that this system's lists do not have is told, and kept in
# build/not_installed.txt for test/run.sh to tell again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '== %s\n' "$*"; }
die() { printf 'setup.sh: %s\n' "$*" >&2; exit 1; }

preset="${1:-release}"
targets=("${@:2}")
shown="core library documents pipelines sites viewer" # what the demonstration needs
case "${targets[*]}" in
  demonstration) sections="$shown" ;;
  programs) sections="$shown geodata certify" ;;
  python | self_filter | docs) sections="$shown geodata ${targets[*]}" ;;
  *) sections="$shown geodata certify physics tests docs self_filter ompl python" ;;
esac
case "$preset" in
  library) sections="core library" ;;
  paraview) sections="core documents paraview" ;;
esac

unknown="" # packages that apt-get does not know, each between blanks

# The packages of some sections that are not installed, save for the unknown ones.
missing_packages() {
  sed -e 's/#.*//' -e 's/[[:space:]]*$//' cmake/packages.txt | awk -v sections=" $* " '
    /^\[/ { wanted = index(sections, " " substr($0, 2, length($0) - 2) " "); next }
    NF && wanted { print }' | while read -r package; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      [[ "$unknown" == *" $package "* ]] || printf '%s\n' "$package"
  done
}

# Which of these packages the lists of apt-get neither have nor see provided by others.
find_unknown() {
  local known package
  known=" $(apt-cache showpkg "$@" 2>/dev/null | awk '
    /^Package: / { package = $2; there = 0; next }
    /^(Versions|Reverse Provides):/ { there = 1; next }
    /^(Reverse Depends|Dependencies|Provides):/ { there = 0; next }
    NF && there { print package }' | sort -u | tr '\n' ' ')"
  unknown=""
  for package in "$@"; do
    [[ "$known" == *" $package "* ]] || unknown="${unknown:- }$package "
  done
}

# This system may lack or rename packages. Without those of the first sections nothing can be built; what needs one of the
# others is left out.
tell_unknown() {
  local needed package
  needed=" $(unknown="" missing_packages core library documents pipelines | tr '\n' ' ')"
  for package in $unknown; do
    if [[ "$needed" == *" $package "* ]]; then
      die "$package: this system's package lists do not have it (cmake/packages.txt names it), and nothing can be built without it"
    fi
    say "$package: this system's package lists do not have it (cmake/packages.txt names it): what needs it is left out"
    printf '%s: this system has no such package\n' "$package" >>build/not_installed.txt
  done
}

as_root() {
  if [[ "$(id -u)" == 0 ]]; then "$@"; else sudo "$@"; fi
}

# In a container nothing has to survive a power failure: dpkg need not wait for the disk after each file (eatmydata).
in_container() { [[ -e /.dockerenv || -e /run/.containerenv || -n "${CI:-}" ]] || ischroot 2>/dev/null; }

apt_get() {
  local unsynced=()
  if in_container && command -v eatmydata >/dev/null; then unsynced=(eatmydata); fi
  as_root env DEBIAN_FRONTEND=noninteractive "${unsynced[@]}" apt-get -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 "$@"
}

install_packages() {
  apt_get install --yes --no-remove --no-install-recommends "$@" || die "apt-get install failed: see the lines above"
}

# Warnings are errors where the environment says PCL_BSH_WERROR=ON (CMakePresets.json).
configure() { cmake --preset "$preset" --log-level=WARNING "$@"; }

# The names of what apt-get would install for these packages.
with_dependencies() {
  apt_get install --simulate --no-install-recommends "$@" | sed -n 's/^Inst \([^ ]*\) .*/\1/p' | sort
}

# apt-get downloads without its lock, and installs when those who hold it are done.
download_and_install() { # FOLDER OF DOWNLOADS, PACKAGES TO DOWNLOAD..., --, PACKAGES TO INSTALL...
  local folder="$1" downloads=()
  shift
  while [[ "$1" != -- ]]; do downloads+=("$1"); shift; done
  shift
  (cd "$folder" && apt_get download "${downloads[@]}") || say "a download failed: apt-get tries again"
  install_packages -o Dir::Cache::archives="$folder" "$@"
  rm -rf "$folder"
}

# Most packages are PCL's and VTK's, which the core and some others do not need: they are downloaded while the core's
# packages are installed, and installed while the core is compiled.
install_all_and_build_core() {
  local core rest others log="$PWD/build/apt.log"
  mapfile -t core < <(missing_packages core documents)
  mapfile -t rest < <(missing_packages $sections)
  mapfile -t others < <(comm -13 <(with_dependencies "${core[@]}") <(with_dependencies "${rest[@]}"))
  mkdir -p build/packages/partial
  say "installing ${#others[@]} packages in the background; what apt-get says of them is in $log"
  download_and_install "$PWD/build/packages" "${others[@]}" -- "${rest[@]}" >"$log" 2>&1 &
  local installing=$!
  trap 'wait' EXIT # whatever fails: apt-get is not left half done
  if ((${#core[@]})); then install_packages "${core[@]}"; fi
  configure -D PCL_BSH_WITHOUT_PCL=ON
  cmake --build --preset "$preset" --target pcl_bsh_documents pcl_bsh_cli
  trap - EXIT
  wait "$installing" || { tail -n 20 "$log" >&2; die "apt-get install failed: see the lines above, and $log"; }
}

mkdir -p build
rm -f build/not_installed.txt
if command -v apt-get >/dev/null; then
  mapfile -t missing < <(missing_packages $sections)
  if ((${#missing[@]})); then
    find_unknown "${missing[@]}"
    if [[ -n "$(missing_packages $sections)" || -z "$(apt-cache madison cmake)" ]]; then # some to install, or no lists yet
      if [[ "$(id -u)" != 0 ]] && ! command -v sudo >/dev/null; then
        die "not root and no sudo: as root, run: apt-get install --no-install-recommends ${missing[*]}"
      fi
      say "installing ${#missing[@]} Debian packages and what they need: ${missing[*]}"
      apt_get update || say "apt-get update failed; going on with the package lists at hand"
      find_unknown "${missing[@]}"
    fi
    tell_unknown
    mapfile -t missing < <(missing_packages $sections)
  fi
  if ((${#missing[@]})); then
    if in_container; then install_packages eatmydata; fi
    if [[ " ${missing[*]} " == *" libpcl-dev "* && "$preset" == release ]]; then
      install_all_and_build_core
    else
      install_packages "${missing[@]}"
    fi
  fi
else
  say "not a Debian system: cmake/packages.txt lists what must be there"
fi

say "configuring build/$preset"
configure

say "building build/$preset"
build=(cmake --build --preset "$preset")
if ((${#targets[@]})); then build+=(--target "${targets[@]}"); fi
"${build[@]}"
