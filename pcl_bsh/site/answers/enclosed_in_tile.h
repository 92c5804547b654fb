// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/question/enclosed.h>
#include <pcl_bsh/site/answers/question_part.h>

#include <memory>

namespace pcl_bsh::site {

/// Adds those of some points of the input that the obstacle holds, where it is asked as a solid.
/// @param points where they stand. @param found of the surface
template <typename Found>
void addEnclosedOf(const QuestionPart& part, const Placed& points, Found& found)
{
  if (!part.question.solid) return;
  Shape tile("a tile", std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &points.hierarchy()));
  Question question = part.question;
  question.uncertainty = {}; // those of the points are built in
  question.input_pose_uncertainty = {};
  addEnclosed(question, tile, *part.shape, found);
}

} // namespace pcl_bsh::site
