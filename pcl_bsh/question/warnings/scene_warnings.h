// SPDX-License-Identifier: BSD-3-Clause
// Warnings about a scene, however it was made. warnings.h has those about two clouds.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/scene/motion.h>
#include <pcl_bsh/scene/scene.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// An object of a scene, as far as warnings depend on it.
struct NamedObject {
  /// One of its clouds.
  struct Part {
    std::string cloud;                                      ///< its name among the clouds
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_object_cloud
    bool solid = false;                                     ///< a mesh that counts with what it encloses
  };

  std::string name;
  bool fixed = false;
  std::vector<Part> parts;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_object
  Motion motion;
};

/// Returns the warnings about a scene that do not depend on its results, a line each. They are about its clouds, the
/// two clouds with the widest holes, the two whose sizes differ most, and objects that are nowhere near the others.
/// @param clouds by the names that objects know them by: all that objects have
/// @param duration of all motion, seconds; none: nobody knows, so what moves by itself may be anywhere
std::vector<std::string> warningsOf(const std::vector<NamedObject>& objects,
                                    const std::map<std::string, NamedCloud>& clouds, double clearance,
                                    std::optional<double> duration);

/// Returns these warnings, with those of spacings, and of meshes that are no solids and close round places of another
/// object while no surface is near. Up to 16 instants of the motion are looked at.
/// @param shapes of the clouds. Their hierarchy() was called
std::vector<std::string> warningsOf(const std::vector<NamedObject>& objects, std::map<std::string, Shape>& shapes,
                                    double clearance, std::optional<double> duration);

/// Returns a warning where effects are about pairs of objects and no pair is tested: all objects are fixed, say.
std::optional<std::string> warningOfNoPairs(const Scene& scene);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
