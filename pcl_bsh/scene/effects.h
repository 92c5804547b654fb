// SPDX-License-Identifier: BSD-3-Clause
// Effects that a scene may be asked for. An effect that is not listed runs no code, allocates nothing and builds
// nothing.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/scene/motion.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

using ObjectId = std::uint32_t; ///< counted from 0 in the order of Scene::add()

/// Quantities that a scene computes for its pairs, and responses of objects that meet. Effects has what each one means.
enum class Effect : std::uint8_t {
  any,
  flags,
  distance,
  contacts,
  first_contact,
  swept,
  self,
  stop,
  slide,
  gravity,
  deform,
};
/// How many there are.
inline constexpr std::size_t kEffects = 11;

/// As it is written in scene files and reports.
const char* nameOf(Effect effect) noexcept;

/// Response of an object that meets another.
enum class Response : std::uint8_t {
  none,
  stop, ///< a moving object halts where it first meets another
  slide ///< it keeps what is left of its motion along what it meets
};

/// Objects follow the ground: pulled down after each of their own motions, lifted over what is low enough.
struct Gravity {
  double step_height = 0.3;                         ///< what an object climbs, and how far it sinks, in one step; > 0
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ(); ///< any length but 0
};

/// The effects of a scene; listed ones are computed by every query() or step().
struct Effects {
  bool any = false;   ///< which pairs of objects collide
  bool flags = false; ///< which points collide with another object
  /// The smallest distance of each pair that is (or may be, for all that is certain) no farther apart than this;
  /// infinity: of every pair to be tested.
  std::optional<double> distance;
  std::optional<std::size_t> contacts; ///< at most so many per pair of parts, the nearest
  bool first_contact = false;          ///< when, on the way from the poses of the last query, a pair first meets
  bool swept = false;                  ///< which points meet another object anywhere on this way
  bool self = false;                   ///< parts of one object that collide with each other
  Response response = Response::none;
  std::optional<Gravity> gravity;
  /// Points of objects move, by Scene::deform(). Spheres follow; those of a voxel, or of all, are built anew once they
  /// have grown by this factor on average; >= 1.
  std::optional<double> deform;

  bool has(Effect effect) const noexcept; ///< whether it is listed
  bool none() const noexcept;             ///< whether a query would compute nothing
  bool ofPairs() const noexcept;          ///< whether a listed one is about pairs of objects
};

/// Counted cost of an effect, equal for any number of threads, and its time.
struct EffectCost {
  std::uint64_t pairs = 0;  ///< pairs of parts put to a query; of deform: parts refitted
  std::uint64_t reused = 0; ///< pairs of objects answered by what was known from an earlier step
  Work work;
  double seconds = 0.0;
};

/// Counted cost of finding the pairs.
struct BroadPhaseCost {
  std::uint64_t moved = 0;       ///< objects whose bounds were computed anew
  std::uint64_t voxels_left = 0; ///< of moved objects
  std::uint64_t voxels_entered = 0;
  std::uint64_t box_tests = 0;     ///< pairs sharing a voxel whose boxes were compared
  std::uint64_t candidates = 0;    ///< of these, pairs whose boxes are near enough to ask further
  std::uint64_t pairs_sharing = 0; ///< pairs to be tested that share a voxel now
  double seconds = 0.0;
};

/// Two objects, a < b, and a part of each.
struct PartPair {
  ObjectId a = 0, b = 0;
  std::uint32_t part_a = 0, part_b = 0;
};

/// A pair that Effect::any found.
struct CollidingPair : PartPair {
  PointPair pair; ///< some colliding pair of points
};

/// A pair that Effect::distance measured.
struct DistantPair : PartPair {
  double distance = 0.0;
  Interval interval; ///< holds it for certain, where the scene's accuracy is less than exact
  PointPair pair;    ///< that realises it; of several, of the smallest parts, then the smallest (a, b)
};

