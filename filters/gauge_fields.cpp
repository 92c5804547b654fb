// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/gauge_fields.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/search/find_field.h>

#include <limits>

namespace pcl_bsh {

void GaugeFields::add(const std::vector<Track>& tracks, const GaugedTracks& found)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const GaugedPoints& told = found.told;
  for (std::size_t i = 0; i < told.state.size(); ++i) {
    const bool placed = hasPlace(told.state[i]);
    const AxisPlace& at = told.place[i];
    chainage_.push_back(placed ? tracks[static_cast<std::size_t>(found.track[i])].axis.chainage(at.distance) : none);
    offset_.push_back(static_cast<float>(placed ? at.offset : none));
    height_.push_back(static_cast<float>(placed ? at.height : none));
    clearance_.push_back(static_cast<float>(told.clearance[i]));
    place_.push_back(static_cast<std::uint8_t>(told.state[i]));
  }
  envelope_.insert(envelope_.end(), told.envelope.begin(), told.envelope.end());
  if (has_names_) track_.insert(track_.end(), found.track.begin(), found.track.end());
}

std::vector<NewField> GaugeFields::fields() const
{
  std::vector<NewField> all = {{"chainage", &chainage_},   {"offset", &offset_},     {"height", &height_},
                               {"clearance", &clearance_}, {"envelope", &envelope_}, {"place", &place_}};
  if (has_names_) all.push_back({"track", &track_});
  return all;
}

TimeField timeFieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  const pcl::PCLPointField* field = nullptr;
  std::string names;
  for (const char* usual : {"gps_time", "time", "timestamp", "timeStamp", "t"})
    if (!field) field = findField(cloud, name.empty() ? usual : name);
  for (const pcl::PCLPointField& given : cloud.fields) names += (names.empty() ? "" : ", ") + given.name;
  if (!field)
    throw InvalidInput(Input::seen, "time field",
                       name.empty() ? "the scan has none" : "the scan has no field '" + name + "'",
                       "give the one that has the points' times: its fields are " + names);
  if (field->datatype != pcl::PCLPointField::FLOAT64 && field->datatype != pcl::PCLPointField::FLOAT32)
    throw InvalidInput(Input::seen, "time field", "'" + field->name + "' holds no FLOAT32 or FLOAT64",
                       "convert the times first");
  return {field->offset, field->datatype == pcl::PCLPointField::FLOAT64 ? Scalar::float64 : Scalar::float32};
}

} // namespace pcl_bsh
