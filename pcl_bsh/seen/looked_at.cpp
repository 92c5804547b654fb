// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/looked_at.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/query/work.h>
#include <pcl_bsh/seen/direction_cells.h>
#include <pcl_bsh/seen/model_ball.h>
#include <pcl_bsh/seen/storage.h>

namespace pcl_bsh {
namespace {

constexpr unsigned kLevel = 8; ///< cells of some 6 milliradians

/// Nodes with cones no wider than this, some cells, are not opened.
constexpr double kNarrow = 0.02;

/// Beams up to this many angles from a ball say whether it is seen.
constexpr double kNeededOfAngle = std::max(kReachOfAngle, kMarginOfAngle + kBetweenOfAngle);

/// Room for the roundings of cones, cells and beams.
constexpr double kSlack = 0x1p-20;

std::size_t numberOf(const DirectionCell& cell)
{
  return (cell.face << 2 * kLevel) + (std::size_t{cell.w} << kLevel) + cell.u;
}

/// Calls visit(cell) for the cells that may share a direction with a cone, while it returns false.
template <class Visit>
bool anyCell(const DirectionCell& cell, const Cone& cone, const Visit& visit)
{
  if (cone.isApartFrom(CellSphere(cell))) return false;
  if (cell.level == kLevel) return visit(cell);
  for (std::uint32_t q = 0; q < 4; ++q)
    if (anyCell(cell.quarter(q), cone, visit)) return true;
  return false;
}

template <class Visit>
bool anyCell(const Cone& cone, const Visit& visit)
{
  for (std::size_t face = 0; face < kCubeFaces; ++face)
    if (anyCell({face, 0, 0, 0}, cone, visit)) return true;
  return false;
}

} // namespace

/// One model at one pose.
class LookedAt::Walk {
public:
  Walk(LookedAt& looked, const Placed& model, double clearance)
  : looked_(looked),
    model_(model),
    storage_(model.hierarchy().storage()),
    clearance_(clearance)
  {
    if (!storage_.top.empty()) enter(nullptr, 0);
  }

private:
  void enter(const Voxel* voxel, std::uint32_t index)
  {
    const Node& node = voxel ? voxel->nodes[index] : storage_.top[index];
    for (std::uint32_t i = 0; i < node.count && !looked_.all_; ++i) {
      const GivenSphere sphere = !voxel                 ? storedSphere(storage_.frame, node, i)
                                 : voxel->given.empty() ? storedSphere(voxel->frame, node, i)
                                                        : givenSphereOf(storage_.view, *voxel, node, i);
      const PosedPlace place(model_.pose, sphere.center);
      const BallView balls(looked_.origin_, place.at, place.magnitude,
                           sphere.radius * (1.0 + kPoseStretch) + clearance_ + storage_.uncertainty.most, 8.0);
      const bool leaf = node.isLeaf(i);
      if (!balls.is_around && (balls.coneAngle() <= kNarrow || (leaf && voxel))) {
        mark(balls);
      }
      else if (voxel && leaf) {
        for (std::uint32_t p = node.begin[i]; p < node.begin[i + 1] && !looked_.all_; ++p)
          mark(ModelBall(model_, voxel->records()[p], clearance_).from(looked_.origin_));
      }
      else if (!leaf) {
        enter(voxel, node.child[i]);
      }
      else {
        enter(&storage_.built(node.begin[i], work_), 0);
      }
    }
  }

  void mark(const BallView& ball)
  {
    if (ball.is_around || !ball.isMeasured()) {
      looked_.all_ = true;
      return;
    }
    anyCell(Cone(ball.direction, ball.coneAngle() + kNeededOfAngle * looked_.angle_ + kSlack),
            [&](const DirectionCell& cell) {
              looked_.cells_[numberOf(cell)] = true;
              return false;
            });
  }

  LookedAt& looked_;
  const Placed& model_;
  const SphereHierarchy::Storage& storage_;
  const double clearance_;
  Work work_;
};

LookedAt::LookedAt(const Point3& origin, double angle)
: origin_(origin),
  angle_(angle),
  cells_(kCubeFaces << 2 * kLevel)
{
  checkBeamAngle(angle);
}

void LookedAt::add(const Placed& model, double clearance)
{
  const DefaultFloatEnvironment environment;
  Walk(*this, model, clearance);
}

bool LookedAt::holds(const Point3& end) const
{
  if (all_) return true;
  const Eigen::Vector3d way = Eigen::Vector3d(end.data()) - Eigen::Vector3d(origin_.data());
  if (way.isZero(0.0)) return false; // no beam
  const FacePlace place = facePlaceOf(way);
  const auto cell = [](double u) {
    const double number = std::ldexp(0.5 * (u + 1.0), kLevel);
    return static_cast<std::uint32_t>(std::clamp(number, 0.0, std::ldexp(1.0, kLevel) - 1.0));
  };
  return cells_[numberOf({place.face, kLevel, cell(place.u), cell(place.w)})];
}

bool LookedAt::holdsSome(const Point3& center, double radius) const
{
  const BallView ball(origin_, Eigen::Vector3d(center.data()), Eigen::Vector3d(center.data()).lpNorm<1>(), radius, 8.0);
  if (all_ || ball.is_around || !ball.isMeasured()) return true;
  return anyCell(Cone(ball.direction, ball.coneAngle() + kSlack),
                 [&](const DirectionCell& cell) { return cells_[numberOf(cell)]; });
}

} // namespace pcl_bsh