/// A pair that Effect::contacts listed.
struct ContactPair : PartPair {
  std::vector<Contact> contacts; ///< nearest first
  bool complete = true;          ///< no contact of these two parts was left out
};

/// A first contact that Effect::first_contact found.
struct PartFirstContact : PartPair {
  double fraction = 0.0; ///< of the way from the last query (SweptMotion::leg), in [0, 1]: before it no pair of points
                         ///< collides, at it one is within tolerance
  PointPair pair;        ///< the points that meet
};

/// The points of a part that collide, or are undecided. Parts without any are not listed.
struct FlaggedPart {
  ObjectId object = 0;
  std::uint32_t part = 0;
  std::size_t colliding = 0;
  std::size_t undecided = 0;  ///< 0 unless the scene's accuracy lets a query stop early, or points are uncertain
  std::vector<Verdict> flags; ///< one per record of the part's view, as in FlagsResult
};

/// Parts of one object, part_a < part_b.
struct SelfCollision {
  ObjectId object = 0;
  std::uint32_t part_a = 0, part_b = 0;
  PointPair pair;
};

/// How a response or gravity changed an object's wanted motion.
struct Outcome {
  ObjectId object = 0;
  bool touched = false;   ///< it met something
  ObjectId against = 0;   ///< the object that it met last, if so
  bool stuck = false;     ///< it collided before it moved, and so stays where it is
  bool grounded = false;  ///< gravity found ground below it
  double wanted = 0.0;    ///< length of the motion asked for, of the object's centre
  double travelled = 0.0; ///< how far the centre is from where it was
  /// The motion it made, leg by leg from its first pose to its last; empty if it did not move. With a response no
  /// instant of it collides. Gravity without a response looks only at the last legs, the drop: the motion itself, and
  /// the lift after it, go through whatever is there.
  std::vector<Leg> legs;
};

/// The motion of an object since its pose at the last query: first_contact and swept look at it. Its points and parts
/// are as they are now, all the way.
struct SweptMotion {
  ObjectId object = 0;
  Leg leg;
  std::optional<std::uint32_t> part; ///< of a part whose pose was set: its own leg, of T_world_cloud; else of the whole
};

/// An object that did more since the last query than first_contact and swept look at.
struct UnsweptObject {
  ObjectId object = 0;
  bool added = false;    ///< since then, and seen first by a query, not a step: it is looked at where it stands
  bool reshaped = false; ///< its points have changed: how they got from their former places is not looked at
  bool detoured = false; ///< it may have gone another way than its leg: its pose, or a part's, was set before it moved
                         ///< on by itself, or a response or gravity led it (Outcome::legs)
};

/// The result of Scene::query() or Scene::step(); a list is empty where its effect is not asked for.
struct SceneResult {
  double time = 0.0; ///< of the scene, seconds
  std::vector<CollidingPair> any;
  /// Pairs of `any`, and (where a == b) of `self`, that may collide or not: accuracy or uncertainty leaves it open.
  std::vector<PartPair> undecided;
  std::vector<FlaggedPart> flags;
  std::vector<DistantPair> distance;
  std::vector<ContactPair> contacts;
  std::vector<PartFirstContact> first_contact;
  /// First contacts of points that collide for certain. Pairs of objects without uncertain points are in both lists.
  std::vector<PartFirstContact> certain_contact;
  std::vector<FlaggedPart> swept;
  std::vector<SweptMotion> swept_motions; ///< by object, the whole before its parts; with first_contact or swept
  std::vector<UnsweptObject> unswept;     ///< by object; none at a scene's first query, before which nothing moves
  std::vector<SelfCollision> self;
  std::vector<Outcome> outcomes; ///< of moved objects, with a response or gravity
  BroadPhaseCost broad_phase;
  std::array<EffectCost, kEffects> costs;

  /// The cost of one effect.
  const EffectCost& cost(Effect effect) const noexcept { return costs[static_cast<std::size_t>(effect)]; }
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
