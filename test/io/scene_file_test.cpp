// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/json_reader.h>
#include <pcl_bsh/filters/io/scene_file.h>
#include <pcl_bsh/filters/io/shape_points.h>

#include "samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

constexpr auto whole = R"({
  // a scene with everything
  "clouds": {
    "ball": { "sphere": { "radius": 0.5 }, "spacing": 0.2 },
    "crate": { "box": { "size": [1, 2, 3] }, "spacing": 0.5, /* moved */ "shift": [1, 0, 0] },
    "pipe": { "cylinder": { "radius": 1, "height": 2, "open": true }, "spacing": 0.5 }
  },
  "objects": [
    { "name": "floor", "cloud": "crate", "fixed": true, "group": "walls", "pose": [0, 0, -5] },
    { "name": "pipe", "cloud": "pipe", "fixed": true, "group": "walls",
      "pose": [0, 0, 1, 5, 0, 1, 0, 6, -1, 0, 0, 7] },
    { "name": "robot", "parts": [ { "name": "base", "cloud": "ball" }, { "name": "arm", "cloud": "ball", "pose": [0, 0, 1] },
                                  { "name": "hand", "cloud": "ball", "pose": [0, 0, 1.4] } ],
      "adjacent": [ ["base", "arm"], ["arm", "hand"] ],
      "motion": { "velocity": { "linear": [1, 0, 0], "angular": [0, 0, 0.5] } } },
    { "name": "moon", "cloud": "ball", "pose": [3, 0, 0, 0, 0, 1.5],
      "motion": { "circular": { "center": [0, 0, 0], "speed": 2, "turning": false } } },
    { "name": "lift", "cloud": "crate", "wave": { "amplitude": [0, 0, 0.1], "length": 2, "period": 1 },
      "motion": { "waypoints": [ { "time": 0, "pose": [9, 0, 0] }, { "time": 2, "pose": [9, 0, 4] } ] } }
  ],
  "scatter": [ { "name": "dust", "cloud": "ball", "count": 4, "low": [20, 20, 20], "high": [25, 25, 25], "speed": 2 } ],
  "pairs": { "default": "tested", "rules": [ { "groups": ["walls", "walls"], "tested": true, "clearance": 0.2 },
                                             { "objects": ["moon", "lift"], "tested": false } ] },
  "effects": { "any": true, "flags": true, "distance": "all", "contacts": 3, "first_contact": true, "swept": true,
               "self": true, "response": "slide", "gravity": { "step_height": 0.2 }, "deform": 1.5 },
  "clearance": 0.1, "tolerance": 0.001, "accuracy": "level=3", "threads": 1, "steps": 20, "dt": 0.5,
  "outputs": { "clouds": "last" }
})";

TEST(SceneFile, ReadsEverything)
{
  const SceneFile file = parseScene(whole, "scene.json");
  EXPECT_EQ(file.clouds.size(), 3u);
  ASSERT_EQ(file.objects.size(), 9u);
  EXPECT_EQ(file.steps, 20u);
  EXPECT_EQ(file.dt, 0.5);
  EXPECT_EQ(file.options.clearance, 0.1);
  EXPECT_EQ(file.options.accuracy.text(), "level=3");
  EXPECT_TRUE(std::isinf(*file.options.effects.distance));
  for (std::size_t e = 0; e < kEffects; ++e)
    EXPECT_EQ(file.options.effects.has(static_cast<Effect>(e)), static_cast<Effect>(e) != Effect::stop);
  EXPECT_EQ(file.objects[1].pose * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(5, 6, 6));
  EXPECT_EQ(file.objects[2].adjacent.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<CircularMotion>(file.objects[3].motion));
  EXPECT_EQ(std::get<WaypointMotion>(file.objects[4].motion).times, (std::vector<double>{0, 2}));
  EXPECT_EQ(file.rules.size(), 2u);
  EXPECT_EQ(file.cloud_output, CloudOutput::last);
}

TEST(SceneFile, BecomesAScene)
{
  const SceneFile file = parseScene(whole, "scene.json");
  SceneWorld world(file);
  EXPECT_EQ(world.scene().size(), 9u);
  EXPECT_EQ(world.scene()[2].parts.size(), 3u);
  SceneResult result = world.scene().query();
  EXPECT_TRUE(result.self.empty()); // of arm and hand, which are adjacent, nothing is said
  for (int step = 0; step < 5; ++step) {
    world.deform(world.scene().time() + file.dt);
    result = world.scene().step(file.dt);
    EXPECT_GT(result.cost(Effect::deform).pairs, 0u);
  }
  const Eigen::Vector3d moon = world.scene()[3].pose.translation();
  EXPECT_NEAR(moon.head<2>().norm(), 3, 0.5); // it falls, for there is no ground
  for (ObjectId i = 5; i < 9; ++i) EXPECT_TRUE((world.scene()[i].pose.translation().head<2>().array() <= 25).all());
}

std::string errorOf(const std::string& text)
{
  try {
    parseScene(text, "scene.json");
  }
  catch (const JsonError& error) {
    return error.what();
  }
  return "none";
}

