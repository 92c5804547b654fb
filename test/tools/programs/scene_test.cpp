// SPDX-License-Identifier: BSD-3-Clause
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

constexpr auto crash = R"({
  "clouds": { "ball": { "sphere": { "radius": 0.5 }, "spacing": 0.1 } },
  "objects": [ { "name": "still", "cloud": "ball", "fixed": true },
               { "name": "moving ball", "cloud": "ball", "pose": [-2, 0, 0], "motion": { "velocity": [1, 0, 0] } } ],
  "clearance": 0.05, "tolerance": 0.001, "steps": 4, "dt": 0.5,
  "effects": { EFFECTS },
  "outputs": { "clouds": "CLOUDS" }
})";

std::string crashWith(const std::string& effects, const std::string& clouds = "none")
{
  std::string text = crash;
  text.replace(text.find("EFFECTS"), 7, effects);
  text.replace(text.find("CLOUDS"), 6, clouds);
  return text;
}

TEST(SceneProgram, RunsAScene)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("crash.json", crashWith(R"("any": true, "flags": true)", "last")).string();
  const std::string out = (folder / "out").string();
  const Outcome done = run("pcl_bsh_scene", scene + " --out " + out);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("5 steps"));
  EXPECT_THAT(done.out, HasSubstr("pairs collide in 3 of them"));
  const std::string csv = io::contentOf(folder / "out" / "steps.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  EXPECT_THAT(csv, HasSubstr("step,time_s,moved_objects,candidate_pairs,colliding_pairs,any_queries"));
  EXPECT_THAT(csv, testing::Not(HasSubstr("slide")));
  const std::string lines = io::contentOf(folder / "out" / "steps.jsonl");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 5);
  const Json last = Json::parse(lines.substr(lines.rfind('\n', lines.size() - 2) + 1));
  EXPECT_EQ(last["any"][0]["b"], "moving ball");
  const Json summary = Json::parse(io::contentOf(folder / "out" / "summary.json"));
  EXPECT_EQ(summary["effects"].size(), 2u);
  EXPECT_GT(summary["effects"]["any"]["work"]["node_pairs"], 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "moving_ball_000004.pcd"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out" / "moving_ball_000003.pcd"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out" / "steps.csv.part"));
}

TEST(SceneProgram, SaysThatNothingIsTested)
{
  const io::TemporaryFolder folder;
  const auto told = [&](const std::string& objects, const std::string& more = "", const char* effect = "any") {
    const std::string scene =
        folder
            .write("fixed.json", R"({"clouds": {"ball": {"sphere": {"radius": 0.5}, "spacing": 0.1}}, "objects": [)" +
                                     objects + R"(], "clearance": 0.05, "steps": 2, "effects": {")" + effect +
                                     R"(": true})" + more + "}")
            .string();
    const Outcome done = run("pcl_bsh_scene", scene + " --out " + (folder / "out").string());
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const bool tests = Json::parse(io::contentOf(folder / "out" / "summary.json"))["tests_pairs"];
    EXPECT_EQ(done.out.find("; no pair of objects was tested") == std::string::npos, tests);
    return done.err;
  };
  const std::string a = R"({"name": "a", "cloud": "ball", "fixed": true})",
                    b = R"({"name": "b", "cloud": "ball", "fixed": true, "group": "doors", "pose": [0.5, 0, 0]})",
                    c = R"({"name": "c", "cloud": "ball", "group": "doors"})";
  EXPECT_THAT(told(a + "," + b), HasSubstr("no pair of objects is tested: all 2 objects are fixed: "));
  EXPECT_THAT(told(a + "," + b, "", "swept"), HasSubstr("no pair of objects is tested: all 2 objects are fixed: "));
  EXPECT_THAT(told(a), HasSubstr("no pair of objects is tested: there is one object"));
  const auto is_tested = testing::Not(HasSubstr("no pair"));
  EXPECT_THAT(told(a + "," + b, R"(, "pairs": {"rules": [{"objects": ["a", "b"], "tested": true}]})"), is_tested);
  EXPECT_THAT(told(a + "," + b + "," + c), is_tested);
  EXPECT_THAT(told(b + "," + c, R"(, "pairs": {"rules": [{"groups": ["doors", "doors"], "tested": false}]})"),
              HasSubstr("no pair of objects is tested: rules leave out all of them: "));
}

