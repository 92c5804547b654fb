# sphereAround(): differences of doubles; hypot as the library has it, a * sqrt((x/a)^2 + (y/a)^2 + (z/a)^2) with the
# largest a, each quotient, square and sum rounded; the sum with a ball; the factor and its product.
{
  d in [-1b-53, 1b-53] /\ q in [-1b-53, 1b-53] /\ p in [-1b-53, 1b-53] /\ s0 in [-1b-53, 1b-53] /\
  s1 in [-1b-53, 1b-53] /\ r in [-1b-53, 1b-53] /\ m in [-1b-53, 1b-53] /\ b in [-1b-53, 1b-53] /\
  t in [-1b-53, 1b-53]
  ->
  (1 + d) * sqrt((1 + q) * (1 + q) * (1 + p) * (1 + s0) * (1 + s1)) * (1 + r) * (1 + m) * (1 + b) * (1 + t)
    * (1 + @kFewDoubleRoundings@) >= 1
}
