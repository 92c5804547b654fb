# SPDX-License-Identifier: BSD-3-Clause
# compareWithTriangle(): what roundings amount to in a gap along a direction, for each unit of the direction's length: of
# C, how far a corner in a lane is from the flat triangle's origin, and of L, the longest side. Lengths of vectors bound
# the terms of their products (Cauchy), and sqrt(3) times a length those of a product with rows of length 1.
{
  sub in [-1b-24, 1b-24] /\ product in [-1b-24, 1b-24] /\ sum0 in [-1b-24, 1b-24] /\ sum1 in [-1b-24, 1b-24] /\
  turned in [-1b-24, 1b-24] /\ turned0 in [-1b-24, 1b-24] /\ turned1 in [-1b-24, 1b-24] /\
  end in [-1b-24, 1b-24] /\ ends in [-1b-24, 1b-24] /\
  row in [-2b-24, 2b-24] /\ gap in [-1b-24, 1b-24] /\ squared_gap in [-1b-24, 1b-24] /\
  x in [-1b-24, 1b-24] /\ y in [-1b-24, 1b-24] /\ z in [-1b-24, 1b-24] /\
  root in [-5b-24, 5b-24] /\ one in [-1b-24, 1b-24] /\ two in [-1b-24, 1b-24] /\ three in [-1b-24, 1b-24] /\
  four in [-1b-24, 1b-24] /\ five in [-1b-24, 1b-24] /\ six in [-1b-24, 1b-24]
  ->
  # of C: the corner less the origin, the product and its sums, by a direction that a turn may have lengthened
  |(1 + 1b-22) * ((1 + sub) * (1 + product) * (1 + sum0) * (1 + sum1) - 1)| <= @kTrianglePairError@ /\
  # of L: the turn, the product and its sum
  |1.7320509 * ((1 + turned) * (1 + turned0) * (1 + turned1) - 1) * (1 + end) * (1 + ends)
    + ((1 + end) * (1 + ends) - 1)| <= @kTrianglePairError@ /\
  # shares of what is compared: rows and turn of the direction's length, the gap's difference, its square; the length's
  # square and the least gap's, each of its operations
  (1 + row) * (1 + 6b-24) * (1 + gap) * (1 + squared_gap) * (1 + root) * (1 + one) * (1 + two) * (1 + three)
    * (1 + four) * (1 + five) * (1 + six) - 1 in [-@kTrianglePairMargin@, @kTrianglePairMargin@]
}
