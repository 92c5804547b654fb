// SPDX-License-Identifier: BSD-3-Clause
#include "io/clouds/samples.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/reports/distance_report.h>
#include <pcl_bsh/version.h>

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace pcl_bsh::io {

using testing::HasSubstr;
using testing::Not;

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// A grid of points, and the same a little higher, of which one is much higher.
class DistanceReports : public testing::Test {
protected:
  DistanceReports()
  {
    for (int i = 0; i < 100; ++i) {
      for (const double coordinate : {0.5 * (i % 10), 0.5 * (i / 10), 0.0}) low.push_back(coordinate);
      for (const double coordinate : {0.5 * (i % 10), 0.5 * (i / 10), i == 42 ? 2.0 : 0.125})
        high.push_back(coordinate);
    }
    question.input = "after.ply";
    question.obstacle = "before.ply";
  }

  /// The report on these files. @param use called with the report
  template <typename Use>
  void with(const Use& use) const
  {
    const SphereHierarchy a(viewOf(high.data(), high.size() / 3)), b(viewOf(low.data(), low.size() / 3));
    const SymmetricDistances found = symmetricDistances({a}, {b, pose}, question.request);
    use(reportOf(question, {a}, {b, pose}, found));
  }

  Json json() const
  {
    Json json;
    with([&](const DistanceReport& report) { json = distanceJson(report); });
    return json;
  }

  std::string page() const
  {
    std::string page;
    with([&](const DistanceReport& report) { page = distancePage(report); });
    return page;
  }

  std::vector<double> low, high;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  DistanceQuestion question;
};

TEST_F(DistanceReports, TellBothDirectionsInNumbers)
{
  question.unit = "m";
  const Json told = json();
  EXPECT_EQ(told["unit"], "m");
  EXPECT_EQ(told["max_distance"], Json());
  EXPECT_EQ(told["accuracy"], "exact");
  const Json& to = told["input_to_obstacle"];
  EXPECT_EQ(to["points"], 100);
  EXPECT_EQ(to["count"], 100);
  EXPECT_EQ(to["farther"], 0);
  EXPECT_EQ(to["mean"], (99 * 0.125 + 2) / 100);
  EXPECT_NEAR(to["rms"].get<double>(), std::sqrt((99 * 0.125 * 0.125 + 4) / 100), 1e-15);
  EXPECT_EQ(to["median"], 0.125);
  for (const char* p : {"5", "25", "75", "95"}) EXPECT_EQ(to["percentiles"][p], 0.125) << p;
  EXPECT_NEAR(to["percentiles"]["99"].get<double>(), 0.125 + 0.01 * 1.875, 1e-13);
  EXPECT_EQ(to["maximum"], 2);
  EXPECT_EQ(to["farthest_pair"], (Json{42, 42}));
  ASSERT_EQ(to["places"].size(), 1u);
  EXPECT_EQ(to["places"][0]["point"], 42);
  EXPECT_EQ(to["places"][0]["at"], (Json{1, 2, 2}));
  const Json& from = told["obstacle_to_input"];
  EXPECT_NEAR(from["maximum"].get<double>(), std::hypot(0.5, 0.125), 1e-15) << "past the one that is higher";
  EXPECT_EQ(from["farthest_pair"][1], 42) << "input before obstacle";
  EXPECT_EQ(told["hausdorff"], 2);
  EXPECT_EQ(told["hausdorff_pair"], (Json{42, 42}));
  EXPECT_EQ(told["hausdorff_interval"], (Json{2, 2})) << "of points it is exact";
  EXPECT_EQ(to["statistics_of"], "points: the distance of each one");
}

TEST_F(DistanceReports, TellWhatWasAskedForOtherThanUsual)
{
  for (std::size_t i = 0; i < 100; ++i) high[3 * i + 2] = 0.001 * static_cast<double>(i);
  const Json to = json()["input_to_obstacle"];
  EXPECT_EQ(to["places_beyond"], to["percentiles"]["95"]) << "where nothing is said";
  question.beyond = 0.25;
  question.request.accuracy = Accuracy::tolerance(0.01);
  EXPECT_EQ(json()["input_to_obstacle"]["places_beyond"], 0.25);
  EXPECT_EQ(json()["accuracy"], "tolerance=0.01");
  EXPECT_THAT(page(), HasSubstr("tolerance=0.01"));
}

/// A solid gives its records negative distances.
TEST_F(DistanceReports, OfNegativeDistancesHaveNoFarPlaces)
{
  const SphereHierarchy a(viewOf(high.data(), high.size() / 3)), b(viewOf(low.data(), low.size() / 3));
  SymmetricDistances found = symmetricDistances({a}, {b}, question.request);
  for (const std::size_t outside : {0u, 1u, 4u}) { // of a hundred
    for (std::size_t i = 0; i < found.a.distance.size(); ++i)
      found.a.distance[i] = i < outside ? 3.0 : -0.01 * static_cast<double>(i);
    const DistanceReport report = reportOf(question, {a}, {b}, found);
    const Json to = distanceJson(report)["input_to_obstacle"];
    EXPECT_LT(to["median"], 0.0);
    EXPECT_EQ(to["places_beyond"], 0.0);
    EXPECT_EQ(to["places"].empty(), outside == 0) << outside;
    EXPECT_THAT(distancePage(report), HasSubstr(outside == 0 ? "No point is farther than 0" : "farther than 0"));
  }
}

TEST_F(DistanceReports, TellWhatHasNoDistance)
{
  question.request.max_distance = 1;
  Json told = json();
  EXPECT_EQ(told["max_distance"], 1);
  EXPECT_EQ(told["input_to_obstacle"]["count"], 99);
  EXPECT_EQ(told["input_to_obstacle"]["farther"], 1);
  EXPECT_EQ(told["hausdorff"], Json()) << "not known";
  EXPECT_EQ(told["input_to_obstacle"]["places"][0]["distance"], Json());
  EXPECT_EQ(told["input_to_obstacle"]["places"][0]["closest_point"], Json());
  EXPECT_THAT(page(), HasSubstr(">1 point has no distance: "));
  EXPECT_THAT(page(), HasSubstr("; 1 point has no distance</text>")) << "beside the histogram, too";
  EXPECT_THAT(page(), Not(HasSubstr("farther than 0.14")));
  EXPECT_THAT(page(), HasSubstr("more than 1<"));

  question.request.max_distance = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& empty : {std::vector<double>{}, {nothing, 0, 0}}) {
    low = empty;
    told = json();
    for (const char* side : {"input_to_obstacle", "obstacle_to_input"}) {
      EXPECT_EQ(told[side]["count"], 0);
      for (const char* key : {"mean", "rms", "median", "maximum", "farthest_pair"}) EXPECT_EQ(told[side][key], Json());
    }
    EXPECT_EQ(told["obstacle_to_input"]["points"], 0);
    EXPECT_THAT(page(), HasSubstr("no point there"));
    EXPECT_THAT(page(), Not(HasSubstr("nan")));
  }
  high.clear();
  EXPECT_THAT(page(), Not(HasSubstr("nan")));
}

