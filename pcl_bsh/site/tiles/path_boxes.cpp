// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/tiles/path_boxes.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::site {

PathBoxes::PathBoxes(const CloudBoxes& model, const std::vector<Eigen::Isometry3d>& poses, const PathReach& reach)
: model_(model),
  poses_(poses),
  reach_(reach)
{
  if (model.empty() || poses.empty()) return;
  Point3 arm;
  for (std::size_t k = 0; k < 3; ++k)
    arm[k] = std::max(std::abs(model.whole().low[k]), std::abs(model.whole().high[k]));
  arm_ = std::hypot(arm[0], arm[1], arm[2]) * (1.0 + 1e-5); // poses are rigid within 1e-6
  levels_.emplace_back();
  const std::size_t steps = reach.moves ? std::max(poses.size() - 1, std::size_t{1}) : poses.size();
  for (std::size_t step = 0; step < steps; ++step) levels_.back().push_back(boxOf(model.whole(), step));
  while (levels_.back().size() > 1) {
    const std::vector<Bounds>& below = levels_.back();
    std::vector<Bounds> level;
    for (std::size_t i = 0; i < below.size(); i += 2)
      level.push_back(i + 1 < below.size() ? joined(below[i], below[i + 1]) : below[i]);
    levels_.push_back(std::move(level));
  }
}

/// Returns how far the model's points may leave the straight lines between their places at both ends of a step. A point
/// turns about the origin by an angle at a constant speed; linear interpolation of a function errs by an eighth of its
/// second derivative, which here is the arm times the angle squared. Poses are rigid within 1e-6 only; this error
/// changes during the step.
double PathBoxes::shiftOf(std::size_t step) const
{
  const Eigen::Matrix3d turn = poses_[step].linear().transpose() * poses_[step + 1].linear();
  // From the chord |R - 1|_F = 2 sqrt(2) sin(angle / 2): the angle is at most pi / 2 times twice the sine of its half.
  const double chord = (turn - Eigen::Matrix3d::Identity()).norm() / std::sqrt(2.0);
  const double angle = std::asin(std::min(1.0, chord / 2)) * 2 + 1e-5;
  return arm_ * (angle * angle / 8 + 1e-5);
}

Bounds PathBoxes::boxOf(const Bounds& part, std::size_t step) const
{
  if (!reach_.moves || step + 1 >= poses_.size()) return moved(part, poses_[step], reach_.distance);
  const double reach = reach_.distance + shiftOf(step);
  return joined(moved(part, poses_[step], reach), moved(part, poses_[step + 1], reach));
}

bool PathBoxes::mayReach(const Bounds& box) const
{
  return !levels_.empty() && mayReach(box, levels_.size() - 1, 0);
}

bool PathBoxes::mayReach(const Bounds& box, std::size_t level, std::size_t index) const
{
  if (!overlap(box, levels_[level][index])) return false;
  if (level == 0)
    return std::any_of(model_.parts().begin(), model_.parts().end(),
                       [&](const Bounds& part) { return overlap(box, boxOf(part, index)); });
  const std::size_t end = std::min(2 * index + 2, levels_[level - 1].size());
  for (std::size_t below = 2 * index; below < end; ++below)
    if (mayReach(box, level - 1, below)) return true;
  return false;
}

} // namespace pcl_bsh::site
