#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws the pictures beside this file anew, from a made-up tunnel and the demonstration's clouds. Needs no display.
#   bash examples/pictures/draw.sh [BUILD]     default: build/release
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

programs="${1:-build/release}/bin"
scans=build/demo
bash examples/demo/fetch_scans.sh "$scans"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

view() { "$programs/pcl_bsh_view" --size 1080x720 "$@" --unit m; }

# A wagon in its tunnel, which is cut off before the wagon's front: how near is the wall, and where does it touch?
"$programs/pcl_bsh_tunnel" "$work/tunnel" >/dev/null
mv "$work/tunnel/scan.ply" "$work/tunnel/tunnel.ply"
sed --quiet 304p "$work/tunnel/poses.txt" >"$work/tunnel/pose.txt"
view "$work/tunnel/tunnel.ply" --model "$work/tunnel/wagon.ply" --pose "$work/tunnel/pose.txt" --clearance 0.05 \
  --color distance --range 1 --cut=193.034,8.775,2.622,0.963,0.270,0.008 \
  --camera=208.704,26.682,10.991,190.042,7.935,3.496 --size 1200x600 --screenshot examples/pictures/tunnel.png

# The demonstration: the man in the doorway, and along his walk.
bash examples/demo/draw.sh "$programs" "$scans"
cp "$scans/meeting.png" "$scans/walk.png" examples/pictures/

# The query at work: most spheres are out of reach, two leaves are compared.
man=("$scans/building.ply" --model "$scans/man.off")
view "${man[@]}" --pose=-7,0,-2.6,0,0,0 --clearance 0.5 --trace --camera=-9.4,-2.6,-1.2,-7,0,-2.2 \
  --screenshot examples/pictures/query.png

# A scene: the visitor walks up a step and along the wall; what is within 0.3 m of him stands out.
view --scene examples/scenes/walk.json --step 90 --clearance 0.3 --camera=-17,-7.5,-0.4,-6.6,0.3,-2.9 \
  --screenshot examples/pictures/scene.png

# Bodies: a man of points pushes two crates, which are meshes, before him.
view --scene examples/scenes/push.json --step 95 --size 1000x620 --camera=-3.2,-5.6,3.6,-0.1,0,0.6 \
  --title "A man walks on, and two crates give way" --screenshot examples/pictures/bodies.png

# A robot of a scene, by states of its joints (where robots are read).
if [[ -x "$programs/pcl_bsh_arm" ]]; then
  view --scene examples/scenes/robot.json --step 11 --size 1000x560 --camera=2.3,-1.6,1.3,0.42,0.02,0.36 \
    --title "An arm reaches over a table" --screenshot examples/pictures/robot.png
fi

# A robot cut out of what its own camera sees (where it was built: bash cmake/setup.sh release self_filter).
if [[ -x "$programs/pcl_bsh_self_filter" ]]; then
  "$programs/pcl_bsh_made_robot" "$work/robot" >/dev/null
  sed --quiet '1p;4p' "$work/robot/states.csv" >"$work/robot/state.csv"
  "$programs/pcl_bsh_self_filter" "$work/robot/robot.urdf" "$work/robot/frame_002.pcd" --frame camera --flag \
    --states "$work/robot/state.csv" --out "$work/robot/flagged" >/dev/null
  view "$work/robot/flagged/frame_002.pcd" --camera=0.55,-0.75,-0.7,0.05,0.35,1.3,0,-1,0.3 \
    --screenshot examples/pictures/self_filter.png
fi

# Two real scans of a room, at the first guess of how they lie to each other: how far is each point of the first from the
# second? Drawn where the scans are there: PCL_BSH_SHARED_DIR is a folder with data/indoor_room_scan1.pcd and ..._scan2.pcd
# (from PCL's repository of data, tutorials/room_scan1.pcd and room_scan2.pcd).
rooms="${PCL_BSH_SHARED_DIR:-}/data/indoor_room_scan"
if [[ -r "${rooms}1.pcd" ]]; then
  view "${rooms}1.pcd" --model "${rooms}2.pcd" --pose 1.79387,0.720047,0,0,0,0.6931 --color distance \
    --camera=-9,-13,15,0.5,0,-0.5 --screenshot examples/pictures/distances.png
  # These scans, with places off by up to 2 cm: which points are within 10 cm, which may be, and
  # where are holes?
  "$programs/pcl_bsh_collide" "${rooms}1.pcd" "${rooms}2.pcd" "$work/room.pcd" --pose 1.79387,0.720047,0,0,0,0.6931 \
    --clearance 0.1 --uncertainty 0.02 --obstacle-uncertainty 0.02 --density >/dev/null
  view "$work/room.pcd" --camera=3.5,0.8,22,3.5,0.81,0 --screenshot examples/pictures/verdicts.png
