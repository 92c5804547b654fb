// SPDX-License-Identifier: BSD-3-Clause
// The stages that measure distances: against the filter called directly, and brute force.
#include "../filters/clouds.h"
#include "io/clouds/samples.h"
#include "run_stage.h"

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/io/clouds/cloud_file.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace pcl_bsh::pipeline {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

class DistanceStages : public testing::Test {
protected:
  DistanceStages()
  {
    points[3].x() = std::nan("");
    const auto add = [](const pcl::PCLPointCloud2& cloud) {
      auto made = std::make_shared<StageCloud>();
      made->cloud = cloud;
      made->viewpoint[0] = 5;
      return made;
    };
    after = add(*test::fieldCloud<double>(points));
    before = add(*test::fieldCloud<float>(others));
  }

  StageCloudPtr output(const std::string& options = "") const
  {
    return outputOf(after, R"({"type": "filters.bsh_distance", "obstacle": "other")" + options + "}", before);
  }

  std::string error(const std::string& type, const std::string& options) const
  {
    return errorOf(
        [&] { runStage(after, R"({"type": ")" + type + R"(", "obstacle": "other", )" + options + "}", before); });
  }

  static std::shared_ptr<const pcl::PCLPointCloud2> pcl2Of(const StageCloudPtr& cloud)
  {
    return {cloud, &cloud->cloud};
  }

  PointDistances brute() const
  {
    const SphereHierarchy a(viewOf(after->cloud)), b(viewOf(before->cloud));
    return brute_force::pointDistances({a}, {b});
  }

  test::Points points = test::randomPoints(700, 1);
  const test::Points others = test::randomPoints(300, 2);
  StageCloudPtr after, before;
  const io::TemporaryFolder folder;
};

TEST_F(DistanceStages, AddTheDistanceOfEachPoint)
{
  const StageCloudPtr all = output();
  ASSERT_EQ(all->cloud.width, points.size() - 1) << "all but the one that is not finite";
  EXPECT_EQ(all->viewpoint[0], 5);
  EXPECT_EQ(all->cloud.fields.back().name, "distance");
  const PointDistances truth = brute();
  for (std::size_t i = 0; i < all->cloud.width; ++i) {
    const auto from = static_cast<std::size_t>(io::valueOf(all->cloud, i, "label"));
    EXPECT_EQ(io::valueOf(all->cloud, i, "distance"), static_cast<float>(truth.distance[from]));
  }
}

TEST_F(DistanceStages, AreTheFilter)
{
  struct Case {
    std::string options;
    double least, most, max_distance;
    bool negative, organized;
  };
  for (const Case& c :
       std::vector<Case>{{R"(, "filter_limits": [0.05, null])", 0.05, infinity, infinity, false, false},
                         {R"(, "filter_limits": [null, 0.1], "max_distance": 0.02)", 0, 0.1, 0.02, false, false},
                         {R"(, "filter_limits": [0.05, 0.1], "negative": true)", 0.05, 0.1, infinity, true, false},
                         {R"(, "filter_limits": [0, 1], "number_of_threads": 2)", 0, 1, infinity, false, false},
                         {R"(, "filter_limits": [0.05, 0.1], "keep_organized": true, "user_filter_value": 7)", 0.05,
                          0.1, infinity, false, true}}) {
    DistanceFilter<pcl::PCLPointCloud2> direct;
    direct.setInputCloud(pcl2Of(after));
    direct.setObstacleCloud(pcl2Of(before));
    direct.setFilterLimits(c.least, c.most);
    direct.setMaxDistance(c.max_distance);
    direct.setNegative(c.negative);
    direct.setKeepOrganized(c.organized);
    direct.setUserFilterValue(7);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.125, 0, 0);
    direct.setPose(pose);
    pcl::PCLPointCloud2 expected;
    direct.filter(expected);
    ASSERT_GT(expected.width, 0U);
    const StageCloudPtr found = output(c.options + R"(, "pose": [0.125, 0, 0, 0, 0, 0])");
    EXPECT_EQ(found->cloud.width, expected.width) << c.options;
    EXPECT_TRUE(found->cloud.data == expected.data) << c.options;
  }
  EXPECT_GT(output(R"(, "accuracy": "tolerance=0.1")")->cloud.width, 0U);
  EXPECT_THAT(error("filters.bsh_distance", R"("filter_limits": [-1, null])"), HasSubstr("/filter_limits: from -1 "));
}

