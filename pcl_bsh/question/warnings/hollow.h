// SPDX-License-Identifier: BSD-3-Clause
// The warning that faces of one of two things close round places of the other, which count as free. It is a hint, by
// samples: a few such places among many others may be overlooked.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/ask.h>

#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Returns a place of the queried thing that the closed faces of a surface wind round, or nothing. Up to 16 of the
/// poses are looked at. At each, some 256 records, 511 at most, are looked at in voxels that meet the surface's box.
/// Samples are 8 of these in all, or one of each pose. The first question about a surface passes all of its triangles,
/// which takes some 160 instructions each; the second finds out whether they close. Where they are known not to close,
/// nothing is looked at.
/// @param T_surface_queried where the queried thing is: one pose or more
/// @returns it in the queried thing's own frame
/// @pre hierarchy() of the surface was called, and isSurface()
std::optional<Point3> placeWithin(Shape& surface, const SphereHierarchy& queried,
                                  const std::vector<Eigen::Isometry3d>& T_surface_queried);

/// Returns the distance below which a user surely looks at the surface: a hundredth of its size. @pre as placeWithin()
double nearTo(const Shape& surface);

/// Returns the warning about such a place. @param option by which the surface counts with what it encloses
Warning warningOfHollow(const std::string& surface, const char* option, const std::string& queried,
                        const Point3& place);

/// Returns the smallest distance between the two things that an answer tells: 0 where anything collides or the answer
/// tells no distance, infinity where nothing collides.
double nearestOf(const Question& question, const Answer& answer);

/// Returns the smallest distance that results of other queries tell: verdicts, distances, results along a path.
double nearestOf(const std::vector<Verdict>& verdicts);
double nearestOf(const std::vector<double>& distances); ///< NaN: none
double nearestOf(const TrajectoryResult& found);

/// Returns warnings about surfaces among the two that are not asked as solids, unless the other thing is near.
/// @pre hierarchy() of both was called
/// @param nearest as nearestOf() has it
std::vector<Warning> warningsOfHollow(const Question& question, double nearest, Shape& input, Shape& obstacle);

/// Returns all warnings of a question that the caller has answered: those of warnings.h, and those of hollow surfaces.
std::vector<Warning> warningsOf(const Question& question, double nearest, Shape& input, Shape& obstacle);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
