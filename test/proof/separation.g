# SPDX-License-Identifier: BSD-3-Clause
# separationOf() and leastApart(): what kSeparationError pays for, in v = 2^-53 of the largest coordinate M; as vectors,
# times sqrt(3).
# Places: shares within [0, 1] of edges, whose differences are at most 2 M, and of faces, of both of which the sum may
# exceed 1 by a rounding. Two of them, and their difference, at most 2 M. The root of a sum of squares is
# kFewDoubleRoundings of itself.
# Directions: a vector over its length, both rounded, is longer than 1 by U at most. Of separationOf(), dot products with
# corners, and their difference; U by kFewDoubleRoundings of itself. Of leastApart(), corners at from + s way + 4 s (1 - s)
# bow, of which M is the sum: dot products have three roundings, parameters and sums four more; U counts. The foot of a
# parabola is where its slope is 0: what rounding makes of its place is of second order, below 64 v^2.
unit = (1 + a) * (1 + b) / sqrt((1 + c) * (1 + d) * (1 + p)) - 1;
{
  a in [-1b-53, 1b-53] /\ b in [-1b-53, 1b-53] /\ c in [-1b-53, 1b-53] /\ d in [-1b-53, 1b-53] /\
  p in [-1b-53, 1b-53] /\ q in [-1b-53, 1b-53] /\ r in [-1b-53, 1b-53] /\ s in [-1b-53, 1b-53]
  ->
  # places
  1.7320509 * (2 * (|2 * ((1 + a) * (1 + b) - 1)| + |2 * ((1 + c) * (1 + d) - 1)| + |2 * p| + |q| + |r|) + |2 * s|)
    <= @kSeparationError@ /\
  |sqrt((1 + a) * (1 + b) * (1 + c)) * (1 + d) * (1 + p) * (1 + q) - 1| <= @kFewDoubleRoundings@ /\
  # directions
  |unit * (1 + q)| + |r| <= @kFewDoubleRoundings@ /\
  2 * |1.7320509 * ((1 + a) * (1 + b) * (1 + c) * (1 + unit) - 1 - unit)| + |3.4641017 * q * (1 + 1b-40)| + |4 * r| <= @kSeparationError@ /\
  2 * |1.7320509 * ((1 + a) * (1 + b) * (1 + c) * (1 + d) * (1 + p) * (1 + q) * (1 + r) - 1)| * (1 + 1b-40) + |3.4641017 * s * (1 + 1b-40)|
    + |3.4641017 * unit| + |4 * r| + 64b-106 <= @kSeparationError@
}