/// Each triangle has a flag of its own, in a format that holds faces.
TEST(SceneProgram, SurfacesAreWrittenWithTheirFaces)
{
  const io::TemporaryFolder folder;
  folder.write("plate.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  folder.write("point.xyz", "0.75 0.25 0.125\n");
  folder.write("scene.json", R"({"clouds": {"plate": "plate.off", "point": "point.xyz"}, "objects": [
      {"name": "plate", "cloud": "plate"}, {"name": "point", "cloud": "point"}],
      "clearance": 0.125, "effects": {"flags": true}, "outputs": {"clouds": "last"}, "steps": 0})");
  const Outcome done = run("pcl_bsh_scene", "scene.json --out out", folder.path());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const io::Mesh plate = io::readMesh(folder / "out" / "plate_000000.ply");
  EXPECT_EQ(plate.triangles.size(), 2u);
  ASSERT_EQ(plate.face_values.size(), 1u);
  EXPECT_EQ(plate.face_values[0].name, "collision");
  EXPECT_EQ(plate.face_values[0].values, (std::vector<double>{1, 0}));
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "point_000000.pcd"));
}

TEST(SceneProgram, EachObjectHasFilesOfItsOwn)
{
  const io::TemporaryFolder folder;
  std::string text = crashWith(R"("any": true, "flags": true)", "last");
  text.replace(
      text.find("{ \"name\": \"still\""), 0,
      R"({ "name": "moving_ball", "cloud": "ball", "fixed": true }, { "name": "Moving_Ball", "cloud": "ball", "pose":
                  [0.1, 0, 0], "fixed": true }, )");
  const std::string scene = folder.write("crash.json", text).string();
  const Outcome done = run("pcl_bsh_scene", scene + " --out " + (folder / "out").string());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  for (const char* name : {"moving_ball_000004.pcd", "Moving_Ball-2_000004.pcd", "moving_ball-3_000004.pcd"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
}

TEST(SceneProgram, TimesAreWrittenToTheLastDigit)
{
  const io::TemporaryFolder folder;
  std::string text = crashWith(R"("any": true)");
  text.replace(text.find("\"dt\": 0.5"), 9, "\"dt\": 0.0000001234567");
  const std::string scene = folder.write("crash.json", text).string();
  ASSERT_EQ(run("pcl_bsh_scene", scene + " --out " + (folder / "out").string()).exit_code, 0);
  std::istringstream rows(io::contentOf(folder / "out/steps.csv"));
  std::string row;
  std::getline(rows, row);
  for (int step = 0; std::getline(rows, row); ++step) {
    const std::size_t comma = row.find(',');
    EXPECT_NEAR(std::stod(row.substr(comma + 1)), step * 0.0000001234567, 1e-18) << row;
  }
}

TEST(SceneProgram, KeepsItsInputs)
{
  const io::TemporaryFolder folder;
  const std::string text = crashWith(R"("any": true, "flags": true)", "last");
  folder.write("summary.json", text);
  const Outcome over = run("pcl_bsh_scene", "summary.json --out .", folder.path());
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_EQ(over.err,
            "pcl_bsh_scene: --out: ./summary.json: is the file of SCENE, which is read: choose another name\n");
  EXPECT_EQ(io::contentOf(folder / "summary.json"), text);

  folder.write("still_000004.xyz", "0 0 0\n");
  folder.write("still_000004.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n0 0 0\n");
  std::string own = text;
  own.replace(own.find(R"({ "sphere")"), 47, R"("still_000004.pcd")");
  folder.write("own.json", own);
  const Outcome cloud = run("pcl_bsh_scene", "own.json --out .", folder.path());
  EXPECT_EQ(cloud.exit_code, 2);
  EXPECT_THAT(cloud.err, HasSubstr("--out: ./still_000004.pcd: is the file of cloud 'ball', which is read"));

  const std::string path = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n";
  folder.write("steps.csv", path);
  folder.write("moved.json", R"({"clouds": {"a": "still_000004.xyz"}, "effects": {"any": true}, "objects": [
    {"name": "A", "cloud": "a"},
    {"name": "B", "cloud": "a", "motion": {"trajectory": {"file": "steps.csv"}}}]})");
  for (const char* arguments : {"pcl_bsh_scene moved.json --out ."}) {
    const std::string program = std::string(arguments).substr(0, std::string(arguments).find(' '));
    const Outcome moved = run(program, std::string(arguments).substr(program.size()), folder.path());
    EXPECT_EQ(moved.exit_code, 2) << moved.err;
    EXPECT_THAT(moved.err, HasSubstr("steps.csv: is the file of "));
    EXPECT_EQ(io::contentOf(folder / "steps.csv"), path);
  }
}

