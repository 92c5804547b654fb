# Double arithmetic of exact distances. A coordinate's terms: a product, three sums, a difference. Norms: squares and two
# sums, a root, and the last subtraction; of sums that were rounded once more where they are compensated.
# squaredDistanceAsFloat(): five roundings, and that of the product with 1 +- kFewDoubleRoundings.
{
  p in [-1b-53, 1b-53] /\ s0 in [-1b-53, 1b-53] /\ s1 in [-1b-53, 1b-53] /\ s2 in [-1b-53, 1b-53] /\
  d in [-1b-53, 1b-53] /\ q in [-1b-53, 1b-53] /\ r in [-1b-53, 1b-53] /\ l in [-1b-53, 1b-53]
  ->
  |(1 + p) * (1 + s0) * (1 + s1) * (1 + s2) * (1 + d) - 1| +
    |sqrt((1 + q) * (1 + s0) * (1 + s1)) * (1 + r) * (1 + l) - 1| + 24b-53 / 1b20 <= @kTermsError@ /\
  |sqrt((1 + d) * (1 + d) * (1 + q) * (1 + s0) * (1 + s1)) * (1 + r) * (1 + l) - 1| <= @kFewDoubleRoundings@ /\
  (1 + d) * (1 + d) * (1 + q) * (1 + s0) * (1 + s1) * (1 + l) * (1 + @kFewDoubleRoundings@) >= 1 /\
  (1 + d) * (1 + d) * (1 + q) * (1 + s0) * (1 + s1) * (1 + l) * (1 - @kFewDoubleRoundings@) <= 1
}
