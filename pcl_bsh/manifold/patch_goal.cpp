// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/patch_goal.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

double turn(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& at)
{
  const Eigen::Vector2d way = to - from, other = at - from;
  return way.x() * other.y() - way.y() * other.x();
}

} // namespace

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

double PlaneHull::gain(const Point& point) const
{
  if (corners_.size() < 2) return 0.0;
  if (corners_.size() == 2) return 0.5 * std::abs(turn(corners_[0], corners_[1], point));
  double gained = 0.0;
  for (std::size_t i = 0; i < corners_.size(); ++i)
    gained += std::max(0.0, -turn(corners_[i], corners_[(i + 1) % corners_.size()], point));
  return 0.5 * gained;
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

double PatchGoal::weight(double gap) const
{
  if (!(most_gap_ > least_gap_)) return 1.0;
  return std::clamp((most_gap_ - gap) / (most_gap_ - least_gap_), 0.0, 1.0);
}

double PatchGoal::score(const Eigen::Vector3d& place, double gap) const
{
  if (!(gap <= most_gap_)) return kNone;
  for (const PatchSlab& slab : ended_)
    if (slab.holds(place)) return kNone;
  if (!patch_) return -gap;
  if (!patch_slab_.holds(place)) return kNone;
  const double score = extent(flat(place)) * weight(gap);
  return score > 0.0 ? score : kNone;
}

double PatchGoal::bound(const Eigen::Vector3d& middle, double radius, double slack, double least_gap) const
{
  const double reach = radius + slack;
  for (const PatchSlab& slab : ended_)
    if (slab.from(middle) + reach + slack <= slab.height) return kNone;
  if (!patch_) return -least_gap;
  if (patch_slab_.from(middle) - reach - slack > patch_slab_.height) return kNone;
  const Eigen::Vector2d at = flat(middle);
  // A corner that moves by a length changes the hull's area by at most half of that times the hull's diameter.
  const double change = hull_.size() < 2 ? 1.0 : 0.5 * hull_.diameter();
  const double span = hull_.diameter() + at.norm() + reach;
  const double rounding = hull_.size() < 2 ? 1e-12 * span : 1e-12 * span * span;
  const double most = extent(at) + change * reach + rounding;
  return most * (1.0 + 1e-12) * weight(least_gap);
}

} // namespace pcl_bsh
