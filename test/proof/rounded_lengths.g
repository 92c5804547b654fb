# longLengths(), in doubles: v = 2^-53. Of one axis the true coordinate is value + T, where T is the sum of three terms of
# absolute sum s; tail is T with two roundings at most, and `errors` is s with two. `loss` is what the bound may lose by its
# own roundings, up to sixteen. Products (1 + a) (1 + b) are written less 1, for Gappa's numbers have 60 bits.
{
  a in [-1b-53, 1b-53] /\ b in [-1b-53, 1b-53] /\ c in [-1b-53, 1b-53] /\ e in [-1b-53, 1b-53] /\
  loss in [-1b-49, 0] /\
  # high - root^2 of a rounded root, relative to root^2; and low as a part of what it may be
  square in [-0x2.0000000000001p-53, 0x2.0000000000001p-53] /\ low in [-1, 1]
  ->
  # (2 value + tail) tail against (2 value + T) T, relative to (|value| + s) s, of which most_mixed is twice: the tail is off by
  # two roundings of s, in both factors, and what was computed has two roundings more. |tail| <= s (1 + 2^-51).
  |4 * (1 + 1b-51) * (a + b + a * b)| - 8b-53 * (1 + 1b-40) * (1 + loss) <= 0 /\
  # low order: four roundings of each term at most
  |(a + b + a * b) + (c + e + c * e) + (a + b + a * b) * (c + e + c * e)| - 4b-53 * (1 + 1b-40) * (1 + loss) <= 0 /\
  # Both are 8 v of size_of_low; half of that is what the root may be off by. The correction is a sum and a quotient, with two
  # roundings; and sqrt(1 + 2 x) - (1 + x) is -x^2 / 2 within x^3, where x = (square + low) / 2.
  (8b-53 * @kMostLowOrder@ / 2
    + |(a + b + a * b) * (square + @kMostLowOrder@ * low) / 2|
    + (square + @kMostLowOrder@ * low) * (square + @kMostLowOrder@ * low) / 8) * (1 + 1b-36) - @kLengthDoubt@ <= 0
}
