#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# test/near.sh names the rooms that a change can break.
#   bash test/project/near.sh SOURCES
set -euo pipefail
cd "$1"
fail() { printf 'near: %s\n' "$*" >&2; exit 1; }
expect() { # ROOMS FILE...
  local rooms="$1" found
  shift
  found="$(bash test/near.sh --list "$@" | sed -n 's/^== near: //p')"
  [[ "$found" == "$rooms" ]] || fail "$*: '$found', not '$rooms'"
}

expect "pairs" test/pairs/trace_test.cpp
expect "pairs" pcl_bsh/pairs/trace.cpp
expect "many_poses pairs robot scene" pcl_bsh/pairs/any_at_places.h             # which these include
expect "clashes query question scene symmetries" pcl_bsh/question/question.h
expect "clusters pairs" pcl_bsh/clusters/clusters.cpp test/pairs/trace_test.cpp # of both
expect "no room of the core" filters/query_filter.h
all="$(bash test/near.sh --list pcl_bsh/hierarchy/points_view.h)"
for room in hierarchy flags pairs distances trajectory scene question symmetries memory; do
  [[ " $all " == *" $room"* ]] || fail "points_view.h: $room is not named"
done
[[ "$all" == *"left to the preset release: "*pipeline* ]] || fail "points_view.h: the pipelines are not left to the release build"

status=0
said="$(bash test/near.sh nix 2>&1)" || status=$?
[[ "$status" == 2 && "$said" == "near.sh: FILE: 'nix' is no file: write "* ]] || fail "nix: exit $status, '$said'"
