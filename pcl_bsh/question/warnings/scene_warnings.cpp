// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/scene_warnings.h>

#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/warnings/hollow.h>
#include <pcl_bsh/question/warnings/warnings.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <variant>

namespace pcl_bsh {
namespace {

using Box = Eigen::AlignedBox3d;
using Objects = std::vector<NamedObject>;
using Clouds = std::map<std::string, NamedCloud>;

constexpr int instants = 100; // at which an object's box is taken; the box about all of them counts
constexpr int looks = 16;     // instants at which what is inside of an object is looked for

/// The box about an object as it stands in its own frame.
Box boxOf(const NamedObject& object, const Clouds& clouds)
{
  Box box;
  for (const NamedObject::Part& part : object.parts) box.extend(boxAlong(clouds.at(part.cloud).box, {part.pose}));
  return box;
}

/// Where an object is at so many instants after the first, unless it does not move.
std::vector<Eigen::Isometry3d> posesOf(const NamedObject& object, double duration, int count)
{
  std::vector<Eigen::Isometry3d> poses = {poseAt(object.motion, object.pose, 0.0)};
  for (int i = 1; i <= count && !object.fixed && duration > 0; ++i)
    poses.push_back(poseAt(object.motion, object.pose, i * duration / count));
  return poses;
}

/// The box about an object and all of its motion, in the world.
Box boxOf(const NamedObject& object, const Clouds& clouds, double duration)
{
  return boxAlong(boxOf(object, clouds), posesOf(object, duration, instants));
}

/// Whether a point of the one cloud may meet a point of the other: the clouds are of two objects, not both fixed.
bool mayMeet(const Objects& objects, const std::string& a, const std::string& b)
{
  const auto has = [](const NamedObject& object, const std::string& cloud) {
    return std::any_of(object.parts.begin(), object.parts.end(), [&](const auto& part) { return part.cloud == cloud; });
  };
  for (const NamedObject& one : objects)
    for (const NamedObject& other : objects)
      if (&one != &other && !(one.fixed && other.fixed) && has(one, a) && has(other, b)) return true;
  return false;
}

/// Warns of the two clouds between whose points the widest holes are.
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

/// Warns of the two clouds whose sizes differ most.
void warnOfUnits(const Objects& objects, const Clouds& clouds, std::vector<std::string>& told)
{
  double most = 0.0;
  std::optional<Warning> found;
  for (auto a = clouds.begin(); a != clouds.end(); ++a) {
    for (auto b = std::next(a); b != clouds.end(); ++b) {
      auto warning = warningOfUnits(a->second, b->second);
      if (!warning || !mayMeet(objects, a->first, b->first)) continue;
      const double one = a->second.box.diagonal().norm(), other = b->second.box.diagonal().norm();
      if (const double times = std::max(one / other, other / one); times > most) {
        most = times;
        found = std::move(warning);
      }
    }
  }
  if (found) addOnce(found->text, told);
}

/// Warns of each object that moves and is nowhere near any other.
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

/// Warns of objects that may be hollow by mistake.
class Hollows {
public:
  Hollows(const Objects& objects, std::map<std::string, Shape>& shapes, const Clouds& clouds, double clearance,
          double duration)
  : objects_(objects),
    shapes_(shapes),
    clearance_(clearance)
  {
    for (const NamedObject& object : objects) {
      const std::vector<Eigen::Isometry3d> poses = posesOf(object, duration, looks - 1);
      const Box box = boxOf(object, clouds);
      std::vector<Box> boxes;
      for (const Eigen::Isometry3d& pose : poses) boxes.push_back(boxAlong(box, {pose}));
      poses_.push_back(poses);
      boxes_.push_back(std::move(boxes));
    }
  }

  /// One sentence for each object that closes round something.
  void tell(std::vector<std::string>& told)
  {
    for (std::size_t i = 0; i < objects_.size(); ++i)
      if (const auto warning = warningOf(i)) addOnce(warning->text, told);
  }

private:
  template <class T>
  static const T& at(const std::vector<T>& of_instants, std::size_t k)
  {
    return of_instants[std::min(k, of_instants.size() - 1)];
  }

