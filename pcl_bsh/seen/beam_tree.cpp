// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/beam_tree.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/build/morton.h>
#include <pcl_bsh/seen/direction_cells.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh {
namespace {

/// Neighbouring directions have neighbouring keys.
std::uint64_t keyOf(const Eigen::Vector3d& direction)
{
  constexpr double cells = 0x1p19; // 20 bits an axis, and three for the face
  const FacePlace place = facePlaceOf(direction);
  const auto cell = [](double u) {
    return static_cast<std::uint64_t>((std::clamp(u, -1.0, 1.0) + 1.0) * cells * 0.99);
  };
  return static_cast<std::uint64_t>(place.face) << 60 | mortonCode(cell(place.u), cell(place.w), 0);
}

BeamNode around(const Beam* begin, const Beam* end)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  BeamNode node{0, 0, 0, 0, std::numeric_limits<float>::infinity(), 0};
  for (const Beam* beam = begin; beam != end; ++beam) {
    sum += beam->direction();
    node.least = std::min(node.least, beam->empty);
    node.greatest = std::max(node.greatest, beam->empty);
  }
  const Eigen::Vector3d center = sum / static_cast<double>(end - begin);
  node.x = roundToFloat(center.x());
  node.y = roundToFloat(center.y());
  node.z = roundToFloat(center.z());
  double farthest = 0.0;
  for (const Beam* beam = begin; beam != end; ++beam) {
    const Eigen::Vector3d way = beam->direction() - node.center();
    farthest = std::max(farthest, way.squaredNorm());
  }
  node.r = roundUp(std::sqrt(farthest) * (1.0 + kDoubleMargin));
  return node;
}

} // namespace

BeamEnd beamOf(const ScanBeams& scan, std::uint32_t record)
{
  const bool returned = record < scan.returns.count;
  const PointsView& view = returned ? scan.returns : scan.misses;
  if (!returned) record -= static_cast<std::uint32_t>(scan.returns.count);
  const Point3 end = view.point(record);
  const Eigen::Vector3d way = Eigen::Vector3d(end.data()) - Eigen::Vector3d(scan.origin.data());
  const double length = way.norm();
  if (!(std::isfinite(length) && length > 0.0)) return {Eigen::Vector3d::Zero(), 0.0};
  if (!returned) return {way, scan.misses_beyond};
  return {way, std::max(0.0, length - view.uncertainty - view.ownUncertainty(record) - view.radius(record))};
}

BeamTree::BeamTree(const ScanBeams& scan) : scan_(scan)
{
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(scan.returns.size());
  eachBeam(scan, [&](std::uint32_t record, const BeamEnd& beam) { order.emplace_back(keyOf(beam.way), record); });
  std::sort(order.begin(), order.end());
  beams_.reserve(order.size());
  for (const auto& [key, record] : order) {
    const BeamEnd beam = beamOf(scan_, record);
    const Eigen::Vector3d direction = beam.way.normalized();
    beams_.push_back({roundToFloat(direction.x()), roundToFloat(direction.y()), roundToFloat(direction.z()),
                      roundDown(beam.empty), record});
  }
  raise();
}

void BeamTree::raise()
{
  if (beams_.empty()) return;
  std::size_t width = kLeaf;
  do {
    levels_.push_back(nodes_.size());
    for (std::size_t begin = 0; begin < beams_.size(); begin += width)
      nodes_.push_back(around(beams_.data() + begin, beams_.data() + std::min(beams_.size(), begin + width)));
    width *= kChildren;
  } while (nodes_.size() - levels_.back() > 1);
}

} // namespace pcl_bsh
