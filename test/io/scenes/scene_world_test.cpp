// SPDX-License-Identifier: BSD-3-Clause
// The content of a scene's file, in the scene that is made of it.
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/scenes/scene_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include "io/clouds/samples.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SceneWorld, WavesMovePointsAlongX)
{
  const TemporaryFolder folder;
  folder.write("points.xyz", "0 0 0\n0.25 1 2\n1.5 -1 0.5\n");
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": {"file": "points.xyz"}}, "steps": 4, "dt": 0.25,
      "objects": [{"name": "a", "cloud": "a", "pose": [0, 0, 9],
                   "wave": {"amplitude": [0.5, 0, -0.25], "length": 2, "period": 4}}], "effects": {"deform": 2}})");
  SceneWorld world(readSceneFile(scene));
  const PointsView rest = viewOf(world.cloud("a"));
  for (const double time : {0.0, 0.3, 1.0, 5.75}) {
    if (time > 0.0) world.setTime(time);
    const PointsView& now = world.scene()[0].parts[0].hierarchy->view();
    ASSERT_EQ(now.count, 3u);
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Point3 before = rest.point(i), after = now.point(i);
      const double height = std::sin(2 * 3.14159265358979323846 * (before[0] / 2 - time / 4));
      EXPECT_NEAR(after[0], before[0] + 0.5 * height, 1e-12) << time;
      EXPECT_NEAR(after[1], before[1], 1e-12);
      EXPECT_NEAR(after[2], before[2] - 0.25 * height, 1e-12);
    }
  }
}

/// A cloud that becomes float64 keeps its rows, its header and what is not finite.
TEST(SceneWorld, WideCoordinatesKeepTheRest)
{
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud = randomCloud<float>(6, 4, {Field::UINT16});
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&cloud.data[cloud.point_step * 5], &nothing, sizeof nothing);
  writeCloud(folder / "a.pcd", cloud);
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": {"file": "a.pcd", "shift": [1e7, 0.1, 0]}},
      "objects": [{"name": "a", "cloud": "a"}]})");
  const SceneWorld world(readSceneFile(scene));
  const pcl::PCLPointCloud2& wide = world.cloud("a");
  EXPECT_EQ(wide.width, 6u);
  EXPECT_EQ(wide.height, 4u);
  EXPECT_FALSE(wide.is_dense);
  EXPECT_TRUE(std::isnan(viewOf(wide).point(5)[0]));
  const Point3 was = viewOf(cloud).point(23), is = viewOf(wide).point(23);
  EXPECT_EQ(is, (Point3{was[0] + 1e7, was[1] + 0.1, was[2]}));
  EXPECT_EQ(world.points(), 23u) << "finite ones";
}

/// Numbers that floats hold stay in floats.
TEST(SceneWorld, NarrowCoordinatesAreScaledEach)
{
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud = randomCloud<float>(20, 1, {});
  writeCloud(folder / "a.pcd", cloud);
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": {"file": "a.pcd", "scale": 0.5}},
      "objects": [{"name": "a", "cloud": "a"}]})");
  const SceneWorld world(readSceneFile(scene));
  const PointsView was = viewOf(cloud), is = viewOf(world.cloud("a"));
  EXPECT_EQ(is.scalar, Scalar::float32);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Point3 p = was.point(i);
    EXPECT_EQ(is.point(i), (Point3{0.5 * p[0], 0.5 * p[1], 0.5 * p[2]}));
  }
}

/// Whether objects one apart collide by a rule.
std::string rules(const std::string& given)
{
  return R"({"clouds": {"a": {"sphere": {"radius": 1}, "spacing": 0.2}}, "clearance": 0.5, "effects": {"any": true},
    "objects": [{"name": "a", "cloud": "a", "group": "left"}, {"name": "b", "cloud": "a", "group": "right", "pose": [3, 0, 0]},
                {"name": "c", "cloud": "a", "group": "right", "pose": [5.25, 0, 0]}], "pairs": )" +
         given + "}";
}

std::string pairsBy(const std::string& given)
{
  SceneWorld world(parseScene(rules(given), "scene.json"));
  std::string pairs;
  for (const CollidingPair& pair : world.scene().query().any)
    pairs += world.scene()[pair.a].name + world.scene()[pair.b].name + " ";
  return pairs;
}

TEST(SceneWorld, PairsAreTestedByTheRules)
{
  EXPECT_EQ(pairsBy(R"({})"), "bc ");
  EXPECT_EQ(pairsBy(R"({"rules": [{"objects": ["a", "b"], "clearance": 1.5}]})"), "ab bc ");
  EXPECT_EQ(pairsBy(R"({"rules": [{"groups": ["right", "left"], "clearance": 1.5}]})"), "ab bc ");
  EXPECT_EQ(pairsBy(R"({"rules": [{"groups": ["right", "right"], "tested": false}]})"), "");
  EXPECT_EQ(pairsBy(R"({"default": "ignored"})"), "");
  EXPECT_EQ(pairsBy(R"({"default": "ignored", "rules": [{"objects": ["c", "b"], "tested": true}]})"), "bc ");
}

