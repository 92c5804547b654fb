#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes two tracks of 200 m, 4 m apart in a curve, a structure gauge, and a scan of their hall from a wagon on the left
# one. A sign stands in the right gauge, a beam of the roof hangs into both, and a cabinet hides the right one.
#   bash make_tracks.sh FOLDER
set -euo pipefail

(($# == 1)) || { printf 'make_tracks.sh: FOLDER: is missing: say where the files shall go\n' >&2; exit 1; }
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
mkdir -p "$1"
cd "$1"

cat >left.axis <<'END'
# chainage 0 to 200
start 500000 4000000 90
straight 60
arc 80 400
straight 60
height 0 30
END
cat >right.axis <<'END'
# the same, 4 m to the right: chainage 1000 to 1199.2
start 500000 3999996 90
chainage 1000
straight 60
arc 79.2 396
straight 60
height 1000 30
END
cp "$here/gauge.csv" .

# The wagon goes 10 m each second. Its scanner is 2.5 m above the left track, and turns across it: 120 beams every 0.25 m.
awk 'function side(at, way, low, high,   a, b, c) { # narrows the part of the beam that is in a box
  if (way == 0) { if (at < low || at > high) far = -1; return }
  a = (low - at) / way; b = (high - at) / way
  if (a > b) { c = a; a = b; b = c }
  if (a > near) near = a
  if (b < far) far = b
}
function box(left, right, low, high) {
  near = 0; far = range
  side(0, du, left, right); side(2.5, dv, low, high)
  if (near < far) range = near
}
BEGIN {
  pi = atan2(0, -1); x = 500000; y = 4000000; h = 0; print "x,y,z,gps_time" > "scan.csv"; print "time,x,y,z" > "path.csv"
  for (i = 0; i <= 800; ++i) {
    d = i * 0.25
    if (i % 4 == 0) printf "%.2f,%.4f,%.4f,32.5\n", d / 10, x, y > "path.csv"
    for (a = 0; a < 120; ++a) {
      du = cos(a * pi / 60); dv = sin(a * pi / 60); range = 50
      box(-5, -4, -1, 9); box(8, 9, -1, 9); box(-5, 9, -1, -0.2); box(-5, 9, 6.5, 7) # the hall
      if (d >= 30 && d <= 40) box(1.95, 2.1, -0.2, 6)                                # the cabinet
      if (d >= 100 && d <= 101) box(5.4, 5.5, 2, 3)                                  # the sign
      if (d >= 160 && d <= 160.5) box(-0.5, 4.5, 4.2, 6.5)                           # the beam
      u = range * du
      printf "%.4f,%.4f,%.4f,%.4f\n", x + u * sin(h), y - u * cos(h), 32.5 + range * dv, d / 10 > "scan.csv"
    }
    for (j = 0; j < 10; ++j) { # to the next place
      k = d + (j + 0.5) * 0.025 > 60 && d + (j + 0.5) * 0.025 < 140 ? 0.025 / 400 : 0
      h -= k / 2; x += 0.025 * cos(h); y += 0.025 * sin(h); h -= k / 2
    }
  }
}'
