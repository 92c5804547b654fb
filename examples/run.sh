#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The demonstration, from a fresh clone: installs what it needs, builds the programs that it runs, fetches two clouds, lets
# a man walk through a scanned building, and draws where he collides. Run again, it takes seconds. All programs:
# bash cmake/setup.sh release programs
#   bash examples/run.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scans=build/demo
bash cmake/setup.sh release demonstration
bash examples/demo/fetch_scans.sh "$scans"
printf '\n'
build/release/bin/pcl_bsh_demo "$scans/building.ply" "$scans/man.off" "$scans/building_collision.pcd"

if [[ -x build/release/bin/pcl_bsh_view ]]; then # where VTK is
  build/release/bin/pcl_bsh_view "$scans/building_collision.pcd" --screenshot "$scans/building_collision.png"
fi
