// SPDX-License-Identifier: BSD-3-Clause
// The effect clashes of pcl_bsh_scene, against pcl_bsh_collide with the same things.
#include "program_run.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::Not;
using ListJson = nlohmann::json;

/// A floor of points, a press that stands, a mill that drives over the floor, and a drone above.
class SceneClashes : public testing::Test {
protected:
  SceneClashes() { setenv("SOURCE_DATE_EPOCH", "1700000000", 1); }
  ~SceneClashes() override { unsetenv("SOURCE_DATE_EPOCH"); }

  static std::string floorXyz()
  {
    std::ostringstream text;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; j <= 30; ++j) text << 0.1 * i << ' ' << 0.1 * j << ' ' << 0.01 * ((i * 7 + j * 3) % 5) << '\n';
    return text.str();
  }

  /// @param effect its members after `of`. @param more members of the scene
  std::string scene(int steps, const std::string& effect = "", const std::string& more = "",
                    const std::string& objects = "") const
  {
    return R"({"clouds": {"floor": "floor.xyz", "crate": "crate.off", "copy": "copy.off"}, "objects": [
      {"name": "hall", "cloud": "floor", "fixed": true},
      {"name": "press", "cloud": "crate", "pose": [0.55, 0.35, 0.1, 0, 0, 0]},
      {"name": "mill", "cloud": "copy", "solid": true, "pose": [2.05, 0.5, -0.25, 0, 0, 0.25],
       "motion": {"velocity": [0.5, 0, 0.25]}})" +
           objects + R"(], "clearance": 0.125, "dt": 0.5, "steps": )" + std::to_string(steps) +
           R"(, "effects": {"clashes": {"of": "hall")" + effect + "}}" + more + "}";
  }

  Outcome runScene(const std::string& text, const std::string& arguments) const
  {
    folder.write("scene.json", text);
    return run("pcl_bsh_scene", "scene.json " + arguments, folder.path());
  }

  std::string text(const std::string& file) const { return io::contentOf(folder / file); }
  ListJson json(const std::string& file) const { return ListJson::parse(text(file)); }

  void expectSameFiles(const std::string& one, const std::string& other) const
  {
    for (const char* extension : {".json", ".csv", ".html"}) {
      EXPECT_EQ(text(one + extension), text(other + extension)) << extension;
      EXPECT_FALSE(text(one + extension).empty());
    }
  }

  static std::string lists(const std::string& name)
  {
    std::string options;
    for (const char* extension : {".json", ".csv", ".html"}) options += " --clashes " + name + extension;
    return options + " ";
  }

  io::TemporaryFolder folder;
  std::filesystem::path floor = folder.write("floor.xyz", floorXyz());
  std::filesystem::path crate =
      folder.write("crate.off", "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  std::filesystem::path copy = folder.write("copy.off", io::contentOf(crate));
  const std::string machines = "--obstacle \"press=crate.off;pose=0.55,0.35,0.1,0,0,0\" --obstacle "
                               "\"mill=copy.off;pose=2.05,0.5,-0.25,0,0,0.25;solid=true\" ";
};

TEST_F(SceneClashes, OfOneStepAreThoseOfTheSameObstacles)
{
  const Outcome done = runScene(scene(0, R"(, "between": true)"), lists("steps") + "--unit m --out out");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ASSERT_EQ(run("pcl_bsh_collide",
                "floor.xyz marked.pcd --clearance 0.125 --between --unit m " + machines + lists("collide"),
                folder.path())
                .exit_code,
            0);
  expectSameFiles("steps", "collide");
  EXPECT_THAT(done.out, HasSubstr("press: clash of"));
  EXPECT_THAT(done.out, HasSubstr("press and mill: clear"));
  const ListJson summary = json("out/summary.json")["clashes"];
  EXPECT_EQ(summary["of"], "hall");
  EXPECT_EQ(summary["obstacles"][1]["name"], "mill");
  EXPECT_EQ(summary["obstacles"][1]["state"], "clash");
  EXPECT_EQ(summary["between"].size(), 1U);
  EXPECT_EQ(summary["clashes"], json("steps.json")["clashes"].size());
}