/// Beyond the axis is one number, without a distance another.
TEST_F(DistanceReports, TellWhatTheHistogramLeavesOut)
{
  question.unit = "m";
  EXPECT_THAT(page(), HasSubstr("; 1 point is farther than 0.145 m</text>"));
  for (int i = 0; i < 2; ++i) high.insert(high.end(), {50.0 + i, 0.0, 0.0});
  question.request.max_distance = 5;
  EXPECT_THAT(page(), HasSubstr("; 1 point is farther than 0.145 m; 2 points have no distance</text>"));
}

TEST_F(DistanceReports, TellDateVersionAndCoordinateSystem)
{
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  EXPECT_THAT(page(), HasSubstr(" Made by pcl_bsh " PCL_BSH_VERSION_TEXT " on 2023-11-14."));
  EXPECT_THAT(page(), Not(HasSubstr("Coordinate system")));
  EXPECT_EQ(json()["date"], "2023-11-14");
  EXPECT_EQ(json()["program"], "pcl_bsh " PCL_BSH_VERSION_TEXT);
  EXPECT_EQ(json()["coordinate_system"], Json());
  question.coordinate_system = "EPSG:25832 <UTM>";
  EXPECT_THAT(page(), HasSubstr("Coordinate system: EPSG:25832 &lt;UTM&gt;."));
  EXPECT_EQ(json()["coordinate_system"], "EPSG:25832 <UTM>");
  unsetenv("SOURCE_DATE_EPOCH");
}

TEST_F(DistanceReports, PlacesAreInTheFrameOfTheInput)
{
  pose = Eigen::Translation3d(0, 0, 100) * Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitX());
  question.beyond = 90;
  const Json place = json()["obstacle_to_input"]["places"][0];
  EXPECT_NEAR(place["at"][2].get<double>(), 100, 1e-9);
}

