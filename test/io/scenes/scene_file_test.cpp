// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/scenes/scene_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include "io/clouds/samples.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

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

TEST(SceneFile, ListsTheFilesThatItIsMadeOf)
{
  SceneFile file;
  file.clouds.resize(2);
  file.clouds[0].name = "hall";
  file.clouds[0].file = "hall.ply";
  file.clouds[1].shape = "sphere"; // no file
  file.trajectories = {"walk.txt"};
  const std::vector<std::pair<std::string, std::filesystem::path>> files = {{"cloud 'hall'", "hall.ply"},
                                                                            {"trajectory", "walk.txt"}};
  EXPECT_EQ(file.files(), files);
}

TEST(SceneFile, ReadsEverything)
{
  const SceneFile file = parseScene(whole, "scene.json");
  ASSERT_EQ(file.clouds.size(), 3u);
  EXPECT_EQ(file.clouds[0].size, Eigen::Vector3d(0.5, 0.5, 0.5)) << "a radius";
  EXPECT_EQ(file.clouds[1].size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.clouds[2].size, Eigen::Vector3d(1, 2, 1)) << "radius, height, open";
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
    world.setTime(world.scene().time() + file.dt);
    result = world.scene().step(file.dt);
    EXPECT_GT(result.cost(Effect::deform).pairs, 0u);
  }
  const Eigen::Vector3d moon = world.scene()[3].pose.translation();
  EXPECT_NEAR(moon.head<2>().norm(), 3, 0.5); // it falls, for there is no ground
  for (ObjectId i = 5; i < 9; ++i) {
    const Eigen::Array2d at = world.scene()[i].pose.translation().head<2>().array();
    EXPECT_TRUE((at >= 20).all() && (at <= 25).all()) << i;
  }
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
  expect("\"clearance\": 0.1", "\"clearance\": -1", "clearance: -1 is too small: give at least 0");
  expect("\"clearance\": 0.1", "\"clearance\": \"x\"", "clearance: \"x\" is no number: give one");
  expect("\"speed\": 2, \"turning\"", "\"speed\": null, \"turning\"",
         "objects[3].motion.circular.speed: null is no number: give one");
  expect("[1, 2, 3]", "[1, 2]", "clouds.crate.box.size: [1,2] is no list of 3 numbers: give [x, y, z]");
  expect("\"radius\": 0.5 }", "\"radius\": 0 }", "clouds.ball.sphere.radius: 0 is too small: give more than 0");
  expect("\"spacing\": 0.2 }", "\"spacing\": 1e-310 }",
         "clouds.ball.spacing: 1e-310 is too small: give at least 1e-30");
  expect("\"threads\": 1", "\"threads\": 1025", "threads: 1025 is too large: give at most 1024");
  expect("\"any\": true", "\"any\": 1", "effects.any: 1 is no boolean: give true or false");
  expect("\"distance\": \"all\"", "\"distance\": \"al\"", "effects.distance: 'al' is unknown: did you mean 'all'?");
  expect("\"distance\": \"all\"", "\"distance\": null",
         "effects.distance: null is no distance: give \"all\", or a length: pairs farther apart are left out");
  expect("[1, 0, 0], \"angular\"", "[1, 0, \"0\"], \"angular\"",
         "objects[2].motion.velocity.linear[2]: \"0\" is no number: give one");
  expect("{ \"velocity\": {", "{ \"velocty\": {",
         "objects[2].motion: key 'velocty' is unknown: did you mean 'velocity'?");
  expect("{ \"velocity\": { \"linear\": [1, 0, 0], \"angular\": [0, 0, 0.5] } }", "{}",
         "objects[2].motion: {} is no motion: give one of { \"velocity\": ... }, { \"circular\": ... }, "
         "{ \"waypoints\": ... } and { \"trajectory\": ... }");
  expect("\"name\": \"moon\", \"cloud\": \"ball\"", "\"name\": \"moon\"",
         "objects[3]: has none or several of 'cloud', 'parts', 'robot': give one");
  expect("[ [\"base\", \"arm\"]", "[ [\"base\"]", "objects[2].adjacent[0]: [\"base\"] is no pair: give two names");
  expect("\"center\": [0, 0, 0], ", "", "objects[3].motion.circular: 'center' is missing: add it");
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
  expect("\"spacing\": 0.2 }", "\"spacing\": 0.2, \"uncertainty\": -1 }",
         "clouds.ball.uncertainty: -1 is too small: give at least 0");
  expect("\"spacing\": 0.2 }", "\"spacing\": 0.2, \"uncertainty\": \"sigma\" }",
         "clouds.ball.uncertainty: names a field, which a sphere does not have: give a length");
  expect("\"spacing\": 0.2 }", "\"spacing\": 0.2, \"uncertainty\": 0.1, \"sigmas\": 3 }",
         "clouds.ball.sigmas: is given, but the uncertainty is no field: give the length itself");
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

