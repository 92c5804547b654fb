// SPDX-License-Identifier: BSD-3-Clause
#include "self_filter/self_filter.h"

#include <utility>

namespace pcl_bsh::self_filter {

SelfFilter::SelfFilter(Robot robot, const Settings& settings) : robot_(std::move(robot))
{
  request_.clearance = settings.padding;
  request_.threads = settings.threads;
  for (const Link& link : robot_.links) {
    bodies_.push_back(std::make_unique<const LinkBody>(bodyOf(link, settings.tolerance)));
    hierarchies_.emplace_back(bodies_.back()->view());
    hierarchies_.back().buildAll(settings.threads);
  }
}

std::size_t SelfFilter::balls() const
{
  std::size_t sum = 0;
  for (const auto& body : bodies_) sum += body->centers.size();
  return sum;
}

const std::vector<std::uint8_t>& SelfFilter::flags(const PointsView& scan, const Eigen::Isometry3d& T_scan_root,
                                                   const JointValues& values)
{
  robot_.requireValues(values);
  const std::vector<Eigen::Isometry3d> poses = robot_.poses(values);
  const SphereHierarchy points(scan);
  flags_.assign(scan.count, 0);
  for (std::size_t link = 0; link < hierarchies_.size(); ++link) {
    collidingIndices({points}, {hierarchies_[link], T_scan_root * poses[link]}, request_, hit_);
    for (const std::int32_t record : hit_.a) flags_[static_cast<std::size_t>(record)] = 1;
  }
  return flags_;
}

} // namespace pcl_bsh::self_filter
