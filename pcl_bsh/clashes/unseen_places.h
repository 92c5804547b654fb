// SPDX-License-Identifier: BSD-3-Clause
// Where a model comes along a path and nobody saw that there is nothing, place by place: entries of a list of clashes
// with the status unseen.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clashes/former_places.h>
#include <pcl_bsh/seen/unseen_points.h>

#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Unseen records of a model at each pose of its path. Borrowed.
struct UnseenAlong {
  const PointsView& model;                      ///< points or triangles
  const std::vector<Eigen::Isometry3d>& poses;  ///< T_scan_model
  const std::vector<std::vector<bool>>& unseen; ///< of each pose, one per record; empty: none

  /// At each pose, with parts in the scan's frame. Null, or empty at a pose: all unseen places are in shadow.
  const std::vector<UnseenKinds>* kinds = nullptr;
};

/// Clusters of the records, as placed, that are unseen at any pose. Places lie together if they are in one cell, or in
/// cells that touch, of a grid through the origin. So do the corners of a triangle that is unseen as a whole, and parts
/// of another triangle whose boxes touch. The cells are as long as the smallest power of two that is at least the
/// cluster distance. Most points first, then by id.
///
/// Sets these members of each: `id` as findClashes() makes them, with U instead of C; `low` and `high`; `place`, the
/// middle of its box; `first_pose`; and no distance (NaN). `closest_pose` is the first at which most of its records are
/// unseen; `points` counts these, and `points_in_shadow` those of them in shadow.
/// @param cluster_distance finite, > 0
/// @throws std::invalid_argument for another distance
std::vector<Clash> findUnseenPlaces(const UnseenAlong& along, double cluster_distance);

/// Tells `former` where the model was in shadow. In the skin beams passed the place: there the run looked.
/// @param former before it judges
void tellUnseen(FormerPlaces& former, const UnseenAlong& along);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
