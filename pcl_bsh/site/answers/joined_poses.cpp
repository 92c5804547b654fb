// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/site/answers/joined_poses.h>
#include <pcl_bsh/site/answers/tile_query.h>

#include <algorithm>

namespace pcl_bsh::site {

namespace {

constexpr std::size_t most_flags = std::size_t{1} << 26; ///< bytes, of several poses

} // namespace

JoinedPoses::JoinedPoses(const SphereHierarchy& scan, const std::vector<Eigen::Isometry3d>& poses,
                         const TrajectoryRequest& request)
: scan_(scan),
  poses_(poses),
  request_(request),
  sum_(poses.size())
{
}

void JoinedPoses::add(const std::vector<PoseSummary>& of_model)
{
  meets_.emplace_back(poses_.size());
  for (std::size_t k = 0; k < of_model.size(); ++k) {
    sum_[k] += of_model[k];
    meets_.back()[k] = of_model[k].colliding_points + of_model[k].undecided_points > 0;
  }
}

std::vector<std::size_t> JoinedPoses::sharedPoses() const
{
  std::vector<std::size_t> shared;
  for (std::size_t k = 0; k < poses_.size(); ++k)
    if (std::count_if(meets_.begin(), meets_.end(), [k](const std::vector<bool>& model) { return model[k]; }) > 1)
      shared.push_back(k);
  return shared;
}

std::vector<PoseSummary> JoinedPoses::joined(const std::function<SphereHierarchy(std::size_t)>& model_of)
{
  const std::vector<std::size_t> shared = sharedPoses();
  const std::size_t at_once = std::max<std::size_t>(most_flags / std::max<std::size_t>(scan_.view().count, 1), 1);
  for (std::size_t begin = 0; begin < shared.size(); begin += at_once) {
    const auto first = shared.begin() + static_cast<std::ptrdiff_t>(begin);
    count({first, first + static_cast<std::ptrdiff_t>(std::min(at_once, shared.size() - begin))}, model_of);
  }
  return sum_;
}

void JoinedPoses::count(const std::vector<std::size_t>& poses,
                        const std::function<SphereHierarchy(std::size_t)>& model_of)
{
  const FlagsRequest wanted(request_.clearance, Flagged::a, {request_.accuracy, request_.threads});
  std::vector<std::vector<Verdict>> flags(poses.size());
  for (auto& of_pose : flags) of_pose.assign(scan_.view().count, Verdict::free);
  FlagsResult found;
  for (std::size_t m = 0; m < meets_.size(); ++m) {
    if (std::none_of(poses.begin(), poses.end(), [&](std::size_t k) { return meets_[m][k]; })) continue;
    const SphereHierarchy model = model_of(m);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!meets_[m][poses[i]]) continue;
      collisionFlags({scan_}, {model, poses_[poses[i]]}, wanted, found);
      join(flags[i], found.a);
    }
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    sum_[poses[i]].colliding_points = countOf(flags[i], Verdict::colliding);
    sum_[poses[i]].undecided_points = countOf(flags[i], Verdict::undecided);
  }
}

} // namespace pcl_bsh::site
