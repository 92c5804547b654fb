// SPDX-License-Identifier: BSD-3-Clause
// Fields of clouds that name them at run time.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <string>

namespace pcl_bsh {

/// The first field of that name; null when the cloud has none.
inline const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const pcl::PCLPointField& field) { return field.name == name; });
  return found == cloud.fields.end() ? nullptr : &*found;
}

} // namespace pcl_bsh
