// SPDX-License-Identifier: BSD-3-Clause
// Which points of a posed cloud are inside a posed solid, or on its surface?
//
//   LabelsResult found = labelPoints({scan}, {tank, T_world_tank});
//   if (found.labels[record] == labelOf(Label::inside)) ...
//
// Labels are those of exact arithmetic on the given numbers and poses. A node of the cloud that surely does not meet
// the surface has one label, found for one of its points: whole nodes are labelled at once. A point is labelled where
// it was measured, and by its centre where it is a ball. Points that are not finite are outside.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/solid/solid.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Returns the label as a number, as LabelsResult::labels has it.
constexpr std::uint8_t labelOf(Label label) noexcept
{
  return static_cast<std::uint8_t>(label);
}
/// The result of labelPoints().
struct LabelsResult {
  std::vector<std::uint8_t> labels; ///< one per record of the cloud's view, a Label as a number
  std::size_t inside = 0;
  std::size_t on_surface = 0;
  Work work; ///< node_pairs: nodes of the cloud tested against the solid; leaf_pairs: leaves, and voxels that are not
             ///< built, whose points were labelled one by one; exact_decisions: crossings of a ray and a triangle
};

/// Labels each point. No voxel is built: where one is not, its points are labelled one by one.
/// @param threads 0: all of the machine's @throws std::invalid_argument when a pose is not rigid
LabelsResult labelPoints(const Placed& cloud, const PlacedSolid& solid, unsigned threads = 1);

/// Fills a result, whose memory is used again: for one pose after another.
void labelPoints(const Placed& cloud, const PlacedSolid& solid, LabelsResult& result, unsigned threads = 1);

/// The smallest record of a point that is inside, or on the surface; nothing where no point is.
/// @param work when given, what the query cost is added. @throws as labelPoints() does
std::optional<std::uint32_t> firstInside(const Placed& cloud, const PlacedSolid& solid, Work* work = nullptr);

/// Whether any point is inside, or on the surface: stops at the first that it finds. As firstInside() otherwise.
bool anyInside(const Placed& cloud, const PlacedSolid& solid, Work* work = nullptr);

/// Whether any point is inside, and not only on the surface. As anyInside() otherwise.
bool anyWithin(const Placed& cloud, const PlacedSolid& solid, Work* work = nullptr);

/// The label of one place in the frame of the solid. Not finite: outside.
Label labelPlace(const Solid& solid, const Point3& place);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
