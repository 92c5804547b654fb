// SPDX-License-Identifier: BSD-3-Clause
// Where stages go beyond PCL's classes: float64, large scenes, every field, clouds that are empty or not finite.
#include "../filters/clouds.h"
#include "io/clouds/samples.h"
#include "run_stage.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace pcl_bsh::pipeline {
namespace {

using test::Points;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

template <typename Coordinate>
StageCloudPtr cloudOf(const Points& points)
{
  auto cloud = std::make_shared<StageCloud>();
  cloud->cloud = *test::fieldCloud<Coordinate>(points);
  cloud->viewpoint = {1, 2, 3, 1, 0, 0, 0};
  return cloud;
}

Points pointsOf(const StageCloudPtr& cloud)
{
  const PointsView view = viewOf(cloud->cloud);
  Points points;
  for (std::uint32_t i = 0; i < view.count; ++i) {
    const Point3 p = view.point(i);
    points.emplace_back(p[0], p[1], p[2]);
  }
  return points;
}

/// Points about a corner of a UTM zone, to the tenth of a millimetre.
Points utmPoints(std::size_t count)
{
  Points points = test::randomPoints(count, 3);
  for (Eigen::Vector3d& p : points) p = p * 10 + Eigen::Vector3d(500000.1234, 5400000.5678, 100.25);
  return points;
}

/// All stages that take one input and need no second, with options that suit points in a cube of edge 1.
const std::map<std::string, std::string> filters = {
    {"filters.voxel_grid", R"("leaf_size": 0.1)"},
    {"filters.approximate_voxel_grid", R"("leaf_size": 0.1)"},
    {"filters.uniform_sampling", R"("radius_search": 0.1)"},
    {"filters.pass_through", R"("filter_field_name": "z", "filter_limits": [-0.2, 0.2])"},
    {"filters.crop_box", R"("min": [-0.3, -0.3, -0.3], "max": [0.3, 0.3, 0.3])"},
    {"filters.statistical_outlier_removal", R"("mean_k": 4, "stddev_mul_thresh": 1)"},
    {"filters.radius_outlier_removal", R"("radius_search": 0.1, "min_neighbors_in_radius": 2)"},
    {"filters.transform", R"("transform": [1, 2, 3, 0, 0, 0.5])"},
    {"filters.normal_estimation", R"("k_search": 8)"},
    {"filters.euclidean_cluster", R"("cluster_tolerance": 0.1)"},
    {"filters.merge", R"("tag": "all")"},
    {"filters.bsh_collision", R"("obstacle": "in", "clearance": 0, "keep": "colliding")"},
    {"filters.bsh_flag", R"("obstacle": "in", "clearance": 2)"}};

std::string stageOf(const std::string& type)
{
  return R"({"type": ")" + type + R"(", )" + filters.at(type) + "}";
}

TEST(Stages, KeepEveryFieldTheFrameAndTheViewpoint)
{
  for (const auto& [type, options] : filters) {
    const StageCloudPtr in = cloudOf<float>(test::randomPoints(500, 1));
    const StageCloudPtr out = outputOf(in, stageOf(type));
    EXPECT_GT(out->cloud.width, 0U) << type;
    ASSERT_GE(out->cloud.fields.size(), in->cloud.fields.size()) << type;
    for (std::size_t i = 0; i < in->cloud.fields.size(); ++i) {
      EXPECT_EQ(out->cloud.fields[i].name, in->cloud.fields[i].name) << type;
      EXPECT_EQ(out->cloud.fields[i].datatype, in->cloud.fields[i].datatype) << type;
    }
    EXPECT_EQ(out->cloud.data.size(), std::size_t{out->cloud.width} * out->cloud.height * out->cloud.point_step)
        << type;
    EXPECT_EQ(out->cloud.row_step, out->cloud.width * out->cloud.point_step) << type;
    EXPECT_EQ(out->cloud.header.frame_id, "scanner") << type;
    EXPECT_EQ(out->viewpoint == in->viewpoint, type != "filters.transform") << type;
  }
}

TEST(Stages, TakeEmptyClouds)
{
  for (const auto& [type, options] : filters) {
    const StageCloudPtr out = outputOf(cloudOf<float>({}), stageOf(type));
    EXPECT_EQ(out->cloud.width * out->cloud.height, 0U) << type;
    EXPECT_THAT(out->cloud.data, IsEmpty()) << type;
    EXPECT_NO_THROW(viewOf(out->cloud)) << type;
  }
}

TEST(Stages, TakePointsThatAreNotFinite)
{
  Points points = test::randomPoints(300, 2);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    points[points.size() / 3].x() = bad;
    points.back().z() = -bad;
    points.push_back(points[0]);
  }
  std::size_t finite = 0;
  for (const Eigen::Vector3d& p : points) finite += p.allFinite() ? 1 : 0;
  for (const auto& [type, options] : filters) {
    const StageCloudPtr out = outputOf(cloudOf<float>(points), stageOf(type));
    const bool keeps_all = type == "filters.transform" || type == "filters.normal_estimation" ||
                           type == "filters.euclidean_cluster" || type == "filters.merge" || type == "filters.bsh_flag";
    if (keeps_all) {
      EXPECT_EQ(out->cloud.width, points.size()) << type;
      continue;
    }
    EXPECT_LE(out->cloud.width, finite) << type;
    for (const Eigen::Vector3d& p : pointsOf(out)) EXPECT_TRUE(p.allFinite()) << type;
  }
  const StageCloudPtr clusters = outputOf(cloudOf<float>(points), stageOf("filters.euclidean_cluster"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double number = io::valueOf(clusters->cloud, i, "cluster");
    if (points[i].allFinite())
      EXPECT_GE(number, 0) << i;
    else
      EXPECT_EQ(number, -1) << i;
  }
}

TEST(Stages, KeepFloat64AsItIs)
{
  const Points points = utmPoints(400);
  const StageCloudPtr in = cloudOf<double>(points);
  const std::string near_origin = R"("translation": [500000.1234, 5400000.5678, 100.25])";
  for (const std::string& stage :
       {std::string(R"({"type": "filters.crop_box", "min": [-3, -3, -9], "max": [3, 3, 9], )") + near_origin + "}",
        std::string(
            R"({"type": "filters.pass_through", "filter_field_name": "y", "filter_limits": [5400000.5678, null]})"),
        std::string(R"({"type": "filters.statistical_outlier_removal", "mean_k": 4, "stddev_mul_thresh": 1})"),
        std::string(R"({"type": "filters.radius_outlier_removal", "radius_search": 1, "min_neighbors_in_radius": 2})"),
        std::string(R"({"type": "filters.uniform_sampling", "radius_search": 1})"),
        std::string(R"({"type": "filters.bsh_collision", "obstacle": "in", "clearance": 100, "keep": "colliding"})")}) {
    const PipelineResult result = runStage(in, stage);
    const StageCloudPtr out = result.clouds.begin()->second;
    EXPECT_GT(out->cloud.width, 0U) << stage;
    EXPECT_THAT(result.warnings, IsEmpty()) << stage;
    for (std::size_t i = 0; i < out->cloud.width; ++i) {
      std::uint16_t label;
      std::memcpy(&label, test::record(out->cloud, i).data(), sizeof label);
      EXPECT_EQ(test::record(out->cloud, i), test::record(in->cloud, label)) << stage;
    }
  }
}

TEST(Stages, CropBoxAndPassThroughCutFloat64Exactly)
{
  // 1/8 mm steps about the limit, which float32 could not tell apart at all.
  Points points;
  for (int i = -4; i <= 4; ++i) points.emplace_back(5400000.0 + i * 0.000125, 0, 0);
  EXPECT_THAT(pointsOf(outputOf(cloudOf<double>(points), R"({"type": "filters.crop_box", "min": [5400000, -1, -1],
                                                            "max": [5400000.00025, 1, 1]})")),
              ElementsAre(points[4], points[5], points[6]));
  EXPECT_THAT(pointsOf(outputOf(cloudOf<double>(points), R"({"type": "filters.pass_through", "filter_field_name": "x",
                                                            "filter_limits": [null, 5399999.999625]})")),
              ElementsAre(points[0], points[1]));
}

TEST(Stages, PassThroughKeepsNothingWithoutAValue)
{
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  pcl::PointCloud<pcl::PointXYZI> points;
  for (const auto& [x, intensity] : {std::pair(0.0f, 1.0f), {1.0f, nothing}, {2.0f, 3.0f}, {nothing, 3.0f}}) {
    pcl::PointXYZI point;
    point.x = x, point.y = point.z = 0.0f;
    point.intensity = intensity;
    points.push_back(point);
  }
  const auto kept = [&](const std::string& options) {
    std::vector<double> places;
    for (const Eigen::Vector3d& p :
         pointsOf(outputOf(stageCloud(points), R"({"type": "filters.pass_through")" + options + "}")))
      places.push_back(p.x());
    return places;
  };
  const std::string from_two = R"(, "filter_field_name": "intensity", "filter_limits": [2, null])";
  EXPECT_THAT(kept(from_two), ElementsAre(2));
  EXPECT_THAT(kept(from_two + R"(, "negative": true)"), ElementsAre(0));
  EXPECT_THAT(kept(""), ElementsAre(0, 1, 2)) << "all with a place";
}

TEST(Stages, VoxelGridKeepsTheDigitsOfFloat64)
{
  const Points points = {{500000.0001, 5400000.0001, 100}, {500000.0003, 5400000.0005, 100.5}};
  const Points mean = pointsOf(outputOf(cloudOf<double>(points), R"({"type": "filters.voxel_grid", "leaf_size": 1})"));
  ASSERT_EQ(mean.size(), 1U);
  EXPECT_NEAR(mean[0].x(), 500000.0002, 1e-9);
  EXPECT_NEAR(mean[0].y(), 5400000.0003, 1e-8);
}

TEST(Stages, VoxelGridIsRightWherePclOverflows)
{
  // PCL numbers cells with 32 bits, and returns these three points as they are, or worse.
  const Points points = {{0, 0, 0}, {1000, 1000, 1000}, {0.5, 0, 0}, {0.502, 0.001, 0}};
  for (const std::string type : {"filters.voxel_grid", "filters.approximate_voxel_grid"}) {
    const Points out = pointsOf(outputOf(cloudOf<float>(points), R"({"type": ")" + type + R"(", "leaf_size": 0.01})"));
    ASSERT_EQ(out.size(), 3U) << type;
    std::size_t merged = 0;
    for (const Eigen::Vector3d& p : out) merged += std::abs(p.x() - 0.501) < 1e-6 ? 1 : 0;
    EXPECT_EQ(merged, 1U) << type;
  }
  EXPECT_EQ(
      outputOf(cloudOf<float>(points), R"({"type": "filters.uniform_sampling", "radius_search": 0.01})")->cloud.width,
      3U);
}

TEST(Stages, GridsTellCellsApartWhoseNumbersAgreeIn32Bits)
{
  // 65536 x 65536 cells to a layer: the first cell of the second layer has number 2^32.
  const Points points = {{0.5, 0.5, 0.5}, {65535.5, 65535.5, 0.5}, {0.5, 0.5, 1.5}};
  for (const std::string stage : {R"({"type": "filters.voxel_grid", "leaf_size": 1})",
                                  R"({"type": "filters.uniform_sampling", "radius_search": 1})"}) {
    EXPECT_EQ(outputOf(cloudOf<double>(points), stage)->cloud.width, 3U) << stage;
    EXPECT_EQ(outputOf(cloudOf<double>({points[0], points[1], points[0]}), stage)->cloud.width, 2U) << stage;
  }
}

TEST(Stages, VoxelGridCountsBeyondFloat)
{
  // 2^25 cells from the origin, where float counts by twos.
  const Points points = {{33554432.25, 0, 0}, {33554433.25, 0, 0}, {33554434.25, 0, 0}, {33554434.5, 0, 0}};
  EXPECT_EQ(outputOf(cloudOf<double>(points), R"({"type": "filters.voxel_grid", "leaf_size": 1})")->cloud.width, 3U);
}

TEST(Stages, VoxelGridRefusesCellsBeyondCounting)
{
  const auto error = [](const Points& points, const std::string& size) {
    return errorOf(
        [&] { outputOf(cloudOf<double>(points), R"({"type": "filters.voxel_grid", "leaf_size": )" + size + "}"); });
  };
  EXPECT_THAT(error({{0, 0, 0}, {1e9, 1e9, 1e9}}, "0.001"),
              EndsWith("/1/leaf_size: a grid of 1000000000001 x 1000000000001 x 1000000000001 cells is too large to be "
                       "numbered: give larger cells"));
  const Points most = {{0.5, 0.5, 0.5}, {1999999.5, 1999999.5, 2299999.5}}; // 9.2e18 cells
  EXPECT_EQ(outputOf(cloudOf<double>(most), R"({"type": "filters.voxel_grid", "leaf_size": 1})")->cloud.width, 2U);
  EXPECT_THAT(error({most[0], most[1] + Eigen::Vector3d(0, 0, 1)}, "1"), HasSubstr("2300001 cells is too large"));
  EXPECT_THAT(error({{0, 0, 0}, {1e300, 0, 0}}, "0.001"),
              HasSubstr("/1/leaf_size: cells of this size cannot be counted"));
}

TEST(Stages, NeighbourSearchSaysWhatFloatLoses)
{
  const auto wide = [](double size) {
    Points points = test::randomPoints(200, 4);
    for (Eigen::Vector3d& p : points) p *= 100;
    points[0].x() = size;
    points[0].y() += 1e-7;
    return cloudOf<double>(points);
  };
  const std::string stage =
      R"({"type": "filters.radius_outlier_removal", "radius_search": 20, "min_neighbors_in_radius": 2})";
  EXPECT_THAT(runStage(wide(100), stage).warnings, IsEmpty());
  EXPECT_THAT(
      runStage(wide(5e5), stage).warnings,
      ElementsAre(HasSubstr("float32, in which neighbours are searched, moves points of this float64 cloud by up to")));
  EXPECT_THAT(errorOf([&] { runStage(wide(5e7), stage); }), EndsWith(": crop the cloud first"));
  EXPECT_THAT(errorOf([&] { runStage(wide(1e200), stage); }), HasSubstr("too large for float32"));
}

TEST(Stages, ClustersSayWhatFloatLoses)
{
  const auto warningsOf = [](double far) {
    return runStage(cloudOf<double>({{0.1, 0, 0}, {0.2, 0, 0}, {far, 0, 0}}),
                    R"({"type": "filters.euclidean_cluster", "cluster_tolerance": 1})")
        .warnings;
  };
  EXPECT_THAT(warningsOf(10), IsEmpty());
  EXPECT_THAT(warningsOf(1e5), ElementsAre(HasSubstr("moves points of this float64 cloud by up to")));
  const auto moved_by_one =
      [](const char* tolerance) { // a ten thousandth of it is heard of, a hundredth refused beyond
        return runStage(cloudOf<double>({{-0x1.000001p24, 0, 0}, {0x1.000001p24, 0, 0}}),
                        std::string(R"({"type": "filters.euclidean_cluster", "cluster_tolerance": )") + tolerance + "}")
            .warnings;
      };
  EXPECT_THAT(moved_by_one("10000"), IsEmpty());
  EXPECT_THAT(moved_by_one("9999"), SizeIs(1));
  EXPECT_THAT(moved_by_one("100"), SizeIs(1));
  EXPECT_THAT(errorOf([&] { moved_by_one("99"); }), EndsWith(": crop the cloud first"));
}

TEST(Stages, CountingNeighboursSaysWhatFloatLoses)
{
  // Two heaps of neighbours some centimetres apart: nothing of that is seen in the box around both.
  const auto heaps = [](double apart) {
    Points points = test::randomPoints(400, 4);
    for (std::size_t i = 0; i < points.size(); i += 2) points[i] += Eigen::Vector3d(apart, apart, 0);
    return cloudOf<double>(points);
  };
  for (const std::string stage : {R"({"type": "filters.normal_estimation", "k_search": 8})",
                                  R"({"type": "filters.statistical_outlier_removal", "mean_k": 8})"}) {
    EXPECT_THAT(runStage(heaps(5), stage).warnings, IsEmpty());
    EXPECT_THAT(runStage(heaps(2e3), stage).warnings, ElementsAre(HasSubstr("moves points of this float64 cloud by")));
    EXPECT_THAT(errorOf([&] { runStage(heaps(5e5), stage); }), EndsWith(": crop the cloud first"));
  }
}

TEST(Stages, KeepFloat64BesideWhatTheyAdd)
{
  const StageCloudPtr in = cloudOf<double>(utmPoints(400));
  for (const char* const type :
       {"filters.bsh_flag", "filters.merge", "filters.normal_estimation", "filters.euclidean_cluster"}) {
    const PipelineResult result = runStage(in, stageOf(type));
    const pcl::PCLPointCloud2& out = result.clouds.begin()->second->cloud;
    ASSERT_EQ(out.width, in->cloud.width) << type;
    EXPECT_THAT(result.warnings, IsEmpty()) << type;
    for (std::size_t i = 0; i < out.width; ++i) {
      ASSERT_EQ(
          std::memcmp(&out.data[i * out.point_step], &in->cloud.data[i * in->cloud.point_step], 3 * sizeof(double)), 0)
          << type;
    }
  }
}

TEST(Stages, TransformWarnsWhereFloatIsCoarse)
{
  const StageCloudPtr local = cloudOf<float>(test::randomPoints(50, 5));
  const std::string far = R"({"type": "filters.transform", "transform": [500000, 5400000, 0, 0, 0, 0]})";
  EXPECT_THAT(runStage(local, far).warnings, ElementsAre(HasSubstr("rounding moved points by up to 0.2")));
  EXPECT_THAT(runStage(cloudOf<double>(test::randomPoints(50, 5)), far).warnings, IsEmpty());
  EXPECT_THAT(runStage(local, R"({"type": "filters.transform", "transform": [1, 2, 3, 0, 0, 1]})").warnings, IsEmpty());
  EXPECT_THAT(errorOf([&] { runStage(local, R"({"type": "filters.transform", "transform": [1e39, 0, 0, 0, 0, 0]})"); }),
              HasSubstr("/1/transform: moves a point beyond all numbers"));
  EXPECT_THAT(
      errorOf([&] { runStage(local, R"({"type": "filters.transform", "transform": [1,0,0,0, 0,1,0,0, 0,0,0,0]})"); }),
      HasSubstr("/1/transform: flattens space"));
}

TEST(Stages, TransformTakesNoMatrixThatIsNoMotion)
{
  const StageCloudPtr cloud = cloudOf<double>({{1, 2, 3}});
  const auto moved = [&](const std::string& rows, const std::string& option = "") {
    return runStage(cloud, R"({"type": "filters.transform", "transform": [)" + rows + "]" + option + "}");
  };
  const auto refusal = [&](const std::string& rows, const std::string& option = "") {
    return errorOf([&] { moved(rows, option); });
  };
  const std::string allowed = R"(, "allow_scale": true)";
  const std::pair<const char*, const char*> wrong[] = {{"1,2,3,0, 4,5,6,0, 7,8,9,0", "flattens space"},
                                                       {"1,0,0,0, 0,1,0,0, 1,1,0,0", "flattens space"},
                                                       {"1,0,0,0, 0,-1,0,0, 0,0,1,0", "mirrors"},
                                                       {"1,0.1,0,0, 0,1,0,0, 0,0,1,0", "shears or scales unevenly"},
                                                       {"1,0,0,0, 0,1,0,0, 0,0,3,0", "shears or scales unevenly"}};
  for (const auto& [rows, text] : wrong)
    for (const std::string& option : {std::string(), allowed})
      EXPECT_THAT(refusal(rows, option), HasSubstr(std::string("/1/transform: ") + text)) << rows;
  const std::string millimetres = "0.001,0,0,0, 0,0.001,0,0, 0,0,0.001,5";
  EXPECT_THAT(refusal(millimetres),
              HasSubstr("/1/transform: scales by 0.001: give \"allow_scale\": true if that is meant"));
  const auto scaled = moved(millimetres, allowed);
  EXPECT_EQ(viewOf(scaled.clouds.begin()->second->cloud).point(0), (Point3{0.001, 0.002, 0.003 + 5}));
  EXPECT_THAT(scaled.warnings, IsEmpty());
  EXPECT_THAT(moved("0.8,-0.6,0,0, 0.60002,0.8,0,0, 0,0,1,0").warnings,
              ElementsAre(HasSubstr("transform: |R'R - I| is ")));
}

TEST(Stages, TransformMovesTheViewpoint)
{
  const StageCloudPtr out =
      outputOf(cloudOf<float>(test::randomPoints(5, 5)),
               R"({"type": "filters.transform", "transform": [10, 0, 0, 0, 0, 1.5707963267948966]})");
  EXPECT_NEAR(out->viewpoint[0], 8, 1e-6);
  EXPECT_NEAR(out->viewpoint[1], 1, 1e-6);
  EXPECT_NEAR(out->viewpoint[2], 3, 1e-6);
  EXPECT_NEAR(out->viewpoint[6], std::sqrt(0.5), 1e-6);
}

TEST(Stages, NormalsPointToWhereTheSensorStood)
{
  Points plane;
  for (int i = 0; i < 100; ++i) plane.emplace_back(i % 10, i / 10, 0);
  plane.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  auto cloud = std::make_shared<StageCloud>();
  cloud->cloud = *test::fieldCloud<float>(plane);
  for (const float side : {5.0F, -5.0F}) {
    cloud->viewpoint = {5, 5, side, 1, 0, 0, 0};
    const StageCloudPtr out = outputOf(cloud, R"({"type": "filters.normal_estimation", "k_search": 9})");
    EXPECT_NEAR(io::valueOf(out->cloud, 50, "normal_z"), side > 0 ? 1 : -1, 1e-6);
    EXPECT_TRUE(std::isnan(io::valueOf(out->cloud, 100, "normal_z"))) << "a point that is nowhere has none";
  }
}

TEST(Stages, PassThroughReadsAnyTypeOfField)
{
  const StageCloudPtr in = cloudOf<float>(test::randomPoints(100, 6));
  const auto count = [&](const std::string& limits) {
    return outputOf(in, R"({"type": "filters.pass_through", "filter_field_name": "label", "filter_limits": )" + limits +
                            "}")
        ->cloud.width;
  };
  EXPECT_EQ(count("[10, 19]"), 10U);
  EXPECT_EQ(count("[null, 4.5]"), 5U);
  EXPECT_EQ(count("[null, null]"), 100U);
}

/// A cloud of one field `stamp` beside x y z, of that many values.
template <typename T>
StageCloudPtr stamped(std::uint8_t datatype, const std::vector<T>& stamps)
{
  auto cloud = std::make_shared<StageCloud>();
  for (const char* const axis : {"x", "y", "z"}) io::addField(cloud->cloud, axis, pcl::PCLPointField::FLOAT32);
  io::addField(cloud->cloud, "stamp", datatype);
  io::allocate(cloud->cloud, static_cast<std::uint32_t>(stamps.size()));
  for (std::size_t i = 0; i < stamps.size(); ++i)
    std::memcpy(&cloud->cloud.data[i * cloud->cloud.point_step + 12], &stamps[i], sizeof(T));
  return cloud;
}

/// How many pass.
std::size_t passing(const StageCloudPtr& cloud, const std::string& limits, bool negative = false)
{
  return outputOf(cloud, R"({"type": "filters.pass_through", "filter_field_name": "stamp", "filter_limits": )" +
                             limits + (negative ? R"(, "negative": true})" : "}"))
      ->cloud.width;
}

TEST(Stages, PassThroughTellsNanosecondsApart)
{
  // Doubles are 256 apart here.
  constexpr std::int64_t begin = 1700000000000000000;
  std::vector<std::int64_t> stamps;
  for (std::int64_t i = -1000; i < 1000; ++i) stamps.push_back(begin + i);
  const StageCloudPtr cloud = stamped(pcl::PCLPointField::INT64, stamps);
  const std::string limits = "[1700000000000000000, 1700000000000000100]";
  EXPECT_EQ(passing(cloud, limits), 101U);
  EXPECT_EQ(passing(cloud, limits, true), 2000U - 101U);
  EXPECT_EQ(passing(cloud, "[null, 1699999999999999999]"), 1000U);
  EXPECT_EQ(passing(cloud, "[1699999999999999999.0, null]"), 1000U) << "a double, as it is written: 17e17";
  EXPECT_THAT(errorOf([&] { passing(cloud, "[1700000000000000001, 1700000000000000000]"); }),
              HasSubstr("has a least above its most"));
  const PipelineResult result = runStage(
      cloud, R"({"type": "filters.pass_through", "filter_field_name": "stamp", "filter_limits": )" + limits + "}");
  EXPECT_THAT(result.metadata, HasSubstr("1700000000000000100")) << "a document to run again";
}

TEST(Stages, PassThroughKnowsTheEndsOfEveryType)
{
  using Field = pcl::PCLPointField;
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  const StageCloudPtr naturals = stamped<std::uint64_t>(Field::UINT64, {0, 1, most - 1, most});
  EXPECT_EQ(passing(naturals, "[18446744073709551615, null]"), 1U);
  EXPECT_EQ(passing(naturals, "[null, 18446744073709551614]"), 3U);
  EXPECT_EQ(passing(naturals, "[-1, 1e300]"), 4U);
  EXPECT_EQ(passing(naturals, "[-1e300, -1]"), 0U);
  EXPECT_EQ(passing(naturals, "[0.5, 1.5]"), 1U);
  EXPECT_EQ(passing(naturals, "[1e300, null]"), 0U);
  EXPECT_EQ(passing(naturals, "[18446744073709551616, null]"), 0U) << "2^64";
  constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
  const StageCloudPtr integers = stamped<std::int64_t>(Field::INT64, {lowest, lowest + 1, -1, 0});
  EXPECT_EQ(passing(integers, "[null, -9223372036854775808]"), 1U);
  EXPECT_EQ(passing(integers, "[-9223372036854775807, null]"), 3U);
  EXPECT_EQ(passing(integers, "[-1.5, -0.5]"), 1U);
  const StageCloudPtr bytes = stamped<std::int8_t>(Field::INT8, {-128, -1, 127});
  EXPECT_EQ(passing(bytes, "[-1000, 126]"), 2U);
  EXPECT_EQ(passing(bytes, "[127.5, null]"), 0U);
  // 2^53 + 1 lies between doubles: what is at least that is at least 2^53 + 2.
  const StageCloudPtr doubles = stamped<double>(Field::FLOAT64, {9007199254740992, 9007199254740994});
  EXPECT_EQ(passing(doubles, "[9007199254740993, null]"), 1U);
  EXPECT_EQ(passing(doubles, "[null, 9007199254740993]"), 1U);
  // As PCL has it, 0.3 is the float 0.3 next to floats.
  const StageCloudPtr floats = stamped<float>(Field::FLOAT32, {0.3F, std::numeric_limits<float>::max()});
  EXPECT_EQ(passing(floats, "[0.3, null]"), 2U);
  EXPECT_EQ(passing(floats, "[null, 0.3]"), 1U);
  EXPECT_EQ(passing(floats, "[1e39, null]"), 0U);
}

TEST(Stages, OptionsThatContradictEachOther)
{
  const StageCloudPtr in = cloudOf<float>(test::randomPoints(10, 6));
  const auto error = [&](const std::string& stage) { return errorOf([&] { runStage(in, stage); }); };
  EXPECT_THAT(error(R"({"type": "filters.pass_through", "filter_limits": [2, 1]})"),
              EndsWith("/1/filter_limits: has a least above its most: exchange them"));
  EXPECT_THAT(
      error(R"({"type": "filters.pass_through", "filter_field_name": "intensty"})"),
      EndsWith("/1/filter_field_name: is 'intensty', which is no field with one value: did you mean 'intensity'?"));
  EXPECT_THAT(error(R"({"type": "filters.crop_box", "min": [0, 0, 0], "max": [1, -1, 1]})"),
              EndsWith("/1/min: lies above `max`: exchange them"));
  EXPECT_THAT(error(R"({"type": "filters.normal_estimation"})"),
              EndsWith("/1/k_search: and `radius_search` are neither given: give one of them"));
  EXPECT_THAT(error(R"({"type": "filters.normal_estimation", "k_search": 5, "radius_search": 1})"),
              EndsWith("/1/k_search: and `radius_search` are both given: give one of them"));
  EXPECT_THAT(error(R"({"type": "filters.euclidean_cluster", "cluster_tolerance": 1, "min_cluster_size": 5,
                        "max_cluster_size": 4})"),
              EndsWith("/1/min_cluster_size: exceeds `max_cluster_size`: exchange them"));
  EXPECT_THAT(error(R"({"type": "filters.statistical_outlier_removal", "mean_k": 10})"),
              EndsWith("/1/mean_k: is 10, but there are only 10 finite points: give less"));
  EXPECT_THAT(
      error(R"({"type": "filters.bsh_flag", "obstacle": "in", "clearance": 1, "pose": [1,0,0,0, 0,2,0,0, 0,0,1,0]})"),
      HasSubstr("/1/pose: "));
}