TEST(SceneFile, CloudsAreOfAFileOrOfAShape)
{
  const auto scene = [](const std::string& cloud) {
    return R"({"clouds": {"a": {)" + cloud +
           R"(}}, "objects": [{"name": "A", "cloud": "a"}], "effects": {"any": true}})";
  };
  const std::string ball = R"("sphere": {"radius": 1})", crate = R"("box": {"size": [1, 1, 1]})";
  EXPECT_THAT(errorOf(scene("")), HasSubstr("clouds.a: is neither or both of a file and a shape"));
  EXPECT_THAT(errorOf(scene(ball + R"(, "file": "a.pcd")")), HasSubstr("clouds.a: is neither or both"));
  EXPECT_THAT(errorOf(scene(ball + ", " + crate)), HasSubstr("clouds.a: is both a sphere and a box"));
}

/// As far as the scene goes.
TEST(SceneWorld, WarnsOfWhatMovesIntoAHollowMesh)
{
  const TemporaryFolder folder;
  folder.write("box.off", "OFF\n8 6 0\n-9 -9 -9\n9 -9 -9\n9 9 -9\n-9 9 -9\n-9 -9 9\n9 -9 9\n9 9 9\n-9 9 9\n"
                          "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const auto warnings = [&folder](const std::string& dt) {
    const auto scene = folder.write("scene.json", R"({
      "clouds": {"box": {"file": "box.off"}, "grain": {"sphere": {"radius": 0.1}, "spacing": 0.05}},
      "objects": [{"name": "vessel", "cloud": "box", "fixed": true},
                  {"name": "probe", "cloud": "grain", "pose": [25, 0, 0], "motion": {"velocity": {"linear": [-2.5, 0, 0]}}}],
      "effects": {"any": true}, "clearance": 0.1, "steps": 10, "dt": )" +
                                                      dt + "}");
    return SceneWorld(readSceneFile(scene)).warnings();
  };
  EXPECT_THAT(warnings("0.1"), testing::IsEmpty());
  EXPECT_THAT(warnings("1"), testing::ElementsAre(HasSubstr("vessel")));
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

/// A point that may be off by 0.25, and another 1 away that is uncertain as the scene says.
std::string verdictOf(const TemporaryFolder& folder, const std::string& uncertainty, const std::string& more = "")
{
  const auto scene = folder.write("scene.json", R"({"clouds": {
      "rough": {"file": "rough.csv", "uncertainty": 0.25}, "unsure": {"file": "unsure.csv", )" +
                                                    uncertainty + R"(}},
    "objects": [{"name": "a", "cloud": "rough"}, {"name": "b", "cloud": "unsure")" +
                                                    more + R"(}],
    "effects": {"any": true, "flags": true, "deform": 2}, "clearance": 0.5, "threads": 1})");
  try {
    SceneWorld world(readSceneFile(scene));
    const SceneResult result = world.scene().query();
    EXPECT_EQ(result.flags.size(), 2 * (result.any.size() + result.undecided.size()));
    return !result.any.empty() ? "colliding" : !result.undecided.empty() ? "undecided" : "free";
  }
  catch (const JsonError& error) {
    return error.what();
  }
}

TEST(SceneFile, CloudsMayBeUncertain)
{
  const TemporaryFolder folder;
  folder.write("rough.csv", "x,y,z\n0,0,0\n");
  folder.write("unsure.csv", "x,y,z,sigma\n1,0,0,0.125\n");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.25)"), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.2499)"), "free");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": "sigma", "sigmas": 2)"), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": "sigma")"), "free");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": "sigma", "scale": 0.125)"), "colliding"); // 0.5 - 0.25 - 0.125 / 8
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.125, "scale": 0.125)"), "colliding");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.126, "scale": 0.125)"), "undecided");
  const std::string wave = R"(, "wave": {"amplitude": [0, 0, 0], "length": 1, "period": 1})";
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": "sigma", "sigmas": 2)", wave), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.25)", wave), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("pose_uncertainty": "0.25")"), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("pose_uncertainty": "0.2499")"), "free");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.1, "pose_uncertainty": "0.1,0.06")"), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": 0.1, "pose_uncertainty": "0.1,0.06,1,0,0")"), "free") << "turns there";
  EXPECT_EQ(verdictOf(folder, R"("uncertainty": "sigma", "pose_uncertainty": "0.126")"), "undecided");
  EXPECT_EQ(verdictOf(folder, R"("pose_uncertainty": "0.25")", wave), "undecided");
  EXPECT_THAT(verdictOf(folder, R"("pose_uncertainty": "0.25,0.1")", wave),
              HasSubstr("clouds.unsure.pose_uncertainty: has an angle, and the wave of 'b' moves points"));
  EXPECT_THAT(verdictOf(folder, R"("pose_uncertainty": "x")"),
              HasSubstr("clouds.unsure.pose_uncertainty: 'x' is none: give T"));
  EXPECT_THAT(verdictOf(folder, R"("uncertainty": "sigm")"),
              HasSubstr("scene.json: clouds.unsure.uncertainty: field 'sigm' of its points' sigmas is missing"));
  EXPECT_THAT(verdictOf(folder, R"("uncertainty": "y", "shift": [0, -1, 0])"),
              HasSubstr("clouds.unsure.uncertainty: field 'y' of point 0 is -1"));
}

