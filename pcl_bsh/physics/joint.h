// SPDX-License-Identifier: BSD-3-Clause
// Checks joints, and makes Bullet's constraints of them.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/physics/body.h>

#include <memory>
#include <string>

namespace pcl_bsh {

/// @throws InvalidInput
inline void check(const Joint& joint, const WorldBody& a, const WorldBody& b)
{
  const auto fail = [](const std::string& value, const std::string& remedy) {
    throw InvalidInput(Input::scene, "joint", value, remedy);
  };
  if (&a == &b) fail("of a body and itself", "give two bodies");
  if (!a.is_free && !b.is_free) fail("of two bodies that do not move freely", "give one that does");
  if (!joint.place.allFinite()) fail("its place is not finite", "give a finite one");
  if (joint.axis && !(joint.axis->allFinite() && joint.axis->norm() > 0.0))
    fail("its axis has no direction", "give one of a finite length above 0");
}

/// Makes the constraint that joins two bodies at their present poses.
inline std::unique_ptr<btTypedConstraint> constraintOf(const WorldBody& a, const WorldBody& b, const Joint& joint)
{
  const btVector3 in_a = a.inOwnAxes(joint.place), in_b = b.inOwnAxes(joint.place);
  if (!joint.axis) return std::make_unique<btPoint2PointConstraint>(*a.solved, *b.solved, in_a, in_b);
  const Eigen::Vector3d end = joint.place + joint.axis->normalized();
  return std::make_unique<btHingeConstraint>(*a.solved, *b.solved, in_a, in_b, a.inOwnAxes(end) - in_a,
                                             b.inOwnAxes(end) - in_b);
}

} // namespace pcl_bsh
