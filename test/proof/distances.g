# boundDistances(), and of boxes boundFromBox() and farthestFromBox(): the distance of two centres is the root of a squared
# distance; radii and reach have three roundings at most. A bound is their difference or sum, less or plus the margin of
# their sum, times a factor.
{
  d in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ s0 in [-1b-24, 1b-24] /\ s1 in [-1b-24, 1b-24] /\ root in [-1b-24, 1b-24] /\
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24] /\
  x in [-1b-24, 1b-24] /\ y in [-1b-24, 1b-24] /\ w in [-1b-24, 1b-24] /\ m in [-1b-24, 1b-24] /\ n in [-1b-24, 1b-24] /\
  skew in [0, 1b-18]
  ->
  # lower: no more of the distance, and no less of the radii, than there is
  sqrt((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) * (1 + root)
    * ((1 + x) - (1 + m) * (1 + n) * @kBoundMargin@) * (1 + y) * (1 + w) <= 1 /\
  (1 + a) * (1 + b) * (1 + c) * ((1 + x) + (1 + m) * (1 + n) * @kBoundMargin@) * (1 + y) * (1 + w) >= 1 /\
  # upper: no less of either
  sqrt((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) * (1 + root)
    * ((1 + x) + (1 + m) * (1 + n) * @kBoundMargin@) * (1 + y) * (1 + w) >= 1 /\
  # the reach within which children are looked for: a product, two sums and the margin's product
  (1 + a) * (1 + b) * (1 + c) * (1 + m) * (1 + @kReachMargin@) >= 1 /\
  # points near the box of a leaf, or near a sphere of b: a reach of three roundings, twice in its square, two products; against a squared distance
  (1 + a) * (1 + b) * (1 + c) * (1 + a) * (1 + b) * (1 + c) * (1 + m) * (1 + n) * (1 + 2 * @kSphereMargin@)
    / ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) >= 1 /\
  # what a float distance says of the true one at a leaf: at most, and at least
  1 + (@kSphereMargin@ + 2 * skew) * (1 - 1b-50) - (1 + @kLengthError@) * (1 + skew) * (1 + 1b-50) >= 0 /\
  (1 - @kLengthError@) * (1 - skew) * (1 - 1b-50) - (1 - (@kSphereMargin@ + 2 * skew) * (1 - 1b-50)) >= 0
}
