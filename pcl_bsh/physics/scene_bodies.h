// SPDX-License-Identifier: BSD-3-Clause
// Objects of a scene as bodies: they fall, slide and rest among its other objects.
//
//   Scene scene(options);
//   scene.add(fixedObject("hill", hill));
//   scene.add(object("stone", stone, T_world_stone));
//   std::vector<SceneBody> how(scene.size());
//   how[1].mass = 200.0;
//   const std::unique_ptr<SceneBodies> bodies = makeSceneBodies(scene, {}, how);
//   for (int i = 0; i < 100; ++i) report(bodies->step(0.1));
//
// Units are those of World. A scene for which nobody makes bodies runs no code of this room.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/physics/world.h>
#include <pcl_bsh/scene/scene.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// How an object takes part among bodies. With a mass or a density, it is a body itself.
struct SceneBody {
  std::optional<double> mass;             ///< finite, > 0
  std::optional<double> density;          ///< of a mesh that closes, or of balls; finite, > 0
  std::optional<Eigen::Vector3d> inertia; ///< about the centre of mass, along the axes of the cloud; each finite, > 0.
                                          ///< None: that of the closed mesh, of the balls, or of points of equal mass
  Material material;                      ///< how it touches; also of an object that is no body

  bool falls() const noexcept { return mass || density; } ///< whether it is a body
};

/// The options of all bodies of a scene.
struct BodiesOptions : WorldOptions {
  double step = 1.0 / 240; ///< seconds between two solutions, at most: a scene's step takes several; finite, > 0
};

/// The report of a step of a scene with bodies.
struct BodiesStep {
  SceneResult scene;     ///< the effects, at the poses after the step
  std::size_t steps = 0; ///< of the world
  WorldStep solved;      ///< sums over these
  double seconds = 0.0;  ///< of the clock, that bodies took
};

/// A body as it is now.
struct BodyState {
  ObjectId object = 0;                                    ///< of the scene
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_object
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     ///< of the centre of mass
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();         ///< radians in a second
  bool asleep = false;                                    ///< it rests, until something moves it
};

/// Contacts of two objects, a < b, as the last step of the world had them.
struct BodyContacts {
  ObjectId a = 0, b = 0;         ///< of the scene
  std::vector<Contact> contacts; ///< with gaps up to the margin
};

/// Moves the objects of a scene. Not to be used from several threads at once. Equal input gives equal bits, whatever
/// the scene's number of threads.
class SceneBodies {
public:
  virtual ~SceneBodies() = default;

  /// Moves all objects and computes the scene's effects. After an exception that is no InvalidInput, neither the bodies
  /// nor the scene may be stepped again.
  /// @param dt seconds, finite, >= 0, at most a million of BodiesOptions::step. @throws InvalidInput for another dt
  virtual BodiesStep step(double dt) = 0;

  /// Leads an object by hand, in place of its motion: each step takes it on towards this pose, by at most 4 m and 4
  /// radians in a second. An object without a mass pushes bodies. A body halts before what stops it, slides along that,
  /// and pushes other bodies.
  /// @throws InvalidInput for a pose that is not rigid, and for an object of several parts
  virtual void lead(ObjectId object, const Eigen::Isometry3d& T_world_object) = 0;

  /// Ends lead(): a body moves freely from its present pose, another object stays there.
  virtual void release(ObjectId object) = 0;

  virtual std::vector<BodyState> states() const = 0;      ///< of all bodies, by object
  virtual std::vector<BodyContacts> contacts() const = 0; ///< by (a, b); none before the first step

  /// Warnings about bodies that overlap something at the beginning, a line each.
  virtual const std::vector<std::string>& warnings() const noexcept = 0;
};

/// The name of a listed effect that does not go with bodies, or null. A response or gravity would move the objects that
/// bodies move. Deformed points have no mass. The way of a body is no leg that first_contact and swept could look at.
inline const char* effectAgainstBodies(const Effects& effects) noexcept
{
  for (const Effect effect :
       {Effect::first_contact, Effect::swept, Effect::stop, Effect::slide, Effect::gravity, Effect::deform})
    if (effects.has(effect)) return nameOf(effect);
  return nullptr;
}

/// Returns why an object cannot take part as `body` says, or null. @param moves whether it has a motion
inline const char* wrongWith(const SceneBody& body, bool fixed, bool moves, std::size_t parts) noexcept
{
  if (moves && parts > 1) return "has a motion and several parts, and one cloud pushes bodies";
  if (!body.falls()) return body.inertia ? "has an inertia and no mass" : nullptr;
  if (body.mass && body.density) return "has both a mass and a density";
  if (parts > 1) return "is a body and has several parts";
  if (fixed) return "is a body and fixed";
  return moves ? "is a body and has a motion" : nullptr;
}

/// Takes over the motions of a scene: they begin now, and setPose(), setMotion() and deform() of its objects are
/// forbidden from now on. Objects that are no bodies go where their motions take them, push bodies, and do not give
/// way. An object that a blocked body holds up waits, and later catches up at twice its speed. Rules about pairs do not
/// hold for bodies, which touch every object.
/// @param scene must outlive the result
/// @param how for each object
/// @throws InvalidInput naming the object: numbers without meaning, a density of points without radii, a body whose
///   mesh does not close (Input::surface), wrongWith(). Also for effectAgainstBodies(), and where no object is a body.
std::unique_ptr<SceneBodies> makeSceneBodies(Scene& scene, const BodiesOptions& options,
                                             const std::vector<SceneBody>& how);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
