// SPDX-License-Identifier: BSD-3-Clause
// The stages that ask about several obstacles at once.
#include "io/clouds/samples.h"
#include "run_stage.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace pcl_bsh::pipeline {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using ListJson = nlohmann::json;

/// Points on a floor and two crates, a metre wide: the second crate is a file in millimetres.
class Obstacles : public testing::Test {
protected:
  static std::string crate(const std::string& metre)
  {
    std::string text = "OFF\n8 6 0\n";
    for (const char* const corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"})
      for (const char* c = corner;; ++c) {
        text += *c == '1' ? metre : *c == '\0' ? "\n" : std::string(1, *c);
        if (*c == '\0') break;
      }
    return text + "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
  }

  std::string quoted(const char* file) const { return '"' + (folder / file).string() + '"'; }

  /// A pipeline of the scan and one stage. @param options after the type
  PipelineResult run(const std::string& type, const std::string& options) const
  {
    return Pipeline::parse("[" + quoted("scan.xyz") + R"(, {"type": ")" + type + R"(", "tag": "asked", )" + options +
                           R"(}, {"type": "filters.merge", "tag": "out"}])")
        .run();
  }

  std::vector<double> column(const std::string& type, const std::string& options, const std::string& name) const
  {
    const StageCloudPtr out = run(type, R"("clearance": 0.1, )" + options).clouds.at("out");
    std::vector<double> values;
    for (std::size_t i = 0; i < out->cloud.width; ++i) values.push_back(io::valueOf(out->cloud, i, name));
    return values;
  }

  /// @param options after the file and the obstacles
  ListJson list(const std::string& obstacles, const std::string& options = "") const
  {
    run("writers.clashes",
        R"("clearance": 0.1, "filename": )" + quoted("list.json") + R"(, "obstacles": )" + obstacles + options);
    return ListJson::parse(io::contentOf(folder / "list.json"));
  }

  std::string refused(const std::string& options, const std::string& type = "filters.bsh_flag") const
  {
    return errorOf([&] { run(type, R"("clearance": 0.1, )" + options); });
  }

  io::TemporaryFolder folder;
  std::filesystem::path press = folder.write("press.off", crate("1"));
  std::filesystem::path mill = folder.write("mill.off", crate("1000"));
  std::filesystem::path scan = folder.write("scan.xyz", "0.5 0.5 0\n5.5 0.5 0.3\n9 9 9\n0.5 0.55 0\n");
  const std::string one = R"({"file": )" + quoted("press.off") + "}";
  const std::string two =
      "[" + one + R"(, {"file": )" + quoted("mill.off") +
      R"(, "name": "the mill", "pose": [5, 0, 0, 0, 0, 0], "solid": true, "unit": "mm", "to_unit": "m"}])";
};

TEST_F(Obstacles, AreFlaggedTogether)
{
  EXPECT_THAT(column("filters.bsh_flag", R"("obstacles": )" + two, "collision"), ElementsAre(1, 1, 0, 1));
  EXPECT_THAT(column("filters.bsh_flag", R"("obstacles": [)" + one + "]", "collision"), ElementsAre(1, 0, 0, 1));
  const std::string narrow =
      R"("obstacles": [{"file": )" + quoted("press.off") + R"(, "pose": [0, 0, 0.05, 0, 0, 0], "clearance": 0.04}])";
  EXPECT_THAT(column("filters.bsh_flag", narrow, "collision"), ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(column("filters.bsh_collision", R"("obstacles": )" + two, "x"), ElementsAre(9));
}

TEST_F(Obstacles, ArePlacedByThePoseOfAll)
{
  EXPECT_THAT(column("filters.bsh_flag", R"("pose": [0, 0, 5, 0, 0, 0], "obstacles": )" + two, "collision"),
              ElementsAre(0, 0, 0, 0));
}

/// Limits begin at 0 by default, which leaves out what a solid encloses.
TEST_F(Obstacles, AreMeasuredToTheNearest)
{
  const StageCloudPtr out = run("filters.bsh_distance", R"("obstacles": )" + two).clouds.at("out");
  ASSERT_EQ(out->cloud.width, 3U);
  EXPECT_EQ(io::valueOf(out->cloud, 0, "distance"), 0.0);
  EXPECT_FLOAT_EQ(static_cast<float>(io::valueOf(out->cloud, 1, "distance")), std::sqrt(137.0F));
}

TEST_F(Obstacles, AreOneListWithTheirNames)
{
  const ListJson all = list(two, R"(, "between": true)");
  ASSERT_EQ(all["obstacles"].size(), 2U);
  EXPECT_EQ(all["obstacles"][0]["name"], "press");
  EXPECT_EQ(all["obstacles"][0]["state"], "clash");
  EXPECT_EQ(all["obstacles"][1]["options"]["solid"], "true");
  EXPECT_EQ(all["obstacles"][1]["distance"], -0.3);
  ASSERT_EQ(all["clashes"].size(), 2U);
  EXPECT_EQ(all["clashes"][0]["obstacle_name"], "the mill");
  EXPECT_EQ(all["between"][0]["state"], "clear");
  EXPECT_EQ(all["between"][0]["distance"], 4.0);
  EXPECT_EQ(list(two, R"(, "between": true, "ignore": ["press:the*"])")["between"].size(), 0U);
  EXPECT_EQ(list(two, R"(, "between": true, "overlap": true)")["between"][0]["area_of_first_within"][1], 0.0);
  EXPECT_EQ(list(two, R"(, "ignore": ["input:press"])")["obstacles"][0]["state"], "ignored");
}

TEST_F(Obstacles, AreThePartsOfAFile)
{
  folder.write(
      "plant.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 9 9 9\nv 5 0 0\nv 6 0 0\nv 6 1 0\nf 1 2 3\no left\nf 1 2 3\no right\nf 5 6 7\n");
  const std::string parts =
      R"([{"file": )" + quoted("plant.obj") + R"(, "parts": true, "pose": [0, 0, 0.05, 0, 0, 0]})";
  const ListJson all = list(parts + ", " + one + "]", R"(, "between": true, "ignore": ["*:press"])");
  ASSERT_EQ(all["obstacles"].size(), 3U);
  EXPECT_EQ(all["obstacles"][0]["name"], "left");
  EXPECT_EQ(all["obstacles"][0]["state"], "clash");
  EXPECT_EQ(all["obstacles"][0]["surface"]["triangles"], 1);
  EXPECT_EQ(all["obstacles"][1]["name"], "right");
  EXPECT_EQ(all["obstacles"][1]["state"], "clear");
  EXPECT_EQ(all["obstacles"][2]["state"], "ignored");
  ASSERT_EQ(all["between"].size(), 1U);
  EXPECT_EQ(all["between"][0]["distance"], 4.0);
  const PipelineResult done = run("filters.bsh_flag", R"("clearance": 0.1, "obstacles": )" + parts + "]");
  EXPECT_THAT(done.warnings,
              testing::Contains(HasSubstr("plant.obj: 1 triangle before the first part's name: left out")));
  EXPECT_THAT(done.warnings, testing::Contains(HasSubstr("plant: the obstacle is a surface of 3 triangles")));
  EXPECT_EQ(list(R"([{"name": "plant", "parts": true, "file": )" + quoted("plant.obj") + "}]")["obstacles"][1]["name"],
            "plant/right");
  EXPECT_THAT(refused(R"("obstacles": [{"file": )" + quoted("press.off") + R"(, "parts": true}])"),
              HasSubstr("/obstacles/0/parts: " + press.string() + ": has no parts with names: give an .obj"));
  EXPECT_THAT(refused(R"("obstacles": )" + parts + R"(, {"file": )" + quoted("press.off") + R"(, "name": "left"}])"),
              EndsWith("/obstacles: two obstacles have the name 'left': give each its own"));
}

TEST_F(Obstacles, AreComparedWithAnEarlierListByName)
{
  list(two);
  folder.write("scan.xyz", "0.5 0.5 0\n9 9 9\n0.5 0.55 0\n5.5 0.5 -3\n");
  const ListJson now = list(two, R"(, "previous": )" + quoted("list.json"));
  ASSERT_EQ(now["clashes"].size(), 2U);
  for (const ListJson& clash : now["clashes"])
    EXPECT_EQ(clash["status"], clash["obstacle_name"] == "press" ? "persisting" : "resolved") << clash;
}

TEST_F(Obstacles, MayBeAskedAboutAlone)
{
  list(two); // to list.json
  const std::string moved =
      "[" + one + R"(, {"file": )" + quoted("mill.off") +
      R"(, "name": "the mill", "pose": [5, 0, 0.1, 0, 0, 0], "solid": true, "unit": "mm", "to_unit": "m"}])";
  std::filesystem::copy_file(folder / "list.json", folder / "before.json");
  const std::string previous = R"(, "previous": )" + quoted("before.json");
  EXPECT_EQ(list(moved, previous + R"(, "only": ["the *"])"), list(moved, previous));
  const auto refusal = [&](const std::string& options) { return errorOf([&] { list(moved, options); }); };
  EXPECT_THAT(refusal(R"(, "only": ["the *"])"),
              EndsWith("/only: is given, and nothing tells of the other obstacles: give `previous`"));
  EXPECT_THAT(refusal(previous + R"(, "only": ["lathe"])"),
              EndsWith("/only: 'lathe' matches no obstacle: give one of their names"));
  EXPECT_THAT(refusal(previous + R"(, "only": ["press"])"),
              HasSubstr("before.json: tells of 'the mill' at other poses: ask about it, too"));
}

TEST_F(Obstacles, GoThroughTheDocumentOfARun)
{
  const PipelineResult first = run("filters.bsh_flag", R"("clearance": 0.1, "obstacles": )" + two);
  const PipelineResult again = Pipeline::parse(first.metadata).run();
  EXPECT_TRUE(again.clouds.at("out")->cloud.data == first.clouds.at("out")->cloud.data);
}

TEST_F(Obstacles, MayBeStages)
{
  const PipelineResult done =
      Pipeline::parse(R"([{"type": "readers.off", "tag": "box", "filename": )" + quoted("press.off") + "}, " +
                      R"({"type": "readers.text", "tag": "scan", "filename": )" + quoted("scan.xyz") +
                      R"(}, {"type": "filters.bsh_flag", "tag": "out", "clearance": 0.1, "obstacles": [{"file": "box"},
                      {"name": "other", "file": "box", "pose": [5, 0, 0, 0, 0, 0]}]}])")
          .run();
  EXPECT_EQ(io::valueOf(done.clouds.at("out")->cloud, 0, "collision"), 1.0);
}

