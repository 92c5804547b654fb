// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/answers/candidate.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <algorithm>

namespace pcl_bsh::site {

SitePoint nameOf(const pcl::PCLPointCloud2& cloud, std::uint32_t i)
{
  const std::uint8_t* const record = cloud.data.data() + std::size_t{i} * cloud.point_step;
  return {numberAt(record + offsetOf(cloud, source_field_name)), numberAt(record + offsetOf(cloud, record_field_name))};
}

Candidates::Candidates(const std::vector<Candidate>& own, double distance)
{
  constexpr std::size_t numbers_each = 5;
  std::vector<double> numbers; // those of 32 bits are exact as doubles
  for (const Candidate& c : own) {
    if (c.distance != distance) continue;
    numbers.insert(numbers.end(), {c.place[0], c.place[1], c.place[2], static_cast<double>(c.point.source),
                                   static_cast<double>(c.point.record)});
  }
  const std::vector<double> all = gatheredFromAllRanks(numbers);
  std::vector<Candidate> last;
  for (std::size_t i = 0; i < all.size(); i += numbers_each) {
    last.push_back({{all[i], all[i + 1], all[i + 2]},
                    {static_cast<std::uint32_t>(all[i + 3]), static_cast<std::uint32_t>(all[i + 4])},
                    distance});
  }
  std::sort(last.begin(), last.end(), [](const Candidate& c, const Candidate& d) { return c.point < d.point; });
  for (const Candidate& c : last) {
    places.push_back(c.place);
    points.push_back(c.point);
  }
}

SphereHierarchy Candidates::hierarchy() const
{
  return SphereHierarchy(viewOf(places.empty() ? nullptr : places.front().data(), places.size()));
}

} // namespace pcl_bsh::site
