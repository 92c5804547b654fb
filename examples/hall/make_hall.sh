#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes two scans of a hall in UTM coordinates, a week apart, three machines in millimetres, and the way by which one of
# them is carried in. In the second week the beam has been raised, and a cabinet stands in the way.
# The programs are found in PATH, or where `bash cmake/setup.sh release programs` builds them.
#   bash make_hall.sh FOLDER
set -euo pipefail
PATH="$PATH:$PWD/build/release/bin"

die() { printf 'make_hall.sh: %s\n' "$*" >&2; exit 1; }

(($# == 1)) || die "FOLDER: is missing: say where the files shall go"
command -v pcl_bsh_pipeline >/dev/null ||
  die "pcl_bsh_pipeline: not found: install pcl-bsh-tools, or run bash cmake/setup.sh release programs"
mkdir -p "$1"
cd "$1"

# scan NAME BEAM CABINET: BEAM is the height of its lower side in metres; CABINET is 1 where there is one
scan() {
  awk -v beam="$2" -v cabinet="$3" '
    function point(x, y, z, class) {
      printf "%.4f %.4f %.4f %d\n", 500000 + x + noise(), 5400000 + y + noise(), 100 + z + noise(), class
    }
    function noise() { return 0.002 * (rand() - 0.5) }
    BEGIN {
      srand(1)
      for (x = 0; x <= 12; x += 0.05) for (y = 0; y <= 8; y += 0.05) point(x, y, 0, 2) # the floor
      for (x = 0; x <= 12; x += 0.05) for (z = 0.05; z <= 4; z += 0.05) { point(x, 0, z, 6); point(x, 8, z, 6) }
      for (x = 0; x <= 12; x += 0.02) for (y = 2; y <= 2.2; y += 0.02) { point(x, y, beam, 6); point(x, y, beam + 0.3, 6) }
      for (z = 0.02; z <= 4; z += 0.02) for (a = 0; a < 6.28; a += 0.1)
        point(8.25 + 0.2 * cos(a), 6.1 + 0.2 * sin(a), z, 6) # a column
      for (z = 0.02; z <= 1.6 * cabinet; z += 0.02) for (y = 2.5; y <= 3; y += 0.02) point(8.1, y, z, 1)
    }' >"$1.points"
  {
    printf 'FIELDS x y z classification\nSIZE 8 8 8 1\nTYPE F F F U\nPOINTS %d\nDATA ascii\n' "$(wc -l <"$1.points")"
    cat "$1.points"
  } >"$1.pcd"
  printf '["%s.pcd", "%s.las"]' "$1" "$1" | pcl_bsh_pipeline -
  rm "$1.points" "$1.pcd"
}
scan week_47 2.4 0
scan week_48 2.8 1

# machine FILE BOXES: closed boxes that do not touch, in millimetres
machine() {
  awk 'function box(x0, y0, z0, x1, y1, z1,   k) {
      for (k = 0; k < 8; ++k) v[k] = sprintf("vertex %g %g %g\n", k % 2 ? x1 : x0, int(k / 2) % 2 ? y1 : y0, k > 3 ? z1 : z0)
      face(0, 2, 3, 1); face(4, 5, 7, 6); face(0, 1, 5, 4); face(2, 6, 7, 3); face(0, 4, 6, 2); face(1, 3, 7, 5)
    }
    function face(a, b, c, d) { triangle(a, b, c); triangle(a, c, d) }
    function triangle(a, b, c) { printf "facet normal 0 0 0\nouter loop\n%s%s%sendloop\nendfacet\n", v[a], v[b], v[c] }
    BEGIN { print "solid machine"; '"$2"'; print "endsolid machine" }' >"$1"
}
machine press.stl 'box(-1000, -750, 0, 1000, 750, 2500); box(1050, -300, 200, 1250, 300, 1700)'
machine mill.stl 'box(-700, -500, 0, 700, 500, 1600)'
machine crate.stl 'box(-450, -450, 0, 450, 450, 1200)'

# The way of the mill: in at the gate, round in place, and up to its column.
cat >way.txt <<'END'
waypoints 0.05 2
500011 5400004 100 0
500007.5 5400003.5 100 0
500007.5 5400003.5 100 90 turn
500007.5 5400006 100 90
END
printf 'made the hall, its machines and the way in %s\n' "$1"
