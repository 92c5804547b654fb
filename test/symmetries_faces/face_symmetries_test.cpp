// SPDX-License-Identifier: BSD-3-Clause
// Filters, pipelines, sites and a program: what must not change an answer of theirs does not.
#include "face_answers.h"
#include "support/pcd_points.h"
#include "support/temporary_folder.h"
#include "symmetries/hard_instances.h"
#include "symmetries/symmetries.h"

#include <gtest/gtest.h>

#include <exception>
#include <filesystem>

namespace pcl_bsh::symmetries {
namespace {

using test::Random;

/// Places of eighths, so that there are ties; everything within a few units. Poses of some are quarter turns, which
/// keep them.
Instance anyFaceInstance(std::uint32_t seed, std::size_t most = 60)
{
  Random random(seed);
  Instance made;
  made.name = "random instance " + std::to_string(seed);
  for (Body* body : {&made.a, &made.b}) {
    body->scalar = random.chance(0.5) ? Scalar::float64 : Scalar::float32;
    body->points.resize(static_cast<std::size_t>(random.integer(1, static_cast<int>(most))));
    const bool is_tied = random.chance(0.5);
    for (Point3& p : body->points)
      p = random.point([&] { return is_tied ? random.integer(0, 16) / 8.0 : random.uniform(0, 2); });
    roundTo(body->scalar, body->points);
  }
  for (int i = random.integer(1, 3); i > 0; --i) {
    Eigen::Isometry3d pose = random.pose(0.5);
    if (random.chance(0.5)) {
      pose = Eigen::Isometry3d::Identity();
      pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
      pose.translation() = Eigen::Vector3d{1.0, random.integer(-4, 4) / 8.0, random.integer(-4, 4) / 8.0};
    }
    made.relative.push_back(pose);
  }
  made.path = made.relative;
  made.b.pose = made.relative.front();
  made.clearance = random.integer(0, 4) / 8.0;
  made.threads = static_cast<unsigned>(random.integer(1, 2));
  addFaces(made, 1.0, random);
  return made;
}

void expectSymmetric(const Instance& instance, Random& random, const Ask& ask)
{
  try {
    EXPECT_GE(requireSymmetric(instance, random, ask), 10u);
  }
  catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
}

/// Two parts of a sampled robot, where it is there.
Instance robotInstance(std::size_t step)
{
  const std::string file = PCL_BSH_SHARED_DIR "/data/robot_panda_sampled.pcd";
  Instance made;
  if (!std::filesystem::exists(file)) return made;
  const test::PcdPoints all = test::readPcdPoints(file);
  made.name = "robot";
  for (Body* body : {&made.a, &made.b}) {
    body->scalar = all.scalar;
    for (std::size_t i = body == &made.a ? 0 : 300; i < all.points.size(); i += step)
      body->points.push_back(all.points[i]);
  }
  made.clearance = 0.02;
  made.b.pose.translation() = Eigen::Vector3d(0.05, 0.02, 0.0);
  made.path = made.relative = {made.b.pose};
  return made;
}

class FaceSymmetries : public testing::Test {
protected:
  void ofAll(std::uint32_t instances, const Ask& ask, std::size_t most = 60)
  {
    for (std::uint32_t seed = 0; seed < instances && !HasFailure(); ++seed) {
      Random random(seed);
      expectSymmetric(anyFaceInstance(seed, most), random, ask);
    }
    const Instance robot = robotInstance(20 * most);
    Random random(1);
    if (!robot.a.points.empty()) expectSymmetric(robot, random, ask);
  }

  /// Each of so many of both catalogues.
  void ofHardCases(std::size_t of, const Ask& ask)
  {
    std::vector<Instance> hard = instancesOfHardSurfaces();
    for (const hard_cases::HardCase& c : hard_cases::catalogue())
      if (!c.a.empty() && !c.b.empty()) hard.push_back(instanceOf(c));
    Random random(5);
    for (std::size_t i = 0; i < hard.size() && !HasFailure(); i += of) expectSymmetric(hard[i], random, ask);
  }

  const files::TemporaryFolder folder_;
  const std::filesystem::path folder = folder_.path();
};

TEST_F(FaceSymmetries, OfFilters)
{
  ofAll(60, askFilters);
  ofHardCases(1, askFilters);
}

TEST_F(FaceSymmetries, OfPipelines)
{
  ofAll(20, askPipelines);
  ofHardCases(8, askPipelines);
}

/// Each is cut otherwise, too.
TEST_F(FaceSymmetries, OfSites)
{
  Random random(3);
  const auto ask = [&](const Instance& instance) {
    return askSite(instance, folder, static_cast<std::uint64_t>(random.integer(4, 70)));
  };
  ofAll(6, ask);
  ofHardCases(16, ask);
}

TEST_F(FaceSymmetries, OfPrograms)
{
  const auto ask = [&](const Instance& instance) { return askProgram(instance, folder); };
  ofAll(2, ask);
  ofHardCases(60, ask);
}

} // namespace
} // namespace pcl_bsh::symmetries
