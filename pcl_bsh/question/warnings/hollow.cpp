// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/hollow.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/triangle/winding.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/solid/bodies.h>
#include <pcl_bsh/solid/labels.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr std::size_t most_poses = 16;
constexpr std::size_t most_records = 256; // of a pose
constexpr std::size_t most_samples = 8;   // of all poses that are looked at, or one of each
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns up to `most` indices, spread evenly over a list of `count` entries.
std::vector<std::size_t> spread(std::size_t count, std::size_t most)
{
  std::vector<std::size_t> places;
  const std::size_t wanted = std::min(count, most);
  for (std::size_t i = 0; i < wanted; ++i) places.push_back(i * count / wanted);
  return places;
}

/// Returns records of the queried thing that are in the surface's box, out of some `most_records` that are looked at.
std::vector<std::uint32_t> recordsIn(const Eigen::AlignedBox3d& box, const SphereHierarchy& queried,
                                     const Eigen::Isometry3d& T_surface_queried)
{
  const SphereHierarchy::Storage& storage = queried.storage();
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t v = 0; v < storage.voxel_count; ++v) {
    const LocalFrame& frame = storage.voxels[v].frame;
    const Eigen::Vector3d middle = Eigen::Map<const Eigen::Vector3d>(frame.origin.data());
    const Eigen::Vector3d reach = frame.unit * Eigen::Map<const Eigen::Vector3d>(frame.reach.data());
    const Eigen::Vector3d turned = T_surface_queried.linear().cwiseAbs() * reach;
    const Eigen::Vector3d at = T_surface_queried * middle;
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
      if (place++ % step != 0) return;
      const Point3 p = storage.view.point(record);
      if (box.contains(T_surface_queried * Eigen::Vector3d(p[0], p[1], p[2]))) records.push_back(record);
    });
  }
  return records;
}

/// A place of the queried thing.
struct Sample {
  Point3 given, at; ///< at: in the surface's frame, rounded: a place deep inside stays inside
  int turns = 0;    ///< of the surface round it
  bool touches = false;
};

/// Adds up how often the triangles wind round each sample. Boxes sort out nearly all triangles before the exact test.
void windRound(std::vector<Sample>& samples, const TrianglesView& triangles)
{
  const Winding winding(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(), 0);
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    const Triangle3 t = triangles.triangle(i);
    const auto [low_y, high_y] = std::minmax({t[0][1], t[1][1], t[2][1]});
    const auto [low_z, high_z] = std::minmax({t[0][2], t[1][2], t[2][2]});
    const double high_x = std::max({t[0][0], t[1][0], t[2][0]});
    for (Sample& sample : samples) {
      const Point3& p = sample.at;
      if (!(p[1] >= low_y && p[1] <= high_y && p[2] >= low_z && p[2] <= high_z && p[0] <= high_x)) continue;
      if (!isFinite(t)) continue;
      const Winding::Crossing met = winding.crossing(p, t);
      sample.turns += met.turns;
      sample.touches |= met.on_surface;
    }
  }
}

/// Returns the first sample that is inside a surface that closes.
std::optional<Point3> enclosed(std::vector<Sample>& samples, Shape& surface, std::optional<bool> closes)
{
  if (!closes) windRound(samples, *surface.hierarchy().view().triangles);
  const auto is_inside = [&](const Sample& sample) {
    return closes ? labelPlace(surface.solid().whole(), sample.at) == Label::inside
                  : sample.turns != 0 && !sample.touches;
  };
  const auto inside = std::find_if(samples.begin(), samples.end(), is_inside);
  if (inside == samples.end() || !surface.isClosed()) return std::nullopt;
  return inside->given;
}

} // namespace

std::optional<Point3> placeWithin(Shape& surface, const SphereHierarchy& queried,
                                  const std::vector<Eigen::Isometry3d>& T_surface_queried)
{
  const Eigen::AlignedBox3d box = surface.facts(false).box;
  if (box.isEmpty() || queried.empty()) return std::nullopt;
  const DefaultFloatEnvironment environment;
  std::vector<Sample> samples;
  const std::vector<std::size_t> poses = spread(T_surface_queried.size(), most_poses);
  for (const std::size_t k : poses) {
    const Eigen::Isometry3d& pose = T_surface_queried[k];
    const std::vector<std::uint32_t> records = recordsIn(box, queried, pose);
    for (const std::size_t i : spread(records.size(), std::max<std::size_t>(1, most_samples / poses.size()))) {
      const Point3 p = queried.view().point(records[i]);
      const Eigen::Vector3d q = pose * Eigen::Vector3d(p[0], p[1], p[2]);
      samples.push_back({p, {q[0], q[1], q[2]}});
    }
  }
  if (samples.empty()) return std::nullopt;
  const std::optional<bool> closes = surface.isKnownToClose();
  if (!closes.value_or(true)) return std::nullopt;
  return enclosed(samples, surface, closes);
}

