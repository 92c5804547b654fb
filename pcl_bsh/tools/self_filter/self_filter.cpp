// SPDX-License-Identifier: BSD-3-Clause
#include "self_filter.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace pcl_bsh::self_filter {

SelfFilter::Part::Part(LinkBody link_body, unsigned threads)
: body(std::move(link_body)),
  enclosing(body.enclosing.view()),
  surface(body.surface.view())
{
  surface.buildAll(threads);
}

SelfFilter::SelfFilter(Robot robot, const Settings& settings) : robot_(std::move(robot))
{
  if (std::all_of(robot_.links.begin(), robot_.links.end(), [](const Link& link) { return link.shapes.empty(); }))
    throw std::runtime_error(
        "robot '" + robot_.name +
        "': has no body, so that nothing would be cut out: give its links <collision> or <visual>");
  request_.clearance = settings.padding;
  request_.threads = settings.threads;
  for (const Link& link : robot_.links) parts_.push_back(std::make_unique<const Part>(bodyOf(link), settings.threads));
}

std::size_t SelfFilter::triangles() const
{
  std::size_t sum = 0;
  for (const auto& part : parts_) sum += part->body.surface.triangles.size();
  return sum;
}

std::size_t SelfFilter::solids() const
{
  std::size_t sum = 0;
  for (const auto& part : parts_) sum += part->body.solids.size();
  return sum;
}

void SelfFilter::flagSolids(const SphereHierarchy& points, const Part& part, const Eigen::Isometry3d& T_scan_link)
{
  if (part.body.solids.empty()) return;
  collidingIndices({points}, {part.enclosing, T_scan_link}, request_, hit_);
  const Eigen::Isometry3d T_link_scan = T_scan_link.inverse();
  for (const std::int32_t record : hit_.a) {
    Verdict& flag = flags_[static_cast<std::size_t>(record)];
    if (flag != Verdict::free) continue;
    const Point3 p = points.view().point(static_cast<std::uint32_t>(record));
    const Eigen::Vector3d seen(p[0], p[1], p[2]);
    const double rounding = 0x1p-48 * (seen.lpNorm<1>() + T_link_scan.translation().lpNorm<1>());
    if (part.body.hasWithin(request_.clearance + rounding, T_link_scan * seen)) flag = Verdict::colliding;
  }
}

const std::vector<Verdict>& SelfFilter::flags(const PointsView& scan, const Eigen::Isometry3d& T_scan_root,
                                              const JointValues& values)
{
  robot_.requireValues(values);
  const std::vector<Eigen::Isometry3d> poses = robot_.poses(values);
  const SphereHierarchy points(scan);
  flags_.assign(scan.count, Verdict::free);
  for (std::size_t link = 0; link < parts_.size(); ++link) {
    const Part& part = *parts_[link];
    const Eigen::Isometry3d T_scan_link = T_scan_root * poses[link];
    flagSolids(points, part, T_scan_link);
    collidingIndices({points}, {part.surface, T_scan_link}, request_, hit_);
    for (const std::int32_t record : hit_.a) flags_[static_cast<std::size_t>(record)] = Verdict::colliding;
  }
  scan_ = namedCloud({}, points);
  return flags_;
}

} // namespace pcl_bsh::self_filter
