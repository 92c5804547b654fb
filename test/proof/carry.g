# carry(), carryPoint(): y = ((g + m0 x0) + m1 x1) + m2 x2, where m and g were rounded to float. Every term's factor
# (1 + rounding) for each rounding on its way: a product's has five, the shift's four.
# Products that are absent are 0, so that m0 x0 is the one with the most roundings.
{
  cast in [-1b-24, 1b-24] /\ product in [-1b-24, 1b-24] /\
  sum0 in [-1b-24, 1b-24] /\ sum1 in [-1b-24, 1b-24] /\ sum2 in [-1b-24, 1b-24]
  ->
  |(1 + cast) * (1 + product) * (1 + sum0) * (1 + sum1) * (1 + sum2) - 1| <= @kCarriedProductError@ /\
  |(1 + cast) * (1 + sum0) * (1 + sum1) * (1 + sum2) - 1| <= @kCarriedShiftError@
}