TEST(SceneProgram, ResponsesKeepObjectsApart)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("crash.json", crashWith(R"("any": true, "response": "stop")")).string();
  const Outcome done = run("pcl_bsh_scene", scene);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("pairs collide in 0 of them"));
  EXPECT_THAT(done.out, HasSubstr(", 3 moves met something"));
}

TEST(SceneProgram, SaysWhatLessAccuracyLeavesOpen)
{
  const io::TemporaryFolder folder;
  const auto sceneAt = [&](const std::string& accuracy) {
    std::string text = crashWith(R"("any": true, "flags": true, "distance": "all")");
    text.insert(text.find("\"steps\""), "\"accuracy\": \"" + accuracy + "\", ");
    return folder.write("crash.json", text).string();
  };
  const std::string out = (folder / "out").string();
  const Outcome done = run("pcl_bsh_scene", sceneAt("pairs=0") + " --out " + out);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const std::string lines = io::contentOf(folder / "out" / "steps.jsonl");
  std::istringstream each(lines);
  std::size_t open = 0;
  for (std::string line; std::getline(each, line);) {
    const Json step = Json::parse(line);
    EXPECT_EQ(step["distance"][0]["interval"].size(), 2u);
    if (step["undecided"].empty()) continue;
    ++open;
    EXPECT_TRUE(step["any"].empty());
    EXPECT_EQ(step["undecided"][0], (Json{{"a", "still"}, {"b", "moving ball"}}));
    ASSERT_FALSE(step["flags"].empty());
    EXPECT_GT(step["flags"][0]["undecided"], 0);
    EXPECT_EQ(step["flags"][0]["points"], 0);
  }
  EXPECT_GT(open, 0u);
  EXPECT_THAT(done.out, HasSubstr("of them, are undecided in " + std::to_string(open)));
  EXPECT_EQ(Json::parse(io::contentOf(folder / "out" / "summary.json"))["accuracy"], "pairs=0");
  EXPECT_THAT(run("pcl_bsh_scene", sceneAt("level=2") + " --explain").out,
              HasSubstr("accuracy of any, flags, distance and self: level=2"));

  const Outcome wrong = run("pcl_bsh_scene", sceneAt("roughly") + " --out " + out);
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("crash.json: accuracy: 'roughly' is no accuracy: give exact, "));
}

TEST(SceneProgram, SaysWhatUncertainPointsLeaveOpen)
{
  const io::TemporaryFolder folder;
  std::string text = crashWith(R"("any": true, "flags": true, "first_contact": true, "swept": true)", "last");
  text.insert(text.find("\"spacing\""), "\"uncertainty\": 0.1, ");
  const std::string scene = folder.write("crash.json", text).string(), out = (folder / "out").string();
  const Outcome done = run("pcl_bsh_scene", scene + " --out " + out);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  std::istringstream each(io::contentOf(folder / "out" / "steps.jsonl"));
  std::size_t open = 0, met = 0;
  for (std::string line; std::getline(each, line);) {
    const Json step = Json::parse(line);
    open += step["undecided"].size();
    EXPECT_TRUE(step["any"].empty()); // twice 0.1 exceeds the clearance
    EXPECT_TRUE(step["certain_contact"].empty());
    met += step["first_contact"].size();
    for (const Json& part : step["flags"]) EXPECT_EQ(part["points"], 0);
    EXPECT_EQ(step["flags"].empty(), step["undecided"].empty());
  }
  EXPECT_GT(open, 0u);
  EXPECT_GT(met, 0u);
  EXPECT_THAT(io::contentOf(folder / "out" / "steps.csv"), HasSubstr(",colliding_pairs,undecided_pairs,"));
  EXPECT_THAT(run("pcl_bsh_scene", scene + " --explain").out, HasSubstr("points of cloud 'ball' may be elsewhere"));
}

