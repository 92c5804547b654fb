// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/question_warnings.h>

#include <iterator>
#include <map>
#include <memory>
#include <mutex>

namespace pcl_bsh::python {
namespace {

Spacing keptSpacing(const SphereHierarchy& hierarchy)
{
  struct Kept {
    std::weak_ptr<const void> arrays;
    Spacing spacing;
  };
  static std::map<const void*, Kept> kept;
  static std::mutex one_at_a_time;
  const std::shared_ptr<const void>& arrays = hierarchy.view().owner;
  {
    const std::lock_guard lock(one_at_a_time);
    for (auto each = kept.begin(); each != kept.end();)
      each = each->second.arrays.expired() ? kept.erase(each) : std::next(each);
    const auto known = kept.find(arrays.get());
    if (known != kept.end()) return known->second.spacing;
  }
  const Spacing spacing = spacingOf(hierarchy);
  const std::lock_guard lock(one_at_a_time);
  if (arrays) kept[arrays.get()] = {arrays, spacing};
  return spacing;
}

} // namespace

NamedCloud factsOf(std::string name, const SphereHierarchy& hierarchy, bool measures)
{
  NamedCloud cloud = namedCloud(std::move(name), hierarchy);
  if (measures && !hierarchy.view().radii) cloud.spacing = keptSpacing(hierarchy);
  return cloud;
}

std::vector<Warning> warningsOf(const Asked& asked)
{
  QuestionFacts question{factsOf(asked.name_a, asked.a.hierarchy(), asked.measures),
                         factsOf(asked.name_b, asked.b, asked.measures), asked.poses_b, asked.clearance};
  for (Eigen::Isometry3d& pose : question.poses) pose = asked.a.pose.inverse() * pose;
  return pcl_bsh::warningsOf(question);
}

void warn(const std::string& text)
{
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

} // namespace pcl_bsh::python