TEST_F(DistanceReports, PageStandsAlone)
{
  question.unit = "m";
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("All lengths in m."));
  EXPECT_THAT(text, HasSubstr("Hausdorff distance [m]"));
  EXPECT_THAT(text, HasSubstr("greatest distance [m]"));
  for (const char* row : {"mean", "RMS", "median", "percentile 95", "maximum"})
    EXPECT_THAT(text, HasSubstr(std::string(row) + "</td><td>m</td><td>"));
  EXPECT_THAT(text, HasSubstr("percentile 95</td><td>m</td><td>0.125"));
  for (const char* outside : {"http", "src=", "url(", "@import", "<script", "href="})
    EXPECT_THAT(text, Not(HasSubstr(outside)));
  EXPECT_THAT(text, HasSubstr("farther than 0.125 m."));
  question.unit.clear();
  EXPECT_THAT(page(), HasSubstr("All lengths in the clouds&apos; unit."));
}

TEST_F(DistanceReports, PageCountsASinglePoint)
{
  EXPECT_THAT(page(), HasSubstr("From above, 100 of 100 points; circles"));
  high.resize(3);
  EXPECT_THAT(page(), HasSubstr("From above, 1 of 1 point; circles"));
}

TEST_F(DistanceReports, TextOfUsersIsNoMarkup)
{
  question.input = "a\"b<script>alert('x')</script>.ply";
  question.obstacle = "{{input}}&amp;\n\x01\xff.ply";
  question.unit = "<b>m</b>";
  const std::string text = page();
  EXPECT_THAT(text, Not(HasSubstr("<script")));
  EXPECT_THAT(text, Not(HasSubstr("<b>m")));
  EXPECT_THAT(text, HasSubstr("a&quot;b&lt;script&gt;"));
  EXPECT_THAT(text, HasSubstr("{{input}}&amp;amp;\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd.ply"));
  EXPECT_TRUE(Json::accept(printed(json())));
}

TEST_F(DistanceReports, AppearCompleteOrNotAtAll)
{
  const TemporaryFolder folder;
  with([&](const DistanceReport& report) {
    writeDistances(folder / "a\"<b>.html", report);
    writeDistances(folder / "a.json", report);
    EXPECT_EQ(contentOf(folder / "a\"<b>.html"), distancePage(report));
    EXPECT_EQ(Json::parse(contentOf(folder / "a.json")), distanceJson(report));
    EXPECT_THROW(writeDistances(folder / "a.csv", report), files::FileError);
    EXPECT_THROW(writeDistances(folder / "none/a.html", report), files::FileError);
    EXPECT_EQ(folder.files(), 2u);
  });
  EXPECT_THROW(requireDistanceFormat("a.txt"), files::FileError);
}

/// Its records are triangles, and what their numbers mean is told.
TEST_F(DistanceReports, TellThatTheObstacleIsASurface)
{
  const TemporaryFolder folder;
  const Obstacle surface =
      readObstacle(folder.write("a.off", "OFF\n4 2 0\n0 0 0\n5 0 0\n5 5 0\n0 5 0\n3 0 1 2\n3 0 2 3\n"), {});
  EXPECT_EQ(json()["surface"], Json());
  EXPECT_THAT(page(), HasSubstr("<td>points</td>"));
  const SphereHierarchy a(viewOf(high.data(), high.size() / 3)), b(surface.view());
  const SymmetricDistances found = symmetricDistances({a}, {b}, question.request);
  question.surface = &surface;
  for (const bool solid : {false, true}) {
    question.solid = solid;
    const DistanceReport report = reportOf(question, {a}, {b}, found);
    const std::string promise = promiseOf(surface, solid) + "; the distance of a triangle is that of its nearest point";
    EXPECT_THAT(distancePage(report), HasSubstr(">Here " + promise + ".<"));
    EXPECT_THAT(distancePage(report), HasSubstr("<td>points, triangles</td>"));
    const Json told = distanceJson(report);
    EXPECT_EQ(told["surface"]["triangles"], 2);
    EXPECT_EQ(told["surface"]["promise"], promise);
    EXPECT_EQ(told["input_to_obstacle"]["points"], 100);
    EXPECT_EQ(told["obstacle_to_input"]["points"], 2);
  }
}

TEST_F(DistanceReports, PointsThatAreNotFiniteAreNotDrawn)
{
  high.insert(high.end(), {nothing, 1.0, 1.0});
  EXPECT_THAT(page(), HasSubstr("From above, 100 of 100 points; circles"));
  EXPECT_THAT(page(), Not(HasSubstr("nan")));
}

TEST_F(DistanceReports, TellThatNothingIsFar)
{
  question.beyond = 100;
  EXPECT_THAT(page(), HasSubstr("No point is farther than 100."));
  EXPECT_THAT(page(), Not(HasSubstr("Places are groups of points")));
  question.beyond = 0.25;
  EXPECT_THAT(page(), HasSubstr("Places are groups of points farther than 0.25."));
}

} // namespace
} // namespace pcl_bsh::io
