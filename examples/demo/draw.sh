#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws where the man of the demonstration meets the building, and what he touches along his walk. Needs no display.
#   bash examples/demo/draw.sh PROGRAMS SCANS     as build/release/bin build/demo: writes meeting.png and walk.png there
set -euo pipefail

die() { printf 'draw.sh: %s\n' "$*" >&2; exit 1; }

(($# == 2)) || die "PROGRAMS SCANS: are missing: give the folders of pcl_bsh_view and of the scans"
programs="$1" scans="$2"

# The man is 1 high in his file, and 1.8 m tall here, his middle 0.9 m above the ground. One pose a line: t, x y z, rotation.
awk 'FNR > 2 && NF == 3 { print 1.8 * $1, 1.8 * $2, 1.8 * $3; next } { print }' "$scans/man.off" >"$scans/walking_man.off"
awk 'BEGIN { for (x = -10; x <= 0; x += 0.5) print x + 10, x, 0, -2.2, 0, 0, 0, 1 }' >"$scans/walk.txt"

view() {
  "$programs/pcl_bsh_view" "$scans/building.ply" --model "$scans/walking_man.off" --clearance 0.5 --unit m --size 1200x750 "$@"
}
view --pose=-6.5,0,-2.2,0,0,0 --closest --color distance --range 3 --camera=-11,-3.2,-0.4,-6.2,0.25,-1.75 \
  --title "A man walks into a scanned building: orange points are within 0.5 m of him" --screenshot "$scans/meeting.png"
view --trajectory "$scans/walk.txt" --step 20 --color first_pose --camera=-13,-7,2.2,-3.5,0.4,-1.6 \
  --title "His walk: points that come within 0.5 m of him, by the first pose" --screenshot "$scans/walk.png"
