#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a line of 400 m with clothoids and cant, a structure gauge, a wagon's profile, and a scan of its tunnel. A part of
# 10 m was not scanned. A cable hangs into the gauge, and a cabinet stands in the curve, where the wagon swings out.
#   bash make_line.sh FOLDER
set -euo pipefail

(($# == 1)) || { printf 'make_line.sh: FOLDER: is missing: say where the files shall go\n' >&2; exit 1; }
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
mkdir -p "$1"
cd "$1"

cat >line.axis <<'END'
# chainage 1000 to 1400: a curve to the right, and a jump of the chainage in its middle
start 500000 4000000 60
chainage 1000
straight 80
clothoid 60 inf 300
arc 120 300
clothoid 60 300 inf
straight 80
height 1000 30
height 1200 32 60
height 1400 30
cant 1080 0
cant 1140 0.12
cant 1260 0.12
cant 1320 0
equation 1200 1500
END

cp "$here/gauge.csv" .

cat >wagon.csv <<'END'
offset,height
-1.40,0.20
1.40,0.20
1.50,1.20
1.50,3.00
1.10,3.90
-1.10,3.90
-1.50,3.00
-1.50,1.20
END

# Rings of a tunnel, 0.25 m apart: the line is integrated in small steps, and cant turns about the low rail, the right one.
awk 'function point(u, v, X, Y, Z) {
  X = x + (shift + u * c + v * s) * sin(h); Y = y - (shift + u * c + v * s) * cos(h); Z = z + lift - u * s + v * c
  printf "%.4f %.4f %.4f\n", X, Y, Z
}
function curvature(d) {
  return d < 80 || d > 320 ? 0 : d < 140 ? (d - 80) / 60 / 300 : d < 260 ? 1 / 300 : (320 - d) / 60 / 300
}
function height(d) {
  if (d > 170 && d < 230) return 31.7 + 0.01 * (d - 170) - 0.02 / 120 * (d - 170) ^ 2
  return d < 200 ? 30 + 0.01 * d : 34 - 0.01 * d
}
BEGIN {
  srand(1); pi = atan2(0, -1); x = 500000; y = 4000000; h = pi / 6; n = 100
  for (i = 0; i <= 1600; ++i) {
    d = i * 0.25; z = height(d); k = curvature(d)
    s = 0.12 * k * 300 / 1.5; c = sqrt(1 - s * s); lift = 0.75 * s; shift = 0.75 * (1 - c)
    if (d < 340 || d > 350) {
      for (a = 0; a < 2 * pi; a += 0.05) {
        v = 2.1 + 2.9 * sin(a)
        if (v > -0.3) point(2.7 * cos(a) + 0.01 * (rand() - 0.5), v)
      }
      for (u = -2.4; u <= 2.4; u += 0.1) point(u, -0.3 + 0.02 * rand())
    }
    if (d >= 50 && d <= 54) for (t = 0; t < 5; ++t) point(-0.6 + 0.01 * t, 4.35 - 0.15 * sin((d - 50) * pi / 4))
    if (d >= 205 && d <= 206) for (v = 0.5; v < 1.4; v += 0.05) point(-1.62 - 0.01 * rand(), v)
    for (j = 0; j < n; ++j) { # to the next ring
      m = d + (j + 0.5) * 0.25 / n; h -= 0.125 / n * curvature(m)
      x += 0.25 / n * cos(h); y += 0.25 / n * sin(h); h -= 0.125 / n * curvature(m)
    }
  }
}' >scan.xyz
