# spheresNear(): a squared distance s above the limit says that the distance exceeds radii and reach. The sum of these has
# three roundings, twice in its square, and two products. The reach is a cast and a product before that, of
# 1 + kReachMargin. spheresInside() and anyPointWithin(): the other way round.
{
  d in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ s0 in [-1b-24, 1b-24] /\ s1 in [-1b-24, 1b-24] /\
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24] /\ q in [-1b-24, 1b-24] /\ t in [-1b-24, 1b-24]
  ->
  (1 + a) * (1 + b) * (1 + c) * (1 + a) * (1 + b) * (1 + c) * (1 + q) * (1 + t) * (1 + @kSphereMargin@)
    / ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) >= 1 /\
  (1 + a) * (1 + b) * (1 + @kReachMargin@) >= 1 /\
  (1 + a) * (1 + b) * (1 - @kReachMargin@) <= 1 /\
  # inside: the room is a difference of two that are rounded up by its own two roundings at most
  (1 + a) * (1 + b) * (1 + a) * (1 + b) * (1 + q) * (1 + t) * (1 - @kSphereMargin@)
    / ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) <= 1 /\
  # a radius that is subtracted there: stretched, with the margin, in three roundings
  (1 + a) * (1 + b) * (1 + c) * (1 + @kSphereMargin@) >= 1
}
