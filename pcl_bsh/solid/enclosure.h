// SPDX-License-Identifier: BSD-3-Clause
// Records of a thing, points or triangles, that a solid holds, and the bodies that hold them.
//
//   const SolidBodies tank(solid);
//   const QueriedRecords robot(robot_hierarchy);
//   std::vector<std::uint32_t> enclosed = enclosedBy({solid, T_world_tank}, robot, T_world_robot);
//   std::vector<std::uint32_t> holders = holdersOf(tank, T_world_tank, robot, T_world_robot, enclosed);
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/solid/bodies.h>
#include <pcl_bsh/solid/solid.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// The thing that solids are asked about: its points, or the corners of its finite triangles; only those that its view
/// names.
class QueriedRecords {
public:
  /// @param thing borrowed; of triangles, their corners are sorted into voxels here
  explicit QueriedRecords(const SphereHierarchy& thing);

  const SphereHierarchy& thing() const noexcept { return thing_; }
  bool isSurface() const noexcept { return corners_ != nullptr; }
  const SphereHierarchy& places() const noexcept { return corners_ ? *corners_ : thing_; } ///< that are labelled

  /// Places of these records, ascending.
  std::vector<std::int32_t> placesOf(const std::vector<std::uint32_t>& records) const;

  const std::vector<std::uint32_t>& triangles() const noexcept { return triangles_; } ///< finite ones of a surface

  /// Returns a triangle of each shell. Triangles that share a vertex, by number, are of one shell. @pre isSurface()
  const std::vector<std::uint32_t>& shells() const noexcept { return shells_; }

private:
  const SphereHierarchy& thing_;
  std::vector<std::uint32_t> triangles_; ///< ascending
  std::vector<std::int32_t> used_;       ///< vertices that are corners
  std::unique_ptr<const SphereHierarchy> corners_;
  std::vector<std::uint32_t> shells_;
};

/// Records, ascending, of which a place is inside the solid, or on its surface: points, or triangles with such a
/// corner.
/// @param threads 0: all of the machine's. @param work when given, what the query cost is added
/// @throws std::invalid_argument when a pose is not rigid
std::vector<std::uint32_t> enclosedBy(const PlacedSolid& solid, const QueriedRecords& queried,
                                      const Eigen::Isometry3d& T_world_queried, unsigned threads = 1,
                                      Work* work = nullptr);

/// The triangles, ascending, of each body that holds a place of these records in its inside, not only on its surface:
/// the place may be on the surface of another body. No body holds a place in a hollow of the solid.
/// @param enclosed the result of enclosedBy() @throws as enclosedBy()
std::vector<std::uint32_t> holdersOf(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid,
                                     const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                                     const std::vector<std::uint32_t>& enclosed, Work* work = nullptr);

/// A triangle of a body that holds a record, which is enclosed.
std::uint32_t holderOf(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid, const QueriedRecords& queried,
                       const Eigen::Isometry3d& T_world_queried, std::uint32_t enclosed, Work* work = nullptr);

/// Finds a record that the solid holds, where its surface is known to touch no triangle of the queried thing: so one
/// triangle of each shell is looked at. Among points it is the smallest record.
/// @return a record of the queried thing that is enclosed, and a triangle of a body that holds it. @throws as
/// enclosedBy()
std::optional<PointPair> findEnclosed(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid,
                                      const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                                      Work* work = nullptr);

/// Selects the records that are enclosed wherever places truly are: their surface verdicts say that they cannot meet
/// the surface. @param of_queried one per record of the queried thing
std::vector<std::uint32_t> certainlyEnclosed(const std::vector<std::uint32_t>& enclosed,
                                             const std::vector<Verdict>& of_queried);

/// Turns the verdicts of two surfaces into those of a solid and a queried thing. Enclosed records collide, and so do
/// the triangles of holdersOf(). With uncertain places, undecided records stay undecided. Triangles of bodies that
/// certainly hold something collide, and triangles of other bodies that may hold something are undecided.
/// @param of_queried one per record, or empty where not asked for; not empty where places are uncertain
/// @param of_solid one per triangle, or empty
void addEnclosed(const SolidBodies& solid, const Eigen::Isometry3d& T_world_solid, const QueriedRecords& queried,
                 const Eigen::Isometry3d& T_world_queried, const std::vector<std::uint32_t>& enclosed, bool uncertain,
                 std::vector<Verdict>& of_queried, std::vector<Verdict>& of_solid, Work* work = nullptr);

} // namespace pcl_bsh