/// The view of a cloud of one file, scaled and shifted.
PointsView placed(const TemporaryFolder& folder, const std::string& file, const std::string& where,
                  std::unique_ptr<SceneWorld>& world)
{
  const auto scene = folder.write("scene.json", R"({"clouds": {"a": {"file": ")" + file + R"(", )" + where +
                                                    R"(}}, "objects": [{"name": "a", "cloud": "a"}]})");
  world = std::make_unique<SceneWorld>(readSceneFile(scene));
  return world->scene()[0].parts[0].hierarchy->view();
}

TEST(SceneFile, ShiftsLoseNothing)
{
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud = randomCloud<float>(50, 1, {});
  for (const pcl::PCLPointField& field : cloud.fields) // the last point is one that fits
    if (field.name.size() == 1 && field.name >= "x" && field.name <= "z")
      std::memset(&cloud.data[49 * cloud.point_step + field.offset], 0, sizeof(float));
  writeCloud(folder / "local.pcd", cloud);
  std::unique_ptr<SceneWorld> world;
  // In UTM coordinates, float32 counts in steps of a half.
  const PointsView far = placed(folder, "local.pcd", R"("shift": [500000, 5400000, 100])", world);
  EXPECT_EQ(far.scalar, Scalar::float64);
  const PointsView local = viewOf(cloud);
  const pcl::PCLPointCloud2& moved = world->cloud("a");
  ASSERT_EQ(moved.fields.size(), cloud.fields.size());
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Point3 p = local.point(i);
    EXPECT_EQ(far.point(i), (Point3{p[0] + 500000, p[1] + 5400000, p[2] + 100})) << i;
    for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
      const pcl::PCLPointField &was = cloud.fields[f], &is = moved.fields[f];
      ASSERT_EQ(is.name, was.name);
      if (was.name.size() == 1 && was.name >= "x" && was.name <= "z") continue;
      ASSERT_EQ(is.datatype, was.datatype);
      EXPECT_EQ(std::memcmp(&moved.data[i * moved.point_step + is.offset],
                            &cloud.data[i * cloud.point_step + was.offset], sizeOf(was)),
                0)
          << is.name;
    }
  }
  // Numbers that float32 can hold stay float32.
  EXPECT_EQ(placed(folder, "local.pcd", R"("scale": 2)", world).scalar, Scalar::float32);
  EXPECT_EQ(placed(folder, "local.pcd", R"("scale": 1)", world).scalar, Scalar::float32);
  EXPECT_EQ(placed(folder, "local.pcd", R"("shift": [1e39, 0, 0])", world).point(0)[0], 1e39)
      << "not infinite, so free";
}

TEST(SceneFile, RefusesShiftsBeyondAllNumbers)
{
  const TemporaryFolder folder;
  folder.write("far.xyz", "1e300 0 0\n");
  std::unique_ptr<SceneWorld> world;
  EXPECT_THAT(
      [&] { placed(folder, "far.xyz", R"("scale": 1e10)", world); },
      testing::ThrowsMessage<JsonError>(HasSubstr("clouds.a: scale and shift take point 0 beyond all numbers")));
}

TEST(SceneFile, TellsOfACloudWithoutAPoint)
{
  const TemporaryFolder folder;
  folder.write("some.xyz", "nan 0 0\n1 2 3\n");
  folder.write("none.xyz", "nan 0 0\n");
  std::unique_ptr<SceneWorld> world;
  placed(folder, "some.xyz", R"("scale": 1)", world);
  EXPECT_THAT(world->warnings(), testing::ElementsAre(HasSubstr("some.xyz: 1 of 2 points is not finite")));
  placed(folder, "none.xyz", R"("scale": 1)", world);
  EXPECT_THAT(world->warnings(),
              testing::ElementsAre(HasSubstr("none.xyz: has no finite point: nothing collides with it")));
}

