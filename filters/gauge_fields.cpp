// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/gauge_fields.h>

#include <limits>

namespace pcl_bsh {

void GaugeFields::add(const Axis& axis, const GaugedPoints& found)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < found.state.size(); ++i) {
    const bool placed = hasPlace(found.state[i]);
    const AxisPlace& at = found.place[i];
    chainage_.push_back(placed ? axis.chainage(at.distance) : none);
    offset_.push_back(static_cast<float>(placed ? at.offset : none));
    height_.push_back(static_cast<float>(placed ? at.height : none));
    clearance_.push_back(static_cast<float>(found.clearance[i]));
    place_.push_back(static_cast<std::uint8_t>(found.state[i]));
  }
  envelope_.insert(envelope_.end(), found.envelope.begin(), found.envelope.end());
}

std::vector<NewField> GaugeFields::fields() const
{
  return {{"chainage", &chainage_},   {"offset", &offset_},     {"height", &height_},
          {"clearance", &clearance_}, {"envelope", &envelope_}, {"place", &place_}};
}

} // namespace pcl_bsh