TEST(SceneProgram, SaysWhatItDidNotSweep)
{
  const io::TemporaryFolder folder;
  const auto runOf = [&](const std::string& wave) {
    std::string text = crashWith(R"("first_contact": true, "swept": true, "deform": 1.5)");
    text.insert(text.find("\"motion\""), wave);
    return run("pcl_bsh_scene",
               folder.write("crash.json", text).string() + " --json --out " + (folder / "out").string());
  };
  const Outcome waving = runOf(R"("wave": { "amplitude": [0, 0, 0.01], "length": 1, "period": 2 }, )");
  ASSERT_EQ(waving.exit_code, 0) << waving.err;
  EXPECT_EQ(Json::parse(waving.out)["unswept_steps"], 4);
  std::istringstream each(io::contentOf(folder / "out" / "steps.jsonl"));
  std::size_t met = 0;
  for (std::string line; std::getline(each, line);) {
    const Json step = Json::parse(line);
    met += step["first_contact"].size();
    if (step["step"] == 0)
      EXPECT_TRUE(step["unswept"].empty());
    else
      EXPECT_EQ(step["unswept"],
                (Json{{{"object", "moving ball"}, {"added", false}, {"reshaped", true}, {"detoured", false}}}));
  }
  EXPECT_GT(met, 0u) << "an object that deforms in each step is swept";
  const std::string csv = io::contentOf(folder / "out" / "steps.csv");
  EXPECT_THAT(csv.substr(0, csv.find('\n')), testing::EndsWith(",unswept_objects"));

  const Outcome rigid = runOf("");
  ASSERT_EQ(rigid.exit_code, 0) << rigid.err;
  EXPECT_EQ(Json::parse(rigid.out)["unswept_steps"], 0);
}

TEST(SceneProgram, ExplainsAndValidatesWithoutRunning)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("crash.json", crashWith(R"("any": true)")).string();
  const Outcome explained = run("pcl_bsh_scene", scene + " --explain");
  EXPECT_EQ(explained.exit_code, 0);
  EXPECT_THAT(explained.out, HasSubstr("any: which pairs collide"));
  EXPECT_THAT(explained.out, HasSubstr("flags distance contacts first_contact swept self stop slide gravity deform"));
  const Outcome valid = run("pcl_bsh_scene", scene + " --validate");
  EXPECT_EQ(valid.exit_code, 0);
  EXPECT_THAT(valid.out, HasSubstr("is valid: 2 objects"));
}

