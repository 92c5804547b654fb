// SPDX-License-Identifier: BSD-3-Clause
// Fields of clouds that name them at run time.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <string>
#include <vector>

namespace pcl_bsh {

/// The first of the fields with that name; null where none has it.
inline const pcl::PCLPointField* findField(const std::vector<pcl::PCLPointField>& fields, const std::string& name)
{
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const pcl::PCLPointField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// The first field of a cloud with that name.
inline const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  return findField(cloud.fields, name);
}

} // namespace pcl_bsh