TEST_F(SceneClashes, OfARunAreThoseAlongThePathOfItsSteps)
{
  const char* const alone = R"({"clouds": {"floor": "floor.xyz", "copy": "copy.off"}, "objects": [
      {"name": "hall", "cloud": "floor", "fixed": true},
      {"name": "mill", "cloud": "copy", "solid": true, "pose": [2, 0.5, -0.25],
       "motion": {"velocity": [0.5, 0, 0.25]}}],
      "clearance": 0.125, "dt": 0.5, "steps": 4, "effects": {"clashes": {"of": "hall"}}})";
  std::ostringstream poses;
  for (int k = 0; k <= 4; ++k) poses << "1 0 0 " << 2 + 0.25 * k << " 0 1 0 0.5 0 0 1 " << -0.25 + 0.125 * k << '\n';
  folder.write("poses.txt", poses.str());
  const Outcome done = runScene(alone, lists("steps"));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ASSERT_EQ(
      run("pcl_bsh_collide",
          "floor.xyz marked.pcd --clearance 0.125 --obstacle \"mill=copy.off;solid=true\" --trajectory poses.txt" +
              lists("collide"),
          folder.path())
          .exit_code,
      0);
  expectSameFiles("steps", "collide");
  const ListJson list = json("steps.json");
  EXPECT_EQ(list["poses"], 5);
  EXPECT_GT(list["clashes"].size(), 0U);
}

TEST_F(SceneClashes, TellWhereOthersMeetAndWhen)
{
  const std::string drone = R"(, {"name": "drone", "cloud": "crate", "pose": [4, 0.5, 1],
                                  "motion": {"velocity": [-0.5, 0, 0]}})";
  const Outcome done = runScene(scene(6, R"(, "between": true)", "", drone), lists("steps") + "--out out");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ListJson between = json("steps.json")["between"];
  ASSERT_EQ(between.size(), 3U);
  EXPECT_EQ(between[2]["first"], "mill");
  EXPECT_EQ(between[2]["second"], "drone");
  EXPECT_EQ(between[2]["state"], "clash");
  EXPECT_GT(between[2]["first_pose"], 0);
  EXPECT_GE(between[2]["closest_pose"], between[2]["first_pose"]);
  EXPECT_EQ(between[0]["state"], "clear"); // press and mill
  EXPECT_FALSE(between[0].contains("first_pose"));
  EXPECT_THAT(done.out, HasSubstr("mill and drone: clash, smallest distance"));
  EXPECT_THAT(text("steps.html"), HasSubstr("<th>first at pose</th>"));
  // the step before its first is free in the scene, too
  const std::string first = between[2]["first_pose"].dump();
  std::string any = scene(6, "", "", drone);
  any.replace(any.find(R"("clashes")"), 0, R"("any": true, )");
  ASSERT_EQ(runScene(any, "--out any").exit_code, 0);
  std::istringstream steps(text("any/steps.jsonl"));
  std::string found;
  for (std::string line; found.empty() && std::getline(steps, line);) {
    const ListJson step = ListJson::parse(line);
    for (const ListJson& pair : step["any"])
      if (pair["a"] == "mill" && pair["b"] == "drone") found = step["step"].dump();
  }
  EXPECT_EQ(found, first);
}

TEST_F(SceneClashes, AreComparedWithThoseOfAnEarlierRun)
{
  ASSERT_EQ(runScene(scene(2), "--clashes first.json --clashes first.bcf").exit_code, 0);
  const std::size_t before = json("first.json")["clashes"].size();
  ASSERT_GE(before, 2U);
  for (const char* previous : {"first.json", "first.bcf"}) {
    const Outcome same = runScene(scene(2), "--clashes again.json --previous " + std::string(previous));
    ASSERT_EQ(same.exit_code, 0) << same.err;
    EXPECT_THAT(same.out, HasSubstr(", 0 resolved"));
    const ListJson list = json("again.json");
    for (const ListJson& clash : list["clashes"]) EXPECT_EQ(clash["status"], "persisting");
  }
  std::string away = scene(2);
  away.replace(away.find("0.35, 0.1"), 9, "0.35, 1.5"); // the press is lifted
  const Outcome lifted = runScene(away, "--clashes again.json --previous first.json");
  ASSERT_EQ(lifted.exit_code, 0) << lifted.err;
  EXPECT_THAT(lifted.out, HasSubstr("press: clear, smallest distance"));
  const ListJson list = json("again.json");
  std::size_t gone = 0;
  for (const ListJson& clash : list["clashes"]) gone += clash["status"] == "not_visited" ? 1 : 0;
  EXPECT_EQ(gone, 1U);
  std::string wider = scene(2);
  wider.replace(wider.find("0.125"), 5, "0.25");
  const Outcome refused = runScene(wider, "--clashes again.json --previous first.json");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.told(), HasSubstr("first.json: lists clashes with clearance 0.125, now it is 0.25"));
}