/// Numbers of an earlier run are replaced, and nothing else is.
TEST(Stages, ClustersAreNumberedAnew)
{
  const StageCloudPtr in = cloudOf<float>({{0, 0, 0}, {0.5, 0, 0}, {2, 0, 0}, {0.25, 0, 0}});
  const auto clustered = [](const StageCloudPtr& cloud, const std::string& tolerance) {
    return outputOf(cloud, R"({"type": "filters.euclidean_cluster", "cluster_tolerance": )" + tolerance + "}");
  };
  const auto numbersOf = [](const StageCloudPtr& cloud) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < cloud->cloud.width; ++i) numbers.push_back(io::valueOf(cloud->cloud, i, "cluster"));
    return numbers;
  };
  const StageCloudPtr once = clustered(in, "0.3"), again = clustered(once, "5");
  EXPECT_THAT(numbersOf(once), ElementsAre(0, 0, 1, 0));
  EXPECT_THAT(numbersOf(again), ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(again->cloud.point_step, once->cloud.point_step);
  EXPECT_EQ(again->cloud.fields.size(), once->cloud.fields.size());
  EXPECT_EQ(pointsOf(again), pointsOf(in));

  auto other = std::make_shared<StageCloud>(*once);
  other->cloud.fields.back().count = 0; // one, as PCL once wrote it
  EXPECT_THAT(numbersOf(clustered(other, "5")), ElementsAre(0, 0, 0, 0));
  const std::string refusal = "the cloud has a field 'cluster' of another type: rename it";
  other->cloud.fields.back().count = 2;
  EXPECT_THAT(errorOf([&] { clustered(other, "5"); }), EndsWith(refusal));
  other->cloud.fields.back().count = 1;
  other->cloud.fields.back().datatype = pcl::PCLPointField::FLOAT32;
  EXPECT_THAT(errorOf([&] { clustered(other, "5"); }), EndsWith(refusal));
}

