// SPDX-License-Identifier: BSD-3-Clause
// While a record goes by a way w relative to the solid, its depth changes by no more than w. Outside, the depth is the
// negative distance to the surface. So a record need not be measured where its last depth plus its way since then is no
// more than its greatest depth. On a motion of length w from depth s to depth t, a record is nowhere deeper than (s + t
// + w) / 2.
#include <pcl_bsh/depths/depths_along.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/geometry/rigid_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double kWayRounding = 0x1p-40;   ///< of ways that are computed, relative to the coordinates; with much room
constexpr double kWayStretch = 1.0 + 4e-6; ///< what poses may lengthen a way by

class Along {
public:
  Along(const DeepSolid& solid, const QueriedPart& part, const DepthPath& path, Work& work)
  : solid_(solid),
    part_(part),
    path_(path),
    work_(work),
    count_(static_cast<std::uint32_t>(part.queried().thing().view().count)),
    best_(count_),
    last_(count_),
    beyond_(count_, 0.0)
  {
  }

  std::vector<DepthAlong> find(std::vector<double>* at_poses)
  {
    if (at_poses) at_poses->assign(path_.poses.size(), 0.0);
    for (std::uint32_t k = 0; k < path_.poses.size(); ++k) {
      const auto [at, pose] = placed(path_.poses[k]);
      std::vector<std::uint32_t> records = recordsIn(at, part_.queried(), pose, path_.threads, work_);
      if (!at_poses) leaveOutNoDeeper(records, at.pose, pose);
      const std::vector<Depth> depths = depthsOf(at, part_.queried(), pose, records, path_.threads, false, work_);
      for (const Depth& depth : depths) {
        note(depth, k);
        if (!at_poses) last_[depth.record] = {depth.depth.upper, seenPlaces(depth.record, at.pose, pose)};
      }
      const Depth* const deepest = deepestOf(depths);
      if (at_poses && deepest != nullptr) (*at_poses)[k] = deepest->told;
    }
    if (path_.swept && path_.poses.size() > 1) sweepAll();
    std::vector<DepthAlong> found;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (!best_[i]) continue;
      DepthAlong deepest = *best_[i];
      deepest.record = part_.original(i);
      deepest.depth.upper = std::max(deepest.depth.upper, beyond_[i]);
      found.push_back(deepest);
    }
    return found;
  }