TEST_F(SceneClashes, FollowTheRulesAboutPairs)
{
  const std::string rules = R"(, "pairs": {"rules": [{"objects": ["hall", "press"], "tested": false},
      {"objects": ["press", "mill"], "clearance": 0.75}, {"objects": ["hall", "mill"], "clearance": 0.25}]})";
  const Outcome done = runScene(scene(0, R"(, "between": true)", rules), "--clashes list.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("press: ignored\n"));
  EXPECT_THAT(done.out, HasSubstr("press and mill: clash"));
  const ListJson list = json("list.json");
  EXPECT_EQ(list["obstacles"][1]["clearance"], 0.25);
  EXPECT_EQ(list["between"][0]["clearance"], 0.75);
  const std::string all = R"(, "pairs": {"default": "ignored"})";
  EXPECT_THAT(runScene(scene(0, "", all), "").told(),
              HasSubstr("effects.clashes: no object is tested against 'hall': do not fix"));
}

TEST_F(SceneClashes, HavePlacesThatNobodySaw)
{
  const std::string eye = R"(, "seen": true, "origin": "3,1.5,4", "seen_angle": 0.1)";
  const Outcome done = runScene(scene(0, eye), lists("steps"));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ASSERT_EQ(run("pcl_bsh_collide",
                "floor.xyz marked.pcd --clearance 0.125 --seen --origin 3,1.5,4 --seen-angle 0.1 " + machines +
                    lists("collide"),
                folder.path())
                .exit_code,
            0);
  expectSameFiles("steps", "collide");
  EXPECT_GT(json("steps.json")["obstacles"][1]["unseen"], 0);
  EXPECT_THAT(done.out, HasSubstr(" unseen"));
  ASSERT_EQ(runScene(scene(0), "--clashes list.json").exit_code, 0);
  EXPECT_EQ(json("list.json")["obstacles"][1]["unseen"], 0) << "an effect that is not listed runs no code";
}

/// A cloud that is shifted brings its scanner along.
TEST_F(SceneClashes, MoveTheScannerWithItsScan)
{
  folder.write("scan.pcd", "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\n"
                           "VIEWPOINT 0 0 2 1 0 0 0\nPOINTS 3\nDATA ascii\n0 0 0\n0.01 0 0\n0 0.01 0\n");
  folder.write("point.xyz", "10 0 1\n");
  const auto unseen = [&](const std::string& origin) {
    const std::string scene = R"({"clouds": {"scan": {"file": "scan.pcd", "shift": [10, 0, 0]}, "point": "point.xyz"},
      "objects": [{"name": "scan", "cloud": "scan", "fixed": true}, {"name": "point", "cloud": "point"}],
      "clearance": 0.001, "steps": 0, "effects": {"clashes": {"of": "scan", "seen": true, "seen_angle": 0.02)" +
                              origin + "}}}";
    const Outcome done = runScene(scene, "--clashes list.json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json("list.json")["obstacles"][0]["options"]["origin"];
  };
  EXPECT_EQ(unseen(""), "10,0,2");
  EXPECT_EQ(unseen(R"(, "origin": "11,0,2")"), "11,0,2");
}

TEST_F(SceneClashes, KnowUncertainPoints)
{
  std::string uncertain = scene(0);
  uncertain.replace(uncertain.find(R"("floor.xyz")"), 11, R"({"file": "floor.xyz", "uncertainty": 0.0625})");
  uncertain.replace(uncertain.find(R"("copy.off")"), 10, R"({"file": "copy.off", "uncertainty": 0.03125})");
  const Outcome done = runScene(uncertain, lists("steps"));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ASSERT_EQ(run("pcl_bsh_collide",
                "floor.xyz marked.pcd --clearance 0.125 --uncertainty 0.0625 --obstacle "
                "\"press=crate.off;pose=0.55,0.35,0.1,0,0,0\" --obstacle "
                "\"mill=copy.off;pose=2.05,0.5,-0.25,0,0,0.25;solid=true;uncertainty=0.03125\"" +
                    lists("collide"),
                folder.path())
                .exit_code,
            0);
  expectSameFiles("steps", "collide");
  uncertain.replace(uncertain.find(R"("uncertainty": 0.03125)"), 22, R"("pose_uncertainty": "0.03125,0,0,0,0")");
  const Outcome posed = runScene(uncertain, "--clashes list.json");
  ASSERT_EQ(posed.exit_code, 0) << posed.err;
  EXPECT_EQ(json("list.json")["obstacles"][1]["options"]["pose_uncertainty"], "0.03125,0,0,0,0");
  EXPECT_EQ(json("list.json")["obstacles"][1]["colliding"], json("steps.json")["obstacles"][1]["colliding"]);
}

TEST_F(SceneClashes, NamePartsOfObjects)
{
  const std::string robot = R"(, {"name": "robot", "parts": [{"name": "foot", "cloud": "crate"},
      {"name": "arm", "cloud": "crate", "pose": [0, 0, 1.125]}], "pose": [4, 1, 0.1]})";
  const Outcome done = runScene(scene(1, R"(, "between": true)", "", robot), "--clashes list.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("robot/foot: clash of"));
  EXPECT_THAT(done.out, HasSubstr("robot/arm: clear"));
  EXPECT_THAT(done.out, HasSubstr("press and robot/foot: clear"));
  EXPECT_THAT(done.out, Not(HasSubstr("robot/foot and robot/arm"))) << "which is the effect self";
  EXPECT_EQ(runScene(scene(1, "", "", robot), "--clashes again.json --previous list.json").exit_code, 0);
}