TEST(SceneProgram, TellsProgramsTheSameAsPeople)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("crash.json", crashWith(R"("any": true, "response": "stop")")).string();
  const Outcome valid = run("pcl_bsh_scene", scene + " --validate --json");
  EXPECT_EQ(valid.exit_code, 0) << valid.err;
  EXPECT_EQ(Json::parse(valid.out), (Json{{"scene", scene}, {"valid", true}, {"objects", 2}}));

  const Json explained = Json::parse(run("pcl_bsh_scene", scene + " --explain --json").out);
  EXPECT_EQ(explained["effects"].size(), 2u);
  EXPECT_THAT(explained["effects"]["any"].get<std::string>(), HasSubstr("which pairs collide"));
  EXPECT_EQ(explained["effects"].size() + explained["off"].size(), 13U);
  EXPECT_EQ(explained["built"], (Json{{"voxels", true}, {"spheres", true}, {"grid", true}}));
  EXPECT_EQ(explained["fixed_objects"], 1);
  EXPECT_EQ(explained["accuracy"], "exact");
  const std::string idle = folder.write("idle.json", crashWith("")).string();
  EXPECT_EQ(Json::parse(run("pcl_bsh_scene", idle + " --explain --json").out)["built"],
            (Json{{"voxels", true}, {"spheres", false}, {"grid", false}}));

  const Outcome done = run("pcl_bsh_scene", scene + " --json --out " + (folder / "out").string());
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const Json summary = Json::parse(done.out);
  EXPECT_EQ(summary, Json::parse(io::contentOf(folder / "out" / "summary.json")));
  EXPECT_EQ(summary["steps"], 5);
  EXPECT_EQ(summary["colliding_steps"], 0);
  EXPECT_EQ(summary["moves"]["touched"], 3);

  folder.write("arm.urdf", R"(<robot name="arm"><link name="foot"><collision><geometry><box size="1 1 1"/></geometry>
    </collision></link></robot>)");
  folder.write("states.csv", "elbow\n1\n");
  const std::string wrong = folder.write("wrong.json", crashWith(R"("ani": true)")).string();
  const std::string states = R"({"urdf": "arm.urdf", "states": "states.csv", "interval": 1})";
  const std::string no_such_joint =
      folder
          .write("robot.json",
                 R"({"clouds": {}, "effects": {"any": true}, "objects": [{"name": "arm", "robot": )" + states + "}]}")
          .string();
  for (const std::string& scene : {wrong, no_such_joint}) {
    const Outcome refused = run("pcl_bsh_scene", scene + " --validate --json");
    EXPECT_EQ(refused.exit_code, 1);
    ASSERT_NE(refused.out, "") << refused.err;
    const Json told = Json::parse(refused.out);
    EXPECT_EQ(told["valid"], false);
    EXPECT_EQ("pcl_bsh_scene: " + told["error"].get<std::string>() + "\n", refused.err);
  }
}

constexpr auto fall = R"({
  "clouds": { "plate": { "box": { "size": [2, 2, 0.1] }, "spacing": 0.1 },
              "crate": { "box": { "size": [0.4, 0.4, 0.4] }, "spacing": 0.1 } },
  "objects": [ { "name": "plate", "cloud": "plate", "fixed": true, "pose": [0, 0, -0.05] },
               { "name": "crate", "cloud": "crate", "pose": [0.1, 0, HEIGHT], "body": { "mass": 10 } } ],
  "steps": 30, "dt": 0.1, "effects": { "distance": 5, "bodies": {} }
})";

std::string fallFrom(const std::string& height)
{
  std::string text = fall;
  return text.replace(text.find("HEIGHT"), 6, height);
}

TEST(SceneProgram, ExplainsBodies)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("fall.json", fallFrom("0.5")).string();
  const Json explained = Json::parse(run("pcl_bsh_scene", scene + " --explain --json").out);
  EXPECT_THAT(explained["effects"]["bodies"].get<std::string>(), HasSubstr("fall, slide and rest"));
  EXPECT_THAT(run("pcl_bsh_scene", scene + " --explain").out, HasSubstr("\n  bodies: objects with a 'body' fall"));
  const std::string other = folder.write("crash.json", crashWith(R"("any": true)")).string();
  EXPECT_THAT(Json::parse(run("pcl_bsh_scene", other + " --explain --json").out)["off"], testing::Contains("bodies"));
}

