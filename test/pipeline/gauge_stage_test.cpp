// SPDX-License-Identifier: BSD-3-Clause
// The stage of gauging runs, against gauge() called directly.
#include "../filters/clouds.h"
#include "io/clouds/samples.h"
#include "run_stage.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/tracks/axis_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/track/tracks.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_bsh::pipeline {
namespace {

using testing::HasSubstr;

class GaugeStage : public testing::Test {
protected:
  GaugeStage()
  {
    folder.write("line.axis", "start 0 0 90\nchainage 100\narc 30 50\n");
    folder.write("box.csv", "offset,height\n-1.5,0\n1.5,0\n1.5,4\n-1.5,4\n");
    test::Points points = test::randomPoints(3000, 1);
    for (Eigen::Vector3d& p : points) p = Eigen::Vector3d(15 * p.x() + 15, 6 * p.y() - 3, 4 * p.z());
    points[3].x() = std::nan("");
    auto made = std::make_shared<StageCloud>();
    made->cloud = *test::fieldCloud<double>(points);
    scan = made;
  }

  std::string stage(const std::string& more = "", const std::string& of_profile = "") const
  {
    return R"({"type": "filters.gauge", "axis": ")" + (folder / "line.axis").string() +
           R"(", "profiles": [{"file": ")" + (folder / "box.csv").string() + '"' + of_profile + "}]" + more + "}";
  }

  std::string fileOption(const std::string& option, const std::string& name) const
  {
    return ", \"" + option + "\": \"" + (folder / name).string() + '"';
  }

  StageCloudPtr scan;
  const io::TemporaryFolder folder;
};

TEST_F(GaugeStage, AddsTheFieldsOfTheQuery)
{
  const StageCloudPtr gauged =
      outputOf(scan, stage(R"(, "reach": 5)", R"(, "vehicle_pivots": 10, "vehicle_overhang": 2)"));
  const PointsView points = viewOf(scan->cloud);
  ASSERT_EQ(gauged->cloud.width, points.count);
  const Axis axis = io::readAxis(folder / "line.axis");
  const Envelope box({"box", {{-1.5, 0}, {1.5, 0}, {1.5, 4}, {-1.5, 4}}, {}, {}, {}, Vehicle{10, 2}});
  GaugeRequest request;
  request.reach.offset = 5;
  const GaugedPoints truth = gauge(points, axis, {box}, request);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < points.count; ++i) {
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "place"), static_cast<double>(truth.state[i]));
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "envelope"), truth.envelope[i]);
    if (truth.envelope[i] < 0) {
      EXPECT_TRUE(std::isnan(io::valueOf(gauged->cloud, i, "clearance")));
      continue;
    }
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "chainage"), axis.chainage(truth.place[i].distance));
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "offset"), static_cast<float>(truth.place[i].offset));
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "height"), static_cast<float>(truth.place[i].height));
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "clearance"), static_cast<float>(truth.clearance[i]));
    inside += truth.clearance[i] <= 0;
  }
  EXPECT_GT(inside, 100u);
  EXPECT_EQ(io::valueOf(gauged->cloud, 3, "place"), 5);
}

TEST_F(GaugeStage, ComparesSeveralProfilesEachInItsRange)
{
  const std::string box = (folder / "box.csv").string();
  const StageCloudPtr gauged = outputOf(scan, R"({"type": "filters.gauge", "axis": ")" +
                                                  (folder / "line.axis").string() + R"(", "profiles": [{"file": ")" +
                                                  box + R"(", "name": "near", "from": 100, "to": 110}, {"file": ")" +
                                                  box + R"(", "name": "far", "from": 112, "to": 125}]})");
  std::array<std::size_t, 3> counts{};
  for (std::size_t i = 0; i < gauged->cloud.width; ++i) {
    const double chainage = io::valueOf(gauged->cloud, i, "chainage"),
                 envelope = io::valueOf(gauged->cloud, i, "envelope");
    const double truth = chainage >= 100 && chainage <= 110 ? 0 : chainage >= 112 && chainage <= 125 ? 1 : -1;
    EXPECT_EQ(envelope, truth) << chainage;
    ++counts[static_cast<std::size_t>(envelope + 1)];
  }
  for (const std::size_t count : counts) EXPECT_GT(count, 50u);
  const std::string twice = R"([{"file": ")" + box + R"("}, {"file": ")" + box + R"("}])";
  EXPECT_THAT(errorOf([&] {
                runStage(scan, R"({"type": "filters.gauge", "axis": ")" + (folder / "line.axis").string() +
                                   R"(", "profiles": )" + twice + "}");
              }),
              HasSubstr("profiles/1: another is called 'box', too"));
}

TEST_F(GaugeStage, WritesTablesAndComparesWithAnEarlierRun)
{
  const std::string files = fileOption("table", "table.csv") + fileOption("infringements", "list.csv") +
                            fileOption("report", "week.json") + fileOption("page", "page.html") +
                            R"(, "input_name": "w48", "step": 10)";
  runStage(scan, stage(files));
  EXPECT_THAT(io::contentOf(folder / "table.csv"), HasSubstr("100,110,0,10,box,infringed,"));
  EXPECT_THAT(io::contentOf(folder / "list.csv"), HasSubstr(",new,box,"));
  EXPECT_THAT(io::contentOf(folder / "page.html"), HasSubstr("Gauging: w48"));
  runStage(scan, stage(files + fileOption("previous", "week.json")));
  const auto report = nlohmann::json::parse(io::contentOf(folder / "week.json"));
  EXPECT_FALSE(report["infringements"].empty());
  for (const auto& one : report["infringements"]) EXPECT_EQ(one["status"], "persisting");
}