private:
  /// Where a record was, in the solid's frame, when it was last measured, and how deep it was at most.
  struct Last {
    double upper = 0.0;
    std::vector<Point3> places;
  };

  /// A record on a part of a motion, which goes from 0 to 1. Depths less than 0 are outside.
  struct Span {
    std::uint32_t record;
    double from, to;
    double first, last; ///< upper bounds of the depths at both ends
    double speed;       ///< upper bound of its way on the whole motion
  };

  std::pair<DeepSolid, Eigen::Isometry3d> placed(const Eigen::Isometry3d& pose) const
  {
    if (path_.solid_moves) return {DeepSolid{solid_.solid, solid_.surface, pose}, path_.at_rest};
    return {DeepSolid{solid_.solid, solid_.surface, path_.at_rest}, pose};
  }

  void note(const Depth& depth, std::uint32_t pose)
  {
    std::optional<DepthAlong>& best = best_[depth.record];
    const double upper = best ? std::max(best->depth.upper, depth.depth.upper) : depth.depth.upper;
    if (!best || depth.told > best->told) best.emplace(DepthAlong{depth, pose});
    best->depth.upper = upper;
  }

  std::vector<Point3> seenPlaces(std::uint32_t record, const Eigen::Isometry3d& of_solid,
                                 const Eigen::Isometry3d& of_queried) const
  {
    const Eigen::Isometry3d see(of_solid.matrix().inverse() * of_queried.matrix());
    std::vector<Point3> places = part_.placesOf(record);
    for (Point3& place : places) {
      const Eigen::Vector3d at = see * Eigen::Vector3d(place[0], place[1], place[2]);
      place = {at.x(), at.y(), at.z()};
    }
    return places;
  }

  void leaveOutNoDeeper(std::vector<std::uint32_t>& records, const Eigen::Isometry3d& of_solid,
                        const Eigen::Isometry3d& of_queried) const
  {
    const double size = of_solid.translation().cwiseAbs().maxCoeff() + of_queried.translation().cwiseAbs().maxCoeff();
    const auto is_no_deeper = [&](std::uint32_t record) {
      const Last& last = last_[record];
      if (last.places.empty()) return false;
      const std::vector<Point3> now = seenPlaces(record, of_solid, of_queried), given = part_.placesOf(record);
      double way = 0.0, largest = size;
      for (std::size_t i = 0; i < now.size(); ++i) {
        const Point3 &p = now[i], &q = last.places[i];
        way = std::max(way, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
        for (std::size_t k = 0; k < 3; ++k)
          largest = std::max({largest, std::abs(p[k]), std::abs(q[k]), std::abs(given[i][k])});
      }
      return last.upper + way * kWayStretch + kWayRounding * largest <= best_[record]->told;
    };
    records.erase(std::remove_if(records.begin(), records.end(), is_no_deeper), records.end());
  }

  /// A ball's radius: its depth is that of its middle, plus the radius.
  double radiusOf(std::uint32_t record) const { return part_.queried().thing().view().ownRadius(record); }

  /// Returns upper bounds of the depths of some records at an instant; less than 0 outside. Notes records inside.
  std::map<std::uint32_t, double> depthsAt(const std::vector<std::uint32_t>& records, const Eigen::Isometry3d& at,
                                           std::uint32_t pose)
  {
    std::map<std::uint32_t, double> depths;
    const std::vector<std::int32_t> subset(records.begin(), records.end());
    PointsView view = part_.queried().thing().view();
    view.restrictTo(subset.data(), subset.size());
    const SphereHierarchy some(view);
    const QueriedRecords queried(some);
    const std::vector<double> found = depthsOfAll(queried, at, pose, std::numeric_limits<double>::infinity());
    for (const std::uint32_t record : records) depths[record] = found[record];
    return depths;
  }

  /// Returns upper bounds of the depths of all records of a queried thing; minus infinity if farther outside than
  /// `reach`.
  std::vector<double> depthsOfAll(const QueriedRecords& queried, const Eigen::Isometry3d& at, std::uint32_t pose,
                                  double reach)
  {
    const auto [solid, of_queried] = placed(at);
    PointDistancesRequest near;
    near.max_distance = reach;
    near.threads = path_.threads;
    PointDistances found = pointDistances({queried.thing(), of_queried}, {solid.surface, solid.pose}, near);
    work_ += found.work;
    std::vector<double> depths = std::move(found.distance);
    for (double& depth : depths) // of a ball outside, too: minus the distance of its middle less its radius
      depth = std::isnan(depth) ? -std::numeric_limits<double>::infinity() : -std::nextafter(depth, -1.0);
    const std::vector<std::uint32_t> inside = recordsIn(solid, queried, of_queried, path_.threads, work_);
    for (const Depth& depth : depthsOf(solid, queried, of_queried, inside, path_.threads, false, work_)) {
      note(depth, pose);
      depths[depth.record] = depth.depth.upper;
    }
    return depths;
  }

  RigidMotion motionFrom(std::uint32_t k) const
  {
    const Eigen::Isometry3d &from = path_.poses[k], &to = path_.poses[k + 1];
    const Eigen::Vector3d turn = shorterTurn(from.linear(), to.linear());
    if (isHalfTurn(turn))
      throw InvalidInput(Input::pose, "motion between two poses", "half a turn, both directions are as short",
                         "give a pose between them");
    return {from, to, {path_.pivot[0], path_.pivot[1], path_.pivot[2]}, turn};
  }

  /// All motions between poses.
  void sweepAll()
  {
    double reach = 0.0;
    for (std::uint32_t k = 0; k + 1 < path_.poses.size(); ++k) {
      const RigidMotion motion = motionFrom(k);
      for (std::uint32_t i = 0; i < count_; ++i) reach = std::fmax(reach, speedOf(i, motion));
    }
    std::vector<double> first = depthsOfAll(part_.queried(), path_.poses[0], 0, reach);
    for (std::uint32_t k = 0; k + 1 < path_.poses.size(); ++k) {
      std::vector<double> last = depthsOfAll(part_.queried(), path_.poses[k + 1], k + 1, reach);
      sweep(k, first, last, reach);
      first = std::move(last);
    }
  }

  /// The motion from a pose to the next.
  /// @param first, last upper bounds of depths at both; minus infinity: farther outside than `reach`, the longest way
  ///   of any record
  void sweep(std::uint32_t k, const std::vector<double>& first, const std::vector<double>& last, double reach)
  {
    const RigidMotion motion = motionFrom(k);
    std::vector<Span> spans;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (std::isinf(first[i]) && std::isinf(last[i])) continue; // farther outside than it goes
      const double speed = speedOf(i, motion), farther = radiusOf(i) - reach;
      if (speed > 0.0) keepOpen({i, 0.0, 1.0, std::max(first[i], farther), std::max(last[i], farther), speed}, spans);
    }
    while (!spans.empty()) {
      std::map<double, std::vector<std::uint32_t>> instants; // halves of the motion, and their halves: exact numbers
      for (const Span& span : spans) instants[0.5 * (span.from + span.to)].push_back(span.record);
      std::vector<Span> halves;
      std::map<double, std::map<std::uint32_t, double>> depths;
      for (auto& [instant, of] : instants) {
        std::sort(of.begin(), of.end());
        depths[instant] = depthsAt(of, motion.at(instant), k);
      }
      for (const Span& span : spans) {
        const double middle = 0.5 * (span.from + span.to), at_middle = depths.at(middle).at(span.record);
        keepOpen({span.record, span.from, middle, span.first, at_middle, span.speed}, halves);
        keepOpen({span.record, middle, span.to, at_middle, span.last, span.speed}, halves);
      }
      spans = std::move(halves);
    }
  }

  /// Keeps a span on which the record may be deeper than known by more than half the tolerance. Spans with a way of a
  /// quarter of the tolerance or less are not divided any more.
  void keepOpen(const Span& span, std::vector<Span>& open)
  {
    const double way = span.speed * (span.to - span.from), upper = 0.5 * (span.first + span.last + way);
    if (upper <= 0.0) return;
    const double known = best_[span.record] ? best_[span.record]->told : 0.0;
    if (upper > known + 0.5 * *path_.swept && way > 0.25 * *path_.swept)
      open.push_back(span);
    else
      beyond_[span.record] = std::max(beyond_[span.record], upper);
  }

  /// A record's speed relative to the solid, with room for rounding.
  double speedOf(std::uint32_t record, const RigidMotion& motion) const
  {
    double radius = 0.0, largest = motion.worldPivot().cwiseAbs().maxCoeff() + motion.shift().norm();
    for (const Point3& place : part_.placesOf(record)) {
      const Eigen::Vector3d p(place[0], place[1], place[2]);
      if (path_.solid_moves) {
        const Eigen::Vector3d at = path_.at_rest * p;
        for (const Eigen::Vector3d& pivot :
             {motion.worldPivot(), Eigen::Vector3d(motion.worldPivot() + motion.shift())})
          radius = std::max(radius, (at - pivot).norm());
      }
      else {
        radius = std::max(radius, (p - motion.pivot()).norm());
      }
      largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    const double way = motion.shift().norm() + motion.turningSpeed(radius * kWayStretch);
    return way > 0.0 ? way * kWayStretch + kWayRounding * (largest + radius) : 0.0;
  }

  const DeepSolid& solid_;
  const QueriedPart& part_;
  const DepthPath& path_;
  Work& work_;
  const std::uint32_t count_;
  std::vector<std::optional<DepthAlong>> best_; ///< of each record of the part
  std::vector<Last> last_;
  std::vector<double> beyond_; ///< nowhere on the motion is it deeper than this, or than the best
};

} // namespace

std::vector<DepthAlong> depthsAlong(const DeepSolid& solid, const QueriedPart& part, const DepthPath& path, Work& work,
                                    std::vector<double>* at_poses)
{
  return Along(solid, part, path, work).find(at_poses);
}

} // namespace pcl_bsh
