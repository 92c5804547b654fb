// SPDX-License-Identifier: BSD-3-Clause
// Which contact a manifold takes next: a score of each candidate, and a bound for all within a sphere, so that most are
// never looked at. SPECIFICATION.md ("Manifolds") defines patches and scores.
#pragma once

#include <pcl_bsh/query/result.h>

#include <Eigen/Geometry>

#include <array>
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

  /// Minus infinity: no candidate. The greatest is the next. It falls with the gap.
  double score(const Eigen::Vector3d& place, double gap) const;

  /// No candidate within the sphere that has at least this gap has a greater score. @param slack what the sphere's
  /// middle and radius may be off by
  double bound(const Eigen::Vector3d& middle, double radius, double slack, double least_gap) const;

private:
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

} // namespace pcl_bsh