TEST_F(GaugeStage, GaugesSeveralTracksInOnePass)
{
  folder.write("right.axis", "start 0 -3 90\nchainage 500\narc 30 47\n");
  const std::string box = (folder / "box.csv").string();
  const std::string axes = R"("axes": [{"name": "left", "file": ")" + (folder / "line.axis").string() +
                           R"("}, {"name": "right", "file": ")" + (folder / "right.axis").string() + R"("}])";
  const auto stageOf = [&](const std::string& profiles, const std::string& more = "") {
    return R"({"type": "filters.gauge", )" + axes + R"(, "profiles": [)" + profiles + "]" + more + "}";
  };
  const std::string both =
      R"({"file": ")" + box + R"("}, {"file": ")" + box + R"(", "name": "more", "tracks": ["right"]})";
  const StageCloudPtr gauged = outputOf(scan, stageOf(both, fileOption("table", "table.csv") + R"(, "step": 50)"));
  const PointsView points = viewOf(scan->cloud);
  const Envelope of_box({"box", {{-1.5, 0}, {1.5, 0}, {1.5, 4}, {-1.5, 4}}});
  const GaugedTracks truth = gauge(points,
                                   {{"left", io::readAxis(folder / "line.axis"), {of_box}},
                                    {"right", io::readAxis(folder / "right.axis"), {of_box}}},
                                   {});
  std::array<std::size_t, 3> counts{};
  for (std::size_t i = 0; i < points.count; ++i) {
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "track"), truth.track[i]);
    ++counts[static_cast<std::size_t>(truth.track[i] + 1)];
    if (truth.track[i] < 0) continue;
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "offset"), static_cast<float>(truth.told.place[i].offset));
    EXPECT_EQ(io::valueOf(gauged->cloud, i, "chainage") >= 500, truth.track[i] == 1);
  }
  EXPECT_GT(counts[1], 500u);
  EXPECT_GT(counts[2], 500u);
  const std::string table = io::contentOf(folder / "table.csv");
  EXPECT_THAT(table, HasSubstr("\nleft,100,130,0,30,box,infringed,"));
  EXPECT_THAT(table, HasSubstr("\nright,500,530,0,30,more,infringed,"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << table;

  const auto error = [&](const std::string& text) { return errorOf([&] { runStage(scan, text); }); };
  EXPECT_THAT(error(stageOf(both, fileOption("axis", "line.axis"))), HasSubstr("axis: is given beside `axes`"));
  EXPECT_THAT(error(R"({"type": "filters.gauge", "profiles": [{"file": ")" + box + R"("}]})"),
              HasSubstr("axis: is missing: give it, or `axes`"));
  EXPECT_THAT(error(stageOf(R"({"file": ")" + box + R"(", "tracks": ["siding"]})")),
              HasSubstr("profiles/0: no track is called 'siding'"));
  EXPECT_THAT(error(stageOf(R"({"file": ")" + box + R"(", "tracks": ["left"]})")),
              HasSubstr("profiles: no profile counts on the track 'right'"));
}

TEST_F(GaugeStage, TellsWhatBeamsSaw)
{
  auto made = std::make_shared<StageCloud>();
  folder.write("beams.csv", "x,y,z,gps_time\n5,-3,1,0\n5,3,1,0\n5,0,6,1\n5,0,-1,1\n");
  made->cloud = io::readCloud(folder / "beams.csv");
  folder.write("line.axis", "start 0 0 90\nchainage 100\nstraight 10\n");
  folder.write("path.csv", "time,x,y,z\n0,5,0,2\n2,5,0,2\n");
  const std::string files = fileOption("origin_path", "path.csv") + R"(, "step": 10, "seen_spacing": 1)";
  runStage(made, stage(files + fileOption("table", "table.csv")));
  EXPECT_THAT(io::contentOf(folder / "table.csv"), HasSubstr("100,110,0,10,box,clear,4,"));
  EXPECT_THAT(errorOf([&] { runStage(scan, stage(files)); }), HasSubstr("time_field: the scan has none"));
  folder.write("path.csv", "time,x,y,z\n0,5,0,2\n");
  EXPECT_THAT(errorOf([&] { runStage(made, stage(files)); }), HasSubstr("path.csv: has 1 of the two places"));
}

TEST_F(GaugeStage, NamesTheOptionThatIsWrong)
{
  const auto error = [&](const std::string& more, const std::string& of_profile = "") {
    return errorOf([&] { runStage(scan, stage(more, of_profile)); });
  };
  EXPECT_THAT(error(R"(, "reach": 45)"), HasSubstr("reach: 45 beside the axis is more than 0.8"));
  EXPECT_THAT(error(R"(, "step": 1e-9)"), HasSubstr("step: 1e-09 makes no table"));
  EXPECT_THAT(error("", R"(, "vehicle_pivots": 120)"), HasSubstr("profiles/0: "));
  EXPECT_THAT(error("", R"(, "from": 3)"), HasSubstr("profiles/0: has one end of a range"));
  EXPECT_THAT(error("", R"(, "with": 3)"), HasSubstr("with: is no option of one of `profiles`"));
  EXPECT_THAT(error(fileOption("previous", "box.csv")), HasSubstr("is no report of a gauging run"));
  EXPECT_THAT(error("", fileOption("widening", "none.csv")), HasSubstr("none.csv"));
  EXPECT_THAT(error(fileOption("table", "box.csv")), HasSubstr("table: is the file of filters_gauge1.profiles/0/file"));
  folder.write("line.axis", "start 0 0 90\nbend 5\n");
  EXPECT_THAT(error(""), HasSubstr("line.axis"));
}

} // namespace
} // namespace pcl_bsh::pipeline