/// A cloud of x y z at the origin, and of more fields: name, type and count.
pcl::PCLPointCloud2 cloudWith(const std::vector<std::tuple<std::string, std::uint8_t, std::uint32_t>>& fields,
                              std::uint32_t points)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* const axis : {"x", "y", "z"}) io::addField(cloud, axis, pcl::PCLPointField::FLOAT32);
  for (const auto& [name, datatype, count] : fields) io::addField(cloud, name, datatype, count);
  io::allocate(cloud, points);
  return cloud;
}

/// Sets the first value of a field.
void set(pcl::PCLPointCloud2& cloud, std::size_t record, const std::string& name, double number)
{
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name != name) continue;
    io::withFieldType(field.datatype, [&](auto value) {
      value = static_cast<decltype(value)>(number);
      std::memcpy(&cloud.data[record * cloud.point_step + field.offset], &value, sizeof value);
    });
  }
}

StageCloudPtr asInput(const pcl::PCLPointCloud2& cloud)
{
  auto input = std::make_shared<StageCloud>();
  input->cloud = cloud;
  return input;
}

/// Normals of three fields of one floating-point type, with one value each; a field without a direction keeps none.
TEST(Stages, TransformTurnsNormalsOfAnyRealType)
{
  using Field = pcl::PCLPointField;
  const auto turned = [](const std::array<std::uint8_t, 3>& types, std::uint32_t count, const Eigen::Vector3d& normal) {
    pcl::PCLPointCloud2 cloud = cloudWith(
        {{"normal_x", types[0], 1}, {"normal_y", types[1], std::max(count, 1U)}, {"normal_z", types[2], 1}}, 2);
    if (count == 0) cloud.fields[4].count = 0;
    for (int k = 0; k < 3; ++k) set(cloud, 1, std::string("normal_") + "xyz"[k], normal[k]);
    const StageCloudPtr out =
        outputOf(asInput(cloud), R"({"type": "filters.transform", "transform": [0, 0, 0, 0, 0, 1.5707963267948966]})");
    Eigen::Vector3d found;
    for (int k = 0; k < 3; ++k) found[k] = io::valueOf(out->cloud, 1, std::string("normal_") + "xyz"[k]);
    return found;
  };
  constexpr std::uint8_t narrow = Field::FLOAT32, wide = Field::FLOAT64;
  const Eigen::Vector3d before(2, 0, 0), after(0, 2, 0);
  EXPECT_TRUE(turned({narrow, narrow, narrow}, 1, before).isApprox(after, 1e-6));
  EXPECT_TRUE(turned({wide, wide, wide}, 1, before).isApprox(after, 1e-15));
  EXPECT_TRUE(turned({wide, wide, wide}, 0, before).isApprox(after, 1e-15)) << "one, as PCL once wrote it";
  EXPECT_EQ(turned({narrow, narrow, narrow}, 2, before), before) << "two values";
  const Eigen::Vector3d whole(2, 1 << 30, 5); // whose bytes would pass for a double of 2
  EXPECT_EQ(turned({Field::INT32, Field::INT32, Field::INT32}, 1, whole), whole);
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<std::uint8_t, 3> types = {narrow, narrow, narrow};
    types[k] = wide;
    EXPECT_EQ(turned(types, 1, before), before) << k;
  }
  EXPECT_EQ(turned({narrow, narrow, narrow}, 1, {0, 0, 0}), Eigen::Vector3d::Zero());
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(turned({wide, wide, wide}, 1, {none, 4, 0})[1], 4) << "as it was";
}

