// SPDX-License-Identifier: BSD-3-Clause
#include "unseen.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/seen/direction_cells.h>
#include <pcl_bsh/seen/model_ball.h>
#include <pcl_bsh/seen/storage.h>
#include <pcl_bsh/seen/triangle_parts.h>

#include <algorithm>

namespace pcl_bsh::brute_force {
namespace {

/// Whether a beam is seen on a side of a cell from each of its corners.
bool isOnSide(const Eigen::Vector3d& beam, std::size_t side, const DirectionCell& cell)
{
  const auto axis = static_cast<Eigen::Index>(cell.face / 2), u = (axis + 1) % 3, w = (axis + 2) % 3;
  const Eigen::Vector3d at = beam / std::abs(beam[axis]);
  constexpr int turns[] = {1, 1, 0, -1, -1, -1, 0, 1}; // cosines of eighths of a turn; sines are six on
  const auto is_left_of = [&](std::size_t eighth, const Eigen::Vector3d& corner) {
    const int cosine = turns[eighth % 8], sine = turns[(eighth + 6) % 8];
    const double left = cosine * (at[w] - corner[w]) - sine * (at[u] - corner[u]);
    return left >= kBesideCell * (std::abs(cosine) + std::abs(sine));
  };
  const std::array<Eigen::Vector3d, 4> corners = cell.corners();
  return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
    return is_left_of(side, corner) && is_left_of(side + 7, corner); // right of its end: left of half a turn on
  });
}

std::vector<DirectionCell> holesOf(const ScanBeams& scan, double angle)
{
  const double cosine = std::cos(cellAngle(angle));
  std::vector<Eigen::Vector3d> beams;
  eachBeam(scan, [&](std::uint32_t, const BeamEnd& beam) { beams.push_back(beam.way.normalized()); });
  std::vector<DirectionCell> holes;
  const unsigned level = cellLevels(angle);
  for (std::size_t face = 0; face < kCubeFaces; ++face) {
    for (std::uint32_t u = 0; u < 1u << level; ++u) {
      for (std::uint32_t w = 0; w < 1u << level; ++w) {
        const DirectionCell cell{face, level, u, w};
        const Eigen::Vector3d middle = cell.middle().normalized();
        std::array<bool, kBeamSides> has_beam{};
        for (const Eigen::Vector3d& beam : beams) {
          if (beam.dot(middle) < cosine) continue;
          for (std::size_t side = 0; side < kBeamSides; ++side)
            has_beam[side] = has_beam[side] || isOnSide(beam, side, cell);
        }
        if (!std::all_of(has_beam.begin(), has_beam.end(), [](bool has) { return has; })) holes.push_back(cell);
      }
    }
  }
  return holes;
}

bool sees(const ScanBeams& scan, const std::vector<DirectionCell>& holes, double angle, const BallView& ball)
{
  if (!ball.isMeasured() || (ball.is_around && !holes.empty())) return false;
  if (!ball.is_around) {
    const Cone cone(ball.direction, ball.coneAngle() + kMarginOfAngle * angle);
    if (std::any_of(holes.begin(), holes.end(), [&](const DirectionCell& cell) { return cone.meets(cell); }))
      return false;
  }
  bool open = false;
  std::size_t beams = 0;
  const BeamAngle speaks(angle);
  eachBeam(scan, [&](std::uint32_t, const BeamEnd& beam) {
    ++beams;
    open = open || leavesOpen(ball, beam.way, beam.empty, speaks);
  });
  return beams >= 2 && !open;
}

bool isDark(const ScanBeams& scan, const std::vector<DirectionCell>& holes, double angle, const BallView& place)
{
  if (!place.isMeasured()) return true;
  bool passed = false;
  std::size_t beams = 0;
  const BeamAngle near(angle, kBetweenOfAngle);
  eachBeam(scan, [&](std::uint32_t, const BeamEnd& beam) {
    ++beams;
    passed = passed || (!place.is_around && passes(place, beam.way, beam.empty, near));
  });
  if (beams < 2) return true;
  if (place.is_around) return false;
  const Cone cone(place.direction, place.coneAngle());
  return !passed ||
         std::any_of(holes.begin(), holes.end(), [&](const DirectionCell& cell) { return cone.meets(cell); });
}

/// Place by place.
struct Shadow {
  const std::vector<ScanBeams>& scans;
  const std::vector<std::vector<DirectionCell>>& holes;
  double angle;

  bool at(const PosedPlace& place) const
  {
    for (std::size_t s = 0; s < scans.size(); ++s)
      if (!isDark(scans[s], holes[s], angle, {scans[s].origin, place.at, place.magnitude, 0.0})) return false;
    return true;
  }
  bool all(const PosedPlace& /*middle*/, double /*radius*/) const { return false; }
  bool none(const PosedPlace& /*middle*/, double /*radius*/) const { return false; }
};

} // namespace

UnseenResult markUnseen(const std::vector<ScanBeams>& scans, double angle, const Placed& model,
                        const UnseenRequest& request, std::vector<Verdict>& verdicts)
{
  checkUnseen(model, request, verdicts.size());
  checkBeamAngle(angle);
  const DefaultFloatEnvironment environment;
  std::vector<std::vector<DirectionCell>> holes;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    checkScan(scans[i], i);
    holes.push_back(holesOf(scans[i], angle));
  }
  const PointsView& view = model.hierarchy().view();
  UnseenResult result;
  const auto sees_ball = [&](const PosedPlace& place, double radius) {
    bool seen = false;
    for (std::size_t s = 0; s < scans.size(); ++s)
      seen = seen || sees(scans[s], holes[s], angle, {scans[s].origin, place.at, place.magnitude, radius});
    return seen;
  };
  const Shadow shadow{scans, holes, angle};
  const Eigen::Isometry3d frame = request.frame.value_or(model.pose);
  if (request.kinds) result.kinds.in_shadow.assign(view.count, false);
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    if (!isFinite(view.point(record)) || verdicts[record] != Verdict::free) continue;
    const RecordSeen seen_record(model, request.clearance, sees_ball);
    if (seen_record(record)) continue;
    verdicts[record] = Verdict::unseen;
    ++result.unseen;
    if (!request.kinds) continue;
    result.kinds.in_shadow[record] =
        seen_record.isInShadow(record, shadow, request.parts ? &result.kinds.parts : nullptr, frame);
    result.in_shadow += result.kinds.in_shadow[record] ? 1 : 0;
  }
  return result;
}

} // namespace pcl_bsh::brute_force
