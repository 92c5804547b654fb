// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/hollow.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/solid/bodies.h>
#include <pcl_bsh/solid/point_labels.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr std::size_t most_poses = 16;
constexpr std::size_t most_records = 256; // of a pose
constexpr std::size_t most_labels = 16;   // likewise
constexpr double near_share = 0.01;       // of the box's diagonal, where no clearance says what is near

/// Spread over a list: `most` of its places at most.
std::vector<std::size_t> spread(std::size_t count, std::size_t most)
{
  std::vector<std::size_t> places;
  const std::size_t wanted = std::min(count, most);
  for (std::size_t i = 0; i < wanted; ++i) places.push_back(i * count / wanted);
  return places;
}

/// Whether the answer tells of something near the obstacle's surface, or does not say.
bool isNear(const Question& question, const Answer& answer, double near)
{
  const Wanted& wanted = question.wanted;
  const TrajectoryResult& found = answer.collisions;
  if (wanted.any && answer.any.verdict != Verdict::free) return true;
  if (!answer.indices.a.empty() || !answer.indices.b.empty()) return true;
  if (std::any_of(answer.obstacle_flags.begin(), answer.obstacle_flags.end(),
                  [](Verdict verdict) { return verdict == Verdict::colliding || verdict == Verdict::undecided; }))
    return true;
  if (wanted.collisions()) {
    const auto taken = [](std::int32_t pose) { return pose >= 0; };
    return found.colliding + found.undecided > 0 ||
           std::any_of(found.first_pose.begin(), found.first_pose.end(), taken);
  }
  const auto within = [near](double distance) { return distance <= near; };
  if (question.path) return std::any_of(found.distance.begin(), found.distance.end(), within);
  if (wanted.closest) return within(answer.closest.distance);
  const std::vector<double>& distances = answer.distances.a.distance;
  return distances.empty() || std::any_of(distances.begin(), distances.end(), within);
}

/// Records of the input that are in the obstacle's box, at most so many.
std::vector<std::uint32_t> recordsIn(const Eigen::AlignedBox3d& box, const SphereHierarchy& input,
                                     const Eigen::Isometry3d& T_obstacle_input)
{
  const SphereHierarchy::Storage& storage = input.storage();
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t v = 0; v < storage.voxel_count; ++v) {
    const LocalFrame& frame = storage.voxels[v].frame;
    const Eigen::Vector3d middle = Eigen::Map<const Eigen::Vector3d>(frame.origin.data());
    const Eigen::Vector3d reach = frame.unit * Eigen::Map<const Eigen::Vector3d>(frame.reach.data());
    const Eigen::Vector3d turned = T_obstacle_input.linear().cwiseAbs() * reach;
    const Eigen::Vector3d at = T_obstacle_input * middle;
    if (box.intersects(Eigen::AlignedBox3d(at - turned, at + turned))) voxels.push_back(v);
  }
  std::vector<std::uint32_t> records;
  const std::vector<std::size_t> some = spread(voxels.size(), most_records);
  for (const std::size_t i : some) {
    const std::uint32_t v = voxels[i];
    const std::size_t count = storage.voxels[v].count,
                      step = std::max<std::size_t>(1, count * some.size() / most_records);
    std::size_t place = 0;
    storage.forEachRecord(v, [&](std::uint32_t record) {
      if (place++ % step != 0 || records.size() >= 2 * most_records) return;
      const Point3 p = storage.view.point(record);
      if (box.contains(T_obstacle_input * Eigen::Vector3d(p[0], p[1], p[2]))) records.push_back(record);
    });
  }
  return records;
}

} // namespace

std::optional<Warning> warningOfHollow(const Question& question, const Answer& answer, const Shape& input,
                                       const Placed& placed_input, Shape& obstacle, const Eigen::AlignedBox3d& box)
{
  if (!obstacle.isSurface() || question.solid || box.isEmpty() || placed_input.hierarchy().empty()) return std::nullopt;
  if (isNear(question, answer, near_share * box.diagonal().norm())) return std::nullopt;
  const DefaultFloatEnvironment environment;
  const std::vector<Eigen::Isometry3d> poses = question.poses();
  for (const std::size_t k : spread(poses.size(), most_poses)) {
    const std::vector<std::uint32_t> records =
        recordsIn(box, placed_input.hierarchy(), poses[k].inverse() * placed_input.pose);
    if (records.empty()) continue;
    const SolidBodies* const solid = obstacle.solidIfClosed();
    if (!solid) return std::nullopt;
    PointLabels labels(placed_input.pose, {solid->whole(), poses[k]});
    std::uint64_t exact_decisions = 0;
    for (const std::size_t i : spread(records.size(), most_labels)) {
      const Point3 p = placed_input.hierarchy().view().point(records[i]);
      if (labels.label(labels.frameAt(p, 0.0), p, exact_decisions) != Label::inside) continue;
      return Warning{WarningKind::hollow,
                     plainText(obstacle.name(), ": its faces close round places of ", input.name(), ", as (", p[0],
                               ", ", p[1], ", ", p[2],
                               "), with none near them: without `solid` what a mesh encloses is free: give it if this "
                               "is not hollow")};
    }
  }
  return std::nullopt;
}

} // namespace pcl_bsh