/// Colours are means of bytes, other numbers means, and normals means of length 1, where they are float32.
TEST(Stages, VoxelGridKnowsColoursAndNormals)
{
  using Field = pcl::PCLPointField;
  const auto meanOf = [](const std::string& name, std::uint8_t type, double first, double second) {
    pcl::PCLPointCloud2 cloud = cloudWith({{name, type, 1}}, 2);
    set(cloud, 0, name, first);
    set(cloud, 1, name, second);
    return io::valueOf(outputOf(asInput(cloud), R"({"type": "filters.voxel_grid", "leaf_size": 1})")->cloud, 0, name);
  };
  for (const char* const name : {"rgb", "rgba"}) {
    EXPECT_EQ(meanOf(name, Field::UINT32, 0xff00c801, 0xff006403), 0xff009602) << name;
    EXPECT_EQ(meanOf(name, Field::FLOAT64, 1, 2), 1.5) << name;
  }
  EXPECT_EQ(meanOf("rgbs", Field::UINT32, 0xff00c801, 0xff006403), 0xff006403) << "the least of the most frequent";

  const auto normalOf = [](std::uint8_t type, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    pcl::PCLPointCloud2 cloud = cloudWith({{"normal_x", type, 1}, {"normal_y", type, 1}, {"normal_z", type, 1}}, 2);
    Eigen::Vector3d mean;
    for (int k = 0; k < 3; ++k) {
      set(cloud, 0, std::string("normal_") + "xyz"[k], first[k]);
      set(cloud, 1, std::string("normal_") + "xyz"[k], second[k]);
    }
    const StageCloudPtr out = outputOf(asInput(cloud), R"({"type": "filters.voxel_grid", "leaf_size": 1})");
    for (int k = 0; k < 3; ++k) mean[k] = io::valueOf(out->cloud, 0, std::string("normal_") + "xyz"[k]);
    return mean;
  };
  const double half = std::sqrt(0.5);
  EXPECT_TRUE(normalOf(Field::FLOAT32, {1, 0, 0}, {0, 1, 0}).isApprox(Eigen::Vector3d(half, half, 0), 1e-6));
  EXPECT_EQ(normalOf(Field::FLOAT64, {0.1, 0.2, 0}, {0.3, 0.7, 0}),
            Eigen::Vector3d(0.1 + (0.3 - 0.1) / 2, 0.2 + (0.7 - 0.2) / 2, 0));
  EXPECT_EQ(normalOf(Field::FLOAT32, {1, 0, 0}, {-1, 0, 0}), Eigen::Vector3d::Zero()) << "not the length of nothing";
}