fi

# A press, closed and then with a side missing: in the first room, by signed distance, and its open edges.
bash examples/pictures/press.sh >"$work/press.off"
bash examples/pictures/press.sh open >"$work/open_press.off"
if [[ -r "${rooms}1.pcd" ]]; then
  view "${rooms}1.pcd" --model "$work/press.off" --pose=1.6,0.2,-1.2,0,0,0.4 --solid --color distance --range 2 \
    --cut 0,0,1.2,0,0,1 --camera=6.5,-6,6,1,0.2,-0.6 --screenshot examples/pictures/solid.png
fi
view "$work/open_press.off" --open-edges --camera=7,-6,4.5,0,0,1.2 --screenshot examples/pictures/open_edges.png
# A made room of 8 m x 6 m with a pillar, scanned from one place: what of a sheet 1.2 m above the floor did nobody see?
awk 'BEGIN {
  print "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nVIEWPOINT 1.5 2 1.5 1 0 0 0\nPOINTS " 628 * 156 "\nDATA ascii"
  for (row = 0; row < 156; ++row) for (column = 0; column < 628; ++column) {
    up = -1.2 + 0.01 * row; around = 0.0100051 * column
    d[1] = cos(up) * cos(around) + 1e-12; d[2] = cos(up) * sin(around) + 1e-12; d[3] = sin(up) + 1e-12
    split("1.5 2 1.5", o); split("8 6 9", high); split("3.4 2.6 0", from); split("4 3.2 9", to)
    range = 99; enter = -99; leave = 99
    for (k = 1; k <= 3; ++k) {
      t = ((d[k] > 0 ? high[k] : 0) - o[k]) / d[k]; if (t < range) range = t
      a = (from[k] - o[k]) / d[k]; b = (to[k] - o[k]) / d[k]; if (a > b) { t = a; a = b; b = t }
      if (a > enter) enter = a; if (b < leave) leave = b
    }
    if (enter <= leave && enter > 0 && enter < range) range = enter
    print o[1] + range * d[1], o[2] + range * d[2], o[3] + range * d[3]
  }
}' >"$work/pillar.pcd"
awk 'BEGIN { for (x = 0.1; x < 7.95; x += 0.02) for (y = 0.1; y < 5.95; y += 0.02) print x, y, 1.2 }' >"$work/sheet.xyz"
"$programs/pcl_bsh_collide" "$work/pillar.pcd" "$work/sheet.xyz" "$work/out.pcd" --clearance 0.05 --seen \
  --obstacle-out "$work/room.pcd" >/dev/null
# Beside the verdicts the pillar, cut off below the ceiling, and where the scanner stood.
{
  printf 'OFF\n8 6 0\n'
  printf '%s %s %s\n' 3.4 2.6 0  4 2.6 0  4 3.2 0  3.4 3.2 0  3.4 2.6 2.2  4 2.6 2.2  4 3.2 2.2  3.4 3.2 2.2
  printf '4 %s %s %s %s\n' 0 3 2 1  4 5 6 7  0 1 5 4  1 2 6 5  2 3 7 6  3 0 4 7
} >"$work/pillar.off"
{
  printf 'OFF\n6 8 0\n'
  printf '%s %s %s\n' 1.58 2 1.5  1.42 2 1.5  1.5 2.08 1.5  1.5 1.92 1.5  1.5 2 1.58  1.5 2 1.42
  printf '3 %s %s %s\n' 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5
} >"$work/scanner.off"
view "$work/room.pcd" "$work/pillar.off" "$work/scanner.off" --camera=3,-6.2,7.6,3.75,2.4,0.2 \
  --screenshot examples/pictures/unseen.png

# The cost of accuracy in time: it is measured, so draw it while nothing else runs. OpenMP of one
# thread is a call, as for the rows of BENCHMARK.md: PCL's times are half as long so.
alone="$(realpath "$programs/../test/benchmark/libone_thread_openmp.so")" # of the preset benchmark
LD_PRELOAD="$alone" "${alone%/*}/bench_accuracy" "$scans/building.ply" "$scans/man.off" --vertices-only --clearance 0.5 \
  --pose=-7,0,-2.6,0,0,0 --poses 10 --unit m --out "$work/study" >/dev/null
mv "$work/study/accuracy.png" examples/pictures/accuracy.png
