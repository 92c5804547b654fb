# SPDX-License-Identifier: BSD-3-Clause
# Poses between the ends of a motion: the matrix of a turn, entry by entry, where sine and cosine err by kSineError, the
# axis has the length 1 within four roundings, and the angle was multiplied once, by half a turn at most. Then a product
# with a matrix of rows of length 1: three roundings, of three entries each. As a matrix, three times an entry.
{
  s in [-@kSineError@, @kSineError@] /\ c in [-@kSineError@, @kSineError@] /\
  x in [-4b-53, 4b-53] /\ y in [-4b-53, 4b-53] /\
  a in [-1b-53, 1b-53] /\ b in [-1b-53, 1b-53] /\ d in [-1b-53, 1b-53] /\ e in [-1b-53, 1b-53] /\ f in [-1b-53, 1b-53] /\
  p in [-1b-53, 1b-53] /\ q in [-1b-53, 1b-53] /\ r in [-1b-53, 1b-53]
  ->
  # an entry: (1 - cos) n_i n_j, at most 2, and sin n_k or cos, at most 1; the angle's own rounding, of 3.2 at most
  3 * (|3.2 * a| + |c| + |2 * ((1 + b) * (1 + x) * (1 + d) * (1 + y) * (1 + e) - 1)| + |s| + |(1 + x) * (1 + f) - 1| + |3 * b|
    + 1.7320509 * |(1 + p) * (1 + q) * (1 + r) - 1|) <= @kMotionRounding@
}
