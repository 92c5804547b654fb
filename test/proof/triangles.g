# SPDX-License-Identifier: BSD-3-Clause
# squaredToTriangle(): what its roundings amount to, of the distance D and of the longest side L. A point turned into the
# triangle's frame errs by T (D + L), where T is sqrt(3) times four roundings. Along a side the share errs by S of how far
# the point is from the side's end, which is E of it off at the far one; the place by P, the far side itself by A. Under
# the sides the height, at most sqrt(3)/2 L, errs by H.
{
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24] /\ d in [-1b-24, 1b-24] /\
  e in [-1b-24, 1b-24] /\ f in [-1b-24, 1b-24] /\ g in [-1b-24, 1b-24] /\ h in [-1b-24, 1b-24] /\
  end in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ far in [-1b-24, 1b-24] /\
  x in [-1b-24, 1b-24] /\ y in [-1b-24, 1b-24] /\ z in [-1b-24, 1b-24]
  ->
  # of D, and of L
  |1.7320509 * ((1 + a) * (1 + b) * (1 + c) * (1 + d) - 1)
    + (1 + 8b-24) * (((1 + e) * (1 + f) * (1 + g) * (1 + h) - 1) * (1 + end) + end)| <= @kFlatTriangleError@ /\
  |1.7320509 * ((1 + a) * (1 + b) * (1 + c) * (1 + d) - 1)
    + (1 + 8b-24) * (((1 + e) * (1 + f) * (1 + g) * (1 + h) - 1) * (1 + end) + end + p * (1 + far) + far)|
    <= @kFlatTriangleError@ /\
  |1.7320509 * ((1 + a) * (1 + b) * (1 + c) * (1 + d) - 1)
    + 0.8660255 * ((1 + x) * (1 + y) * (1 + z) - 1)| <= @kFlatTriangleError@ /\
  # rows of length 1, of which each entry is rounded
  |1.7320509 * a| <= @kFlatSkewOfFloats@
}