/// 18641348 and more cells from the origin, where products of floats count by twos.
TEST(Stages, VoxelGridCountsFloat32BeyondFloat)
{
  const Points points = {{16777213, 0, 0}, {16777214, 0, 0}, {16777215, 0, 0}};
  EXPECT_EQ(outputOf(cloudOf<float>(points), R"({"type": "filters.voxel_grid", "leaf_size": 0.9})")->cloud.width, 3U);
}

TEST(Stages, PassThroughTakesFieldsOfOneValue)
{
  pcl::PCLPointCloud2 cloud = cloudWith({{"pair", pcl::PCLPointField::FLOAT32, 2}, {"single", 7, 1}}, 3);
  cloud.fields[4].count = 0; // one, as PCL once wrote it
  const auto filtered = [&](const std::string& field) {
    return outputOf(asInput(cloud), R"({"type": "filters.pass_through", "filter_limits": [1, 2],
                                        "filter_field_name": ")" +
                                        field + "\"}")
        ->cloud.width;
  };
  set(cloud, 1, "single", 1.5);
  EXPECT_EQ(filtered("single"), 1U);
  EXPECT_THAT(errorOf([&] { filtered("pair"); }), HasSubstr("is 'pair', which is no field with one value"));
  EXPECT_THAT(errorOf([&] { filtered("pairs"); }), testing::Not(HasSubstr("mean 'pair'")));
}

