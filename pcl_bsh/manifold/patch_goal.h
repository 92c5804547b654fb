// SPDX-License-Identifier: BSD-3-Clause
// Which contact a manifold takes next: a score of each candidate, and a bound for all within a sphere, so that most are
// never looked at. SPECIFICATION.md ("Manifolds") defines patches and scores.
#pragma once

#include <pcl_bsh/query/result.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_bsh {

/// A pair that may become a contact: its numbers are those of the channel that has it.
struct Candidate {
  double score = -std::numeric_limits<double>::infinity();
  double gap = std::numeric_limits<double>::infinity();
  std::uint8_t channel = 0;
  PointPair pair;                                   ///< of the channel's sides
  bool is_enclosed = false;                         ///< the probe is in the solid of the other side
  Eigen::Vector3d place;                            ///< of the probe, in the world
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< of edges that cross: from the other side to the probe's

  bool isThere() const { return score > -std::numeric_limits<double>::infinity(); }

  /// By score, then by gap, channel and pair.
  bool isBefore(const Candidate& other) const
  {
    if (score != other.score) return score > other.score;
    if (gap != other.gap) return gap < other.gap;
    return channel != other.channel ? channel < other.channel : pair < other.pair;
  }
};

/// All places that are no farther from a plane than a height.
struct PatchSlab {
  Eigen::Vector3d place, normal; ///< of the patch's first contact
  double height = 0.0;

  double from(const Eigen::Vector3d& at) const { return std::abs(normal.dot(at - place)); }
  bool holds(const Eigen::Vector3d& at) const { return from(at) <= height; }
};

/// The convex hull of some points of a plane, by its corners.
class PlaneHull {
public:
  using Point = Eigen::Vector2d;

  /// Returns twice the signed area of a triangle: above 0 where the last point is to the left of the way between the
  /// others.
  static double turn(const Point& from, const Point& to, const Point& at)
  {
    const Point way = to - from, other = at - from;
    return way.x() * other.y() - way.y() * other.x();
  }

  void clear() { corners_.clear(), diameter_ = 0.0; }
  std::size_t size() const { return corners_.size(); }
  double diameter() const { return diameter_; }

  void add(const Point& point);

  /// How much larger the hull would be with this point, in area.
  double gain(const Point& point) const;

private:
  std::vector<Point> corners_; ///< counterclockwise
  std::vector<Point> sorted_;  ///< scratch of add()
  double diameter_ = 0.0;
};

/// Chooses the next contact by those that were taken.
class PatchGoal {
public:
  /// Forgets what was taken. @param most_gap contacts have no greater one
  void reset(double most_gap)
  {
    most_gap_ = most_gap;
    ended_.clear();
    patch_ = false;
  }

  double mostGap() const { return most_gap_; }
  bool seeksDeepest() const { return !patch_; }

  /// The deepest contact that is in no patch yet begins one.
  void begin(const Candidate& first, const Eigen::Vector3d& normal, double height);
  void add(const Eigen::Vector3d& place) { hull_.add(flat(place)); }
  void end();

  /// Returns the score of a place; minus infinity: it is no candidate. The candidate with the greatest score is the
  /// next. Scores fall with the gap.
  double score(const Eigen::Vector3d& place, double gap) const;

  /// Returns a bound: no candidate within the sphere that has at least this gap has a greater score. @param slack what
  /// the sphere's middle and radius may be off by
  double bound(const Eigen::Vector3d& middle, double radius, double slack, double least_gap) const;

  bool hasEndedPatches() const { return !ended_.empty(); }

  /// Whether a patch that was ended holds all of some places about a middle.
  /// @param reach called with a patch's normal: returns how far these places reach along it from the middle at most
  template <class Reach>
  bool isTaken(const Eigen::Vector3d& middle, double slack, const Reach& reach) const
  {
    for (const PatchSlab& slab : ended_)
      if (slab.from(middle) + reach(slab.normal) + slack <= slab.height) return true;
    return false;
  }

private:
  static constexpr double kNone = -std::numeric_limits<double>::infinity();

  Eigen::Vector2d flat(const Eigen::Vector3d& place) const
  {
    const Eigen::Vector3d at = place - patch_slab_.place;
    return {axes_[0].dot(at), axes_[1].dot(at)};
  }
  double weight(double gap) const;
  double extent(const Eigen::Vector2d& at) const { return hull_.size() < 2 ? at.norm() : hull_.gain(at); }

  double most_gap_ = 0.0;
  std::vector<PatchSlab> ended_;
  bool patch_ = false;
  PatchSlab patch_slab_; ///< of the patch that is begun
  double least_gap_ = 0.0;
  std::array<Eigen::Vector3d, 2> axes_; ///< of its plane
  PlaneHull hull_;
};

// Searches ask these of each pair of nodes, so they are defined here.

inline double PlaneHull::gain(const Point& point) const
{
  if (corners_.size() < 2) return 0.0;
  if (corners_.size() == 2) return 0.5 * std::abs(turn(corners_[0], corners_[1], point));
  double gained = 0.0;
  for (std::size_t i = 0; i < corners_.size(); ++i)
    gained += std::max(0.0, -turn(corners_[i], corners_[(i + 1) % corners_.size()], point));
  return 0.5 * gained;
}

inline double PatchGoal::weight(double gap) const
{
  if (!(most_gap_ > least_gap_)) return 1.0;
  return std::clamp((most_gap_ - gap) / (most_gap_ - least_gap_), 0.0, 1.0);
}

inline double PatchGoal::score(const Eigen::Vector3d& place, double gap) const
{
  if (!(gap <= most_gap_)) return kNone;
  for (const PatchSlab& slab : ended_)
    if (slab.holds(place)) return kNone;
  if (!patch_) return -gap;
  if (!patch_slab_.holds(place)) return kNone;
  const double score = extent(flat(place)) * weight(gap);
  return score > 0.0 ? score : kNone;
}

inline double PatchGoal::bound(const Eigen::Vector3d& middle, double radius, double slack, double least_gap) const
{
  const double reach = radius + slack;
  if (isTaken(middle, slack, [&](const Eigen::Vector3d&) { return reach; })) return kNone;
  if (!patch_) return -least_gap;
  if (patch_slab_.from(middle) - reach - slack > patch_slab_.height) return kNone;
  const Eigen::Vector2d at = flat(middle);
  // A corner that moves by a length changes the hull's area by at most half of that times the hull's diameter.
  const double change = hull_.size() < 2 ? 1.0 : 0.5 * hull_.diameter();
  const double span = hull_.diameter() + at.norm() + reach;
  const double rounding = hull_.size() < 2 ? 1e-12 * span : 1e-12 * span * span;
  const double most = extent(at) + change * reach + rounding;
  return most * (1.0 + 1e-12) * weight(least_gap);
}

} // namespace pcl_bsh
