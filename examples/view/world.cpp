// SPDX-License-Identifier: BSD-3-Clause
#include "world.h"

#include "cli/program.h"
#include "cli/step.h"

#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/io/cloud_file.h>
#include <pcl_bsh/filters/io/field_type.h>
#include <pcl_bsh/filters/io/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pcl_bsh::view {
namespace {

const pcl::PCLPointField* find(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == name && field.count <= 1) return &field;
  return nullptr;
}

/// One value of each record.
template <class T, class Use>
void eachValue(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field, const Use& use)
{
  const std::size_t count = std::size_t{cloud.width} * cloud.height;
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, cloud.data.data() + i * cloud.point_step + field.offset, sizeof value);
    use(i, value);
  }
}

Thing load(const std::filesystem::path& file, unsigned threads)
{
  Thing thing;
  thing.file = file;
  cli::Step step("Loading " + file.string());
  thing.cloud = io::readCloud(file);
  HierarchyOptions how;
  how.threads = threads;
  thing.hierarchy = std::make_unique<SphereHierarchy>(viewOf(thing.cloud), how);
  step.done(std::to_string(thing.points().count) + " points");
  return thing;
}

} // namespace

std::optional<std::vector<float>> Thing::field(const std::string& name) const
{
  const pcl::PCLPointField* const found = find(cloud, name);
  if (!found) return std::nullopt;
  std::vector<float> values(std::size_t{cloud.width} * cloud.height);
  io::withFieldType(found->datatype, [&](auto zero) {
    eachValue<decltype(zero)>(cloud, *found, [&](std::size_t i, auto value) { values[i] = static_cast<float>(value); });
  });
  return values;
}

std::optional<std::vector<std::array<unsigned char, 3>>> Thing::colors() const
{
  std::vector<std::array<unsigned char, 3>> colors(std::size_t{cloud.width} * cloud.height);
  for (const char* packed : {"rgb", "rgba"}) {
    const pcl::PCLPointField* const found = find(cloud, packed);
    if (!found || io::sizeOf(found->datatype) != 4) continue;
    eachValue<std::uint32_t>(cloud, *found, [&](std::size_t i, std::uint32_t bits) {
      colors[i] = {static_cast<unsigned char>(bits >> 16), static_cast<unsigned char>(bits >> 8),
                   static_cast<unsigned char>(bits)};
    });
    return colors;
  }
  constexpr const char* names[2][3] = {{"red", "green", "blue"}, {"r", "g", "b"}};
  for (const auto& set : names) {
    const pcl::PCLPointField* const channels[3] = {find(cloud, set[0]), find(cloud, set[1]), find(cloud, set[2])};
    if (!channels[0] || !channels[1] || !channels[2]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      // 16 bits a channel where the type says so; fractions of one where it is a real number.
      const std::uint8_t type = channels[k]->datatype;
      const float scale = type == pcl::PCLPointField::UINT16                                           ? 1.0f / 257.0f
                          : type == pcl::PCLPointField::FLOAT32 || type == pcl::PCLPointField::FLOAT64 ? 255.0f
                                                                                                       : 1.0f;
      const std::vector<float> values = *field(set[k]);
      for (std::size_t i = 0; i < values.size(); ++i)
        colors[i][k] = static_cast<unsigned char>(std::clamp(values[i] * scale, 0.0f, 255.0f));
    }
    return colors;
  }
  return std::nullopt;
}

World::World(const Options& options) : options_(options), poses_{options.pose}
{
  if (options.trajectory) poses_ = io::readPoses(*options.trajectory);
  if (options.step >= poses_.size())
    throw cli::UsageError("--step: " + std::to_string(options.step) + ": the trajectory has " +
                          std::to_string(poses_.size()) + " poses, counted from 0");
  for (const std::filesystem::path& file : options.clouds) things_.push_back(load(file, options.threads));
  if (options.model) {
    model_ = things_.size();
    things_.push_back(load(*options.model, options.threads));
  }
  if (scan().hierarchy->empty()) throw std::invalid_argument(scan().file.string() + ": has no finite point to show");
}

Eigen::Isometry3d World::poseOf(std::size_t thing, std::size_t step) const
{
  return thing == model_ ? poses_[step] : Eigen::Isometry3d::Identity();
}

