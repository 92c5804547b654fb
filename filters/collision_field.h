// SPDX-License-Identifier: BSD-3-Clause
// Results of a query for each point, as fields added to the cloud.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/result.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

struct TrajectoryResult;

/// The field that holds collision flags: UINT8, 0 = free, 1 = collides, 2 = undecided. Flag 3 is sparse: the obstacle
/// is not scanned densely enough there. Flag 4 is unseen: it would be free, but no scanner saw that.
inline constexpr const char* collision_field_name = "collision";

/// Along a trajectory: FLOAT32, the smallest distance, NaN where free; INT32, numbers of poses, -1 where free.
inline constexpr const char* distance_field_name = "distance";
inline constexpr const char* first_pose_field_name = "first_pose";
inline constexpr const char* closest_pose_field_name = "closest_pose";

/// One value per point: UINT8 (verdicts, too), INT32, FLOAT32 or FLOAT64. The values are borrowed.
struct NewField {
  std::string name;
  std::variant<const std::vector<Verdict>*, const std::vector<std::uint8_t>*, const std::vector<std::int32_t>*,
               const std::vector<float>*, const std::vector<double>*>
      values; ///< one per point
};

/// A copy of the cloud with more fields at the end of each record; every other byte is kept. A field of the same name
/// and type that is there already takes the new values instead.
/// @throws std::invalid_argument naming what is wrong: a cloud that viewOf() refuses, a number of values that is not
///   the number of points, a field of that name but of another type
pcl::PCLPointCloud2 withFields(const pcl::PCLPointCloud2& cloud, const std::vector<NewField>& fields);

/// Adds one field of verdicts.
inline pcl::PCLPointCloud2 withField(const pcl::PCLPointCloud2& cloud, const std::string& name,
                                     const std::vector<Verdict>& values)
{
  return withFields(cloud, {{name, &values}});
}

/// `collision`, `distance`, `first_pose` and `closest_pose` of a result that has all four. Borrows them.
std::vector<NewField> fieldsOf(const TrajectoryResult& result);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
