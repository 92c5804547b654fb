# Radii measured in float: of a squared distance a root, a product and a sum, each rounded once. Slabs: a dot product of
# a difference.
{
  d in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ s0 in [-1b-24, 1b-24] /\ s1 in [-1b-24, 1b-24] /\
  r in [-1b-24, 1b-24] /\ q in [-1b-24, 1b-24] /\ t in [-1b-24, 1b-24]
  ->
  sqrt((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) * (1 + r) * (1 + q) * (1 + t) * (1 + @kRadiusMargin@) >= 1 /\
  2 * |(1 + d) * (1 + p) * (1 + s0) * (1 + s1) - 1| <= @kRadiusMargin@
}
