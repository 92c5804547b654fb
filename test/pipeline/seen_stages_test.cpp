// SPDX-License-Identifier: BSD-3-Clause
// Stages that ask what of an obstacle nobody saw.
#include "run_stage.h"

#include "../filters/clouds.h"
#include "support/made_scans.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/filters/collision_field.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

StageCloudPtr cloudOf(const std::vector<double>& xyz, const io::Viewpoint& viewpoint)
{
  test::Points points;
  for (std::size_t i = 0; i < xyz.size(); i += 3) points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  auto cloud = std::make_shared<StageCloud>();
  cloud->cloud = *test::fieldCloud<double>(points);
  cloud->viewpoint = viewpoint;
  return cloud;
}

class SeenStages : public testing::Test {
protected:
  /// A scan of a room from a place.
  static StageCloudPtr scanFrom(double x, const io::Viewpoint& viewpoint)
  {
    const test::MadeRoom room{{Eigen::Vector3d(-5, -5, 0), Eigen::Vector3d(5, 5, 3)}, {}};
    test::Random random(1);
    return cloudOf(test::makeScan(room, {{x, 0, 1}, 0.05, -1.57, 1.57}, random).returns, viewpoint);
  }

  const io::Viewpoint at_scanner = {1, 0, 1, 1, 0, 0, 0};
  const StageCloudPtr scan = scanFrom(1, at_scanner);
  const StageCloudPtr machine = cloudOf({2, 0, 1, 9, 0, 1}, io::no_viewpoint); // in the room, and outside
  const std::string flag = R"({"type": "filters.bsh_flag", "obstacle": "other", "clearance": 0.1, "seen": true)";
};

TEST_F(SeenStages, WarnOfWhatIsUnseen)
{
  const std::string told = "1 point of the obstacle is unseen";
  EXPECT_THAT(runStage(scan, flag + "}", machine).warnings, Contains(HasSubstr(told)));
  EXPECT_THAT(runStage(scanFrom(1, io::no_viewpoint), flag + R"(, "origin": "1,0,1"})", machine).warnings,
              Contains(HasSubstr(told)));
}

/// Stages that remove points before it is asked, alone, one after the other, and of one of two inputs that are merged.
TEST_F(SeenStages, WarnOfBeamsThatWereRemovedBefore)
{
  const auto warned = [&](const std::string& before, const std::string& seen = "true") {
    std::string all;
    for (const std::string& warning :
         runStage(scan,
                  before +
                      R"({"type": "filters.bsh_flag", "tag": "ask", "obstacle": "other", "clearance": 0.1, "seen": )" +
                      seen + "}",
                  machine)
             .warnings)
      if (warning.find("beams") != std::string::npos) all += warning + "\n";
    return all;
  };
  const std::string crop = R"({"type": "filters.crop_box", "tag": "crop", "min": [-1, -5, 0], "max": [9, 5, 3]},)";
  const std::string thin = R"({"type": "filters.voxel_grid", "tag": "thin", "leaf_size": 0.5},)";
  const std::string pass =
      R"({"type": "filters.pass_through", "tag": "pass", "filter_field_name": "z", "filter_limits": [0.1, 9]},)";
  EXPECT_EQ(warned(""), "");
  EXPECT_EQ(warned(R"({"type": "filters.transform", "transform": [0, 0, 0, 0, 0, 0]},)"), "");
  for (const auto& [before, tag] : {std::pair(crop, "crop"), {thin, "thin"}, {pass, "pass"}}) {
    EXPECT_THAT(warned(before),
                testing::StartsWith("ask: `seen` is asked of beams, and " + std::string(tag) + " removed "));
    EXPECT_EQ(warned(before, "false"), "");
  }
  EXPECT_THAT(warned(crop + pass), AllOf(HasSubstr("and crop removed"), HasSubstr("and pass removed")));
  EXPECT_THAT(warned(crop + R"({"type": "filters.merge", "inputs": ["in", "crop"], "number_scans": true},)"),
              HasSubstr("and crop removed"));
}

TEST_F(SeenStages, ListWhatIsUnseen)
{
  const files::TemporaryFolder folder;
  const auto unseenIn = [&](const std::string& seen) {
    const std::string file = (folder / "a.json").string();
    runStage(scan,
             R"({"type": "writers.clashes", "obstacle": "other", "clearance": 0.1, "filename": ")" + file + '"' + seen +
                 "}",
             machine);
    const nlohmann::json list = nlohmann::json::parse(files::contentOf(file));
    return std::count_if(list["clashes"].begin(), list["clashes"].end(),
                         [](const nlohmann::json& clash) { return clash["status"] == "unseen"; });
  };
  EXPECT_EQ(unseenIn(R"(, "seen": true)"), 1);
  EXPECT_EQ(unseenIn(""), 0);
}

/// A viewpoint of some of the points says nothing of the others.
TEST_F(SeenStages, RefuseCloudsMergedOfSeveralScans)
{
  const std::string merge = R"({"type": "filters.merge", "inputs": ["in", "other"]})";
  EXPECT_EQ(outputOf(scan, merge, scanFrom(1, at_scanner))->viewpoint, at_scanner);
  EXPECT_EQ(outputOf(scan, merge, machine)->viewpoint, io::no_viewpoint);
}

