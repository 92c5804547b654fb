// SPDX-License-Identifier: BSD-3-Clause
// Moves one object among all the others, which stand still meanwhile.
#pragma once

#include <pcl_bsh/pairs/pairs_along.h>
#include <pcl_bsh/scene/responses/contact_planes.h>
#include <pcl_bsh/scene/state.h>
#include <pcl_bsh/scene/swept/conservative_advancement.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// Moves an object leg by leg. Before each leg, it collects all pairs of points that can meet on it, of any objects. A
/// leg ends where the first of them meets. Its end is taken only if none of them collides there, in exact arithmetic.
/// A slide may bend its path a little before they are collected anew.
class Mover {
public:
  Mover(Scene::State& state, ObjectId object, EffectCost& cost);

  Outcome outcome;       ///< touched, against and stuck, of all moves so far
  std::vector<Leg> legs; ///< gone so far

  const Eigen::Isometry3d& pose() const { return body_.object.pose; }
  Eigen::Vector3d center() const { return pose() * body_.center(); }

  /// Moves to the target or to the first contact, the centre on a straight line. @return whether it reached the target
  bool follow(const Eigen::Isometry3d& target, const Eigen::Vector3d& turn);

  /// Moves without turning, to the target or to the first contact, or, sliding, along what it meets. @return whether it
  /// reached the target
  bool translate(const Eigen::Isometry3d& target, bool slide);

private:
  /// Two records that may meet: one of the mover, one of another object.
  struct Encounter {
    PointPair pair; ///< a: the mover's
    std::uint32_t part = 0;
    ObjectId other = 0;
    std::uint32_t other_part = 0;
    double reach = 0.0;          ///< at most so far apart, they may collide
    double clearance = 0.0;      ///< of the objects
    bool of_points = true;       ///< of both; else one is a triangle
    Eigen::Vector3d apart;       ///< from the other's point to the mover's, at the pose they were collected at
    std::optional<double> meets; ///< s of their contact, where the first contact of all is sought and this may be it
  };

  /// A motion from s = begin to end of which only the way to the first contact counts.
  struct FirstContact {
    const RigidMotion* motion = nullptr;
    double begin = 0.0, end = 1.0;

    /// The share of the way to an s.
    double shareAt(double s) const { return std::min(1.0, (s - begin) / (end - begin) * (1.0 + kDoubleMargin)); }
  };

  /// Where the object may go.
  struct Passage {
    StraightWays ways;                 ///< of its places, in its own frame
    std::size_t most = 0;              ///< pairs of points that may meet on it, with one other part
    std::uint64_t most_leaf_pairs = 0; ///< that may be compared to find them
    std::optional<FirstContact> until_met = {};

    double length() const { return ways.shift.norm(); } ///< where it does not turn
  };

  enum class Walked { free, met, blocked };

  double firstWay() const;
  bool follow(const ObjectMotion& motion, double begin, double end, double most, double& done);
  Walked walk(Eigen::Vector3d& left, const Passage& passage, const Eigen::Isometry3d* target, bool slide,
              ContactPlanes& planes);
  Passage passageOn(const StraightWays& ways, double length) const;
  static double roomIn(const Passage& passage, const Eigen::Vector3d& gone, const Eigen::Vector3d& direction);
  bool collect(Box3 swept, const Passage& passage);
  bool collectFrom(ObjectId other, double clearance, const Passage& passage);
  bool isInside(ObjectId other);
  bool accept(const Eigen::Isometry3d& target);
  bool go(const Eigen::Isometry3d& target);
  std::optional<double> contactOn(const RigidMotion& motion, const Encounter& encounter, double begin,
                                  double end) const;
  std::optional<double> contactOn(const RigidMotion& motion, const Eigen::Vector3d& way, const Encounter& encounter,
                                  const Eigen::Vector3d& gone, double end) const;
  Separation separationOf(const Encounter& encounter) const;
  Eigen::Vector3d normalOf(const Encounter& encounter) const;
  Corners mineOf(const Encounter& encounter) const;
  Corners othersOf(const Encounter& encounter) const;
  bool halt();
  void touch(const Encounter& encounter);
  const SphereHierarchy& hierarchyOf(const Encounter& encounter) const;
  const Eigen::Isometry3d& worldOf(const Encounter& encounter) const;

  Scene::State& state_;
  Body& body_;
  ObjectId object_;
  double tolerance_;
  EffectCost& cost_;
  ObjectId crowded_ = 0; ///< whose points are too many to collect
  std::vector<ObjectId> around_;
  std::vector<Encounter> encounters_;
  double first_contact_ = 1.0; ///< s, where it is sought
  std::size_t near_ = 0;       ///< pairs that were found, of the two parts with most
  Eigen::Isometry3d collected_at_ = Eigen::Isometry3d::Identity(); ///< the pose at which encounters were collected
  std::vector<ObjectId> outside_of_;                               ///< objects that isInside() has ruled out
};

} // namespace pcl_bsh