TEST(Stages, MergeRefusesFieldsOfOtherCounts)
{
  const StageCloudPtr one = asInput(cloudWith({{"echo", pcl::PCLPointField::FLOAT32, 1}}, 2)),
                      two = asInput(cloudWith({{"echo", pcl::PCLPointField::FLOAT32, 2}}, 2));
  const std::string stage = R"({"type": "filters.merge", "inputs": ["in", "other"]})";
  EXPECT_THAT(errorOf([&] { runStage(one, stage, two); }),
              EndsWith("/inputs/1: has no field 'echo' of the type that another has: give clouds alike"));
  EXPECT_EQ(outputOf(two, stage, two)->cloud.width, 4U);
}

TEST(Stages, MergeRefusesCloudsThatDiffer)
{
  const StageCloudPtr with = cloudOf<float>(test::randomPoints(3, 6));
  auto without = std::make_shared<StageCloud>(*with);
  without->cloud.fields.pop_back();
  const std::string stage = R"({"type": "filters.merge", "inputs": ["in", "other"]})";
  EXPECT_THAT(errorOf([&] { runStage(with, stage, without); }),
              EndsWith("/inputs/1: has no field 'intensity' of the type that another has: give clouds alike"));
  EXPECT_THAT(errorOf([&] { runStage(without, stage, with); }), HasSubstr("/inputs/0: has no field 'intensity'"));
  EXPECT_THAT(errorOf([&] { runStage(with, stage, cloudOf<double>(test::randomPoints(3, 6))); }),
              HasSubstr("/inputs/1: has no field 'x'"));
}

