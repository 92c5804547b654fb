// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/scenes/scene_warnings.h>

#include <pcl_bsh/question/warnings.h>

#include <algorithm>
#include <cstddef>
#include <optional>

namespace pcl_bsh::io {
namespace {

using Box = Eigen::AlignedBox3d;
using Clouds = std::map<std::string, NamedCloud>;

constexpr std::size_t most_instants = 100; // at which an object's box is taken: a box about all of them is meant

/// The box about an object and all of its motion, in the world.
Box boxOf(const ObjectEntry& object, const SceneFile& file, const Clouds& clouds)
{
  Box box;
  for (const PartEntry& part : object.parts) box.extend(boxAlong(clouds.at(part.cloud).box, {part.pose}));
  const double duration = static_cast<double>(file.steps) * file.dt;
  const std::size_t instants = object.fixed ? 0 : std::min(file.steps, most_instants);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i <= instants; ++i) {
    const double share = instants == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(instants);
    poses.push_back(poseAt(object.motion, object.pose, share * duration));
  }
  return boxAlong(box, poses);
}

/// Whether a point of the one cloud may meet a point of the other: those of two objects, not both of which are fixed.
bool mayMeet(const SceneFile& file, const std::string& a, const std::string& b)
{
  const auto has = [](const ObjectEntry& object, const std::string& cloud) {
    return std::any_of(object.parts.begin(), object.parts.end(), [&](const auto& part) { return part.cloud == cloud; });
  };
  for (const ObjectEntry& one : file.objects)
    for (const ObjectEntry& other : file.objects)
      if (&one != &other && !(one.fixed && other.fixed) && has(one, a) && has(other, b)) return true;
  return false;
}

/// Of the two clouds between whose points the widest holes are.
void warnOfDensity(const SceneFile& file, const Clouds& clouds, std::vector<std::string>& told)
{
  double widest = 0.0;
  std::optional<Warning> found;
  for (auto a = clouds.begin(); a != clouds.end(); ++a) {
    for (auto b = a; b != clouds.end(); ++b) {
      const double blind = Density{a->second.spacing, b->second.spacing}.blind();
      if (blind <= widest) continue;
      auto warning = warningOfDensity(a->second, b->second, file.options.clearance);
      if (!warning || !mayMeet(file, a->first, b->first)) continue;
      widest = blind;
      found = std::move(warning);
    }
  }
  if (found) addOnce(found->text, told);
}

/// Of each object that moves, and is nowhere near any of the others.
void warnOfFrames(const SceneFile& file, const Clouds& clouds, std::vector<std::string>& told)
{
  const std::vector<ObjectEntry>& objects = file.objects;
  std::vector<Box> boxes;
  for (const ObjectEntry& object : objects) boxes.push_back(boxOf(object, file, clouds));
  std::vector<Box> behind(objects.size() + 1); // about all objects from this one on
  for (std::size_t i = objects.size(); i-- > 0;) behind[i] = Box(behind[i + 1]).extend(boxes[i]);
  Box before;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Box others = Box(before).extend(behind[i + 1]);
    before.extend(boxes[i]);
    if (objects[i].fixed) continue;
    const std::string name = objects.size() == 2 ? "'" + objects[1 - i].name + "'" : "the other objects";
    const auto warning = warningOfFrames(name, others, "'" + objects[i].name + "'", boxes[i], file.options.clearance);
    if (!warning) continue;
    addOnce(warning->text, told);
    if (objects.size() == 2) return; // the other one is as far from it
  }
}

} // namespace

std::vector<std::string> warningsOf(const SceneFile& file, const std::map<std::string, NamedCloud>& clouds)
{
  std::vector<std::string> told;
  for (const auto& [name, cloud] : clouds) addTexts(pcl_bsh::warningsOf(cloud, file.options.clearance), told);
  warnOfDensity(file, clouds, told);
  warnOfFrames(file, clouds, told);
  return told;
}

} // namespace pcl_bsh::io
