// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/outliers.h>

#include <pcl_bsh/geometry/distance_between.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh {
namespace {

using Storage = SphereHierarchy::Storage;

constexpr double kGap = 4096.0;         ///< outliers are so many times as far from the middle as ordinary voxels reach
constexpr double kSlack = 0x1p-20;      ///< exceeds the stretch of a pose that is rigid within 1e-6, and all rounding
constexpr double kPlaceSlack = 0x1p-40; ///< of coordinates: exceeds the rounding of sums of a few of them

/// The voxels of a cloud that lie about its middle, and how far the others are from there at least.
class OrdinaryVoxels {
public:
  explicit OrdinaryVoxels(const Storage& storage) : storage_(storage)
  {
    for (std::size_t axis = 0; axis < 3; ++axis) middle_[static_cast<Eigen::Index>(axis)] = middleOn(axis);
    std::vector<std::pair<double, std::uint32_t>> by_distance;
    for (std::uint32_t v = 0; v < storage.voxel_count; ++v) by_distance.emplace_back(distanceOf(v), v);
    std::sort(by_distance.begin(), by_distance.end());
    std::size_t points = 0, used = 0;
    for (; used < by_distance.size(); ++used) {
      const auto [distance, v] = by_distance[used];
      const double size = sizeOf(v);
      if (2 * points > storage.size && distance > kGap * (radius + size)) break;
      radius = std::max(radius, distance + size);
      points += storage.voxels[v].count;
    }
    for (; used < by_distance.size(); ++used) {
      const auto [distance, v] = by_distance[used];
      nearest_outlier = std::min(nearest_outlier, distance - sizeOf(v));
      outliers.push_back(v);
    }
  }

  const Eigen::Vector3d& middle() const { return middle_; }

  double radius = 0.0; ///< about the middle, of all ordinary points
  double nearest_outlier = std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> outliers; ///< voxels

private:
  /// Half of the points are in voxels on either side.
  double middleOn(std::size_t axis) const
  {
    std::vector<std::pair<double, std::size_t>> origins;
    for (std::uint32_t v = 0; v < storage_.voxel_count; ++v)
      origins.emplace_back(storage_.voxels[v].frame.origin[axis], storage_.voxels[v].count);
    std::sort(origins.begin(), origins.end());
    std::size_t points = 0, i = 0;
    while (2 * (points += origins[i].second) < storage_.size) ++i;
    return origins[i].first;
  }

  double distanceOf(std::uint32_t v) const
  {
    return distanceBetween(storage_.voxels[v].frame.origin, {middle_[0], middle_[1], middle_[2]});
  }

  double sizeOf(std::uint32_t v) const
  {
    const Voxel& voxel = storage_.voxels[v];
    return static_cast<double>(voxel.radius) * voxel.frame.unit * (1.0 + kSlack) + voxel.largest_radius;
  }

  const Storage& storage_;
  Eigen::Vector3d middle_;
};

void divide(const Storage& storage, const std::vector<std::uint32_t>& voxels, std::vector<std::int32_t>& ordinary,
            std::vector<std::int32_t>& outlier)
{
  std::vector<bool> is_outlier(storage.view.count, false);
  for (const std::uint32_t v : voxels)
    storage.forEachRecord(v, [&](std::uint32_t record) {
      is_outlier[record] = true;
      outlier.push_back(static_cast<std::int32_t>(record));
    });
  for (std::size_t i = 0; i < storage.view.size(); ++i)
    if (const std::uint32_t record = storage.view.record(i); !is_outlier[record])
      ordinary.push_back(static_cast<std::int32_t>(record));
}

} // namespace

std::optional<Outliers> findOutliers(const Placed& scan, const SphereHierarchy& model,
                                     const std::vector<Eigen::Isometry3d>& model_poses, double clearance)
{
  const Storage &a = scan.hierarchy().storage(), &b = model.storage();
  if (a.size == 0 || b.size == 0) return std::nullopt;
  const OrdinaryVoxels of_scan(a), of_model(b);
  if (of_scan.outliers.empty() && of_model.outliers.empty()) return std::nullopt;
  // All ordinary points are within `scene` of the middles of both clouds, at every pose.
  const Eigen::Vector3d middle = scan.pose * of_scan.middle();
  double apart = 0.0, coordinates = middle.lpNorm<1>() + scan.pose.translation().lpNorm<1>() +
                                    of_scan.middle().lpNorm<1>() + of_model.middle().lpNorm<1>();
  for (const Eigen::Isometry3d& pose : model_poses) {
    apart = std::max(apart, (pose * of_model.middle() - middle).stableNorm());
    coordinates = std::max(coordinates, pose.translation().lpNorm<1>());
  }
  const double scene = (apart + of_scan.radius + of_model.radius + clearance + a.largest_radius + b.largest_radius +
                        a.uncertainty.most + b.uncertainty.most) *
                           (1.0 + kSlack) +
                       kPlaceSlack * coordinates;
  if (!(2 * scene < std::min(of_scan.nearest_outlier, of_model.nearest_outlier))) return std::nullopt;
  Outliers outliers;
  divide(a, of_scan.outliers, outliers.ordinary_scan, outliers.outlier_scan);
  divide(b, of_model.outliers, outliers.ordinary_model, outliers.outlier_model);
  return outliers;
}

void addOutliers(TrajectoryResult& result, const TrajectoryResult& outliers,
                 const std::vector<std::int32_t>& outlier_scan)
{
  const auto take = [&](auto& all, const auto& some) {
    for (const std::int32_t record : outlier_scan)
      if (!all.empty()) all[static_cast<std::size_t>(record)] = some[static_cast<std::size_t>(record)];
  };
  take(result.flags, outliers.flags);
  take(result.distance, outliers.distance);
  take(result.first_pose, outliers.first_pose);
  take(result.closest_pose, outliers.closest_pose);
  take(result.closest_point, outliers.closest_point);
  take(result.certain_pose, outliers.certain_pose);
  result.colliding += outliers.colliding;
  result.undecided += outliers.undecided;
  for (std::size_t k = 0; k < result.poses.size(); ++k) result.poses[k] += outliers.poses[k];
  result.work += outliers.work;
}

} // namespace pcl_bsh
