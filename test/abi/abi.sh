#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Programs that were linked to the last version rely on what its libraries export and on the types of its public headers.
# The files *.abi.xz describe both.
#   bash test/abi/abi.sh check BUILD [FOLDER]       prints abidiff's report of BUILD's libraries against the descriptions.
#                                                   It fails where a library differs, and has the version that is described.
#   bash test/abi/abi.sh describe BUILD [FOLDER]    writes the descriptions by abidw.
# BUILD: all of the preset package. FOLDER: holds the descriptions; default: the folder of this script.
# Compilers tell abidw different things of the same sources, and types of PCL are types of its version. A library is compared
# where it was built with the compiler and the PCL of its description: those of Debian 12.
set -euo pipefail
fail() { printf 'abi.sh: %s\n' "$*" >&2; exit 1; }
skip() { printf 'abi.sh: skipped: %s\n' "$*"; exit 77; }
if (($# < 2 || $# > 3)) || [[ "$1" != check && "$1" != describe ]]; then
  printf 'abi.sh: write bash test/abi/abi.sh check BUILD, or describe BUILD\n' >&2
  exit 2
fi
build="$2" folder="${3:-$(dirname "${BASH_SOURCE[0]}")}"
command -v abidw >/dev/null || skip "abidw is not found: install abigail-tools"
command -v xz >/dev/null || skip "xz is not found: install xz-utils"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
for component in libs dev; do
  cmake --install "$build" --component "$component" --prefix "$work/installed" >"$work/log" ||
    fail "$build: cannot be installed: build the preset package first"
done
library() { find "$work/installed" -name "lib$1.so"; }

# The symbols' version is left out, for it changes with each version. The last line tells compiler and PCL.
describe() { # LIBRARY FILE
  [[ "$(readelf --sections --wide "$1")" == *" .debug_info "* ]] || fail "$1: has no debug information: build the preset package"
  abidw --headers-dir "$work/installed/include" --drop-private-types --exported-interfaces-only --no-corpus-path \
    --no-comp-dir-path --no-show-locs --no-parameter-names --no-elf-needed "$1" |
    sed -E "s/@@?PCL_BSH_[0-9.]+//g; s/ version='PCL_BSH_[^']*' is-default-version='yes'//" >"$2"
  {
    readelf --string-dump=.comment "$1" | sed -nE 's/^ *\[.*\] +(GCC|.*clang).* ([0-9]+)\.[^ ]*$/\1 \2/p'
    readelf --dynamic "$1" | sed -nE '/libpcl_bsh_/d; s/.*\[libpcl_[a-z_0-9]+\.so\.([0-9.]+)\]$/PCL \1/p'
  } | sort -u | paste -s -d ';' | sed 's/.*/<!-- & -->/' >>"$2"
}

if [[ "$1" == describe ]]; then
  for name in pcl_bsh_{core,search,filters,pipeline,sites}; do
    file="$(library "$name")"
    if [[ -z "$file" ]]; then continue; fi
    describe "$file" "$work/$name.abi"
    xz -9 --extreme --stdout "$work/$name.abi" >"$folder/$name.abi.xz"
    printf '%s: %s bytes\n' "$folder/$name.abi.xz" "$(stat --format %s "$folder/$name.abi.xz")"
  done
  exit 0
fi

soname() { sed -n "1s/.* soname='\([^']*\)'.*/\1/p" "$1"; }
changed=()
compared=0
for description in "$folder"/*.abi.xz; do
  name="$(basename "$description" .abi.xz)"
  file="$(library "$name")"
  if [[ -z "$file" ]]; then
    printf 'abi.sh: not compared: %s is not built\n' "$name"
    continue
  fi
  xz --decompress --stdout "$description" >"$work/old.abi"
  describe "$file" "$work/new.abi"
  with="$(tail -n 1 "$work/new.abi")"
  if [[ "$with" != "$(tail -n 1 "$work/old.abi")" ]]; then
    printf 'abi.sh: not compared: %s is built with %s, its description is of %s\n' "$name" "$with" "$(tail -n 1 "$work/old.abi")"
    continue
  fi
  compared=$((compared + 1))
  printf '== %s: since %s\n' "$(soname "$work/new.abi")" "$(soname "$work/old.abi")"
  status=0
  abidiff --no-added-syms "$work/old.abi" "$work/new.abi" || status=$?
  if ((status & 3)); then fail "$description: abidiff cannot compare it with $file"; fi
  if ((status)) && [[ "$(soname "$work/old.abi")" == "$(soname "$work/new.abi")" ]]; then changed+=("$(soname "$work/new.abi")"); fi
done
((compared)) || skip "no library of $build is built as $folder describes it"
if ((${#changed[@]})); then
  fail "${changed[*]}: other than described: undo what is reported above, or raise PCL_BSH_VERSION_MINOR in pcl_bsh/version.h"
fi
