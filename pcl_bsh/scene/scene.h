// SPDX-License-Identifier: BSD-3-Clause
// Many objects in motion, and only the effects the scene calls for.
//
//   SceneOptions options;
//   options.clearance = 0.02;
//   options.effects.any = true;
//   options.effects.response = Response::slide;
//   Scene scene(options);
//   scene.add(fixedObject("hall", hall));
//   ObjectId visitor = scene.add(object("visitor", man, T_world_man));
//   scene.setMotion(visitor, VelocityMotion{{1.2, 0, 0}});
//   for (int i = 0; i < 100; ++i) report(scene.step(0.1));
//
// A voxel grid over the scene finds the pairs worth a query: only objects that share a voxel are tested, and an object
// that moves updates only the voxels it leaves and enters. Answers are those of the queries in collide.h: exact unless
// the options ask for less, and the same for any number of threads. Memory from step to step changes times, never
// answers.
//
// Where points have uncertainties (PointsView), any, flags, self, first_contact and swept give verdicts that hold
// wherever the points truly are: what may collide, but does not for certain, is undecided. A first contact is the first
// that may be, SceneResult::certain_contact the first that is for certain. A response halts before what may collide.
// Distances and contacts are those of the measured places.
//
// The inside of a solid part collides, at any clearance: the records that it holds collide, and so do the triangles of
// the body that holds them. Smallest distances are negative then, the depth of the deepest. A first contact of a motion
// that begins inside is its first instant, and a response is stuck there (Outcome). Swept motion flags the records held
// at any instant, and each body that then holds a record, or comes within the tolerance of holding one. Contacts are
// those of surfaces.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/scene/effects.h>
#include <pcl_bsh/scene/motion.h>

#include <Eigen/Geometry>

#include <memory>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// One cloud of an object. Objects and scenes may share a hierarchy.
struct ScenePart {
  std::string name;
  std::shared_ptr<SphereHierarchy> hierarchy;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_object_cloud
  bool solid = false; ///< triangles only: the part counts with what they enclose, and they must close
};

/// An object: parts that move together, where they stand, and how they move.
struct SceneObject {
  std::string name;                                       ///< unique in the scene, not empty
  std::string group;                                      ///< for rules about pairs; may be empty
  std::vector<ScenePart> parts;                           ///< at least one
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_object
  bool fixed = false; ///< part of the surroundings: pairs of fixed objects are not tested unless a rule asks for it
  Motion motion;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> adjacent; ///< parts that `self` does not compare, joints
};

