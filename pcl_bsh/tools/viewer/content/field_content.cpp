// SPDX-License-Identifier: BSD-3-Clause
#include "field_content.h"

#include <pcl_bsh/filters/collision_field.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::viewer {
namespace {

/// The verdict for a value of the field `collision`: any number that stands for no other verdict is a collision.
Verdict verdictOf(float value)
{
  for (const Verdict verdict : {Verdict::free, Verdict::undecided, Verdict::sparse, Verdict::unseen})
    if (value == static_cast<float>(verdict)) return verdict;
  return Verdict::colliding;
}

} // namespace

void countVerdicts(StepCollisions& found)
{
  found.colliding = countOf(found.flags[0], Verdict::colliding);
  found.undecided = countOf(found.flags[0], Verdict::undecided);
  found.sparse = countOf(found.flags[0], Verdict::sparse);
  found.unseen = countOf(found.flags[0], Verdict::unseen);
}

StepCollisions FieldContent::collisions(std::size_t /*step*/) const
{
  StepCollisions found;
  found.flags.resize(viewed_clouds_.size());
  const auto field = scan().result(collision_field_name);
  if (!field) return found;
  found.known = true;
  for (const float value : *field) found.flags[0].push_back(verdictOf(value));
  countVerdicts(found);
  return found;
}

std::vector<float> FieldContent::distances(std::size_t /*step*/) const
{
  if (auto field = scan().result(distance_field_name)) return *field;
  return std::vector<float>(scan().parts(), std::numeric_limits<float>::quiet_NaN());
}

std::vector<double> FieldContent::allDistances(std::size_t /*step*/) const
{
  const auto field = scan().result(distance_field_name);
  if (!field) return {};
  const auto collides = scan().result(collision_field_name);
  const bool all = sharedColors() ? sharedColors()->all_distances : !collides;
  if (all) return {field->begin(), field->end()};
  for (std::size_t i = 0; i < field->size(); ++i) {
    const bool free = !sharedColors() && (*collides)[i] == 0.0f;
    if (free && std::isfinite((*field)[i])) return {field->begin(), field->end()};
  }
  return {};
}

std::vector<std::int32_t> FieldContent::firstPoses() const
{
  std::vector<std::int32_t> first(scan().parts(), -1);
  const auto field = scan().result(first_pose_field_name);
  for (std::size_t i = 0; field && i < first.size(); ++i)
    first[i] = std::isfinite((*field)[i]) ? static_cast<std::int32_t>((*field)[i]) : -1;
  return first;
}

} // namespace pcl_bsh::viewer
