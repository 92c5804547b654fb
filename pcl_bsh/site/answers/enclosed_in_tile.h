// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/question/enclosed.h>
#include <pcl_bsh/site/answers/question_part.h>

#include <memory>

namespace pcl_bsh::site {

/// A tile as a thing of questions. Its copies share what solids need of it.
inline Shape shapeOf(const SphereHierarchy& tile)
{
  return {"a tile", std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &tile)};
}

/// Adds those of a tile's points that the obstacle holds, where it is asked as a solid. @param found of the surface
template <typename Found>
void addEnclosedOf(const QuestionPart& part, Shape tile, Found& found)
{
  if (!part.question.solid) return;
  Question question = part.question;
  question.uncertainty = {}; // those of the points are built in
  question.input_pose_uncertainty = {};
  addEnclosed(question, tile, *part.shape, found);
}

/// @param points where they stand
template <typename Found>
void addEnclosedOf(const QuestionPart& part, const Placed& points, Found& found)
{
  if (part.question.solid) addEnclosedOf(part, shapeOf(points.hierarchy()), found);
}

} // namespace pcl_bsh::site
