# SPDX-License-Identifier: BSD-3-Clause
# slabGaps(), supportGaps(), pointsGap(): what kSupportShare of a radius r and kDistanceShare of the distance |d| pay for.
# Exactly, of the direction u of d, and of any numbers c and k, points p with |p| <= r, |n p| <= h and |m p| <= g reach
# u p = c (n p) + k (m p) + (u - c n - k m) p <= |c| h + |k| g + |u - c n - k m| r. Here c and k are the quotients of what
# was summed for n d and m d by |d|: their own errors do not matter, and they are below 1 + 2^-17.
# - Normals that are carried are off the directions in which n p is bounded by 2^-18 (slabs.g), each.
# - The rest: of each of three coordinates, three terms of at most |d|, of which each has up to three roundings.
# - Thicknesses are no greater than radii by more than 2^-17 of them. Three products are summed, divided by the length,
#   and subtracted: six roundings each, and the length's four, of the root of a sum of squares.
# - The distance: d was rounded once in each coordinate, its length four times; then come two differences.
rest = 1.7320509 * 3 * ((1 + a) * (1 + b) * (1 + c) - 1);
sums = (1 + a) * (1 + b) * (1 + c) * (1 + d) * (1 + e) * (1 + p) * (1 + q) * (1 + s) * (1 + t) * (1 + w) - 1;
length = (1 + a) * (1 + b) * (1 + c) * (1 + d) * (1 + e) * (1 + p) * (1 + q) - 1;
{
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24] /\ d in [-1b-24, 1b-24] /\
  e in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ q in [-1b-24, 1b-24] /\ s in [-1b-24, 1b-24] /\
  t in [-1b-24, 1b-24] /\ w in [-1b-24, 1b-24]
  ->
  (2 * 1b-18 + |rest| + 3 * |sums|) * (1 + 1b-16) <= @kSupportShare@ /\
  |length| * (1 + 1b-20) <= @kDistanceShare@
}
