// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/search/find_field.h>

#include <algorithm>

namespace pcl_bsh::io {

bool isBeamField(const std::string& name)
{
  return std::find(beam_field_names.begin(), beam_field_names.end(), name) != beam_field_names.end();
}

ScanOrigins originsOf(const pcl::PCLPointCloud2& cloud, const CloudFacts& facts)
{
  if (findField(cloud, scan_field_name) == nullptr) {
    if (facts.scanners.size() == 1) {
      const Viewpoint& pose = facts.scanners.front();
      return ScanOrigins::of({pose[0], pose[1], pose[2]});
    }
    if (!tellsPlace(facts.viewpoint)) return {};
    return ScanOrigins::of({facts.viewpoint[0], facts.viewpoint[1], facts.viewpoint[2]});
  }
  ScanOrigins origins{scan_field_name, {}};
  for (const Viewpoint& pose : facts.scanners)
    origins.entries.push_back({static_cast<double>(origins.entries.size()), {pose[0], pose[1], pose[2]}});
  return origins.entries.empty() ? ScanOrigins() : origins;
}

} // namespace pcl_bsh::io
