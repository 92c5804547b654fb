// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/piecewise.h>

namespace pcl_bsh {

Piecewise Piecewise::through(const std::vector<Knot>& knots, Ends ends)
{
  std::vector<Part> parts;
  double slope = 0.0;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const Knot& knot = knots[i];
    const bool last = i + 1 == knots.size();
    const double length = last ? 0.0 : knots[i + 1].at - knot.at;
    if (!last && length == 0.0) continue; // a jump, or a knot given twice: the next one holds
    if (!last) slope = (knots[i + 1].value - knot.value) / length;
    if (last && ends == Ends::held) slope = 0.0;
    if (parts.empty() && ends == Ends::held) parts.push_back({knot.at, knot.value, 0.0, 0.0});
    parts.push_back({knot.at, knot.value, slope, 0.0});
  }
  return Piecewise(std::move(parts));
}

} // namespace pcl_bsh
