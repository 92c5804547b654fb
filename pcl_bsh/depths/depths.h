// SPDX-License-Identifier: BSD-3-Clause
// How deep is what a solid holds?
//
//   const QueriedRecords robot(robot_hierarchy);
//   DepthsResult found = depthsIn({tank_solid, tank_hierarchy, T_world_tank}, robot, T_world_robot);
//   found.depths[0].depth.upper // of the first record that the tank holds, or that meets its surface
//
// The depth of a point is its distance to the surface. The depth of a triangle is the greatest distance to the surface
// of its places that are inside. The depth of a ball whose middle is enclosed is the depth of its middle plus its
// radius: how far the ball has to move at least until none of it is inside. It continues the distance of a ball
// outside, which is that of its middle less its radius.
#pragma once

#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/solid/enclosure.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// A solid where it stands. All is borrowed.
struct DeepSolid {
  const Solid& solid;
  const SphereHierarchy& surface; ///< the solid's triangles
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// A record's depth: for points and balls the nearest double, for triangles not known better than the interval.
struct Depth {
  std::uint32_t record = 0;
  Interval depth;            ///< 0 <= lower <= upper
  double told = 0.0;         ///< one number for it: the nearest double, of triangles the lower end
  std::uint32_t nearest = 0; ///< the triangle of the solid that is nearest to the deepest place that was found
};

/// The result of depthsIn().
struct DepthsResult {
  std::vector<Depth> depths; ///< by record, ascending
  Work work;
};

/// For triangles, the search stops where upper <= lower (1 + kDepthShare), or where a record has been cut into as many
/// pieces as the query allows, so that its interval is wider.
inline constexpr double kDepthShare = 0x1p-10;

/// Records, ascending, with a place inside or on the surface: points that are enclosed, triangles that are enclosed or
/// meet the surface. @throws std::invalid_argument when a pose is not rigid
std::vector<std::uint32_t> recordsIn(const DeepSolid& solid, const QueriedRecords& queried,
                                     const Eigen::Isometry3d& T_world_queried, unsigned threads, Work& work);

/// The depth of each record of recordsIn().
/// @param deepest true: other records than the deepest are measured only until they are known not to be deeper; their
///   intervals hold their depths all the same
/// @param threads 0: all of the machine's. @throws std::invalid_argument when a pose is not rigid
DepthsResult depthsIn(const DeepSolid& solid, const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                      unsigned threads = 1, bool deepest = false);

/// The greatest depth; of several equal ones, that of the first record. Nothing where no record is deeper than 0.
const Depth* deepestOf(const std::vector<Depth>& depths);

/// Turns the smallest distance of the two into the negative depth of the deepest record, where the solid holds
/// anything. Among equally deep records it is the first. Its interval holds the depths of all.
/// @param solid_is_b whether pairs are (queried record, solid's triangle), or the other way round
void deepen(DistanceResult& closest, const DeepSolid& solid, bool solid_is_b, const QueriedRecords& queried,
            const Eigen::Isometry3d& T_world_queried, unsigned threads = 1);

/// As depthsIn(), of some of the records that recordsIn() has. @param records ascending
std::vector<Depth> depthsOf(const DeepSolid& solid, const QueriedRecords& queried,
                            const Eigen::Isometry3d& T_world_queried, const std::vector<std::uint32_t>& records,
                            unsigned threads, bool deepest, Work& work);

/// Returns a view of these points with all radii negated: distances of these balls are depths. For RecordDistance
/// alone. @param radii are written, and must last as long as the view
PointsView sunk(PointsView balls, std::vector<float>& radii);

} // namespace pcl_bsh