/// An object of one cloud.
inline SceneObject object(std::string name, std::shared_ptr<SphereHierarchy> hierarchy,
                          const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
{
  SceneObject made;
  made.parts.push_back({name, std::move(hierarchy), Eigen::Isometry3d::Identity()});
  made.name = std::move(name);
  made.pose = pose;
  return made;
}

/// An object of the surroundings, which does not move.
inline SceneObject fixedObject(std::string name, std::shared_ptr<SphereHierarchy> hierarchy,
                               const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
{
  SceneObject made = object(std::move(name), std::move(hierarchy), pose);
  made.fixed = true;
  return made;
}

/// Settings for some pairs of objects. The more special rule wins: two names over two groups, a later one over an
/// earlier one.
struct PairRule {
  std::optional<bool> tested;
  std::optional<double> clearance; ///< finite, >= 0
};

/// The effects that a scene computes, and how exactly. The accuracy applies to any, flags, distance and self; all other
/// effects stay exact. Each query of two parts may stop early, and leaves pairs, points and distances undecided, or
/// known within an interval. Each query and each step reports its progress by itself.
struct SceneOptions : Effort {
  Effects effects;
  double clearance = 0.0;  ///< of pairs without a rule; finite, >= 0; inclusive
  bool test_pairs = true;  ///< pairs without a rule are tested; false: only those a rule asks for
  double tolerance = 1e-4; ///< of first contacts, swept motion and responses, in the clouds' unit; > 0
  double voxel_edge = 0.0; ///< of the grid over the scene; 0: chosen by the sizes of objects that are not fixed
  bool remember = true;    ///< keep witnesses and distances from step to step; never changes an answer
};

/// Not to be used from several threads at once. All poses are T_world_object in double, rigid within 1e-6.
///
/// Within a step an object's centre (of its bounding box) moves on a straight line while its rotation turns at constant
/// speed, by any angle that its motion asks for, full turns included (motion.h: Leg). A response changes that motion: a
/// slide turns the object in place before it moves on, and goes along what it meets. With a response, objects move one
/// after the other in the order of their ids, each among the others as they stand at that moment. A response never lets
/// an object collide at any instant of its motion (Outcome::legs). It halts at a distance in (clearance, clearance +
/// tolerance] of the obstacle. Each pose where it halts or turns off is checked exactly.
///
/// Where the motion matters (first_contact, swept, a response or gravity), a step or query throws std::invalid_argument
/// before anything has moved in two cases. An object turns more than 1000 times within a step. Or coordinates are so
/// large that they round by more than 1/32 of the tolerance: with the default tolerance, beyond some 100,000 km.
class Scene {
public:
  /// @throws std::invalid_argument naming what is wrong with the options
  explicit Scene(SceneOptions options);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// @throws std::invalid_argument for a name that is empty or taken, an object without parts, a part without a
  ///   hierarchy, or a pose that is not rigid. Also for a motion that check() refuses, an adjacent part that does not
  ///   exist, or a solid part that does not close.
  ObjectId add(SceneObject object);

  std::size_t size() const noexcept;                           ///< objects
  const SceneObject& operator[](ObjectId object) const;        ///< as added; pose and parts as they are now
  std::optional<ObjectId> find(const std::string& name) const; ///< nothing: there is no such object
  const SceneOptions& options() const noexcept;                ///< as given
  double time() const noexcept;                                ///< seconds stepped so far

  /// T_world_cloud of a part: the very pose that queries are given.
  const Eigen::Isometry3d& worldPose(ObjectId object, std::uint32_t part = 0) const;

  /// Puts an object, or a part within its object, at a pose, whatever is in between. The object's motion goes on from
  /// there. `first_contact` and `swept` look at the way there, unless no query has seen the object yet.
  void setPose(ObjectId object, const Eigen::Isometry3d& pose);
  void setPartPose(ObjectId object, std::uint32_t part, const Eigen::Isometry3d& pose);
  void setMotion(ObjectId object, const Motion& motion);

  /// Sets the rule of two objects, or of all objects of two groups, from now on.
  void setRule(ObjectId a, ObjectId b, const PairRule& rule);
  void setGroupRule(const std::string& group_a, const std::string& group_b, const PairRule& rule);

  /// The clearance of two objects by the rules, or nothing where they are not tested.
  std::optional<double> clearanceOf(ObjectId a, ObjectId b) const;

  /// Whether any two objects are tested against each other: false where there is one object, all are fixed, or rules
  /// leave out all pairs. Then queries and steps find no pair, whatever effects the scene lists.
  bool testsPairs() const;

  /// The points of a part have moved: same records, new coordinates. Its spheres follow (SphereHierarchy::refit()), in
  /// every object that shares them. `first_contact` and `swept` look at the motion of objects with their present
  /// points, not at how points got there: SceneResult::unswept.
  /// @throws std::invalid_argument when the scene does not list `deform`, or the view does not fit
  RefitReport deform(ObjectId object, std::uint32_t part, const PointsView& now);

  /// Forgets what is remembered of an object's points, as after deform(). Changes of its hierarchies (HierarchyUpdate,
  /// refit(), another scene's deform()) are seen by the next step or query without it.
  void pointsChanged(ObjectId object);

  // A query or step that throws (std::bad_alloc, Cancelled) has changed nothing, and may be asked for again.

  /// The effects at the present poses. `first_contact` and `swept` look at the motion from the poses of the last query
  /// or step, with the present points and rules (SceneResult::swept_motions). This is one leg, also where a response
  /// took several. After setPose() it turns in the shorter direction; a part has a leg of its own after setPartPose().
  /// An object that was added since then is looked at where it stands. Objects and parts that are left out are listed
  /// in SceneResult::unswept.
  SceneResult query();

  /// Moves every object along its motion, as response and gravity allow, and queries. An object that no query has seen
  /// yet moves from where it was put. @param dt seconds, finite, >= 0
  SceneResult step(double dt);

  class State;

private:
  std::unique_ptr<State> state_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
