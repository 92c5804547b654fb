// SPDX-License-Identifier: BSD-3-Clause
// Collisions along a path, place by place: clusters of colliding points, with names that last from run to run.
#pragma once

#include <pcl_bsh/clashes/extent.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The status of a clash against an earlier list of clashes; without one, all are fresh. An earlier clash that is not
/// found again is resolved if the run looked there. It did not look there where the path does not come near the place
/// any more (not_visited), or nothing at all of the scan lies near it (not_scanned). Nor did it where the model is in
/// shadow there (unseen): see FormerPlaces. A place that is unseen and was no clash before has an entry of its own
/// (findUnseenPlaces()).
enum class ClashStatus : std::uint8_t { fresh, persisting, resolved, not_visited, not_scanned, unseen };
inline constexpr std::size_t clash_statuses = 6; ///< how many there are

/// new, persisting, resolved, not_visited, not_scanned or unseen.
const char* nameOf(ClashStatus status) noexcept;

/// Whether a clash of this status is there now.
constexpr bool isPresent(ClashStatus status) noexcept
{
  return status == ClashStatus::fresh || status == ClashStatus::persisting;
}

/// Colliding points of a scan that lie together. Coordinates are in the scan's own frame.
struct Clash {
  std::string id;
  ClashStatus status = ClashStatus::fresh;
  std::vector<std::uint32_t> records;      ///< its points, ascending; empty unless it is there now
  std::vector<float> distances;            ///< of `records`, the smallest of each, as a TrajectoryResult has it
  std::vector<std::int32_t> closest_poses; ///< of `records`, where that is
  std::size_t points = 0;
  std::size_t certain_points = 0;   ///< of these: that collide wherever the points truly are; the others are undecided
  std::size_t points_in_shadow = 0; ///< of what is unseen and was no clash: of these, in shadow; the others in the skin
  Point3 low = {}, high = {};       ///< its bounding box
  Point3 place = {};                ///< where its point of the closest pair is; of a triangle, its middle
  double distance = 0.0; ///< the smallest, less radii; negative of what a solid holds: the greatest depth. NaN
                         ///< of what is unseen and was no clash
  /// Certainly holds the distance where a solid makes that negative, or may; else both ends are NaN.
  Interval interval = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  std::uint32_t scan_point = 0;  ///< the pair that realises it; of several, that of the smallest record of the scan
  std::uint32_t model_point = 0; ///< at the closest pose
  std::int32_t first_pose = 0;
  std::int32_t closest_pose = 0;

  /** Clears the records, and what is known of each. */ void clearRecords()
  {
    records.clear();
    distances.clear();
    closest_poses.clear();
  }

  bool isCertain() const { return certain_points > 0; } ///< else it collides only perhaps

  bool isDeep() const { return distance < 0.0; } ///< inside a solid, or balls overlap

  bool wasNoClash() const { return std::isnan(distance); } ///< unseen, and nothing else is known of it
};

/// Whether a clash stands before another: certain before perhaps, then the smaller distance, more points, the id.
/// Unseen places come last, those of most points first.
bool isMoreSevere(const Clash& one, const Clash& other);

/// The records of a scan that collide or may, out of a result about all of its records.
struct CollidingRecords {
  std::vector<std::int32_t> records; ///< ascending
  TrajectoryResult found;            ///< its vectors of records have one entry for each of these

  CollidingRecords() = default;
  /** Copies what is not free. */ explicit CollidingRecords(const TrajectoryResult& of_all);
};

/// Clusters of the points that collide or are undecided (euclideanClusters() with that distance), the most severe
/// first. Clusters with a point that collides for certain come before those that collide only perhaps. Then the order
/// is by smallest distance, so that the deepest come first, then by most points, then by id.
///
/// An id tells the place: `C12_-3_0` has the middle of its box in cell (12, -3, 0) of a grid through the origin. The
/// cells' edge is the smallest power of two that is at least four cluster distances. So it is the same in every run in
/// which the box's middle stays in its cell, whatever the order of points. A second clash of one cell is `C12_-3_0#2`;
/// the lower corners of their boxes decide which.
/// @param found of a request with flags, distances, first_poses and closest_poses
/// @param cluster_distance finite, > 0
/// @throws std::invalid_argument for another distance, or a result without these vectors or of another scan
std::vector<Clash> findClashes(const PointsView& scan, const TrajectoryResult& found, double cluster_distance);

/// As above, of a result that has been cut down to what collides.
std::vector<Clash> findClashes(const PointsView& scan, const CollidingRecords& colliding, double cluster_distance);

/// Gives clashes their ids and puts the most severe first, as findClashes() does: for those that were found in parts.
/// @param clashes in the order of their smallest records, which decides the order of clashes with equal boxes alone
/// @param cluster_distance finite, > 0
void nameClashes(std::vector<Clash>& clashes, double cluster_distance);

/// Names the unseen places that were no clash.
void nameUnseenPlaces(std::vector<Clash>& places, double cluster_distance);

/// Tells which clashes were there before: a clash is persisting if its box comes within `nearness` (per axis) of an
/// earlier one's box. Each earlier id passes on to the clash whose middle is nearest to the earlier middle, one to one.
/// So a clash that moves or grows across cells keeps its id. Earlier clashes that nothing comes near are appended as
/// resolved, which FormerPlaces then judges; those that were resolved then already are forgotten. An unseen place that
/// was no clash gets its id from earlier unseen places alone, and is forgotten where it is not found again.
/// @return how many boxes were compared
std::uint64_t compareWithEarlier(std::vector<Clash>& clashes, const std::vector<Clash>& earlier, double nearness);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
