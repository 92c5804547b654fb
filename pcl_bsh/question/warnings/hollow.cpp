// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/hollow.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/triangle/winding.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr std::size_t most_poses = 16;
constexpr std::size_t most_records = 256; // of a pose
constexpr std::size_t most_samples = 8;   // of all poses that are looked at, or one of each
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

/// A place of the input.
struct Sample {
  Point3 given, in_obstacle;
  int turns = 0; ///< of the surface round it
  bool touches = false;
};

/// How often the triangles wind round each sample: all are looked at once, few of them closely.
void windRound(std::vector<Sample>& samples, const TrianglesView& triangles)
{
  const Winding winding(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(), 0);
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    const Triangle3 t = triangles.triangle(i);
    const auto [low_y, high_y] = std::minmax({t[0][1], t[1][1], t[2][1]});
    const auto [low_z, high_z] = std::minmax({t[0][2], t[1][2], t[2][2]});
    const double high_x = std::max({t[0][0], t[1][0], t[2][0]});
    for (Sample& sample : samples) {
      const Point3& p = sample.in_obstacle;
      if (!(p[1] >= low_y && p[1] <= high_y && p[2] >= low_z && p[2] <= high_z && p[0] <= high_x)) continue;
      if (!isFinite(t)) continue;
      const Winding::Crossing met = winding.crossing(p, t);
      sample.turns += met.turns;
      sample.touches |= met.on_surface;
    }
  }
}

} // namespace

std::optional<Warning> warningOfHollow(const Question& question, const Answer& answer, const Shape& input,
                                       const Placed& placed_input, Shape& obstacle, const SphereHierarchy& surface,
                                       const Eigen::AlignedBox3d& box)
{
  if (!obstacle.isSurface() || question.solid || box.isEmpty() || placed_input.hierarchy().empty()) return std::nullopt;
  if (isNear(question, answer, near_share * box.diagonal().norm())) return std::nullopt;
  const DefaultFloatEnvironment environment;
  const SphereHierarchy& scan = placed_input.hierarchy();
  const std::vector<Eigen::Isometry3d> all_poses = question.poses();
  const std::vector<std::size_t> poses = spread(all_poses.size(), most_poses);
  std::vector<Sample> samples; // whose places in the obstacle are rounded: what is deep inside stays so
  for (const std::size_t k : poses) {
    const Eigen::Isometry3d T_obstacle_input = all_poses[k].inverse() * placed_input.pose;
    const std::vector<std::uint32_t> records = recordsIn(box, scan, T_obstacle_input);
    for (const std::size_t i : spread(records.size(), std::max<std::size_t>(1, most_samples / poses.size()))) {
      const Point3 p = scan.view().point(records[i]);
      const Eigen::Vector3d q = T_obstacle_input * Eigen::Vector3d(p[0], p[1], p[2]);
      samples.push_back({p, {q[0], q[1], q[2]}});
    }
  }
  if (samples.empty() || !obstacle.mayClose()) return std::nullopt;
  windRound(samples, *surface.view().triangles);
  const auto held = std::find_if(samples.begin(), samples.end(),
                                 [](const Sample& sample) { return sample.turns != 0 && !sample.touches; });
  if (held == samples.end() || !obstacle.isClosed()) return std::nullopt;
  const Point3& p = held->given;
  return Warning{WarningKind::hollow,
                 plainText(obstacle.name(), ": its faces close round places of ", input.name(), ", as (", p[0], ", ",
                           p[1], ", ", p[2],
                           "), with none near them: without `solid` what a mesh encloses is free: give it if this is "
                           "not hollow")};
}

} // namespace pcl_bsh
