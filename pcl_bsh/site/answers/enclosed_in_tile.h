// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/question/enclosed.h>
#include <pcl_bsh/site/answers/question_part.h>

#include <memory>

namespace pcl_bsh::site {

/// A tile as a Shape, which borrows its hierarchy. Copies of the Shape share what solids need of the tile.
inline Shape shapeOf(const SphereHierarchy& tile)
{
  return {"a tile", std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &tile)};
}

/// Adds the points of a tile that the obstacle holds, where it is asked as a solid.
/// @param found the answer about the obstacle's surface
template <typename Found>
void addEnclosedOf(const QuestionPart& part, Shape tile, Found& found)
{
  if (!part.question.solid) return;
  Question question = part.question;
  question.uncertainty = {}; // the hierarchy of the points has theirs
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