TEST_F(Obstacles, RefuseWhatIsNoObstacle)
{
  const auto listed = [&](const std::string& more) { return refused(R"("obstacles": [)" + more + "]"); };
  EXPECT_THAT(refused(R"("obstacles": [])"), HasSubstr("/obstacle: is missing: give the tag of an earlier stage"));
  EXPECT_THAT(refused(R"("obstacles": )" + two + R"(, "obstacle": )" + quoted("press.off")),
              EndsWith("/obstacles: and `obstacle` are both given: give one of them"));
  EXPECT_THAT(refused(R"("obstacles": "press.off")"),
              HasSubstr("/obstacles: is \"press.off\": give a list of objects with `file`, `name`, `pose`"));
  EXPECT_THAT(listed("3"), EndsWith("/obstacles/0: is 3: give an object"));
  EXPECT_THAT(listed(one + R"(, {"name": "a"})"),
              HasSubstr("/obstacles/1/file: is missing: give the tag of an earlier stage"));
  EXPECT_THAT(listed(R"({"file": "none.off"})"), HasSubstr("none.off: no such file"));
  EXPECT_THAT(listed(R"({"file": "none.what"})"),
              HasSubstr("/obstacles/0/file: is \"none.what\", neither an earlier stage's tag nor a cloud file"));
  EXPECT_THAT(listed(R"({"file": )" + quoted("press.off") + R"(, "clearence": 1})"),
              HasSubstr("/obstacles/0/clearence: is no option of one of `obstacles`: did you mean 'clearance'?"));
  EXPECT_THAT(listed(R"({"file": )" + quoted("press.off") + R"(, "clearance": -1})"),
              HasSubstr("/obstacles/0/clearance: is -1: give a number of at least 0, in m"));
  EXPECT_THAT(listed(R"({"file": )" + quoted("press.off") + R"(, "pose": [1]})"),
              HasSubstr("/obstacles/0/pose: is [1]: give [x, y, z, roll, pitch, yaw]"));
  EXPECT_THAT(listed(R"({"file": )" + quoted("press.off") + R"(, "unit": "ell", "to_unit": "m"})"),
              HasSubstr("/obstacles/0/file/unit: "));
  EXPECT_THAT(listed(R"({"file": "asked_before", "unit": "mm"})"), HasSubstr("/obstacles/0/file: is \"asked_before\""));
  EXPECT_THAT(listed(one + ", " + one), EndsWith("/obstacles: two obstacles have the name 'press': give each its own"));
  const std::string to_list = R"("filename": )" + quoted("a.json") + R"(, "obstacle)";
  EXPECT_THAT(refused(to_list + R"(": )" + quoted("press.off") + R"(, "between": true)", "writers.clashes"),
              EndsWith("/between: is given, and there is one obstacle: give `obstacles`"));
  EXPECT_THAT(refused(to_list + R"(s": )" + two + R"(, "overlap": true)", "writers.clashes"),
              EndsWith("/overlap: is of obstacles that are compared: give `between`: true"));
  EXPECT_THAT(refused(to_list + R"(s": )" + two + R"(, "ignore": ["a:b"])", "writers.clashes"),
              EndsWith("/ignore: 'a' matches no obstacle: give input, or one of their names"));
  EXPECT_THAT(refused(to_list + R"(s": )" + two + R"(, "ignore": [3])", "writers.clashes"),
              EndsWith("/ignore: is [3]: give a list of texts"));
}

} // namespace
} // namespace pcl_bsh::pipeline