TEST(SceneProgram, BodiesFallAndRest)
{
#ifndef PCL_BSH_BODIES
  GTEST_SKIP() << "pcl_bsh::physics is not built: install libbullet-dev";
#endif
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("fall.json", fallFrom("0.5")).string();
  const Outcome done = run("pcl_bsh_scene", scene + " --out " + (folder / "out").string());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.told(), "");
  EXPECT_THAT(done.out, HasSubstr("720 solutions"));
  const std::string csv = io::contentOf(folder / "out" / "steps.csv");
  EXPECT_THAT(csv, HasSubstr(",awake_bodies,body_contacts,bodies_steps,bodies_queries,bodies_cut,bodies_node_pairs,"
                             "bodies_seconds\n"));
  const std::string lines = io::contentOf(folder / "out" / "steps.jsonl");
  const Json first = Json::parse(lines.substr(0, lines.find('\n')));
  EXPECT_EQ(first["bodies"][0]["pose"], (Json{1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0.5}));
  EXPECT_TRUE(first["body_contacts"].empty());
  const Json last = Json::parse(lines.substr(lines.rfind('\n', lines.size() - 2) + 1));
  EXPECT_EQ(last["bodies"][0]["object"], "crate");
  EXPECT_EQ(last["bodies"][0]["asleep"], true);
  EXPECT_NEAR(last["bodies"][0]["pose"][11].get<double>(), 0.25, 0.01) << "two clouds rest by half a spacing";
  EXPECT_EQ(last["body_contacts"][0]["a"], "plate");
  EXPECT_EQ(last["body_contacts"][0]["b"], "crate");
  EXPECT_GE(last["body_contacts"][0]["points"].size(), 3u);
  EXPECT_LT(last["body_contacts"][0]["points"][0]["normal"][2], -0.5) << "from crate to plate";
  EXPECT_NEAR(last["distance"][0]["distance"].get<double>(), 0.05, 0.01);
  const Json summary = Json::parse(io::contentOf(folder / "out" / "summary.json"));
  EXPECT_EQ(summary["effects"]["bodies"]["steps"], 720);
  EXPECT_GT(summary["effects"]["bodies"]["contacts"], 0);

  const std::string sunk = folder.write("sunk.json", fallFrom("0.19")).string();
  EXPECT_THAT(run("pcl_bsh_scene", sunk).err, HasSubstr("objects 'plate' and 'crate' begin in each other"));
}

TEST(SceneProgram, RefusesBodiesThatDoNotClose)
{
#ifndef PCL_BSH_BODIES
  GTEST_SKIP() << "pcl_bsh::physics is not built: install libbullet-dev";
#endif
  const io::TemporaryFolder folder;
  folder.write("sheet.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string scene = folder
                                .write("sheet.json", R"({"clouds": {"sheet": "sheet.off"}, "objects": [
                                  {"name": "leaf", "cloud": "sheet", "body": {"mass": 1}}], "effects": {"bodies": {}}})")
                                .string();
  const Outcome refused = run("pcl_bsh_scene", scene + " --out " + (folder / "out").string());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("pcl_bsh_scene: " + scene + ": object 'leaf': "));
  EXPECT_THAT(refused.err, HasSubstr("3 edges are open"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out" / "steps.csv"));
}

TEST(SceneProgram, WithoutBodiesNoneOfTheirCodeRuns)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("crash.json", crashWith(R"("any": true)")).string();
  ASSERT_EQ(run("pcl_bsh_scene", scene + " --out " + (folder / "out").string()).exit_code, 0);
  EXPECT_THAT(io::contentOf(folder / "out" / "steps.csv"), testing::Not(HasSubstr("bodies")));
  EXPECT_THAT(io::contentOf(folder / "out" / "steps.jsonl"), testing::Not(HasSubstr("bod")));
  EXPECT_FALSE(Json::parse(io::contentOf(folder / "out" / "summary.json"))["effects"].contains("bodies"));
}

TEST(SceneProgram, FailsInOneLine)
{
  const io::TemporaryFolder folder;
  const std::string scene = folder.write("crash.json", crashWith(R"("ani": true)")).string();
  const Outcome wrong = run("pcl_bsh_scene", scene + " --out " + (folder / "out").string());
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.err, "pcl_bsh_scene: " + scene + ": effects: key 'ani' is unknown: did you mean 'any'?\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  EXPECT_EQ(run("pcl_bsh_scene", "nowhere.json").exit_code, 1);
  EXPECT_EQ(run("pcl_bsh_scene", "").exit_code, 2);
  EXPECT_EQ(run("pcl_bsh_scene", scene + " --fast").exit_code, 2);
  EXPECT_EQ(run("pcl_bsh_scene", "--help").exit_code, 0);
}

TEST(SceneProgram, SamplesAreSound)
{
  for (const char* sample : {"drift.json", "tunnel.json", "falling_stone.json", "push.json", "carry.json"}) {
    const Outcome valid =
        run("pcl_bsh_scene", std::string(PCL_BSH_SOURCE_DIR) + "/examples/scenes/" + sample + " --validate");
    EXPECT_EQ(valid.exit_code, 0) << valid.err;
  }
}

} // namespace
} // namespace pcl_bsh