TEST(Stages, FilesOfEachFormat)
{
  const io::TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud = io::randomCloud<float>(6, 1, {});
  cloud.fields.pop_back();                // text holds no field with a count
  cloud.fields.back().name = "intensity"; // for which an .obj has no place
  for (std::size_t i = 0; i < 6; ++i) {
    const float intensity = static_cast<float>(i);
    std::memcpy(&cloud.data[i * cloud.point_step + 12], &intensity, 4);
  }
  for (const std::string extension : {".pcd", ".ply", ".txt", ".xyz", ".obj"}) {
    const std::string first = (folder / ("a" + extension)).string();
    const std::string second = (folder / ("b" + extension)).string();
    auto in = std::make_shared<StageCloud>();
    in->cloud = cloud;
    const PipelineResult result = runStage(in, "{\"filename\": \"" + first + "\"}");
    EXPECT_EQ(result.warnings.size(), extension == ".obj" ? 1U : 0U);
    Pipeline::parse("[\"" + first + "\", \"" + second + "\"]").run();
    EXPECT_EQ(io::contentOf(second), io::contentOf(first)) << extension;
    EXPECT_EQ(io::readCloud(second).width, 6U);
  }
}

TEST(Stages, ValidationReadsHeadersButNoPoints)
{
  const io::TemporaryFolder folder;
  const std::string good = "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n";
  const std::string file = folder.write("in.pcd", good + "these are no points\n").string();
  const auto pipeline = [&](const std::string& in, const std::string& stage, const std::string& out) {
    return Pipeline::parse("[\"" + in + "\", " + stage + ", \"" + (folder / out).string() + "\"]");
  };
  const std::string by_intensity = R"({"type": "filters.pass_through", "filter_field_name": "intensity"})";
  EXPECT_NO_THROW(pipeline(file, by_intensity, "out.pcd").validate());
  EXPECT_EQ(folder.files(), 1U) << "and writes nothing";
  EXPECT_THAT(errorOf([&] { pipeline(file, by_intensity, "out.pcd").run(); }), HasSubstr("in.pcd: line 6 is damaged"));
  EXPECT_THAT(errorOf([&] { pipeline("none.pcd", by_intensity, "out.pcd").validate(); }),
              EndsWith("readers_pcd1: /0: none.pcd: no such file: check the name"));
  EXPECT_THAT(errorOf([&] { pipeline(file, by_intensity, "none/out.pcd").validate(); }),
              HasSubstr("there is no folder"));
  EXPECT_THAT(
      errorOf([&] {
        pipeline(file, R"({"type": "filters.bsh_flag", "obstacle": "none.ply", "clearance": 1})", "out.pcd").validate();
      }),
      EndsWith("readers_ply1: /1/obstacle: none.ply: no such file: check the name"));
  // A stage's own field is known to those after it.
  EXPECT_NO_THROW(pipeline(file, R"({"type": "filters.euclidean_cluster", "cluster_tolerance": 1},
                                    {"type": "filters.pass_through", "filter_field_name": "cluster"})",
                           "out.pcd")
                      .validate());
  const std::string wide =
      folder.write("wide.pcd", "FIELDS x y z id\nSIZE 4 4 4 8\nTYPE F F F U\nPOINTS 0\nDATA ascii\n");
  EXPECT_THAT(errorOf([&] { pipeline(wide, by_intensity, "out.ply").validate(); }), HasSubstr("did you mean"));
  EXPECT_THAT(errorOf([&] { pipeline(wide, R"({"type": "filters.merge"})", "out.ply").validate(); }),
              HasSubstr("field 'id' has a type that PLY does not know"));
  EXPECT_THAT(errorOf([&] { Pipeline::parse(R"([{"type": "readers.ply", "filename": ")" + file + "\"}]").validate(); }),
              HasSubstr("/0/filename: is \"" + file + "\": give a .ply file, or leave out the type"));
}

