#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the clouds and poses that the pipelines beside this file name, so that each of them can be run in that folder.
# The programs are found in PATH, or where `bash cmake/setup.sh release programs` builds them.
#   bash make_clouds.sh FOLDER
set -euo pipefail
PATH="$PATH:$PWD/build/release/bin"

die() { printf 'make_clouds.sh: %s\n' "$*" >&2; exit 1; }

(($# == 1)) || die "FOLDER: is missing: say where the clouds shall go"
command -v pcl_bsh_tunnel >/dev/null || die "pcl_bsh_tunnel: not found: install pcl-bsh-tools, or run bash cmake/setup.sh release programs"
mkdir -p "$1"
cd "$1"

# cloud FILE SIZE PROGRAM: the points that awk's PROGRAM gives to point(x, y, z), with an intensity, as floats of SIZE
cloud() {
  awk "function point(x, y, z) { printf \"%.6f %.6f %.6f %d\\n\", x, y, z, n++ % 100 } BEGIN { $3 }" >"$1.points"
  {
    printf 'FIELDS x y z intensity\nSIZE %d %d %d 4\nTYPE F F F F\n' "$2" "$2" "$2"
    printf 'POINTS %d\nDATA ascii\n' "$(wc -l <"$1.points")"
    cat "$1.points"
  } >"$1"
  rm "$1.points"
}

# A room's floor and a wall, and in it a robot, of which the scan sees some points, too.
robot='for (a = 0; a < 6.28; a += 0.1) for (z = 0; z <= 1.2; z += 0.02) point(0.2 * cos(a), 0.2 * sin(a), z)'
cloud robot.pcd 4 "$robot"
cloud scan.pcd 4 'for (x = 0; x < 4; x += 0.02) for (y = 0; y < 4; y += 0.02) point(x, y, 0);
  for (x = 0; x < 4; x += 0.02) for (z = 0; z < 2; z += 0.02) point(x, 2.22, z);
  for (a = 0; a < 3.14; a += 0.05) for (z = 0; z <= 1.2; z += 0.03) point(1.5 + 0.2 * cos(a), 2 - 0.2 * sin(a), z)'
printf '0 -1 0 1.5\n1 0 0 2\n0 0 1 0\n' >T_scan_robot.txt

# Ground in UTM coordinates, and a line of power that a tree has grown up to.
cloud terrain.pcd 8 'for (x = 0; x < 50; x += 0.5) for (y = 0; y < 50; y += 0.5) point(500000 + x, 5400000 + y, 100 + sin(x / 9));
  for (a = 0; a < 6.28; a += 0.1) for (z = 0; z < 12; z += 0.1) point(500025 + cos(a), 5400025 + sin(a), 100 + z)'
awk 'BEGIN { for (x = 0; x < 50; x += 0.02) printf "%.6f %.6f %.6f\n", 500000 + x, 5400025, 111.9 }' >power_line.xyz

# Two scans of one place: a box has gone, another has come.
place='for (x = 0; x < 5; x += 0.05) for (y = 0; y < 5; y += 0.05) point(x, y, 0)'
cloud before.pcd 4 "$place; for (x = 1; x < 2; x += 0.05) for (z = 0.3; z < 1; z += 0.05) point(x, 1, z)"
cloud after.pcd 4 "$place; for (x = 3; x < 4; x += 0.05) for (z = 0.3; z < 1; z += 0.05) point(x, 4, z)"

# A hall with a column, a machine as triangles, and its way along the hall.
cloud hall.pcd 4 'for (x = 0; x < 6; x += 0.04) for (y = 0; y < 4; y += 0.04) point(x, y, 0);
  for (x = 0; x < 6; x += 0.04) for (z = 0; z < 3; z += 0.04) { point(x, 0, z); point(x, 4, z) }
  for (a = 0; a < 6.28; a += 0.2) for (z = 0; z < 3; z += 0.04) point(3 + 0.15 * cos(a), 2.6 + 0.15 * sin(a), z)'
awk 'function face(a, b, c, d) { triangle(a, b, c); triangle(a, c, d) }
  function triangle(a, b, c) { printf "facet normal 0 0 0\nouter loop\n%s%s%sendloop\nendfacet\n", v[a], v[b], v[c] }
  function box(x0, y0, z0, x1, y1, z1,   k) {
    for (k = 0; k < 8; ++k)
      v[k] = sprintf("vertex %g %g %g\n", k % 2 ? x1 : x0, int(k / 2) % 2 ? y1 : y0, k > 3 ? z1 : z0)
    face(0, 2, 3, 1); face(4, 5, 7, 6); face(0, 1, 5, 4); face(2, 6, 7, 3); face(0, 4, 6, 2); face(1, 3, 7, 5)
  }
  BEGIN { print "solid machine"; box(-0.6, -0.4, 0.2, 0.6, 0.4, 1.2); box(-0.1, -0.1, 1.2, 0.1, 0.1, 2.4); print "endsolid machine" }' >machine.stl
awk 'BEGIN { for (x = 0.8; x < 5.3; x += 0.2) printf "1 0 0 %g 0 1 0 2 0 0 1 0\n", x }' >machine_way.txt

# The ground as LAS, and a road that is to be built there, as a mesh.
printf '["terrain.pcd", "terrain.las"]' | pcl_bsh_pipeline -
awk 'BEGIN { for (k = 0; k <= 10; ++k) for (side = 0; side < 2; ++side) printf "v %.3f %.3f %.3f\n", 500000 + 5 * k, 5400010 + 6 * side, 100 + sin(k * 5 / 9) / 2
  for (k = 0; k < 10; ++k) printf "f %d %d %d %d\n", 2 * k + 1, 2 * k + 2, 2 * k + 4, 2 * k + 3 }' >road.obj

# A tunnel, a wagon and its way.
pcl_bsh_tunnel tunnel --scale 0.005
for cloud in scan.ply:tunnel.pcd wagon.ply:wagon.pcd; do
  printf '["tunnel/%s", "%s"]' "${cloud%:*}" "${cloud#*:}" | pcl_bsh_pipeline -
done
cp tunnel/poses.txt track.txt
printf 'made the clouds of the sample pipelines in %s\n' "$1"