CollisionRequest World::request() const
{
  CollisionRequest request;
  request.clearance = options_.clearance.value_or(0.0);
  request.threads = options_.threads;
  request.flagged = Side::both;
  return request;
}

TrajectoryRequest World::along() const
{
  TrajectoryRequest request;
  request.clearance = options_.clearance.value_or(0.0);
  request.threads = options_.threads;
  request.flags = false;
  return request;
}

Findings World::findings(std::size_t step) const
{
  Findings found;
  if (options_.clearance) {
    found.known = true;
    found.scan.assign(scan().points().count, 0);
    found.other.resize(things_.size() - 1);
    for (std::size_t other = 1; other < things_.size(); ++other) {
      FlagsResult flags = collisionFlags(placed(0, step), placed(other, step), request());
      for (std::size_t i = 0; i < flags.a.size(); ++i) found.scan[i] |= flags.a[i];
      found.other[other - 1] = std::move(flags.b);
    }
  }
  else if (const auto field = scan().field(collision_field_name)) {
    found.known = true;
    for (const float value : *field) found.scan.push_back(value != 0.0f);
    found.other.resize(things_.size() - 1);
  }
  found.colliding = static_cast<std::size_t>(std::count(found.scan.begin(), found.scan.end(), 1));
  if (!options_.closest) return found;
  for (std::size_t other = 1; other < things_.size(); ++other) {
    const DistanceResult closest = closestPair(placed(0, step), placed(other, step));
    if (!closest.pair || (found.closest && found.closest->distance <= closest.distance)) continue;
    const Point3 a = scan().points().point(closest.pair->a), b = things_[other].points().point(closest.pair->b);
    found.closest = {Eigen::Vector3d(a[0], a[1], a[2]), poseOf(other, step) * Eigen::Vector3d(b[0], b[1], b[2]),
                     closest.distance};
  }
  return found;
}

std::optional<double> World::distanceOf(std::uint32_t record, std::size_t step) const
{
  if (things_.size() == 1) return std::nullopt;
  const Point3 p = scan().points().point(record);
  const SphereHierarchy point(viewOf(p.data(), 1));
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t other = 1; other < things_.size(); ++other)
    nearest = std::min(nearest, closestPair({point}, placed(other, step)).distance);
  return nearest;
}

std::vector<float> World::distances(std::size_t step) const
{
  if (!options_.clearance)
    if (auto field = scan().field("distance")) return *field;
  std::vector<float> distances(scan().points().count, std::numeric_limits<float>::quiet_NaN());
  if (!options_.clearance) return distances;
  TrajectoryRequest asked = along();
  asked.distances = true;
  for (std::size_t other = 1; other < things_.size(); ++other) {
    const TrajectoryResult found =
        collideAlong(placed(0, step), *things_[other].hierarchy, {poseOf(other, step)}, asked);
    for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = std::fmin(distances[i], found.distance[i]);
  }
  return distances;
}

const std::vector<std::int32_t>& World::firstPoses() const
{
  if (first_poses_) return *first_poses_;
  std::vector<std::int32_t> first(scan().points().count, -1);
  if (const auto field = options_.clearance ? std::nullopt : scan().field("first_pose")) {
    for (std::size_t i = 0; i < first.size(); ++i)
      first[i] = std::isfinite((*field)[i]) ? static_cast<std::int32_t>((*field)[i]) : -1;
  }
  else if (options_.clearance) {
    cli::Step step("Following " + std::to_string(steps()) + " poses");
    TrajectoryRequest asked = along();
    asked.first_poses = true;
    for (std::size_t other = 1; other < things_.size(); ++other) {
      const std::vector<Eigen::Isometry3d> still = {poseOf(other, 0)};
      const TrajectoryResult found =
          collideAlong(placed(0, 0), *things_[other].hierarchy, other == model_ ? poses_ : still, asked);
      for (std::size_t i = 0; i < first.size(); ++i) {
        const std::int32_t pose = found.first_pose[i];
        if (pose >= 0 && (first[i] < 0 || pose < first[i])) first[i] = pose;
      }
    }
    step.done(std::to_string(steps()) + " poses");
  }
  return *(first_poses_ = std::move(first));
}

CollisionTrace World::trace(std::size_t obstacle, std::size_t step) const
{
  return traceCollision(placed(0, step), placed(obstacle, step), request());
}

} // namespace pcl_bsh::view
