# distanceBand(). A hit: s <= threshold says S (1 + five roundings) <= (1 - e) L^2 (1 + rounding in double), and S <= L^2
# has to follow. A miss likewise. And the lengths: what rounding takes off a sum is given back.
{
  d in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ s0 in [-1b-24, 1b-24] /\ s1 in [-1b-24, 1b-24] /\
  r0 in [-1b-53, 1b-53] /\ r1 in [-1b-53, 1b-53] /\ r2 in [-1b-53, 1b-53] /\ r3 in [-1b-53, 1b-53]
  ->
  (1 - @kSquaredDistanceError@) * (1 + r0) * (1 + r1) * (1 + r2) * (1 + r3)
    / ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) <= 1 /\
  (1 + @kSquaredDistanceError@) * (1 + r0) * (1 + r1) * (1 + r2) * (1 + r3)
    / ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) >= 1 /\
  (1 + r0) * (1 + r1) * (1 + r2) * (1 + r3) * (1 + @kFewDoubleRoundings@) >= 1
}
