// SPDX-License-Identifier: BSD-3-Clause
#include "path_scene.h"

#include "random.h"

#include <examples/tunnel/tunnel.h>

#include <algorithm>
#include <stdexcept>

namespace pcl_bsh::bench {
namespace {

// The store, in metres: aisles along x, racks between them.
constexpr double kLength = 60, kWidth = 42, kRackDepth = 1.2, kAisle = 1.8, kRackHeight = 7.0;
constexpr double kTallGoods = 7.43; // now and then: within the clearance of the jib
constexpr double kJibHeight = 7.46, kReach = 20.0;

/// `count` points on the surface of an upright box.
void addBox(Points& points, std::size_t count, const std::array<double, 3>& low, const std::array<double, 3>& high,
            Random& random)
{
  const std::array<double, 3> size = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  const std::array<double, 3> area = {size[1] * size[2], size[0] * size[2], size[0] * size[1]};
  const double total = area[0] + area[1] + area[2];
  for (std::size_t i = 0; i < count; ++i) {
    double pick = random.uniform(0, total);
    std::size_t axis = 0;
    while (axis < 2 && pick >= area[axis]) pick -= area[axis++];
    std::array<double, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = random.uniform(low[k], high[k]);
    p[axis] = random.bits() % 2 == 0 ? low[axis] : high[axis];
    points.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
}

Points store(std::size_t count)
{
  Random random(21);
  const auto rows = static_cast<std::size_t>(kWidth / (kRackDepth + kAisle));
  const auto bays = static_cast<std::size_t>(kLength / 2.5);
  const std::size_t per_bay = count / (rows * bays);
  Points points;
  points.reserve(count);
  for (std::size_t row = 0; row < rows; ++row) {
    const double y = static_cast<double>(row) * (kRackDepth + kAisle);
    for (std::size_t bay = 0; bay < bays; ++bay) {
      const double x = 2.5 * static_cast<double>(bay);
      const double top = random.below(20) == 0 ? kTallGoods : kRackHeight - random.uniform(0, 1.5);
      addBox(points, per_bay, {x + 0.1, y, 0.0}, {x + 2.4, y + kRackDepth, top}, random);
    }
  }
  addBox(points, count - points.size(), {0, 0, -0.1}, {kLength, kWidth, 0.0}, random); // the floor
  return points;
}

/// Origin on the floor, at the mast: a long carriage behind it, along the aisle, and the jib across.
Points crane(std::size_t count)
{
  Random random(22);
  Points points;
  points.reserve(count);
  addBox(points, count * 2 / 5, {-kReach, -0.4, 0.2}, {0.0, 0.4, 0.6}, random);
  addBox(points, count / 5, {-0.2, -0.2, 0.6}, {0.2, 0.2, kJibHeight}, random);
  addBox(points, count - points.size(), {-0.3, -0.3, kJibHeight}, {0.3, kReach, kJibHeight + 0.5}, random);
  return points;
}

PathScene craneScene(double scale, double denser)
{
  PathScene scene;
  scene.scan = store(static_cast<std::size_t>(15e6 * scale));
  scene.model = crane(static_cast<std::size_t>(1e6 * scale));
  scene.clearance = 0.05;
  const auto poses = static_cast<std::size_t>(std::max(2.0, 10000 * scale * denser));
  const double aisle = 3 * (kRackDepth + kAisle) + kRackDepth + kAisle / 2;
  for (std::size_t k = 0; k < poses; ++k) {
    const double f = static_cast<double>(k) / static_cast<double>(poses - 1);
    // The carriage sways a little: all of it turns.
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.012 * std::sin(40 * f), Eigen::Vector3d::UnitZ()));
    pose.translation() = Eigen::Vector3d(kReach + f * (kLength - kReach), aisle, 0.0);
    scene.poses.push_back(pose);
  }
  return scene;
}

Points pointsOf(const std::vector<Eigen::Vector3f>& vectors)
{
  Points points;
  points.reserve(vectors.size());
  for (const Eigen::Vector3f& v : vectors) points.push_back({v.x(), v.y(), v.z()});
  return points;
}

PathScene tunnelScene(double scale, double denser, tunnel::Course course)
{
  tunnel::Size size = tunnel::Size::atScale(scale);
  size.poses = static_cast<std::size_t>(std::max(1.0, static_cast<double>(size.poses) * denser));
  const tunnel::Passage passage = tunnel::makePassage(size, course);
  return {pointsOf(passage.scan), pointsOf(passage.wagon), passage.poses, tunnel::clearance};
}

} // namespace

PathScene pathScene(const std::string& name, double scale, double denser)
{
  if (name == "tunnel") return tunnelScene(scale, denser, tunnel::Course::winding);
  if (name == "tight") return tunnelScene(scale, denser, tunnel::Course::tight);
  if (name == "crane") return craneScene(scale, denser);
  throw std::invalid_argument("scene '" + name + "' is unknown: use tunnel, tight or crane");
}

} // namespace pcl_bsh::bench
