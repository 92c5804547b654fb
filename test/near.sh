#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds and runs the core's tests that a change to some files can break (preset dev), and says how long it took.
#   bash test/near.sh [--list] FILE...     --list: names the rooms and ends.
# A file can break its own room, and each room that has a file that includes it, directly or not. A public header
# (pcl_bsh/CMakeLists.txt) can also break each room that includes its room by the table of ARCHITECTURE.md.
# Tests that take long (test/long_tests.txt), and rooms outside of the core, are left to test/run.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() { printf 'near.sh: %s: write bash test/near.sh [--list] FILE...\n' "$*" >&2; exit 2; }

list=""
if [[ "${1:-}" == --list ]]; then
  list=yes
  shift
fi
(($#)) || usage "FILE: is missing"
changed=()
for file in "$@"; do
  path="$(realpath --no-symlinks --relative-to=. "$file" 2>/dev/null)" && [[ -f "$path" ]] || usage "FILE: '$file' is no file"
  changed+=("$path")
done

# Prints the rooms of the changed files, then those of all files that include them.
rooms() {
  awk -v public="$(sed -n 's/^ *FILES \([a-z_/]*\.h\)$/\1/p; s/^ *\([a-z_/]*\.h\))*$/\1/p' pcl_bsh/CMakeLists.txt | tr '\n' ' ')" \
    -v changed="${changed[*]}" '
    function room_of(file, part) { # pcl_bsh/pairs/trace.h, test/pairs/trace_test.cpp: pairs
      sub(/^filters\/pipeline\/.*/, "test/pipeline/", file)
      sub(/^filters\/.*/, "test/filters/", file)
      sub(/\/(io|tools|examples)\//, "/", file)
      split(file, part, "/")
      return file ~ /\/.*\// ? part[2] : ""
    }
    function add(file) {
      if (file in reached) return
      reached[file] = 1
      queue[++last] = file
    }
    FILENAME == "ARCHITECTURE.md" { # a row of the table: | `pcl_bsh/ROOM` | target | lives | never | includes |
      if (split($0, column, "|") != 7 || column[2] !~ /^ `pcl_bsh\/[a-z_]+` $/) next
      room = column[2]
      gsub(/[ `]|pcl_bsh\//, "", room)
      count = split(column[6], included, /[ ,]+/)
      for (i = 1; i <= count; ++i) if (included[i] != "") above[included[i]] = above[included[i]] " " room
      next
    }
    match($0, /^ *# *include [<"][^>"]+[>"]/) {
      path = substr($0, RSTART, RLENGTH)
      gsub(/^.*include [<"]|[>"]$/, "", path)
      folder = FILENAME
      sub(/\/[^\/]*$/, "", folder)
      if (path !~ /^(pcl_bsh|filters|examples)\//) {
        includers[folder "/" path] = includers[folder "/" path] " " FILENAME
        path = "test/" path # "support/...": what tests share
      }
      includers[path] = includers[path] " " FILENAME
    }
    END {
      count = split(changed, files, " ")
      for (i = 1; i <= count; ++i) {
        add(files[i])
        header = files[i]
        if (!sub(/^pcl_bsh\//, "", header) || !index(" " public, " " header " ")) continue
        others = split(above[room_of(files[i])], other, " ")
        for (k = 1; k <= others; ++k) found[other[k]] = 1
      }
      for (i = 1; i <= last; ++i) {
        found[room_of(queue[i])] = 1
        others = split(includers[queue[i]], other, " ")
        for (k = 1; k <= others; ++k) add(other[k])
      }
      for (room in found) if (room != "") print room
    }' ARCHITECTURE.md $(find pcl_bsh filters test -name '*.h' -o -name '*.hpp' -o -name '*.cpp') | sort
}

core=" $(sed -n '/^set(threaded/,/)/p; /^set(core_tests/p' test/CMakeLists.txt | sed 's/^set([a-z_]*//; s/[${}()]//g' | tr '\n' ' ') "
near=() left=()
for room in $(rooms); do
  if [[ "$core" == *" $room "* ]]; then
    near+=("$room")
  elif [[ -n "$(compgen -G "test/$room/*_test.cpp" || compgen -G "test/*/$room/*_test.cpp")" ]]; then
    left+=("$room")
  fi
done
printf '== near: %s\n' "${near[*]:-no room of the core}"
if ((${#left[@]})); then
  printf '== left to the preset release: %s\n' "${left[*]}"
fi
if [[ -n "$list" || ${#near[@]} == 0 ]]; then exit 0; fi

TIMEFORMAT='== took %R s, of which %U s of processor time, and %S s of the system'
time {
  if [[ ! -e build/dev/build.ninja ]]; then cmake --preset dev --log-level=WARNING; fi
  cmake --build --preset dev --target "${near[@]/%/_test}"
  ctest --preset dev --parallel "$(nproc)" --label-regex "-($(IFS='|'; printf '%s' "${near[*]}"))$"
}
