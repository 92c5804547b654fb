// SPDX-License-Identifier: BSD-3-Clause
// How far the points of PCL's clouds may truly be from where they were measured: question/uncertainty.h says what that
// means.
#pragma once

#include <pcl_bsh/question/uncertainty.h>

#include <pcl/PCLPointField.h>

namespace pcl_bsh {

/// Returns PCL's fields in the core's type.
inline std::vector<RecordField> recordFields(const std::vector<pcl::PCLPointField>& fields)
{
  std::vector<RecordField> same;
  for (const pcl::PCLPointField& field : fields)
    same.push_back({field.name, field.offset, field.datatype, field.count});
  return same;
}

/// As the core's withUncertainty(), for PCL's fields.
inline PointsView withUncertainty(const PointsView& view, const std::vector<pcl::PCLPointField>& fields,
                                  const std::string& cloud, const Uncertainty& uncertainty)
{
  return withUncertainty(view, recordFields(fields), cloud, uncertainty);
}

} // namespace pcl_bsh
