// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/scene_warnings.h>

#include <pcl_bsh/question/warnings/warnings.h>

#include <algorithm>
#include <cstddef>
#include <variant>

namespace pcl_bsh {
namespace {

using Box = Eigen::AlignedBox3d;
using Objects = std::vector<NamedObject>;
using Clouds = std::map<std::string, NamedCloud>;

constexpr int instants = 100; // at which an object's box is taken: a box about all of them is meant

/// The box about an object and all of its motion, in the world.
Box boxOf(const NamedObject& object, const Clouds& clouds, double duration)
{
  Box box;
  for (const auto& [cloud, pose] : object.parts) box.extend(boxAlong(clouds.at(cloud).box, {pose}));
  std::vector<Eigen::Isometry3d> poses = {poseAt(object.motion, object.pose, 0.0)};
  for (int i = 1; i <= instants && !object.fixed && duration > 0; ++i)
    poses.push_back(poseAt(object.motion, object.pose, i * duration / instants));
  return boxAlong(box, poses);
}

/// Whether a point of the one cloud may meet a point of the other: those of two objects, not both of which are fixed.
bool mayMeet(const Objects& objects, const std::string& a, const std::string& b)
{
  const auto has = [](const NamedObject& object, const std::string& cloud) {
    return std::any_of(object.parts.begin(), object.parts.end(), [&](const auto& part) { return part.first == cloud; });
  };
  for (const NamedObject& one : objects)
    for (const NamedObject& other : objects)
      if (&one != &other && !(one.fixed && other.fixed) && has(one, a) && has(other, b)) return true;
  return false;
}

/// Of the two clouds between whose points the widest holes are.
void warnOfDensity(const Objects& objects, const Clouds& clouds, double clearance, std::vector<std::string>& told)
{
  double widest = 0.0;
  std::optional<Warning> found;
  for (auto a = clouds.begin(); a != clouds.end(); ++a) {
    for (auto b = a; b != clouds.end(); ++b) {
      const double blind = Density{a->second.spacing, b->second.spacing}.blind();
      if (blind <= widest) continue;
      auto warning = warningOfDensity(a->second, b->second, clearance);
      if (!warning || !mayMeet(objects, a->first, b->first)) continue;
      widest = blind;
      found = std::move(warning);
    }
  }
  if (found) addOnce(found->text, told);
}

/// Of each object that moves, and is nowhere near any of the others.
void warnOfFrames(const Objects& objects, const Clouds& clouds, double clearance, std::optional<double> duration,
                  std::vector<std::string>& told)
{
  const auto is_anywhere = [&](const NamedObject& object) {
    return !duration && !object.fixed && !std::holds_alternative<NoMotion>(object.motion);
  };
  if (std::any_of(objects.begin(), objects.end(), is_anywhere)) return;
  std::vector<Box> boxes;
  for (const NamedObject& object : objects) boxes.push_back(boxOf(object, clouds, duration.value_or(0.0)));
  std::vector<Box> behind(objects.size() + 1); // about all objects from this one on
  for (std::size_t i = objects.size(); i-- > 0;) behind[i] = Box(behind[i + 1]).extend(boxes[i]);
  Box before;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Box others = Box(before).extend(behind[i + 1]);
    before.extend(boxes[i]);
    if (objects[i].fixed) continue;
    const std::string name = objects.size() == 2 ? "'" + objects[1 - i].name + "'" : "the other objects";
    const auto warning = warningOfFrames(name, others, "'" + objects[i].name + "'", boxes[i], clearance);
    if (!warning) continue;
    addOnce(warning->text, told);
    if (objects.size() == 2) return; // the other one is as far from it
  }
}

} // namespace

std::vector<std::string> warningsOf(const Objects& objects, const Clouds& clouds, double clearance,
                                    std::optional<double> duration)
{
  std::vector<std::string> told;
  for (const auto& [name, cloud] : clouds) addTexts(warningsOf(cloud, clearance), told);
  warnOfDensity(objects, clouds, clearance, told);
  warnOfFrames(objects, clouds, clearance, duration, told);
  return told;
}

} // namespace pcl_bsh
