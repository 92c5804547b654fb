// SPDX-License-Identifier: BSD-3-Clause
// A body of a world, with its counterpart in Bullet.
#pragma once

#include <pcl_bsh/physics/world.h>

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>

namespace pcl_bsh {

inline btVector3 bullet(const Eigen::Vector3d& v)
{
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

inline Eigen::Vector3d eigen(const btVector3& v)
{
  return {v.x(), v.y(), v.z()};
}

inline Eigen::Matrix3d turnBy(const Eigen::Vector3d& way)
{
  const double angle = way.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, way / angle).toRotationMatrix() : Eigen::Matrix3d::Identity().eval();
}

struct WorldBody {
  const Collider* collider;
  Material material;
  Eigen::Isometry3d pose, own_axes; ///< T_world_collider, T_collider_axes: of the inertia, about the centre of mass
  double reach = 0.0;               ///< no place of the collider is farther from the centre of mass
  bool is_free = false;
  bool is_led = false;      ///< a free body that moveTo() leads to its target
  Eigen::Isometry3d target; ///< of a body that is not free, or is led
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();
  std::unique_ptr<btRigidBody> solved;

  Eigen::Vector3d center() const { return pose * own_axes.translation(); }
  bool isAsleep() const { return is_free && !solved->isActive(); }
  bool moves() const { return !velocity.isZero(0.0) || !spin.isZero(0.0); }

  /// Returns the pose after so many seconds at the present velocities.
  Eigen::Isometry3d after(double seconds) const
  {
    const Eigen::Vector3d from = center();
    Eigen::Isometry3d there = pose;
    there.pretranslate(-from);
    there.prerotate(turnBy(seconds * spin));
    there.pretranslate(from + seconds * velocity);
    there.linear() = Eigen::Quaterniond(there.linear()).normalized().toRotationMatrix();
    return there;
  }

  /// A body that is not free, or is led, takes the velocity that brings it to its target in so many seconds.
  void headForTarget(double dt)
  {
    if (is_free && !is_led) return;
    velocity = spin = Eigen::Vector3d::Zero();
    const bool moves_on = is_led || target.matrix() != pose.matrix();
    if (is_free) solved->activate(true);
    if (!is_free) solved->forceActivationState(moves_on ? DISABLE_DEACTIVATION : ISLAND_SLEEPING); // awake wakes others
    if (!moves_on) return;
    const Eigen::AngleAxisd turn(target.linear() * pose.linear().transpose());
    velocity = (target * own_axes.translation() - center()) / dt;
    spin = turn.angle() / dt * turn.axis();
  }

  /// Gives the solver the pose, relative to an origin, and the velocities.
  void place(const Eigen::Vector3d& origin, double dt)
  {
    const btTransform there = transformOf(pose, origin);
    solved->setCenterOfMassTransform(there);
    // The solver computes the velocities of a body that is not free from two poses.
    solved->setInterpolationWorldTransform(is_free ? there : transformOf(after(-dt), origin));
    solved->setLinearVelocity(bullet(velocity));
    solved->setAngularVelocity(bullet(spin));
    solved->setInterpolationLinearVelocity(bullet(velocity));
    solved->setInterpolationAngularVelocity(bullet(spin));
  }

  btTransform transformOf(const Eigen::Isometry3d& at, const Eigen::Vector3d& origin) const
  {
    const Eigen::Isometry3d axes = at * own_axes;
    const Eigen::Quaterniond turn(axes.linear());
    return btTransform(btQuaternion(static_cast<btScalar>(turn.x()), static_cast<btScalar>(turn.y()),
                                    static_cast<btScalar>(turn.z()), static_cast<btScalar>(turn.w())),
                       bullet(axes.translation() - origin));
  }

  /// Returns a place of the world in the body's own axes, as the solver has it.
  btVector3 inOwnAxes(const Eigen::Vector3d& place) const
  {
    return bullet(own_axes.inverse() * (pose.inverse() * place));
  }

  /// Returns an upper bound of the speed of its places.
  double mostSpeed() const { return velocity.norm() + spin.norm() * reach; }
};

inline double reachOf(const PointsView& view, const Eigen::Vector3d& from)
{
  double reach = 0.0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i)); // of triangles, a ball that holds each
    if (isFinite(p))
      reach = std::max(reach, (Eigen::Vector3d(p[0], p[1], p[2]) - from).norm() + view.radius(view.record(i)));
  }
  return reach;
}

/// Whether one of two bodies holds a place of the other: then they are pushed apart, and nothing halts them.
inline bool areInEachOther(const Manifold& between)
{
  return std::any_of(between.contacts.begin(), between.contacts.end(),
                     [&](const Contact& contact) { return contact.distance < -between.thickness; });
}

} // namespace pcl_bsh
