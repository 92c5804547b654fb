// SPDX-License-Identifier: BSD-3-Clause
// The warning that faces of one of two things close round places of the other, which count as free. A hint, by samples:
// places that are few among others may be overlooked.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/ask.h>

#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A place of some points or triangles that the faces of a surface wind round, where these close. At up to 16 of the
/// poses, of voxels that meet the surface's box, some 256 records are looked at, 511 at most, and 8 are samples, or one
/// of each pose. The first question about a surface passes all of its triangles, which takes some 160 instructions
/// each; the second finds out whether they close. Where they are known not to, nothing is looked at.
/// @param T_surface_content where the content is, of one pose or more @return in the content's own frame
/// @pre hierarchy() of the surface was called, and isSurface()
std::optional<Point3> placeWithin(Shape& surface, const SphereHierarchy& content,
                                  const std::vector<Eigen::Isometry3d>& T_surface_content);

/// What is so near to a surface that its user surely looks at it: a hundredth of its size. @pre likewise
double nearTo(const Shape& surface);

/// The sentence about such a place. @param option by which the surface counts with what it encloses
Warning warningOfHollow(const std::string& surface, const char* option, const std::string& content,
                        const Point3& place);

/// How near an answer says that the one thing is to the other's surface: a distance, 0 where anything collides or the
/// answer does not tell, infinite where nothing does.
double nearestOf(const Question& question, const Answer& answer);

/// The same of queries that no question has: of verdicts, of distances, and along a path.
double nearestOf(const std::vector<Verdict>& verdicts);
double nearestOf(const std::vector<double>& distances); ///< NaN: none
double nearestOf(const TrajectoryResult& found);

/// Of either thing that is a surface, and no solid, unless something is near it. @pre hierarchy() of both was called
/// @param nearest as nearestOf() has it
std::vector<Warning> warningsOfHollow(const Question& question, double nearest, Shape& input, Shape& obstacle);

/// Of a question whose answer its asker has: as of two clouds (warnings.h), and of what is hollow.
std::vector<Warning> warningsOf(const Question& question, double nearest, Shape& input, Shape& obstacle);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
