// SPDX-License-Identifier: BSD-3-Clause
// Which points of a scan are the robot that scans?
//
//   SelfFilter filter(io::readRobot("arm.urdf"), {});
//   const std::vector<Verdict>& mine = filter.flags(viewOf(cloud), T_cloud_root, {{"elbow", 0.7}});
//
// A point is flagged where it is within the padding of a link, or inside of it. Boxes, cylinders, spheres and meshes
// that close are solid. A mesh that does not close counts as a surface alone, with a warning.
#pragma once

#include "link_body.h"

#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/question/named_cloud.h>
#include <pcl_bsh/solid/labels.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh::self_filter {

struct Settings {
  double padding = 0.02;                       ///< m, finite and >= 0
  unsigned threads = 1;                        ///< 0: all of the machine's
  std::map<std::string, double> paddings = {}; ///< of links by their names, m, in place of `padding`
};

/// Reads all links once. For each frame it builds the scan's hierarchy, only where that is near the robot.
class SelfFilter {
public:
  /// @throws as bodyOf() does; std::runtime_error for a robot without a body; std::invalid_argument naming a link that
  ///   is not there and has a padding
  SelfFilter(Robot robot, const Settings& settings);

  const Robot& robot() const { return robot_; }
  std::size_t triangles() const; ///< of the meshes of all links
  std::size_t solids() const;    ///< of all links: boxes, cylinders, spheres and meshes that close
  double leastPadding() const;   ///< of all links
  double greatestPadding() const;

  /// Warnings about the links, a sentence each: meshes that do not close.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// One per record of the scan: colliding where it is the robot, else free. Valid until the next call.
  /// @param T_scan_root where the robot's root is in the scan's frame
  /// @throws std::invalid_argument as Robot::requireValues(), Kinematics and SphereHierarchy do
  const std::vector<Verdict>& flags(const PointsView& scan, const Eigen::Isometry3d& T_scan_root,
                                    const JointValues& values);

  /// Facts about the last scan, for warnings; without a name.
  const NamedCloud& scan() const { return scan_; }

private:
  /// A body, hierarchies of the balls about its solids and of its triangles, and the solids of its meshes.
  struct Part {
    /// @param warnings gets one for each mesh that does not close
    Part(LinkBody link_body, const std::string& link, unsigned threads, std::vector<std::string>& warnings);

    LinkBody body;
    SphereHierarchy enclosing, surface;
    std::vector<pcl_bsh::Solid> enclosed; ///< of each mesh that closes
  };

  void flagSolids(const SphereHierarchy& points, const Part& part, const Eigen::Isometry3d& T_scan_link);
  void flagEnclosed(const SphereHierarchy& points, const Part& part, const Eigen::Isometry3d& T_scan_link);

  Robot robot_;
  FlagsRequest request_;
  std::vector<std::unique_ptr<const Part>> parts_; ///< for each link
  std::vector<double> paddings_;                   ///< for each link
  std::vector<std::string> warnings_;
  CollidingIndices hit_;
  LabelsResult labels_;
  std::vector<Verdict> flags_;
  NamedCloud scan_;
};

/// Whether a point in the sensor's frame stands for a beam without a return: it is exactly 0 0 0.
inline bool isNoReturn(const Point3& point)
{
  return point == Point3{0.0, 0.0, 0.0};
}

} // namespace pcl_bsh::self_filter
