// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/patch_goal.h>

#include <algorithm>

namespace pcl_bsh {

void PlaneHull::add(const Point& point)
{
  std::vector<Point>& all = sorted_;
  all = corners_;
  all.push_back(point);
  for (const Point& corner : corners_) diameter_ = std::max(diameter_, (corner - point).norm());
  std::sort(all.begin(), all.end(),
            [](const Point& l, const Point& r) { return l.x() != r.x() ? l.x() < r.x() : l.y() < r.y(); });
  if (all.size() < 3) {
    corners_ = all;
    return;
  }
  corners_.clear();
  const auto half = [&](auto begin, auto end) { // Andrew's monotone chain
    const std::size_t from = corners_.size();
    for (; begin != end; ++begin) {
      while (corners_.size() >= from + 2 && turn(corners_[corners_.size() - 2], corners_.back(), *begin) <= 0.0)
        corners_.pop_back();
      corners_.push_back(*begin);
    }
    corners_.pop_back();
  };
  half(all.begin(), all.end());
  half(all.rbegin(), all.rend());
}

void PatchGoal::begin(const Candidate& first, const Eigen::Vector3d& normal, double height)
{
  patch_ = true;
  patch_slab_ = {first.place, normal, height};
  least_gap_ = first.gap;
  const Eigen::Vector3d across = normal.isZero(0.0) ? Eigen::Vector3d::UnitZ().eval() : normal;
  axes_[0] = across.unitOrthogonal();
  axes_[1] = across.cross(axes_[0]);
  hull_.clear();
  add(first.place);
}

void PatchGoal::end()
{
  patch_ = false;
  ended_.push_back(patch_slab_);
}

} // namespace pcl_bsh
