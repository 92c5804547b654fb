// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/spacing.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/distance_between.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr std::size_t kGroups = 32, kGroupPoints = 32;

/// Distances from points of a cloud to the nearest point at another place, as the points are given; infinity when all
/// are at one place.
class NearestElsewhere {
public:
  explicit NearestElsewhere(const SphereHierarchy& cloud) : cloud_(cloud) {}

  double from(const Point3& place)
  {
    if (known_ && place == place_) return distance_; // points of one place follow each other in a voxel
    place_ = place;
    distance_ = search(place);
    known_ = true;
    return distance_;
  }

private:
  /// Asks for more neighbours as long as all of them are at the place itself.
  double search(const Point3& place)
  {
    for (std::size_t k = 2;; k *= 8) {
      nearestKSearch(cloud_, place, k, found_);
      for (const std::int32_t index : found_.indices) {
        const Point3 p = cloud_.view().point(static_cast<std::uint32_t>(index));
        if (p != place) return distanceBetween(p, place);
      }
      if (found_.indices.size() < k) return std::numeric_limits<double>::infinity();
    }
  }

  const SphereHierarchy& cloud_;
  Neighbors found_;
  Point3 place_ = {};
  double distance_ = 0.0; ///< from `place_`
  bool known_ = false;
};

} // namespace

Spacing spacingOf(const SphereHierarchy& cloud)
{
  const DefaultFloatEnvironment environment;
  const SphereHierarchy::Storage& storage = cloud.storage();
  if (storage.view.triangles) return {}; // has no holes between points
  const std::size_t wanted = kGroups * kGroupPoints;
  const std::size_t groups = storage.size <= wanted ? storage.voxel_count : kGroups;
  NearestElsewhere nearest(cloud);
  BuildWork built;
  Spacing spacing;
  std::vector<double> gaps;
  for (std::size_t group = 0; group < groups; ++group) {
    std::size_t number = group, first = 0, count = 0;
    if (storage.size <= wanted) {
      count = storage.voxels[number].count;
    }
    else {
      const std::size_t rank = (2 * group + 1) * storage.size / (2 * kGroups);
      const Voxel* const past =
          std::upper_bound(storage.voxels.get(), storage.voxels.get() + storage.voxel_count, rank,
                           [](std::size_t place, const Voxel& voxel) { return place < voxel.begin; });
      number = static_cast<std::size_t>(past - storage.voxels.get()) - 1;
      const std::size_t here = storage.voxels[number].count;
      count = std::min(kGroupPoints, here);
      first = std::min(rank - storage.voxels[number].begin, here - count);
    }
    const Voxel& voxel = storage.built(number, built);
    for (std::size_t k = first; k < first + count; ++k) {
      ++spacing.samples;
      const double gap = nearest.from(voxel.point(storage.view, static_cast<std::uint32_t>(k)));
      if (std::isfinite(gap)) gaps.push_back(gap);
    }
  }
  if (gaps.empty()) return spacing;
  std::sort(gaps.begin(), gaps.end());
  spacing.median = gaps[gaps.size() / 2];
  spacing.wide = gaps[gaps.size() * 9 / 10];
  return spacing;
}

} // namespace pcl_bsh