TEST_F(DistanceStages, TheirFieldIsKnownBeforehand)
{
  io::writeCloud(folder / "scan.pcd", after->cloud);
  const std::string scan = '"' + (folder / "scan.pcd").string() + '"';
  const auto validate = [&](const std::string& field) {
    Pipeline::parse("[" + scan + R"(, {"type": "filters.bsh_distance", "obstacle": )" + scan +
                    R"(}, {"type": "filters.pass_through", "filter_field_name": ")" + field + R"("}, ")" +
                    (folder / "out.pcd").string() + "\"]")
        .validate();
  };
  EXPECT_NO_THROW(validate("distance"));
  EXPECT_THAT(errorOf([&] { validate("distances"); }), HasSubstr("/2/filter_field_name: "));
}

TEST_F(DistanceStages, WriteNumbersAndAPage)
{
  const std::string page = (folder / "a.html").string(), json = (folder / "a.json").string();
  const PipelineResult result =
      runStage(after,
               R"({"type": "writers.distances", "obstacle": "other", "filename": ")" + page + R"(", "also": ")" + json +
                   R"(", "unit": "m", "input_name": "<i>\"after\"", "places_beyond": 0.08})",
               before);
  EXPECT_THAT(result.warnings, testing::ElementsAre(HasSubstr("the input: 1 of 700 points is not finite")));
  const nlohmann::json told = nlohmann::json::parse(io::contentOf(json));
  const PointDistances truth = brute();
  EXPECT_EQ(told["input"], "<i>\"after\"");
  EXPECT_EQ(told["unit"], "m");
  EXPECT_EQ(told["input_to_obstacle"]["count"], truth.measured);
  EXPECT_EQ(told["input_to_obstacle"]["maximum"], truth.greatest);
  EXPECT_EQ(told["input_to_obstacle"]["places_beyond"], 0.08);
  EXPECT_GE(told["hausdorff"], truth.greatest);
  EXPECT_THAT(io::contentOf(page), HasSubstr("&lt;i&gt;&quot;after&quot;"));
}

TEST_F(DistanceStages, RefuseWhatMakesNoSense)
{
  const std::string filename = R"("filename": ")" + (folder / "a.html").string() + R"(", )";
  for (const std::string type : {"filters.bsh_distance", "writers.distances"}) {
    const std::string file = type == "writers.distances" ? filename : "";
    EXPECT_THAT(error(type, file + R"("max_distance": -1)"), HasSubstr("/max_distance: is -1: give a number"));
    EXPECT_THAT(error(type, file + R"("accuracy": "level=1")"),
                HasSubstr("/accuracy: level=1: leaves points without a distance"));
    EXPECT_THAT(error(type, file + R"("accuracy": "roughly")"), HasSubstr("/accuracy: "));
    EXPECT_THAT(error(type, file + R"("pose": [1,0,0,0, 0,2,0,0, 0,0,1,0])"), HasSubstr("/pose: "));
  }
  EXPECT_THAT(error("filters.bsh_distance", R"("filter_limits": [0.2, 0.1])"), HasSubstr("/filter_limits: from "));
  EXPECT_THAT(error("filters.bsh_distance", R"("filter_limits": [-1, 0.1])"), HasSubstr("/filter_limits: from "));
  EXPECT_THAT(error("writers.distances", R"("filename": "a.csv")"), HasSubstr("/filename: a.csv: unknown extension"));
  EXPECT_THAT(error("writers.distances", R"("filename": "none/a.html")"), HasSubstr("/filename: none"));
  EXPECT_THAT(error("writers.distances", filename + R"("places_beyond": -1)"), HasSubstr("/places_beyond: is -1"));
  EXPECT_EQ(folder.files(), 0U) << "nothing was written";

  auto taken = std::make_shared<StageCloud>(*after);
  taken->cloud.fields[4].name = "distance";
  taken->cloud.fields[4].datatype = pcl::PCLPointField::INT32;
  after = taken;
  EXPECT_THAT(errorOf([&] { output(); }), HasSubstr("field 'distance' exists already"));
}

TEST_F(DistanceStages, EmptyCloudsAreFarFromEverything)
{
  auto none = std::make_shared<StageCloud>();
  none->cloud = *test::fieldCloud<float>({});
  before = none;
  EXPECT_EQ(output(R"(, "filter_limits": [9, null])")->cloud.width, points.size() - 1);
  EXPECT_EQ(output(R"(, "filter_limits": [0, 1e300])")->cloud.width, 0U);
  std::swap(before, after);
  EXPECT_EQ(output()->cloud.width, 0U);
}

} // namespace
} // namespace pcl_bsh::pipeline