  std::optional<Warning> warningOf(std::size_t i)
  {
    for (const NamedObject::Part& part : objects_[i].parts) {
      if (part.solid || !shapes_.at(part.cloud).isSurface()) continue;
      for (std::size_t j = 0; j < objects_.size(); ++j)
        if (j != i && !(objects_[i].fixed && objects_[j].fixed))
          if (auto warning = warningOf(i, part, j)) return warning;
    }
    return std::nullopt;
  }

  /// Returns the warning that a part of object i closes round places of object j.
  std::optional<Warning> warningOf(std::size_t i, const NamedObject::Part& part, std::size_t j)
  {
    std::vector<std::size_t> meeting; // instants
    for (std::size_t k = 0; k < std::max(poses_[i].size(), poses_[j].size()); ++k)
      if (at(boxes_[i], k).intersects(at(boxes_[j], k))) meeting.push_back(k);
    if (meeting.empty()) return std::nullopt;
    Shape& surface = shapes_.at(part.cloud);
    for (const NamedObject::Part& other : objects_[j].parts) {
      const SphereHierarchy& queried = shapes_.at(other.cloud).hierarchy();
      for (const std::size_t k : meeting) {
        const Eigen::Isometry3d of_surface = at(poses_[i], k) * part.pose, of_queried = at(poses_[j], k) * other.pose;
        const auto place = placeWithin(surface, queried, {of_surface.inverse() * of_queried});
        if (!place) continue;
        if (isNear(surface, of_surface, queried, of_queried)) return std::nullopt; // its effects tell of this
        return warningOfHollow("'" + objects_[i].name + "'", "solid", "'" + objects_[j].name + "'", *place);
      }
    }
    return std::nullopt;
  }

  bool isNear(const Shape& surface, const Eigen::Isometry3d& of_surface, const SphereHierarchy& queried,
              const Eigen::Isometry3d& of_queried) const
  {
    return closestPair({queried, of_queried}, {surface.hierarchy(), of_surface}).distance <=
           std::max(clearance_, nearTo(surface));
  }

  const Objects& objects_;
  std::map<std::string, Shape>& shapes_;
  const double clearance_;
  std::vector<std::vector<Eigen::Isometry3d>> poses_; ///< of each object, at each instant, or one where it rests
  std::vector<std::vector<Box>> boxes_;
};

} // namespace

std::vector<std::string> warningsOf(const Objects& objects, const Clouds& clouds, double clearance,
                                    std::optional<double> duration)
{
  std::vector<std::string> told;
  for (const auto& [name, cloud] : clouds) addTexts(warningsOf(cloud, clearance), told);
  warnOfDensity(objects, clouds, clearance, told);
  const std::size_t before = told.size();
  warnOfFrames(objects, clouds, clearance, duration, told);
  if (told.size() == before) warnOfUnits(objects, clouds, told); // a warning of frames names units, too
  return told;
}

std::vector<std::string> warningsOf(const Objects& objects, std::map<std::string, Shape>& shapes, double clearance,
                                    std::optional<double> duration)
{
  Clouds clouds;
  for (const auto& [name, shape] : shapes) clouds.emplace(name, shape.facts(true));
  std::vector<std::string> told = warningsOf(objects, clouds, clearance, duration);
  Hollows(objects, shapes, clouds, clearance, duration.value_or(0.0)).tell(told);
  return told;
}

std::optional<std::string> warningOfNoPairs(const Scene& scene)
{
  if (!scene.options().effects.ofPairs() || scene.size() == 0 || scene.testsPairs()) return std::nullopt;
  const std::string none = "no pair of objects is tested: ";
  if (scene.size() == 1) return none + "there is one object, and nothing that it could meet";
  for (ObjectId id = 0; id < scene.size(); ++id)
    if (!scene[id].fixed) return none + "rules leave out all of them: give a rule that tests two objects";
  return none +
         plainText("all ", scene.size(), " objects are fixed: do not fix what moves, or give a rule that tests them");
}

} // namespace pcl_bsh
