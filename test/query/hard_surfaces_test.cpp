// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of test/hard_cases/surfaces: surfaces and solids that other tools answer wrongly, or not at all, with
// the answers of exact arithmetic. Every query of two clouds, instruction set, one thread and several.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/triangle_labels.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/hard_surfaces.h"
#include "support/simd_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using Json = nlohmann::json;

std::vector<std::uint32_t> recordsOf(const std::vector<Verdict>& flags)
{
  std::vector<std::uint32_t> records;
  for (std::uint32_t i = 0; i < flags.size(); ++i)
    if (flags[i] == Verdict::colliding) records.push_back(i);
  return records;
}

class HardSurfaces : public testing::TestWithParam<Json> {};

TEST_P(HardSurfaces, EqualExactArithmetic)
{
  const Json& told = GetParam();
  const test::OffMesh mesh = test::meshOf(told);
  if (told.contains("open_edges")) {
    try {
      const Solid solid(mesh.view());
      FAIL() << "it is no solid";
    }
    catch (const InvalidInput& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(std::to_string(told.at("open_edges").get<int>()) + " edges"), std::string::npos) << text;
      EXPECT_EQ(error.index(), told.at("first_open_triangle").get<std::size_t>()) << text;
    }
    return;
  }
  const test::HardInput input(told);
  const Eigen::Isometry3d pose = test::poseOf(told);
  const double clearance = told.at("clearance"), smallest = told.at("smallest_distance");
  const auto of_input = told.at("colliding").get<std::vector<std::uint32_t>>(),
             of_mesh = told.at("colliding_of_mesh").get<std::vector<std::uint32_t>>();

  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const test::OnTarget on_target(target);
    for (const unsigned threads : {1u, 4u}) {
      const SphereHierarchy ha(input.view()), hb(viewOf(mesh.view()));
      const Placed a(ha), b(hb, pose);
      FlagsRequest flags;
      flags.clearance = clearance;
      flags.flagged = Flagged::both;
      flags.threads = threads;
      const FlagsResult found = collisionFlags(a, b, flags);
      EXPECT_EQ(recordsOf(found.a), of_input);
      EXPECT_EQ(recordsOf(found.b), of_mesh);
      EXPECT_EQ(recordsOf(brute_force::collisionFlags(a, b, flags).a), of_input);
      AnyRequest any;
      any.clearance = clearance;
      any.threads = threads;
      EXPECT_EQ(anyCollision(a, b, any).verdict == Verdict::colliding, !of_input.empty());
      EXPECT_EQ(closestPair(a, b).distance, smallest);
      const PointDistances distances = pointDistances(a, b);
      EXPECT_EQ(*std::min_element(distances.distance.begin(), distances.distance.end()), smallest);
      TrajectoryRequest path;
      path.clearance = clearance;
      path.threads = threads;
      EXPECT_EQ(recordsOf(collideAlong(a, hb, std::vector{pose}, path).flags), of_input);
      EXPECT_EQ(recordsOf(collideAlong({hb, pose}, ha, std::vector{Eigen::Isometry3d::Identity()}, path).flags),
                of_mesh);
      EXPECT_TRUE(ha.validate().none());
      EXPECT_TRUE(hb.validate().none());
    }
  }
  if (!told.contains("labels")) return;
  const auto labels = told.at("labels").get<std::vector<std::uint8_t>>();
  const Solid solid(mesh.view());
  const SphereHierarchy ha(input.view());
  EXPECT_EQ(input.mesh ? labelTriangles(input.mesh->view(), Eigen::Isometry3d::Identity(), {solid, pose})
                       : labelPoints({ha}, {solid, pose}).labels,
            labels);

  Question question;
  question.solid = true;
  question.clearance = clearance;
  question.pose = pose;
  question.wanted.flags = true;
  Shape a("the input", input.view()), b("the solid", viewOf(mesh.view()));
  std::vector<std::uint32_t> with_inside = of_input;
  for (std::uint32_t i = 0; i < labels.size(); ++i)
    if (labels[i] != 0 && std::count(of_input.begin(), of_input.end(), i) == 0) with_inside.push_back(i);
  std::sort(with_inside.begin(), with_inside.end());
  EXPECT_EQ(recordsOf(ask(question, a, b).collisions.flags), with_inside);
}

std::string nameOf(const testing::TestParamInfo<Json>& info)
{
  std::string name;
  for (const char c : info.param.at("name").get<std::string>()) name += std::isalnum(c) ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardSurfaces, testing::ValuesIn(test::hardSurfaces()), nameOf);

} // namespace
} // namespace pcl_bsh