TEST(SceneWorld, RulesThatSayNothingAreRefused)
{
  const auto expect = [](const std::string& given, const std::string& words) {
    EXPECT_THAT([&] { parseScene(rules(given), "scene.json"); }, ThrowsMessage<JsonError>(HasSubstr(words))) << given;
  };
  expect(R"({"rules": [{"objects": ["a", "b"]}]})", "pairs.rules[0]: says nothing: give 'tested' or 'clearance'");
  expect(R"({"rules": [{"objects": ["a", "a"], "tested": true}]})", "pairs.rules[0].objects: names one object twice");
  expect(R"({"rules": [{"tested": true}]})", "pairs.rules[0]: has ");
  expect(R"({"rules": [{"groups": ["left", "lift"], "tested": true}]})", "'lift' is unknown: did you mean 'left'?");
  EXPECT_NO_THROW(parseScene(rules(R"({"rules": [{"groups": ["left", "left"], "tested": true}]})"), "scene.json"));
}

std::string sceneWith(const std::string& object, const std::string& more = "")
{
  return R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "objects": [{"name": "a", "cloud": "a")" + object + "}]" +
         more + "}";
}

TEST(SceneWorld, WhatCannotBeIsRefused)
{
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_THAT([&] { parseScene(text, "scene.json"); }, ThrowsMessage<JsonError>(HasSubstr(words))) << text;
  };
  const std::string moving = R"(, "motion": {"velocity": [1, 0, 0]})";
  expect(sceneWith(R"(, "fixed": true)" + moving), "objects[0]: is fixed and moves: leave 'fixed' or 'motion' out");
  EXPECT_NO_THROW(parseScene(sceneWith(R"(, "fixed": true)"), "scene.json"));
  EXPECT_NO_THROW(parseScene(sceneWith(R"(, "fixed": false)" + moving), "scene.json"));
  const std::string outputs = R"(, "outputs": {"clouds": "every"})";
  expect(sceneWith("", outputs), "outputs.clouds: needs the effect 'flags' or 'swept': add one of them to 'effects'");
  EXPECT_NO_THROW(parseScene(sceneWith("", outputs + R"(, "effects": {"swept": true})"), "scene.json"));
  EXPECT_NO_THROW(parseScene(sceneWith("", outputs + R"(, "effects": {"flags": true})"), "scene.json"));
  EXPECT_NO_THROW(parseScene(sceneWith("", R"(, "outputs": {"clouds": "none"})"), "scene.json"));
  expect(sceneWith(R"(, "motion": {"circular": {"center": [0, 0, 0], "axis": [0, 0, 0], "speed": 1}})"),
         "objects[0].motion.circular.axis: has length 0: give a direction");
  expect(sceneWith("", R"(, "accuracy": "best")"), "accuracy: 'best' is no accuracy: give exact, tolerance=LENGTH");
  expect(R"({"clouds": {"a": {"sphere": {"radius": 1}, "box": {"size": [1, 1, 1]}}}, "objects": []})", "clouds.a: ");
  const auto scatter = [](const std::string& high, const std::string& name) {
    return sceneWith("", R"(, "scatter": [{"name": ")" + name + R"(", "cloud": "a", "count": 2, "low": [0, 0, 0],
                             "high": )" +
                             high + "}]");
  };
  expect(scatter("[1, -1, 1]", "dust"), "scatter[0].high: is below 'low': give the larger corner");
  EXPECT_NO_THROW(parseScene(scatter("[1, 0, 1]", "dust"), "scene.json")) << "a flat box";
  expect(scatter("[1, 1, 1]", "a"), "scatter[0].name: 'a' is taken");
  const SceneFile file = parseScene(scatter("[1, 1, 1]", "dust"), "scene.json");
  ASSERT_EQ(file.objects.size(), 3u);
  EXPECT_EQ(file.objects[1].name, "dust 0");
  EXPECT_EQ(file.objects[2].name, "dust 1");
  EXPECT_TRUE(std::holds_alternative<NoMotion>(file.objects[1].motion)) << "without speed";
}