/// Its points would be infinite, and so free, or one.
TEST(SceneFile, RefusesShapesThatFloatsCannotHold)
{
  for (const char* shape :
       {R"("sphere": {"radius": 1e39}, "spacing": 1e39)", R"("sphere": {"radius": 1e-300}, "spacing": 1e-300)",
        R"("box": {"size": [1, 1e39, 1]}, "spacing": 1e38)", R"("box": {"size": [1, -1, 1]})",
        R"("cylinder": {"radius": 1, "height": 1e39}, "spacing": 1e38)"}) {
    SCOPED_TRACE(shape);
    const std::string text = R"({"clouds": {"a": {)" + std::string(shape) +
                             R"(}}, "objects": [{"name": "A", "cloud": "a"}], "effects": {"any": true}})";
    EXPECT_THAT([&] { parseScene(text, "scene.json"); }, testing::ThrowsMessage<JsonError>(HasSubstr("clouds.a")));
  }
}

constexpr auto square = "OFF\n4 1 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n";

/// A point that stands over the middle of a square at a height.
std::string pointOver(const TemporaryFolder& folder, const std::string& height, const std::string& square_options,
                      const std::string& of_object = "")
{
  folder.write("square.off", square);
  folder.write("point.xyz", "1 1 " + height + "\n");
  return R"({"clouds": {"square": {"file": ")" + (folder / "square.off").string() + '"' + square_options +
         R"(}, "point": ")" + (folder / "point.xyz").string() +
         R"("}, "objects": [{"name": "square", "cloud": "square")" + of_object +
         R"(}, {"name": "point", "cloud": "point"}], "clearance": 0.1,
             "effects": {"any": true, "flags": true, "distance": "all", "deform": 1}})";
}

TEST(SceneFile, FilesWithFacesAreSurfaces)
{
  const TemporaryFolder folder;
  const auto collides = [&](const std::string& height, const std::string& square_options) {
    SceneWorld world(parseScene(pointOver(folder, height, square_options), "scene.json"));
    const SceneResult result = world.scene().query();
    return !result.flags.empty();
  };
  EXPECT_TRUE(collides("0.1", ""));
  EXPECT_FALSE(collides("0.10000000000000002", "")) << "the next double";
  EXPECT_FALSE(collides("0", R"(, "vertices_only": true)"));
  EXPECT_TRUE(collides("3.0625", R"(, "shift": [0, 0, 3])")) << "shifted as the vertices are";

  const SceneWorld world(parseScene(pointOver(folder, "0", ""), "scene.json"));
  const Obstacle* const surface = world.surface("square");
  ASSERT_NE(surface, nullptr);
  EXPECT_EQ(world.surface("point"), nullptr);
  EXPECT_EQ(surface->view().count, 2u);
  EXPECT_EQ(world.cloud("square").width, 4u) << "its vertices";
  EXPECT_EQ(world.points(), 3u) << "two triangles and a point";
}

TEST(SceneFile, RefusesWhatSurfacesCannotDo)
{
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& square_options, const std::string& of_object, const char* words) {
    EXPECT_THAT([&] { SceneWorld(parseScene(pointOver(folder, "0", square_options, of_object), "scene.json")); },
                testing::ThrowsMessage<JsonError>(HasSubstr(words)));
  };
  const std::string wave = R"(, "wave": {"amplitude": [0, 0, 0.1], "length": 2, "period": 1})";
  expect("", wave, "clouds.square: is a surface, and the wave of 'square' moves points: give 'vertices_only': true");
  SceneWorld(parseScene(pointOver(folder, "0", R"(, "vertices_only": true)", wave), "scene.json"));
  std::string ball = whole;
  ball.replace(ball.find("\"spacing\": 0.2"), 0, "\"vertices_only\": true, ");
  EXPECT_THAT([&] { parseScene(ball, "scene.json"); },
              testing::ThrowsMessage<JsonError>(HasSubstr("is about faces, and a sphere is points")));
  std::string named = whole;
  named.replace(named.find("\"spacing\": 0.2"), 0, "\"columns\": \"x,y,z\", ");
  EXPECT_THAT([&] { parseScene(named, "scene.json"); },
              testing::ThrowsMessage<JsonError>(HasSubstr("is about files, and a sphere is points")));
}

TEST(SceneFile, WhatTheCallbackThrowsComesOutUnchanged)
{
  const SceneFile file = parseScene(whole, "scene.json");
  for (const std::string at : {"ball", "pipe"})
    EXPECT_THROW(SceneWorld(file,
                            [&](const CloudSource& cloud) {
                              if (cloud.name == at) throw 3;
                            }),
                 int)
        << at;
  std::size_t clouds = 0;
  EXPECT_EQ(SceneWorld(file, [&](const CloudSource&) { ++clouds; }).scene().size(), 9u);
  EXPECT_EQ(clouds, 3u);
}

