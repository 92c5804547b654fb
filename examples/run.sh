#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The demonstration, from a fresh clone: installs what it needs, builds the programs that it runs, fetches two clouds, lets
# a man walk through a scanned building, and draws where they meet. The first run takes minutes, a later one seconds. All
# programs: bash cmake/setup.sh release programs
#   bash examples/run.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scans=build/demo
bash cmake/setup.sh release demonstration
bash examples/demo/fetch_scans.sh "$scans"
printf '\n'
build/release/bin/pcl_bsh_demo "$scans/building.ply" "$scans/man.off" "$scans/building_collision.pcd"

if [[ -x build/release/bin/pcl_bsh_view ]]; then # where VTK is
  bash examples/demo/draw.sh build/release/bin "$scans"
fi
printf '\n%s\n' "Try next, after: bash cmake/setup.sh release programs && export PATH=\"\$PWD/build/release/bin:\$PATH\"
  pcl_bsh_collide $scans/building.ply $scans/walking_man.off build/free.ply --clearance 0.5 --pose=-6.5,0,-2.2,0,0,0 --keep free
  pcl_bsh_collide $scans/building.ply $scans/walking_man.off build/walk.las --clearance 0.5 --trajectory $scans/walk.txt --clashes build/clashes.html
  pcl_bsh_view $scans/building.ply --model $scans/walking_man.off --trajectory $scans/walk.txt --clearance 0.5 --unit m"
