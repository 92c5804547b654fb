// SPDX-License-Identifier: BSD-3-Clause
// Scans, models and their ways past each other, and what a trajectory query has to answer alike.
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

#include "support/meshes.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

using Poses = std::vector<Eigen::Isometry3d>;

inline const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

inline TrajectoryRequest everything(double clearance, unsigned threads = 1)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  request.distances = request.first_poses = request.closest_poses = request.pose_summaries = true;
  request.threads = threads;
  return request;
}

inline TrajectoryRequest flagsOnly(double clearance)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  return request;
}

/// NaN equals NaN here.
inline std::vector<std::uint32_t> bitsOf(const std::vector<float>& values)
{
  std::vector<std::uint32_t> bits(values.size());
  if (!values.empty()) std::memcpy(bits.data(), values.data(), values.size() * sizeof(float));
  return bits;
}

inline void expectSame(const TrajectoryResult& result, const TrajectoryResult& expected)
{
  EXPECT_EQ(result.flags, expected.flags);
  EXPECT_EQ(result.colliding, expected.colliding);
  EXPECT_EQ(result.undecided, expected.undecided);
  EXPECT_EQ(result.certain_pose, expected.certain_pose);
  EXPECT_EQ(bitsOf(result.distance), bitsOf(expected.distance));
  EXPECT_EQ(result.first_pose, expected.first_pose);
  EXPECT_EQ(result.closest_pose, expected.closest_pose);
  EXPECT_EQ(result.closest_point, expected.closest_point);
  ASSERT_EQ(result.poses.size(), expected.poses.size());
  for (std::size_t k = 0; k < result.poses.size(); ++k) {
    SCOPED_TRACE("pose " + std::to_string(k));
    EXPECT_EQ(result.poses[k].colliding, expected.poses[k].colliding);
    EXPECT_EQ(result.poses[k].colliding_points, expected.poses[k].colliding_points);
    EXPECT_EQ(result.poses[k].undecided_points, expected.poses[k].undecided_points);
    EXPECT_EQ(result.poses[k].distance, expected.poses[k].distance);
  }
}

/// A model's way: each kind that has a trap of its own. It starts at `start`, where the scene has its model.
inline Poses anyPath(const Eigen::Isometry3d& start, const Point3& center, double scale, std::size_t count,
                     Random& random)
{
  const Eigen::Vector3d middle(center[0], center[1], center[2]);
  const auto direction = [&] {
    return Eigen::Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}.normalized();
  };
  const int kind = random.integer(0, 6);
  const Eigen::Vector3d along = direction(), axis = direction();
  const double step = scale * random.uniform(0.01, 0.5), turn = random.uniform(-0.5, 0.5);
  Eigen::Isometry3d at = start;
  Poses poses;
  for (std::size_t k = 0; k < count; ++k) {
    poses.push_back(at);
    const auto about = [&](const Eigen::Vector3d& pivot, double angle) {
      return Eigen::Isometry3d(Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle, axis) *
                               Eigen::Translation3d(-pivot));
    };
    switch (kind) {
    case 0: // straight
      at = Eigen::Translation3d(step * along) * at;
      break;
    case 1: // on the spot
      at = at * about(middle, turn);
      break;
    case 2: // a bend
      at = Eigen::Translation3d(step * along) * at * about(middle, 0.1 * turn);
      break;
    case 3: // a loop about a far centre, which comes back to where it was
      at = start * about(middle + 20 * scale * along, 2 * M_PI / 16 * static_cast<double>(k + 1));
      break;
    case 4: // standing still, now and then a step
      if (random.chance(0.2)) at = Eigen::Translation3d(step * along) * at;
      break;
    case 5: // any poses
      at = start * about(middle, random.uniform(-3, 3)) * Eigen::Translation3d(scale * random.uniform(0, 1) * along);
      break;
    default: // there and back
      at = start;
      at.translation() += scale / 8 * static_cast<double>(k % 8 < 4 ? k % 8 : 8 - k % 8) * along;
      break;
    }
  }
  return poses;
}

struct Journey {
  Scene scene;
  Poses poses;
  std::string name;
};

/// The model of a scene on its way.
inline Journey journeyOf(Scene scene, std::uint64_t seed, int max_poses)
{
  Random random(seed + 77);
  const PointsView view = scene.b.view();
  Point3 center = {0, 0, 0};
  double scale = 1.0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    if (std::isfinite(p[0] + p[1] + p[2])) {
      center = p;
      const Point3 q = view.point(view.record(view.size() / 2));
      const double extent = std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]);
      if (extent > 0 && extent < 1e5) scale = extent;
      break;
    }
  }
  const auto count = static_cast<std::size_t>(random.integer(0, max_poses));
  Poses poses = anyPath(scene.pose_b, center, scale, count, random);
  const std::string name = scene.name + ", " + std::to_string(poses.size()) + " poses";
  return {std::move(scene), std::move(poses), name};
}

inline Journey anyJourney(std::uint64_t seed, int max_points, int max_poses)
{
  return journeyOf(anyScene(seed, max_points), seed, max_poses);
}

/// Triangles along a path, past triangles or past points; or points past triangles.
inline Journey anyMeshJourney(std::uint64_t seed, int most, int max_poses)
{
  return journeyOf(anyMeshScene(seed, most), seed, max_poses);
}

} // namespace pcl_bsh::test
