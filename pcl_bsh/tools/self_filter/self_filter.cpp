// SPDX-License-Identifier: BSD-3-Clause
#include "self_filter.h"

#include <pcl_bsh/base/invalid_input.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace pcl_bsh::self_filter {

SelfFilter::Part::Part(LinkBody link_body, const std::string& link, unsigned threads,
                       std::vector<std::string>& warnings)
: body(std::move(link_body)),
  enclosing(body.enclosing.view()),
  surface(body.surface.view())
{
  surface.buildAll(threads);
  for (const LinkBody::Mesh& mesh : body.meshes) {
    try {
      enclosed.emplace_back(body.trianglesOf(mesh));
    }
    catch (const InvalidInput& error) {
      warnings.push_back("link '" + link + "': " + mesh.file.string() + ": " + error.wrong() +
                         ": it is a surface alone, and what is inside of it is not cut out: close it");
    }
  }
}

SelfFilter::SelfFilter(Robot robot, const Settings& settings) : robot_(std::move(robot))
{
  if (std::all_of(robot_.links.begin(), robot_.links.end(), [](const Link& link) { return link.shapes.empty(); }))
    throw std::runtime_error(
        "robot '" + robot_.name +
        "': has no body, so that nothing would be cut out: give its links <collision> or <visual>");
  request_.threads = settings.threads;
  paddings_.assign(robot_.links.size(), settings.padding);
  for (const auto& [link, padding] : settings.paddings) paddings_[robot_.linkNamed(link)] = padding;
  for (const Link& link : robot_.links)
    parts_.push_back(std::make_unique<const Part>(bodyOf(link), link.name, settings.threads, warnings_));
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
  for (const auto& part : parts_) sum += part->body.solids.size() + part->enclosed.size();
  return sum;
}

double SelfFilter::leastPadding() const
{
  return *std::min_element(paddings_.begin(), paddings_.end());
}

double SelfFilter::greatestPadding() const
{
  return *std::max_element(paddings_.begin(), paddings_.end());
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

void SelfFilter::flagEnclosed(const SphereHierarchy& points, const Part& part, const Eigen::Isometry3d& T_scan_link)
{
  for (const pcl_bsh::Solid& solid : part.enclosed) {
    labelPoints({points}, {solid, T_scan_link}, labels_, request_.threads);
    if (labels_.inside + labels_.on_surface == 0) continue;
    for (std::size_t i = 0; i < labels_.labels.size(); ++i)
      if (labels_.labels[i] != labelOf(Label::outside)) flags_[i] = Verdict::colliding;
  }
}

const std::vector<Verdict>& SelfFilter::flags(const PointsView& scan, const Eigen::Isometry3d& T_scan_root,
                                              const JointValues& values)
{
  const std::vector<Eigen::Isometry3d> poses = linkPoses(robot_, values);
  const SphereHierarchy points(scan);
  flags_.assign(scan.count, Verdict::free);
  for (std::size_t link = 0; link < parts_.size(); ++link) {
    const Part& part = *parts_[link];
    request_.clearance = paddings_[link];
    const Eigen::Isometry3d T_scan_link = T_scan_root * poses[link];
    flagSolids(points, part, T_scan_link);
    flagEnclosed(points, part, T_scan_link);
    collidingIndices({points}, {part.surface, T_scan_link}, request_, hit_);
    for (const std::int32_t record : hit_.a) flags_[static_cast<std::size_t>(record)] = Verdict::colliding;
  }
  scan_ = namedCloud({}, points);
  return flags_;
}

} // namespace pcl_bsh::self_filter
