# SPDX-License-Identifier: BSD-3-Clause
# What kFlatMargin pays for where squared distances s from flat triangles are compared with lengths, or are bounds of
# them: |sqrt(s) - D| <= kFlatShare D + error, but for kSquaredDistanceError of s.
# Near: of the limit, two sums, a product, its square, and a sum. Inside: of the room less radius and error, linear in
# their share of it: both ends. Bounds: a root, a product of the margin, three sums, and one product more.
{
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24] /\ d in [-1b-24, 1b-24] /\
  p in [-1b-24, 1b-24] /\ q in [-1b-24, 1b-24] /\ r in [-1b-24, 1b-24] /\ s in [-1b-24, 1b-24]
  ->
  # near: a pair within the reach is not above the limit
  (1 + @kFlatShare@) * sqrt(1 + @kSquaredDistanceError@)
    / ((1 + @kFlatMargin@) * (1 + a) * (1 + b) * (1 + c) * sqrt((1 + d) * (1 + p))) <= 1 /\
  # inside: with neither radius nor error; and with as much as there is room
  (1 + a) * (1 - @kFlatMargin@) * (1 + b) * sqrt((1 + c) * (1 + d) * (1 - @kFlatMargin@) * (1 + p) * (1 + q))
    * sqrt(1 + @kSquaredDistanceError@) / (1 - @kFlatShare@) <= 1 /\
  ((1 - (1 + @kFlatMargin@) * (1 + a) * (1 + b)) * 0.99999 + 1) / (1 - @kFlatShare@) <= 1 /\
  # bounds: of the length; of error and radius
  |(1 - @kFlatShare@) * sqrt(1 - @kSquaredDistanceError@) * (1 + q) * (1 + a) * (1 + b) * (1 + c) - 1| * (1 + 9b-24)
    <= @kFlatMargin@ /\
  |(1 + @kFlatShare@) * sqrt(1 + @kSquaredDistanceError@) * (1 + q) * (1 + a) * (1 + b) * (1 + c) - 1| * (1 + 9b-24)
    <= @kFlatMargin@ /\
  |(1 + a) * (1 + b) * (1 + c) * (1 + d) - 1| * (1 + 9b-24) <= @kFlatMargin@
}