/// A pose of the file every interval, each seen from a base.
TEST(SceneWorld, TrajectoriesOfFiles)
{
  const TemporaryFolder folder;
  folder.write("walk.txt", "0 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 2 3 0 0 0 0 1\n");
  const auto motionOf = [&](const std::string& more) {
    const auto scene = folder.write("scene.json", R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "dt": 0.5, "objects":
        [{"name": "a", "cloud": "a", "motion": {"trajectory": {"file": "walk.txt")" +
                                                      more + "}}}]}");
    const SceneFile file = readSceneFile(scene);
    EXPECT_EQ(file.trajectories.size(), 1u);
    return std::get<WaypointMotion>(file.objects[0].motion);
  };
  const WaypointMotion plain = motionOf("");
  EXPECT_EQ(plain.times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(plain.poses[2].translation(), Eigen::Vector3d(2, 3, 0));
  const WaypointMotion based = motionOf(R"(, "interval": 2, "base": [0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30])");
  EXPECT_EQ(based.times, (std::vector<double>{0, 2, 4}));
  EXPECT_TRUE(based.poses[2].translation().isApprox(Eigen::Vector3d(10 - 3, 20 + 2, 30), 1e-12));
}

/// Where one axis alone needs them, too.
TEST(SceneWorld, CoordinatesBecomeWideForAnyAxis)
{
  const TemporaryFolder folder;
  writeCloud(folder / "a.pcd", randomCloud<float>(2, 1, {}));
  const auto scalarOf = [&](const std::string& shift) {
    const auto scene = folder.write("scene.json", R"({"clouds": {"a": {"file": "a.pcd", "scale": 0.5, "shift": )" +
                                                      shift + R"(}}, "objects": [{"name": "a", "cloud": "a"}]})");
    const SceneWorld world(readSceneFile(scene));
    return viewOf(world.cloud("a")).scalar;
  };
  EXPECT_EQ(scalarOf("[0, 0, 0]"), Scalar::float32);
  for (const char* shift : {"[1e9, 0, 0]", "[0, 1e9, 0]", "[0, 0, 1e9]"})
    EXPECT_EQ(scalarOf(shift), Scalar::float64) << shift;
}

TEST(SceneWorld, CloudsOfNoObjectAreNotRead)
{
  const TemporaryFolder folder;
  folder.write("broken.ply", "no cloud");
  folder.write("a.xyz", "1 2 3\n4 5 6\n");
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": "a.xyz", "b": "broken.ply"},
      "objects": [{"name": "a", "cloud": "a"}]})");
  std::vector<std::string> read;
  const SceneWorld world(readSceneFile(scene), [&](const CloudSource& cloud) { read.push_back(cloud.name); });
  EXPECT_EQ(read, std::vector<std::string>{"a"});
  EXPECT_EQ(world.points(), 2u);
}

/// A tetrahedron, without its last face where it is open.
std::string tetrahedron(bool open)
{
  return std::string("OFF\n4 ") + (open ? "3" : "4") + " 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n" +
         (open ? "" : "3 1 2 3\n");
}

TEST(SceneWorld, SolidsAreMeshesThatClose)
{
  const TemporaryFolder folder;
  folder.write("closed.off", tetrahedron(false));
  folder.write("open.off", tetrahedron(true));
  folder.write("points.xyz", "0 0 0\n1 2 3\n");
  folder.write("inside.xyz", "0.5 0.5 0.5\n");
  const auto worldOf = [&](const std::string& file, const std::string& solid) {
    const auto scene = folder.write("scene.json", R"({"clouds": {"in": "inside.xyz", "b": ")" + file +
                                                      R"("}, "objects": [{"name": "in", "cloud": "in"},
        {"name": "B", "cloud": "b", "solid": )" + solid +
                                                      R"(}], "effects": {"any": true}})");
    return SceneWorld(readSceneFile(scene));
  };
  EXPECT_EQ(worldOf("closed.off", "true").scene().query().any.size(), 1u) << "what is inside collides";
  EXPECT_EQ(worldOf("closed.off", "false").scene().query().any.size(), 0u) << "it is hollow";
  EXPECT_EQ(worldOf("open.off", "false").scene().query().any.size(), 0u);
  EXPECT_THAT([&] { worldOf("open.off", "true"); },
              ThrowsMessage<JsonError>(HasSubstr("scene.json: objects[1].solid: 3 edges are open")));
  EXPECT_THAT([&] { worldOf("points.xyz", "true"); },
              ThrowsMessage<JsonError>(HasSubstr("scene.json: objects[1].solid: cloud 'b' has no faces: give a mesh "
                                                 "that closes, or leave it out")));
}

TEST(SceneWorld, NamesTheCloudOfWhatIsNoSurface)
{
  const TemporaryFolder folder;
  folder.write("vast.off", "OFF\n3 1 0\n0 0 0\n1e300 0 0\n0 1e300 0\n3 0 1 2\n");
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": "vast.off"},
      "objects": [{"name": "a", "cloud": "a"}]})");
  EXPECT_THAT([&] { SceneWorld(readSceneFile(scene)); },
              ThrowsMessage<JsonError>(HasSubstr("scene.json: clouds.a: triangle 0 is too large")));
}

/// Assumptions of its reader are told with the file's name.
TEST(SceneWorld, TellsWhatIsToBeKnownOfAFile)
{
  const TemporaryFolder folder;
  folder.write("a.xyz", "1 5 7 9\n2 6 8 0\n3 1 1 1\n");
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": "a.xyz"},
      "objects": [{"name": "a", "cloud": "a"}]})");
  const std::vector<std::string> warnings = SceneWorld(readSceneFile(scene)).warnings();
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings[0], testing::StartsWith((folder / "a.xyz").string() + ": its first column counts up by one"));
}

} // namespace
} // namespace pcl_bsh::io
