# NearFrame: (sqrt(s) + rho)^2 <= s (1 + e) + rho^2 (1 + 1/e) for any e; with e = kNeighborShare and the roundings of a squared
# distance, of a product and of a sum, s * above and s / inverse_below bound it, and rho^2 / e of the slack.
{
  d in [-1b-24, 1b-24] /\ p in [-1b-24, 1b-24] /\ s0 in [-1b-24, 1b-24] /\ s1 in [-1b-24, 1b-24] /\
  a in [-1b-24, 1b-24] /\ b in [-1b-24, 1b-24] /\ c in [-1b-24, 1b-24]
  ->
  (1 + 2 * @kNeighborShare@) * (1 + a) * (1 + b) * (1 + c) * ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1))
    - (1 + @kNeighborShare@) >= 0 /\
  (1 + 4 * @kNeighborShare@) * (1 + a) * (1 + b) * (1 + c) * (1 - @kNeighborShare@)
    * ((1 + d) * (1 + d) * (1 + p) * (1 + s0) * (1 + s1)) - 1 >= 0 /\
  (1 + 32 * @kNeighborShare@) * (1 + a) * (1 + b) * (1 + c) - (1 + @kNeighborShare@) >= 0 /\
  (1 + 8 * @kNeighborShare@) * (1 + a) * (1 + b) - (1 + 2 * @kNeighborShare@) * (1 + 4 * @kNeighborShare@) * (1 + c) * (1 + d) >= 0 /\
  (1 + @kNeighborMargin@) * (1 + a) * (1 + b) * (1 + c) * (1 + d) >= 1
}
