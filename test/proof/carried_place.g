# The same, as the arithmetic itself, for a shift and a matrix row of absolute values up to 1 and points up to 1: the
# whole error is below the shift's part and three products' parts.
@rnd = float<ieee_32, ne>;
G = rnd(g); M0 = rnd(m0); M1 = rnd(m1); M2 = rnd(m2);
x0 = rnd(x0_); x1 = rnd(x1_); x2 = rnd(x2_);
y rnd= ((G + M0 * x0) + M1 * x1) + M2 * x2;
exact = g + m0 * x0 + m1 * x1 + m2 * x2;
{
  |g| <= 1 /\ |m0| <= 1 /\ |m1| <= 1 /\ |m2| <= 1 /\ |x0| <= 1 /\ |x1| <= 1 /\ |x2| <= 1
  ->
  |y - exact| - (@kCarriedShiftError@ + 3 * @kCarriedProductError@) <= 0
}
