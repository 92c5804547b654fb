# LocalFrame, PointFrame: a difference of doubles, rounded to double and then to float, of an absolute value up to 1; and
# relative to what is stored.
@f = float<ieee_32, ne>;
@d = float<ieee_64, ne>;
stored = f(d(given));
{
  |given| <= 1 /\ r in [-1b-53, 1b-53] /\ c in [-1b-24, 1b-24]
  ->
  |stored - given| - (@kStoringError@ + 1b-148) <= 0 /\ |(1 + r) * (1 + c) - 1| <= @kStoringError@
}
