# Squared distances: x^2 is rounded five times, and so is y^2; z^2 four times. And what follows for a root in double.
{
  d in [-1b-24, 1b-24] /\ product in [-1b-24, 1b-24] /\ sum0 in [-1b-24, 1b-24] /\ sum1 in [-1b-24, 1b-24] /\
  root in [-1b-53, 1b-53] /\ factor in [-1b-53, 1b-53] /\ times in [-1b-53, 1b-53]
  ->
  |(1 + d) * (1 + d) * (1 + product) * (1 + sum0) * (1 + sum1) - 1| <= @kSquaredDistanceError@ /\
  sqrt((1 + d) * (1 + d) * (1 + product) * (1 + sum0) * (1 + sum1)) * (1 + root) * (1 + factor) * (1 + times)
    * (1 + @kLengthError@) >= 1
}
