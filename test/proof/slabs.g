# SPDX-License-Identifier: BSD-3-Clause
# slabsApart(): what kSlabMargin of all lengths L = |d|_1 + r + r' pays for. Exactly, of unit normals u and n, a pair is
# along u apart by |u d| - h' - (c h + s r), where c = |u n| and s is the sine, and across it by |d - (u d) u| - r - r'.
# Normals are off the directions of length 1 that they stand for: one by l, the other, which was carried, by e. They are
# stored off length 1 by 2^-22; poses are rigid within 1e-6, so that the inverse of one is off its transpose by 1.01e-6;
# what carries has five roundings along each of three axes. Thicknesses are measured along stored normals, and are no
# greater than radii by more than 2^-18 of them.
# - The cosine errs by C: both normals, and a dot product of three roundings.
# - The sine: 1 - c^2 may be less by 2 (1 + C) C than it should be, and by five roundings; so with kSlabMargin it is not.
# - Along: d rounded once, a dot product, two differences; of thicknesses, what is left of their roundings.
# - Across: both products with normals, the difference, and a root of squares; radii are summed in two roundings.
# The lengths themselves are summed and multiplied in six roundings, which their last factor pays for.
C = (1 + e) * (1 + l) * (1 + a) * (1 + b) * (1 + c) - 1;
along_d = (1 + e) * (1 + a) * (1 + b) * (1 + c) * (1 + d) * (1 + p) * (1 + q) - 1;
on_normal = (1 + e) * (1 + a) * (1 + b) * (1 + c) * (1 + d) - 1;
thick = 1 + 0x1.00001p-22;
{
  e in [-1b-18, 1b-18] /\ l in [-1b-19, 1b-19] /\
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24] /\ d in [-1b-24, 1b-24] /\
  p in [-1b-24, 1b-24] /\ q in [-1b-24, 1b-24] /\ r in [-1b-24, 1b-24] /\ s in [-1b-24, 1b-24] /\
  t in [-1b-24, 1b-24] /\ w in [-1b-24, 1b-24] /\ x in [-1b-24, 1b-24]
  ->
  # the normals
  1.01e-6 + 1b-22 <= 1b-19 /\
  2.03e-6 + |1.7320509 * ((1 + a) * (1 + b) * (1 + c) * (1 + d) * (1 + p) - 1)| + 1b-22 <= 1b-18 /\
  # the sine's square
  |2 * (1 + C) * C| + |(1 + p) * (1 + q) * (1 + r) * (1 + s) * (1 + t) - 1| <= @kSlabMargin@ /\
  # along: of d; of the other thickness, which is at most 1 + 2^-18 times the radius; of the own one, and the radius
  |along_d| * (1 + 7b-24) <= @kSlabMargin@ /\
  |thick - (1 + a) * (1 + b)| * (1 + 1b-17) <= @kSlabMargin@ /\
  (|thick - (1 + p) * (1 + q) * (1 + r) * (1 + s)| + |C|) * (1 + 1b-17) + |1 - (1 + t) * (1 + w) * (1 + x) * (1 + p)|
    <= @kSlabMargin@ /\
  # across: of d, of radii
  (|on_normal * (1 + e) + e| * (1 + 3b-24) + |(1 + p) * (1 + q) - 1| + |(1 + r) * (1 + s) * (1 + t) * (1 + w) * (1 + x) - 1|)
    * (1 + 7b-24) <= @kSlabMargin@ /\
  |(1 + a) * (1 + b) * (1 + c) - 1| * (1 + 7b-24) <= @kSlabMargin@
}
