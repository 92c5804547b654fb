#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes a press as a mesh to standard output: a table, a frame of two columns and a head, and a round ram, each closed.
#   bash examples/pictures/press.sh [open]     open: a side of the table and a sector of the ram's mantle are missing
set -euo pipefail
awk -v open="${1:-}" '
function vertex(x, y, z) { v[n++] = x " " y " " z; return n - 1 }
function face(a, b, c, d) { f[m++] = "4 " a " " b " " c " " d }
function box(x0, y0, z0, x1, y1, z1, lacking,   p) {
  p = vertex(x0, y0, z0); vertex(x1, y0, z0); vertex(x1, y1, z0); vertex(x0, y1, z0)
  vertex(x0, y0, z1); vertex(x1, y0, z1); vertex(x1, y1, z1); vertex(x0, y1, z1)
  face(p, p + 3, p + 2, p + 1); face(p + 4, p + 5, p + 6, p + 7); face(p, p + 1, p + 5, p + 4)
  if (!lacking) face(p + 1, p + 2, p + 6, p + 5)
  face(p + 2, p + 3, p + 7, p + 6); face(p + 3, p, p + 4, p + 7)
}
function drum(radius, z0, z1, sides, lacking,   i, p, a, next_, top, bottom) {
  for (i = 0; i < sides; ++i) {
    a = 6.283185307179586 * i / sides
    p = vertex(radius * cos(a), radius * sin(a), z0); vertex(radius * cos(a), radius * sin(a), z1)
  }
  p -= 2 * (sides - 1); top = bottom = sides
  for (i = 0; i < sides; ++i) {
    next_ = p + 2 * ((i + 1) % sides)
    if (!lacking || i % 12 != 10) face(p + 2 * i, next_, next_ + 1, p + 2 * i + 1)
    top = top " " (p + 2 * i + 1); bottom = bottom " " (p + 2 * (sides - 1 - i))
  }
  f[m++] = top; f[m++] = bottom
}
BEGIN {
  box(-1.2, -0.8, 0, 1.2, 0.8, 0.7, open); box(-1.2, -0.8, 0.65, -0.8, 0.8, 2.4); box(0.8, -0.8, 0.65, 1.2, 0.8, 2.4)
  box(-1.25, -0.85, 2.3, 1.25, 0.85, 2.9); drum(0.35, 1.1, 2.35, 48, open)
  print "OFF"; print n, m, 0
  for (i = 0; i < n; ++i) print v[i]
  for (i = 0; i < m; ++i) print f[i]
}'