TEST_F(SeenStages, KnowWhereEachMergedScanIsFrom)
{
  const std::string merge = R"({"type": "filters.merge", "inputs": ["in", "other"], "number_scans": true})";
  const StageCloudPtr second = scanFrom(-1, {-1, 0, 1, 1, 0, 0, 0});
  const StageCloudPtr merged = outputOf(scan, merge, second);
  EXPECT_EQ(merged->scanners, (std::vector<io::Viewpoint>{at_scanner, {-1, 0, 1, 1, 0, 0, 0}}));
  const auto count = [](const StageCloudPtr& cloud) { return cloud->cloud.width * cloud->cloud.height; };
  ASSERT_EQ(count(merged), count(scan) + count(second));
  EXPECT_EQ(io::valueOf(merged->cloud, 0, "scan"), 0.0);
  EXPECT_EQ(io::valueOf(merged->cloud, count(scan), "scan"), 1.0);
  EXPECT_THAT(runStage(merged, flag + "}", machine).warnings, Contains(HasSubstr("1 point of the obstacle is unseen")));
  const StageCloudPtr again = outputOf(merged, merge, merged);
  EXPECT_EQ(again->scanners.size(), 4u);
  EXPECT_EQ(io::valueOf(again->cloud, count(merged) + count(scan), "scan"), 3.0);
  const StageCloudPtr moved = outputOf(merged, R"({"type": "filters.transform", "transform": [1, 0, 0, 0, 0, 0]})");
  EXPECT_EQ(moved->scanners[1][0], 0.0) << "the scanners move along";
}

/// The scanner, where it is known; else the viewpoint.
TEST_F(SeenStages, KnowWhereASingleScanIsFrom)
{
  const std::string merge = R"({"type": "filters.merge", "inputs": ["in", "other"], "number_scans": true})";
  const io::Viewpoint stood = {7, 0, 1, 1, 0, 0, 0}, elsewhere = {-2, 0, 1, 1, 0, 0, 0};
  auto one = std::make_shared<StageCloud>(*cloudOf({0, 0, 0}, at_scanner));
  one->scanners = {stood};
  auto merged = std::make_shared<StageCloud>(*outputOf(one, merge, cloudOf({1, 0, 0}, elsewhere)));
  EXPECT_EQ(merged->scanners, (std::vector<io::Viewpoint>{stood, elsewhere}));
}

/// A file may number its scans and not say where they are from. A viewpoint at the origin is what a file without one
/// has.
TEST_F(SeenStages, KnowNoMergedScanWhereOneIsNotKnown)
{
  const std::string merge = R"({"type": "filters.merge", "inputs": ["in", "other"], "number_scans": true})";
  const StageCloudPtr one = cloudOf({0, 0, 0}, at_scanner), nowhere = cloudOf({1, 0, 0}, io::no_viewpoint);
  const auto two = std::make_shared<StageCloud>(*outputOf(one, merge, one));
  two->scanners.clear();
  two->viewpoint = at_scanner;
  const auto numbersOf = [](const StageCloudPtr& cloud) {
    std::vector<double> numbers;
    for (std::uint32_t i = 0; i < cloud->cloud.width; ++i) numbers.push_back(io::valueOf(cloud->cloud, i, "scan"));
    return numbers;
  };
  const StageCloudPtr merged = outputOf(two, merge, two);
  EXPECT_EQ(merged->scanners, std::vector<io::Viewpoint>());
  EXPECT_EQ(numbersOf(merged), (std::vector<double>{0, 1, 2, 3}));
  for (const StageCloudPtr& part : {outputOf(one, merge, nowhere), outputOf(nowhere, merge, one)}) {
    EXPECT_EQ(part->scanners, std::vector<io::Viewpoint>());
    EXPECT_EQ(numbersOf(part), (std::vector<double>{0, 1}));
    EXPECT_THAT(errorOf([&] { runStage(part, flag + "}", machine); }), HasSubstr("origin"));
  }
}

TEST_F(SeenStages, RefuseScanNumbersThatTheFieldDoesNotHold)
{
  const auto merged = [&](const auto& numbers) {
    auto cloud = std::make_shared<StageCloud>(*cloudOf({0, 0, 0}, at_scanner));
    cloud->cloud = withFields(cloud->cloud, {{"scan", &numbers}});
    return outputOf(cloud, R"({"type": "filters.merge", "inputs": ["in", "other"], "number_scans": true})", cloud);
  };
  const auto refused = [&](const auto& numbers) { return errorOf([&] { merged(numbers); }); };
  EXPECT_EQ(io::valueOf(merged(std::vector<std::uint8_t>{127})->cloud, 1, "scan"), 255.0);
  EXPECT_THAT(
      refused(std::vector<std::uint8_t>{128}),
      HasSubstr(
          "has scan number 128, and 129 scans are before it: the field `scan` takes whole numbers from 0 to 255"));
  for (const float number : {-1.0f, 0.5f, NAN, 1e8f})
    EXPECT_THAT(refused(std::vector<float>{number}),
                HasSubstr("the field `scan` takes whole numbers from 0 to 16777216"));
}

} // namespace
} // namespace pcl_bsh::pipeline