/// The scene with one part of its text replaced.
std::string with(const std::string& from, const std::string& to)
{
  std::string text = whole;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(SceneFile, NamesThePlaceOfWhatIsWrong)
{
  const auto expect = [](const std::string& from, const std::string& to, const std::string& message) {
    EXPECT_EQ(errorOf(with(from, to)), "scene.json: " + message) << to;
  };
  expect("\"steps\"", "\"stepps\"", "key 'stepps' is unknown: did you mean 'steps'?");
  expect("\"fixed\": true, \"group\"", "\"fixd\": true, \"group\"",
         "objects[0]: key 'fixd' is unknown: did you mean 'fixed'?");
  expect("\"cloud\": \"pipe\"", "\"cloud\": \"pip\"",
         "objects[1].cloud: no cloud is called 'pip': did you mean 'pipe'?");
  expect("\"slide\"", "\"slyde\"", "effects.response: 'slyde' is unknown: did you mean 'slide'?");
  expect("\"clearance\": 0.1", "\"clearance\": -1", "clearance: -1 is too small: give at least 0.0");
  expect("\"clearance\": 0.1", "\"clearance\": \"x\"", "clearance: \"x\" is no number: give one");
  expect("\"speed\": 2, \"turning\"", "\"speed\": null, \"turning\"",
         "objects[3].motion.circular.speed: null is no number: give one");
  expect("[3, 0, 0, 0, 0, 1.5]", "[3, 0]",
         "objects[3].pose: [3,0] is no pose: give [x, y, z], [x, y, z, roll, pitch, yaw] with radians, or the 12 or 16 "
         "numbers of a matrix, row by row");
  expect("[0, 0, 1, 5, 0, 1, 0", "[0, 0, 2, 5, 0, 1, 0",
         "objects[1].pose: is no rigid transform: give a rotation without scale or mirror, and 0 0 0 1 as last row");
  expect("\"time\": 2", "\"time\": 0",
         "objects[4].motion.waypoints[1].time: is not later than the one before: let times ascend");
  expect("\"name\": \"moon\"", "\"name\": \"floor\"",
         "objects[3].name: 'floor' is taken: give every object a name of its own");
  expect("[\"moon\", \"lift\"]", "[\"moon\", \"lyft\"]",
         "pairs.rules[1].objects[1]: 'lyft' is unknown: did you mean 'lift'?");
  expect("[\"arm\", \"hand\"]", "[\"arm\", \"hadn\"]",
         "objects[2].adjacent[1][1]: 'hadn' is unknown: did you mean 'hand'?");
  expect("\"count\": 4", "\"count\": 4.5", "scatter[0].count: 4.5 is no whole number: give one");
  expect("\"radius\": 0.5 }, \"spacing\": 0.2", "\"radius\": 0.5 }, \"spacing\": 1e-9",
         "clouds.ball: would have more than 1e8 points: give a larger 'spacing'");
  expect(", \"deform\": 1.5", "", "objects[4].wave: needs the effect 'deform': add \"deform\": 1.5 to 'effects'");
  expect("\"steps\": 20, ", "\"steps\": 20, \"steps\": 21, ", "says the key \"steps\" twice in one object: remove one");
  expect("{ \"sphere\": { \"radius\": 0.5 }, \"spacing\": 0.2 }", "\"nowhere.ply\"",
         "clouds.ball: no such file: nowhere.ply: check the name");
  expect("\"dt\": 0.5", "\"dt\" 0.5",
         "is no JSON: line 26, column 98: syntax error while parsing object separator - unexpected number literal; "
         "expected ':': mend what stands there or just before");
}

TEST(SceneFile, RefusesWhatIsNoScene)
{
  EXPECT_THAT(errorOf(""), HasSubstr("is no JSON"));
  EXPECT_THAT(errorOf("[]"), HasSubstr("is no object"));
  EXPECT_THAT(errorOf("{}"), HasSubstr("'clouds' is missing"));
  EXPECT_THAT(errorOf(R"({"clouds": {}, "objects": []})"), HasSubstr("objects: the scene has no objects"));
  EXPECT_THAT(errorOf(std::string(200, '[') + std::string(200, ']')),
              HasSubstr("nests deeper than 100 levels: flatten it"));
}

TEST(SceneFile, FindsCloudsBesideItself)
{
  const TemporaryFolder folder;
  folder.write("two.xyz", "0 0 0\n1 2 3\n");
  const auto scene =
      folder.write("scene.json", R"({"clouds": {"two": {"file": "two.xyz", "scale": 2, "shift": [1, 0, 0]}},
                                                    "objects": [{"name": "a", "cloud": "two"}]})");
  const SceneFile file = readSceneFile(scene);
  SceneWorld world(file);
  EXPECT_EQ(world.points(), 2u);
  EXPECT_EQ(world.scene()[0].parts[0].hierarchy->view().point(1), (Point3{3, 4, 6}));
}

TEST(ShapePoints, LieOnTheirSurfaces)
{
  const auto each = [](const std::vector<float>& xyz, const auto& check) {
    ASSERT_GT(xyz.size(), 30u);
    for (std::size_t i = 0; i < xyz.size(); i += 3) check(Eigen::Vector3d(xyz[i], xyz[i + 1], xyz[i + 2]));
  };
  each(shapePoints("sphere", {2, 2, 2}, 0.3), [](const Eigen::Vector3d& p) { EXPECT_NEAR(p.norm(), 2, 1e-5); });
  each(shapePoints("box", {1, 2, 3}, 0.3), [](const Eigen::Vector3d& p) {
    const Eigen::Array3d inside = Eigen::Array3d(0.5, 1, 1.5) - p.array().abs();
    EXPECT_NEAR(inside.minCoeff(), 0, 1e-5);
  });
  each(shapePoints("cylinder", {1, 2, 0}, 0.3),
       [](const Eigen::Vector3d& p) { EXPECT_NEAR(std::min(1 - p.head<2>().norm(), 1 - std::abs(p.z())), 0, 1e-5); });
  for (const char* shape : {"sphere", "box", "cylinder"}) {
    const auto count = static_cast<double>(shapePoints(shape, {1, 2, 3}, 0.1).size() / 3);
    EXPECT_LE(count, 2 * shapePointCount(shape, {1, 2, 3}, 0.1));
  }
}

} // namespace
} // namespace pcl_bsh::io