TEST_F(SceneClashes, RunNoCodeWhereTheyAreNotListed)
{
  std::string without = scene(0);
  without.replace(without.find(R"("clashes": {"of": "hall"})"), 25, R"("any": true)");
  const Outcome refused = runScene(without, "--clashes list.json");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.told(), HasSubstr("--clashes: scene.json does not list the effect 'clashes': add"));
  const Outcome done = runScene(without, "--out out");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_FALSE(json("out/summary.json").contains("clashes"));
  EXPECT_THAT(done.out, Not(HasSubstr("press: ")));
  EXPECT_THAT(runScene(without, "--explain").out, HasSubstr(" clashes\n\nWhat is built"));
  EXPECT_THAT(runScene(scene(0), "--explain").out, HasSubstr("  clashes: where objects come too near to 'hall'"));
  const ListJson explained = ListJson::parse(runScene(scene(0), "--explain --json").out);
  EXPECT_TRUE(explained["effects"].contains("clashes"));
  EXPECT_EQ(explained["built"]["spheres"], true);
}

TEST_F(SceneClashes, AreRefusedInOneLine)
{
  const auto refusal = [&](const std::string& text, const std::string& arguments = "", int exit_code = 1) {
    const Outcome done = runScene(text, arguments);
    EXPECT_EQ(done.exit_code, exit_code) << done.err;
    const std::string told = done.told();
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
    EXPECT_FALSE(std::filesystem::exists(folder / "list.json"));
    return told;
  };
  const auto with = [&](std::string text, const std::string& what, const std::string& instead) {
    return text.replace(text.find(what), what.size(), instead);
  };
  EXPECT_THAT(refusal(with(scene(0), R"("of": "hall")", R"("of": "hal")"), "--clashes list.json"),
              HasSubstr("effects.clashes.of: "));
  EXPECT_THAT(refusal(with(scene(0), R"("of": "hall")", R"("of": "press")")),
              HasSubstr("effects.clashes.of: 'press' is not fixed: give it \"fixed\": true"));
  EXPECT_THAT(refusal(with(scene(0), R"("fixed": true)", R"("fixed": true, "pose": [1, 0, 0])")),
              HasSubstr("'hall' has parts or a pose, and places are told in its cloud's coordinates: make it"));
  EXPECT_THAT(refusal(with(scene(0), R"("floor": "floor.xyz")", R"("floor": "crate.off")")),
              HasSubstr("effects.clashes.of: cloud 'floor' is a surface, and places of points are listed: give"));
  EXPECT_THAT(refusal(with(scene(0), R"("clashes")", R"("deform": 1.5, "clashes")")),
              HasSubstr("effects.clashes: does not go with the effect 'deform': leave one out"));
  EXPECT_THAT(refusal(scene(0, R"(, "origin": "1,2,3")")),
              HasSubstr("effects.clashes.origin: needs 'seen': give \"seen\": true, too"));
  EXPECT_THAT(refusal(scene(0, R"(, "seen": true, "origin": "here")")), HasSubstr("effects.clashes.origin: "));
  EXPECT_THAT(refusal(scene(0, R"(, "seen": true)")), HasSubstr("scene.json: effects.clashes: "));
  EXPECT_THAT(refusal(scene(0, R"(, "sen": true)")), HasSubstr("effects.clashes: key 'sen' is unknown"));
  EXPECT_THAT(refusal(with(scene(0), R"("name": "press")", R"("name": "input")")),
              HasSubstr("scene.json: effects.clashes: "));
  EXPECT_THAT(refusal(scene(0), "--clashes list.txt", 2), HasSubstr("--clashes: list.txt: unknown extension '.txt'"));
  EXPECT_THAT(refusal(scene(0), "--previous old.json", 2),
              HasSubstr("--previous: no clash report is written: give --clashes FILE"));
  EXPECT_THAT(refusal(scene(0), "--clashes scene.json", 2), HasSubstr("--clashes"));
  EXPECT_THAT(refusal(R"({"clouds": {"floor": "floor.xyz"}, "objects": [{"name": "hall", "cloud": "floor",
      "fixed": true}], "effects": {"clashes": {"of": "hall"}}})"),
              HasSubstr("effects.clashes.of: there is no other object: add one"));
}

} // namespace
} // namespace pcl_bsh
