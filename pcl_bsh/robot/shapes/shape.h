// SPDX-License-Identifier: BSD-3-Clause
// One type for all shapes that are no meshes. Each shape has a header of its own beside this one.
#pragma once

#include <pcl_bsh/robot/robot.h>
#include <pcl_bsh/robot/shapes/box.h>
#include <pcl_bsh/robot/shapes/capsule.h>
#include <pcl_bsh/robot/shapes/cylinder.h>
#include <pcl_bsh/robot/shapes/sphere.h>

namespace pcl_bsh::robots {

/// A shape that is no mesh.
using Solid = std::variant<Box, Cylinder, Sphere, Capsule>;

/// How far a point in its frame lies from it, m; inside, the negative depth. Within a few roundings of double.
inline double signedDistance(const Solid& solid, const Eigen::Vector3d& point)
{
  return std::visit([&](const auto& form) { return signedDistance(form, point); }, solid);
}

/// Returns the radius of rounding: the solid is all places within it of its core.
inline double roundness(const Solid& solid)
{
  return std::visit([](const auto& form) { return roundness(form); }, solid);
}

/// The place of its core that is farthest in this direction.
inline Eigen::Vector3d support(const Solid& solid, const Eigen::Vector3d& direction)
{
  return std::visit([&](const auto& form) { return support(form, direction); }, solid);
}

/// The radius of a ball about the origin of its frame that holds it.
inline double enclosingRadius(const Solid& solid)
{
  return std::visit([](const auto& form) { return enclosingRadius(form); }, solid);
}

inline std::array<double, 3> sizesOf(const Solid& solid)
{
  return std::visit([](const auto& form) { return sizesOf(form); }, solid);
}

/// The solid of a shape; nothing of a mesh.
inline std::optional<Solid> solidOf(const Shape& shape)
{
  return std::visit(
      [](const auto& form) -> std::optional<Solid> {
        if constexpr (std::is_same_v<std::decay_t<decltype(form)>, Mesh>)
          return std::nullopt;
        else
          return form;
      },
      shape.form);
}

} // namespace pcl_bsh::robots
