// SPDX-License-Identifier: BSD-3-Clause
// How much of a surface lies within a solid.
//
//   const Interval area = areaWithin(question, crate, press); // of the crate's triangles, inside the press
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/question/question.h>
#include <pcl_bsh/question/shape.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The area of all places of triangles that a solid encloses: places that its surface winds round another number of
/// times than 0. Each triangle counts by itself. Returns an interval that certainly holds the area, for the poses as
/// they are given. Triangles are halved until the open part is at most 2^-8 of the upper end, 40 times at most, and
/// into 2^18 open parts at most. A triangle that lies in the solid's surface stays open as a whole.
/// @param question its poses and `threads` count. @param surface of triangles
/// @throws InvalidInput as ask() does of such a solid
Interval areaWithin(const Question& question, Shape& surface, Shape& solid);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