double nearTo(const Shape& surface)
{
  const Eigen::AlignedBox3d box = surface.facts(false).box;
  return box.isEmpty() ? 0.0 : 0.01 * box.diagonal().norm();
}

Warning warningOfHollow(const std::string& surface, const char* option, const std::string& queried, const Point3& place)
{
  return {WarningKind::hollow, plainText(surface, ": its faces close round places of ", queried, ", as (", place[0],
                                         ", ", place[1], ", ", place[2], "), with none near them: without `", option,
                                         "` what a mesh encloses is free: give it if this is not hollow")};
}

double nearestOf(const std::vector<Verdict>& verdicts)
{
  const auto is_near = [](Verdict verdict) { return verdict == Verdict::colliding || verdict == Verdict::undecided; };
  return std::any_of(verdicts.begin(), verdicts.end(), is_near) ? 0.0 : infinity;
}

double nearestOf(const std::vector<double>& distances)
{
  double nearest = infinity;
  for (const double distance : distances) nearest = std::fmin(nearest, distance);
  return nearest;
}

double nearestOf(const TrajectoryResult& found)
{
  const auto taken = [](std::int32_t pose) { return pose >= 0; };
  const bool any = found.colliding + found.undecided > 0 || found.first_contact ||
                   std::any_of(found.first_pose.begin(), found.first_pose.end(), taken);
  return any ? 0.0 : infinity;
}

double nearestOf(const Question& question, const Answer& answer)
{
  const Wanted& wanted = question.wanted;
  if (wanted.any && answer.any.verdict != Verdict::free) return 0.0;
  const CollidingIndices& lists = answer.indices;
  for (const auto* const list : {&lists.a, &lists.b, &lists.undecided_a, &lists.undecided_b})
    if (!list->empty()) return 0.0;
  if (wanted.collisions()) return std::min(nearestOf(answer.obstacle_flags), nearestOf(answer.collisions));
  if (question.path) {
    const std::vector<float>& distances = answer.collisions.distance;
    return nearestOf(std::vector<double>(distances.begin(), distances.end()));
  }
  if (wanted.closest) return answer.closest.distance;
  return answer.distances.a.distance.empty() ? 0.0 : nearestOf(answer.distances.a.distance);
}

std::vector<Warning> warningsOfHollow(const Question& question, double nearest, Shape& input, Shape& obstacle)
{
  std::vector<Warning> warnings;
  const auto look = [&](Shape& surface, bool solid, const char* option, const Shape& queried, bool is_obstacle) {
    if (!surface.isSurface() || solid || !(nearest > 0.0)) return;
    if (nearest <= nearTo(surface)) return;
    std::vector<Eigen::Isometry3d> poses = question.poses();
    for (Eigen::Isometry3d& pose : poses) {
      pose = pose.inverse() * question.pose_of_input;
      if (!is_obstacle) pose = pose.inverse();
    }
    if (const auto place = placeWithin(surface, queried.hierarchy(), poses))
      warnings.push_back(warningOfHollow(surface.name(), option, queried.name(), *place));
  };
  look(obstacle, question.solid, "solid", input, true);
  if (!question.wanted.oneWay()) // one-way distances do not depend on `input_solid`
    look(input, question.input_solid, "input_solid", obstacle, false);
  return warnings;
}

std::vector<Warning> warningsOf(const Question& question, double nearest, Shape& input, Shape& obstacle)
{
  const bool spacings = question.wanted.spacings;
  std::vector<Warning> warnings = warningsOf(question, input.facts(spacings), obstacle.facts(spacings));
  for (Warning& hollow : warningsOfHollow(question, nearest, input, obstacle)) warnings.push_back(std::move(hollow));
  return warnings;
}

} // namespace pcl_bsh