TEST(SceneFile, BoundsHowOftenScatteredObjectsBounce)
{
  const auto scene = [](const std::string& steps, const std::string& count) {
    return R"({"clouds": {"ball": {"sphere": {"radius": 1}}}, "steps": )" + steps + R"(, "dt": 1, "objects": [],
      "scatter": [{"name": "dust", "cloud": "ball", "count": )" +
           count + R"(, "low": [0, 0, 0], "high": [1, 1, 1], "speed": 1}]})";
  };
  EXPECT_EQ(errorOf(scene("1000", "10")), "none");
  for (const auto& [steps, count] : {std::pair("100000000", "1"), std::pair("10000", "1000000")})
    EXPECT_EQ(
        errorOf(scene(steps, count)),
        "scene.json: scatter[0]: bounces more than a million times until the scene ends: give a smaller 'speed' or "
        "'count', fewer 'steps', a smaller 'dt' or a larger box");
}

TEST(SceneFile, PrintedMatricesStandForTheirRotations)
{
  const SceneFile file = parseScene(with("[0, 0, 1, 5, 0, 1, 0, 6, -1, 0, 0, 7]",
                                         "[0.877583, -0.479426, 0, 5, 0.479426, 0.877583, 0, 6, 0, 0, 1, 7]"),
                                    "scene.json");
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_THAT(file.warnings[0], HasSubstr("objects[1].pose: |R'R - I| is "));
  EXPECT_LE(
      (file.objects[1].pose.linear().transpose() * file.objects[1].pose.linear() - Eigen::Matrix3d::Identity()).norm(),
      1e-14);
  EXPECT_THAT(parseScene(whole, "scene.json").warnings, testing::IsEmpty());
}

/// Its keys one by one, each with a value that is not its default.
TEST(SceneFile, EffectsAreThoseThatItLists)
{
  const auto effectsOf = [](const std::string& effects) {
    return parseScene(R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "objects": [{"name": "A", "cloud": "a"}],
                          "effects": {)" +
                          effects + "}}",
                      "scene.json")
        .options.effects;
  };
  EXPECT_TRUE(effectsOf("").none());
  for (const auto& [key, effect] : {std::pair{R"("any": true)", Effect::any},
                                    {R"("flags": true)", Effect::flags},
                                    {R"("distance": 2.5)", Effect::distance},
                                    {R"("contacts": 7)", Effect::contacts},
                                    {R"("first_contact": true)", Effect::first_contact},
                                    {R"("swept": true)", Effect::swept},
                                    {R"("self": true)", Effect::self},
                                    {R"("response": "stop")", Effect::stop},
                                    {R"("response": "slide")", Effect::slide},
                                    {R"("gravity": {})", Effect::gravity},
                                    {R"("deform": 1.5)", Effect::deform}}) {
    const Effects effects = effectsOf(key);
    for (std::size_t e = 0; e < kEffects; ++e)
      EXPECT_EQ(effects.has(static_cast<Effect>(e)), static_cast<Effect>(e) == effect) << key;
  }
  EXPECT_EQ(effectsOf(R"("distance": 2.5)").distance, 2.5);
  EXPECT_EQ(effectsOf(R"("contacts": 7)").contacts, 7u);
  EXPECT_EQ(effectsOf(R"("deform": 1.5)").deform, 1.5);
  EXPECT_EQ(effectsOf(R"("response": "none")").response, Response::none);
  EXPECT_EQ(effectsOf(R"("gravity": {})").gravity->down, Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(effectsOf(R"("gravity": {})").gravity->step_height, 0.3);
  const Effects falls = effectsOf(R"("gravity": {"down": [0, 2, 0], "step_height": 0.5})");
  EXPECT_EQ(falls.gravity->down, Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(falls.gravity->step_height, 0.5);
  EXPECT_THAT([&] { effectsOf(R"("gravity": {"down": [0, 0, 0]})"); },
              testing::ThrowsMessage<JsonError>(HasSubstr("effects.gravity.down: has length 0: give a direction")));
}

/// A scene of a floor and a crate. @param bodies of the effect @param crate more members of the crate
std::string withBodies(const std::string& bodies, const std::string& crate, const std::string& more = "")
{
  return R"({"clouds": {"a": {"box": {"size": [1, 1, 1]}}},
             "objects": [{"name": "floor", "cloud": "a", "fixed": true, "friction": 0.9, "pose": [0, 0, -2]},
                         {"name": "crate", "cloud": "a")" +
         crate + R"(}], "effects": {"any": true, "bodies": {)" + bodies + "}" + more + "}}";
}

TEST(SceneFile, BodiesAreWhatItSays)
{
  const SceneFile plain = parseScene(withBodies("", R"(, "body": {"mass": 40})"), "scene.json");
  ASSERT_TRUE(plain.bodies);
  EXPECT_EQ(plain.bodies->gravity, Eigen::Vector3d(0, 0, -9.81));
  EXPECT_EQ(plain.bodies->step, 1.0 / 240);
  EXPECT_EQ(plain.bodies->thickness, 0.001);
  EXPECT_EQ(plain.bodies->margin, 0.01);
  EXPECT_EQ(plain.bodies->most_push, 1.0);
  EXPECT_EQ(plain.bodies->damping, 0.0);
  EXPECT_FALSE(plain.objects[0].body.falls());
  EXPECT_EQ(plain.objects[0].body.material.friction, 0.9);
  EXPECT_TRUE(plain.objects[1].body.falls());
  EXPECT_EQ(plain.objects[1].body.mass, 40.0);
  EXPECT_FALSE(plain.objects[1].body.density);
  EXPECT_FALSE(plain.objects[1].body.inertia);
  EXPECT_EQ(plain.objects[1].body.material.friction, 0.7);
  EXPECT_EQ(plain.objects[1].body.material.restitution, 0.0);
  const SceneFile other = parseScene(
      withBodies(
          R"("gravity": [1, 2, 3], "step": 0.01, "thickness": 0.02, "margin": 0.03, "push": 0.5, "damping": 0.25)",
          R"(, "body": {"density": 2700, "inertia": [4, 5, 6]}, "friction": 0.4, "restitution": 0.1)"),
      "scene.json");
  EXPECT_EQ(other.bodies->gravity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(other.bodies->step, 0.01);
  EXPECT_EQ(other.bodies->thickness, 0.02);
  EXPECT_EQ(other.bodies->margin, 0.03);
  EXPECT_EQ(other.bodies->most_push, 0.5);
  EXPECT_EQ(other.bodies->damping, 0.25);
  EXPECT_EQ(other.objects[1].body.density, 2700.0);
  EXPECT_FALSE(other.objects[1].body.mass);
  EXPECT_EQ(other.objects[1].body.inertia, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(other.objects[1].body.material.friction, 0.4);
  EXPECT_EQ(other.objects[1].body.material.restitution, 0.1);
  EXPECT_FALSE(parseScene(whole, "scene.json").bodies);
  EXPECT_TRUE(plain.warnings.empty());
  std::string ruled = withBodies("", R"(, "body": {"mass": 40})");
  ruled.insert(1, R"("pairs": {"rules": [{"objects": ["floor", "crate"], "tested": false}]},)");
  EXPECT_THAT(parseScene(ruled, "scene.json").warnings,
              testing::ElementsAre("pairs: do not hold for bodies, which touch every object"));
}

TEST(SceneFile, RefusesWhatCannotBeABody)
{
  const auto expect = [](const std::string& text, const std::string& message) {
    EXPECT_EQ(errorOf(text), "scene.json: " + message) << text;
  };
  const std::string heavy = R"(, "body": {"mass": 40})";
  expect(withBodies("", ""), "effects.bodies: no object is a body: give one a 'body' with its mass or density");
  expect(withBodies("", R"(, "body": {})"), "objects[1].body: has none or several of 'mass', 'density': give one");
  expect(withBodies("", R"(, "body": {"mass": 1, "density": 1})"),
         "objects[1].body: has none or several of 'mass', 'density': give one");
  expect(withBodies("", R"(, "body": {"mass": 0})"), "objects[1].body.mass: 0 is too small: give more than 0");
  expect(withBodies("", R"(, "body": {"mass": null})"), "objects[1].body.mass: null is no number: give one");
  EXPECT_THAT(errorOf(withBodies("", R"(, "body": {"mass": NaN})")), HasSubstr("is no JSON"));
  expect(withBodies("", heavy + R"(, "friction": -0.1)"), "objects[1].friction: -0.1 is too small: give at least 0");
  expect(withBodies("", heavy + R"(, "restitution": 1.1)"), "objects[1].restitution: 1.1 is too large: give at most 1");
  expect(withBodies(R"("step": 0)", heavy), "effects.bodies.step: 0 is too small: give more than 0");
  expect(withBodies(R"("damping": 2)", heavy), "effects.bodies.damping: 2 is too large: give at most 1");
  expect(withBodies("", heavy + R"(, "fixed": true)"), "objects[1]: is a body and fixed: leave one out");
  expect(withBodies("", heavy + R"(, "motion": {"velocity": [1, 0, 0]})"),
         "objects[1]: is a body and has a motion: leave one out");
  std::string parts = withBodies("", heavy);
  parts.replace(parts.find(R"("crate", "cloud": "a")"), 21,
                R"("crate", "parts": [{"name": "b", "cloud": "a"}, {"name": "c", "cloud": "a"}])");
  expect(parts, "objects[1]: is a body and has several parts: leave one out");
  for (const auto& [effect, name] : {std::pair{R"("first_contact": true)", "first_contact"},
                                     {R"("swept": true)", "swept"},
                                     {R"("response": "stop")", "stop"},
                                     {R"("response": "slide")", "slide"},
                                     {R"("gravity": {})", "gravity"},
                                     {R"("deform": 1.5)", "deform"}})
    expect(withBodies("", heavy, std::string(", ") + effect),
           std::string("effects.bodies: does not go with the effect '") + name + "': leave one out");
  for (const auto& [member, key] : {std::pair{R"("body": {"mass": 40})", "body"},
                                    {R"("friction": 0.5)", "friction"},
                                    {R"("restitution": 0.5)", "restitution"}})
    expect(std::string(R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "objects": [{"name": "A", "cloud": "a", )") +
               member + "}]}",
           std::string("objects[0].") + key + ": needs the effect 'bodies': add \"bodies\": {} to 'effects'");
}

TEST(SceneFile, MotionsAreWhatItSays)
{
  const auto motionOf = [](const std::string& motion) {
    const SceneFile file = parseScene(
        R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "objects": [{"name": "A", "cloud": "a", "motion": {)" + motion +
            "}}]}",
        "scene.json");
    return file.objects.at(0).motion;
  };
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), linear(1, 2, 3), angular(0, 0.5, 0);
  const auto plain = std::get<VelocityMotion>(motionOf(R"("velocity": [1, 2, 3])"));
  EXPECT_EQ(plain.linear, linear);
  EXPECT_EQ(plain.angular, zero);
  const auto both = std::get<VelocityMotion>(motionOf(R"("velocity": {"linear": [1, 2, 3], "angular": [0, 0.5, 0]})"));
  EXPECT_EQ(both.linear, linear);
  EXPECT_EQ(both.angular, angular);
  const auto about_z = std::get<CircularMotion>(motionOf(R"("circular": {"center": [1, 2, 3], "speed": 4})"));
  EXPECT_EQ(about_z.center, linear);
  EXPECT_EQ(about_z.axis, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(about_z.speed, 4);
  EXPECT_TRUE(about_z.turning);
  const auto about_y = std::get<CircularMotion>(
      motionOf(R"("circular": {"center": [0, 0, 0], "speed": -4, "axis": [0, 0.5, 0], "turning": false})"));
  EXPECT_EQ(about_y.axis, angular);
  EXPECT_EQ(about_y.speed, -4);
  EXPECT_FALSE(about_y.turning);
  const auto ways = std::get<WaypointMotion>(
      motionOf(R"("waypoints": [{"time": -1, "pose": [1, 2, 3]}, {"time": 0.5, "pose": [0, 0, 0]}])"));
  EXPECT_EQ(ways.times, (std::vector<double>{-1, 0.5}));
  EXPECT_EQ(ways.poses[0].translation(), linear);
  EXPECT_EQ(ways.poses[1].translation(), zero);
}

TEST(SceneFile, OptionsAreWhatItSays)
{
  const auto parsed = [](const std::string& more) {
    return parseScene(R"({"clouds": {"can": {"cylinder": {"radius": 1, "height": 2}}},
                          "objects": [{"name": "A", "cloud": "can", "solid": false}])" +
                          more + "}",
                      "scene.json");
  };
  const SceneFile plain = parsed("");
  EXPECT_EQ(plain.clouds[0].size, Eigen::Vector3d(1, 2, 0)) << "closed";
  EXPECT_EQ(plain.clouds[0].spacing, 0.1);
  EXPECT_EQ(plain.options.threads, 0u) << "all of the machine's";
  EXPECT_EQ(plain.options.clearance, 0);
  EXPECT_EQ(plain.options.tolerance, 1e-4);
  EXPECT_EQ(plain.options.voxel_edge, 0);
  EXPECT_TRUE(plain.options.test_pairs);
  EXPECT_EQ(plain.steps, 1u);
  EXPECT_EQ(plain.dt, 0.1);
  EXPECT_EQ(plain.cloud_output, CloudOutput::none);
  EXPECT_FALSE(plain.objects[0].fixed);
  EXPECT_FALSE(plain.objects[0].solid);
  EXPECT_EQ(plain.objects[0].place, "objects[0]");
  const SceneFile other = parsed(R"(, "threads": 3, "tolerance": 0.5, "voxel_edge": 4, "steps": 0, "dt": 2,
      "pairs": {"default": "ignored"}, "effects": {"flags": true}, "outputs": {"clouds": "every"},
      "scatter": [{"name": "dust", "cloud": "can", "count": 1, "low": [0, 0, 0], "high": [9, 9, 9], "group": "dirt",
                   "speed": 1}])");
  EXPECT_EQ(other.options.threads, 3u);
  EXPECT_EQ(other.options.tolerance, 0.5);
  EXPECT_EQ(other.options.voxel_edge, 4);
  EXPECT_FALSE(other.options.test_pairs);
  EXPECT_EQ(other.steps, 0u);
  EXPECT_EQ(other.dt, 2);
  EXPECT_EQ(other.cloud_output, CloudOutput::every);
  EXPECT_EQ(other.objects[1].group, "dirt");
  EXPECT_TRUE(std::holds_alternative<WaypointMotion>(other.objects[1].motion));
}

/// Each with what it is about.
TEST(SceneFile, NamesThatMissOrMeetAreRefused)
{
  const auto expect = [](const std::string& rest, const std::string& message) {
    EXPECT_EQ(errorOf(R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "objects": [)" + rest + "}"),
              "scene.json: " + message)
        << rest;
  };
  const std::string object = R"({"name": "A", "cloud": "a"})";
  EXPECT_EQ(errorOf(R"({"clouds": {}, "objects": [)" + object + "]}"),
            "scene.json: objects[0].cloud: no cloud is called 'a': add it to 'clouds'");
  expect(R"({"name": "A", "parts": [{"name": "p", "cloud": "a"}, {"name": "q", "cloud": "a"},
                                    {"name": "p", "cloud": "a"}]}])",
         "objects[0].parts[2].name: 'p' is taken: give another name");
  const auto scatter = [](const std::string& count) {
    return R"({"name": "dust 1", "cloud": "a"}],
      "scatter": [{"name": "dust", "cloud": "a", "low": [0, 0, 0], "high": [9, 9, 9], "count": )" +
           count + "}]";
  };
  expect(scatter("2"), "scatter[0].name: 'dust 1' is taken: give another name");
  EXPECT_EQ(errorOf(R"({"clouds": {"a": {"sphere": {"radius": 1}}}, "objects": [)" + scatter("1") + "}"), "none");
  expect(object + R"(], "pairs": {"rules": [{"groups": ["g", "g"], "tested": true}]})",
         "pairs.rules[0].groups: no object has a group: give objects a 'group'");
  expect(object + R"(], "pairs": {"rules": [{"groups": ["g", "g"], "objects": ["A", "A"], "tested": true}]})",
         "pairs.rules[0]: has both or none of 'objects' and 'groups': give one");
}

TEST(SceneFile, TransformsOfAScanMayScaleWhereThatIsAllowed)
{
  const TemporaryFolder folder;
  folder.write("a.ptx", "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n1 2 3 0.5\n");
  const auto scene = [&](const std::string& option) {
    return SceneWorld(
        readSceneFile(folder.write("scene.json", R"({"clouds": {"a": {"file": "a.ptx")" + option +
                                                     R"(}}, "objects": [{"name": "A", "cloud": "a"}]})")));
  };
  EXPECT_THAT([&] { scene(""); },
              testing::ThrowsMessage<files::FileError>(HasSubstr("a.ptx: scan 0 has a transform that scales by 2")));
  EXPECT_EQ(scene(R"(, "allow_scale": true)").scene()[0].parts[0].hierarchy->view().point(0), (Point3{2, 4, 6}));
}

TEST(SceneFile, ColumnsOfACloudMayBeNamed)
{
  const TemporaryFolder folder;
  folder.write("a.xyz", "1 2 3 4\n5 6 7 8\n");
  const auto scene = [&](const std::string& cloud) {
    return folder.write("scene.json",
                        R"({"clouds": {"a": )" + cloud + R"(}, "objects": [{"name": "A", "cloud": "a"}]})");
  };
  const SceneFile file = readSceneFile(scene(R"({"file": "a.xyz", "columns": "z, _,x,y"})"));
  EXPECT_EQ(file.clouds[0].columns, (ColumnNames{"z", "_", "x", "y"}));
  EXPECT_EQ(SceneWorld(file).scene()[0].parts[0].hierarchy->view().point(1), (Point3{7, 8, 5}));
  EXPECT_THAT([&] { readSceneFile(scene(R"({"file": "a.xyz", "columns": "x,,z"})")); },
              testing::ThrowsMessage<JsonError>(
                  HasSubstr("clouds.a.columns: has a column without a name: give one name for each column")));
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THAT([&] { readSceneFile(scene(R"("sub")")); },
              testing::ThrowsMessage<JsonError>(
                  HasSubstr("clouds.a: " + (folder / "sub").string() + " is a folder: name a file")));
}

} // namespace
} // namespace pcl_bsh::io
