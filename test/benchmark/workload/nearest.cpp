// SPDX-License-Identifier: BSD-3-Clause
#include "nearest.h"

#include "points_adaptor.h"

#include <algorithm>
#include <limits>

namespace pcl_bsh::bench {

struct NearestDistance::Tree {
  explicit Tree(const Points& points)
  : adaptor{points},
    index(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(16))
  {
  }

  PointsAdaptor adaptor;
  NanoflannIndex<double> index;
};

NearestDistance::NearestDistance(const Points& points) : tree_(std::make_unique<Tree>(points))
{
}
NearestDistance::~NearestDistance() = default;

double NearestDistance::to(const Point& query) const
{
  std::uint32_t index;
  double squared;
  const bool found = tree_->index.knnSearch(&query.x, 1, &index, &squared) > 0;
  return found ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

double NearestDistance::toOther(const Point& query) const
{
  constexpr std::size_t kNeighbours = 16;
  std::array<std::uint32_t, kNeighbours> index;
  std::array<double, kNeighbours> squared;
  const auto end = squared.begin() + tree_->index.knnSearch(&query.x, kNeighbours, index.data(), squared.data());
  const auto other = std::find_if(squared.begin(), end, [](double s) { return s > 0.0; });
  return other != end ? std::sqrt(*other) : std::numeric_limits<double>::infinity();
}

} // namespace pcl_bsh::bench