TEST(Stages, FilesThatWouldRace)
{
  const io::TemporaryFolder folder;
  const std::string a = folder.write("a.xyz", "1 2 3\n").string();
  const std::string out = (folder / "out.pcd").string();
  EXPECT_THAT(errorOf([&] {
                Pipeline::parse("[\"" + a + "\", {\"type\": \"writers.pcd\", \"filename\": \"" + out + "\"}, \"" + out +
                                "\"]")
                    .validate();
              }),
              EndsWith("/2/filename: is the file of writers_pcd1.filename, too: choose another name"));
  EXPECT_THAT(errorOf([&] {
                Pipeline::parse(R"([{"filename": ")" + a + R"(", "tag": "a"}, {"filename": ")" + a + R"(", "tag": "b"},
                                   {"type": "filters.merge", "inputs": ["a", "b"], "tag": "both"},
                                   {"type": "writers.text", "inputs": "a", "filename": ")" +
                                a + R"("}, {"type": "filters.merge", "inputs": "both"}])")
                    .validate();
              }),
              EndsWith("/3/filename: is the file of a.filename, which is read: choose another name"));
  EXPECT_THAT(errorOf([&] { Pipeline::parse("[\"" + a + "\", \"" + a + "\"]").run(); }),
              EndsWith("/1/filename: is the file of readers_text1.filename, which is read: choose another name"));
  EXPECT_EQ(io::contentOf(a), "1 2 3\n");

  // The document, its poses, and what the caller writes.
  const std::string pose = folder.write("pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n").string();
  const auto flagged = [&](const std::string& output) {
    return "[\"" + a + R"(", {"type": "filters.bsh_flag", "obstacle": ")" + a + R"(", "clearance": 1, "pose": ")" +
           pose + "\"}, \"" + output + "\"]";
  };
  EXPECT_THAT(errorOf([&] { Pipeline::parse(flagged(pose)).run(); }),
              EndsWith("/2/filename: is the file of filters_bsh_flag1.pose, which is read: choose another name"));
  const std::string document = folder.write("p.txt", flagged((folder / "./p.txt").string())).string();
  EXPECT_THAT(errorOf([&] { Pipeline::read(document).run(); }),
              EndsWith("/2/filename: is the file of the document, which is read: choose another name"));
  for (const std::string& file : {a, pose, out}) {
    Pipeline pipeline = Pipeline::parse(flagged(out));
    pipeline.reserve("--metadata", file);
    EXPECT_THAT(errorOf([&] { pipeline.validate(); }),
                HasSubstr("pipeline: --metadata: " + file + ": is the file of "));
  }
}

} // namespace
} // namespace pcl_bsh::pipeline
