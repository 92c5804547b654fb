# Segments against boxes, in parts of the largest coordinate: two ends carried, their difference, the widened box, the
# difference to it; and of the motion, at most two such coordinates long: the time's inverse and its products.
@rnd = float<ieee_32, ne>;
start = rnd(start_); end = rnd(end_); low = rnd(low_); reach = rnd(reach_);
motion rnd= end - start;
to_box rnd= low - rnd(start + reach);
{
  |start| <= 1 /\ |end| <= 1 /\ |low| <= 1 /\ |reach| <= 1 /\
  i in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ m in [-1b-24, 1b-24]
  ->
  2 * @kCarriedProductError@ + |motion - (end - start)| + |to_box - (low - (start + reach))| + 12b-24
    <= @kSegmentRounding@ /\
  |(1 + i) * (1 + p) * (1 + m) - 1| <= 6b-24 /\ # of the motion, twice the largest coordinate: 12b-24
  |(1 + i) * (1 + p) - 1| <= @kStepRounding@ # of an instant, in steps
}
