# SPDX-License-Identifier: BSD-3-Clause
# CompensatedSum of up to 16 terms, each of which may be a product: the sum and all errors are what they add up to, exactly.
# Of the absolute sum A, a sum of two errs by v of at most (1 + v)^15 A, 15 times at most, since the first has no error,
# and products by v A together. These 31 errors are added in doubles, with 31 roundings each at most. A itself is summed
# in 16 roundings.
{
  d in [-1b-53, 1b-53]
  ->
  |(1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d)
    * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d)
    * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d)
    * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) * (1 + d) - 1|
    * 16b-53 * (1 + 32b-53) <= @kCompensatedError@
}
