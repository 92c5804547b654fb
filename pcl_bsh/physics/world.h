// SPDX-License-Identifier: BSD-3-Clause
// Bodies that fall, slide, bounce and rest on clouds and surfaces as they are. Contacts are those of manifolds; Bullet
// solves for velocities.
//
//   World world;
//   world.addFixed(ground);                                    // Collider: no proxy
//   const BodyId stone = world.add(stone_collider, T_world_stone, massOf(stone_solid, 2700));
//   for (int i = 0; i < 1000; ++i) world.step(1.0 / 240);      // world.pose(stone)
//
// Units: metres, kilograms, seconds. Equal input gives equal motion.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/manifold/mass.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

using BodyId = std::uint32_t; ///< counted from 0 in the order of being added

/// How bodies touch. Frictions and restitutions of two are multiplied.
struct Material {
  double friction = 0.7;    ///< finite, >= 0
  double restitution = 0.0; ///< in [0, 1]
};

/// A joint holds a place of two bodies together, and a hinge an axis, too.
struct Joint {
  Eigen::Vector3d place;                    ///< in the world, metres
  std::optional<Eigen::Vector3d> axis = {}; ///< of a hinge, of any length above 0; none: a ball and socket
};

/// The options of a world.
struct WorldOptions {
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  double margin = 0.01;     ///< contacts are sought so far beyond the thickness; finite, > 0
  double thickness = 0.001; ///< bodies rest so far apart; two clouds of points by half the larger spacing; finite, > 0
  std::size_t contacts = 8; ///< of a patch; >= 1
  double most_push = 1.0;   ///< speed at which bodies that are in each other are pushed apart; finite, > 0
  double damping = 0.0;     ///< share of speed and spin that is lost in a second; in [0, 1]. Round stones rock for
                            ///< long without: contacts have no rolling resistance
  bool sleeping = true;     ///< bodies that rest are left alone until something moves beside them
};

/// The report of a step.
struct WorldStep {
  std::size_t pairs = 0;    ///< put to contactManifold()
  std::size_t contacts = 0; ///< given to the solver
  std::size_t cut = 0;      ///< bodies that would have passed a surface, and halt before it until the next step
  Work work;

  /// Sums of all counts.
  WorldStep& operator+=(const WorldStep& more)
  {
    pairs += more.pairs;
    contacts += more.contacts;
    cut += more.cut;
    work += more.work;
    return *this;
  }
};

/// Not to be used from several threads at once. Colliders are borrowed, and must stay as they are.
class World {
public:
  /// @throws InvalidInput naming the option (Input::scene)
  explicit World(const WorldOptions& options = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Adds a part of the surroundings. With it, moveTo() pushes whatever is in the way.
  /// @throws InvalidInput for a pose that is not rigid, a material without meaning
  BodyId addFixed(const Collider& collider, const Eigen::Isometry3d& T_world_collider = Eigen::Isometry3d::Identity(),
                  const Material& material = {});

  /// A body that moves freely. @throws InvalidInput as above, and for a mass or an inertia that is not finite and > 0
  BodyId add(const Collider& collider, const Eigen::Isometry3d& T_world_collider, const MassProperties& mass,
             const Material& material = {});

  /// Holds two bodies together as they are now, in place of an earlier joint of the two. They do not touch each other
  /// from then on.
  /// @throws InvalidInput for a body and itself, two that are fixed, a place or an axis without meaning
  void join(BodyId a, BodyId b, const Joint& joint);

  std::size_t size() const noexcept;                ///< bodies
  const Eigen::Isometry3d& pose(BodyId body) const; ///< T_world_collider
  Eigen::Vector3d velocity(BodyId body) const;      ///< of the centre of mass
  Eigen::Vector3d spin(BodyId body) const;          ///< radians in a second
  bool isAsleep(BodyId body) const;                 ///< it rests, until something moves it

  void setVelocity(BodyId body, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin = Eigen::Vector3d::Zero());

  /// Sets where a body is to be after the next step. It goes there straight, at constant speed. Where it is cut, it
  /// goes on in the next step. A fixed body gives way to nothing; a free one gives way to what it meets, and is led
  /// until release().
  void moveTo(BodyId body, const Eigen::Isometry3d& T_world_collider);
  void release(BodyId body);       ///< a free body moves freely again, at the velocity that it has
  bool isThere(BodyId body) const; ///< whether it is where moveTo() wanted it

  /// The last contacts of all pairs that have any, by their bodies, the smaller first; borrowed, until the next step.
  const std::map<std::pair<BodyId, BodyId>, Manifold>& contacts() const;

  /// Moves all bodies. A body that would come to half of its distance from a surface halts there. So it is nearer than
  /// that at no instant, whatever its speed. @param dt seconds, finite, > 0. @throws InvalidInput
  WorldStep step(double dt);

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
