// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/leaf/plane_beside.h>

#include <pcl_bsh/geometry/triangle/vector3.h>
#include <pcl_bsh/trajectory/leaf/record_course.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kDecisionsBeforePlane = 64;
constexpr std::uint64_t kRecordsForDecision = 16; // laying a plane looks at so many at the cost of one decision

} // namespace

PlaneBeside::PlaneBeside(const TrajectoryQuery& query)
: query_(query),
  may_know_(!query.of_points && !query.scan.hierarchy().view().areBalls() && !query.model.view().areBalls() &&
            query.of_pairs.isOne()),
  error_(kSeparationError * query.boxes.radius),
  least_(kInfinitelyFar),
  policy_(std::max<std::uint64_t>(kDecisionsBeforePlane, query.model.storage().size / kRecordsForDecision))
{
}

bool PlaneBeside::isBeside(const MovingCorners& arcs, double distance)
{
  const bool is_beside = MovingPair(arcs, touching_).leastApart(normal_, 0.0, 1.0) - error_ > distance;
  policy_.answered(is_beside);
  is_laid_ = policy_.mayAsk();
  return is_beside;
}

void PlaneBeside::lay()
{
  if (least_ == kInfinitelyFar) return;
  const SphereHierarchy::Storage& storage = query_.model.storage();
  normal_ = direction_;
  double highest = -kInfinitelyFar;
  for (std::uint32_t v = 0; v < storage.voxel_count; ++v)
    storage.forEachRecord(v, [&](std::uint32_t record) {
      const MovingCorners corners = restingAt(query_, record);
      for (std::uint32_t i = 0; i < corners.count; ++i) {
        const double height = dot(normal_, corners.from[i]);
        if (!(height > highest)) continue;
        highest = height;
        touching_ = corners;
      }
    });
  is_laid_ = true;
  ++number_;
  least_ = kInfinitelyFar;
}

} // namespace pcl_bsh
