// SPDX-License-Identifier: BSD-3-Clause
// A job as a planner of a plant has it: three machines in millimetres in a hall in UTM coordinates, a floor that does
// not count, a way with a turn, and a second week. Once by programs, once by a pipeline; every number by brute force.
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace pcl_bsh {
namespace {

using HallJson = nlohmann::json;
using Boxes = std::vector<Eigen::AlignedBox3d>;

const std::map<std::string, Boxes> machines = {
    {"press",
     {Eigen::AlignedBox3d(Eigen::Vector3d(-1, -0.75, 0), Eigen::Vector3d(1, 0.75, 2.5)),
      Eigen::AlignedBox3d(Eigen::Vector3d(1.05, -0.3, 0.2), Eigen::Vector3d(1.25, 0.3, 1.7))}},
    {"mill", {Eigen::AlignedBox3d(Eigen::Vector3d(-0.7, -0.5, 0), Eigen::Vector3d(0.7, 0.5, 1.6))}},
    {"crate", {Eigen::AlignedBox3d(Eigen::Vector3d(-0.45, -0.45, 0), Eigen::Vector3d(0.45, 0.45, 1.2))}}};

Eigen::Isometry3d place(double x, double y, double heading)
{
  return Eigen::Translation3d(500000 + x, 5400000 + y, 100) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
}

const std::map<std::string, Eigen::Isometry3d> places = {
    {"press", place(3, 2, 0.3)}, {"mill", place(7.5, 6, 1.5707963267948966)}, {"crate", place(5, 5, 0)}};

double clearanceOf(const std::string& machine)
{
  return machine == "crate" ? 0.3 : 0.1;
}

/// To the surface of boxes that do not touch; negative inside.
double signedDistance(const Boxes& boxes, const Eigen::Vector3d& p)
{
  double nearest = INFINITY;
  bool inside = false;
  for (const Eigen::AlignedBox3d& box : boxes) {
    inside = inside || box.contains(p);
    const double depth = std::min((p - box.min()).minCoeff(), (box.max() - p).minCoeff());
    nearest = std::min(nearest, box.contains(p) ? depth : box.exteriorDistance(p));
  }
  return inside ? -nearest : nearest;
}

/// The corners of a box's floor, in their order, where it stands.
std::vector<Eigen::Vector2d> floorOf(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& pose)
{
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [x, y] : {std::pair(box.min().x(), box.min().y()), std::pair(box.max().x(), box.min().y()),
                             std::pair(box.max().x(), box.max().y()), std::pair(box.min().x(), box.max().y())})
    corners.emplace_back((pose * Eigen::Vector3d(x, y, 0)).head<2>());
  return corners;
}

/// The distance of machines that stand on one floor and do not overlap is that of their floors.
double distanceOf(const std::string& first, const std::string& second)
{
  double nearest = INFINITY;
  const auto toEdges = [&](const std::vector<Eigen::Vector2d>& corners, const std::vector<Eigen::Vector2d>& edges) {
    for (const Eigen::Vector2d& p : corners)
      for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d along = edges[(i + 1) % 4] - edges[i];
        const double share = std::clamp((p - edges[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - edges[i] - share * along).norm());
      }
  };
  for (const Eigen::AlignedBox3d& a : machines.at(first))
    for (const Eigen::AlignedBox3d& b : machines.at(second)) {
      const auto floor = floorOf(a, places.at(first)), other = floorOf(b, places.at(second));
      toEdges(floor, other);
      toEdges(other, floor);
    }
  return nearest;
}

/// How the points of a scan that count lie to a machine along its poses.
struct Truth {
  std::vector<double> distances; ///< of each point, the smallest; NaN where it does not count
  std::vector<int> poses;        ///< at which that is; the first of several

  Truth(const pcl::PCLPointCloud2& scan, const Boxes& boxes, const std::vector<Eigen::Isometry3d>& path)
  : distances(scan.width, NAN),
    poses(scan.width, -1)
  {
    std::vector<Eigen::Isometry3d> back;
    for (const Eigen::Isometry3d& pose : path) back.push_back(pose.inverse());
    for (std::size_t i = 0; i < scan.width; ++i) {
      if (io::valueOf(scan, i, "classification") == 2) continue;
      const Eigen::Vector3d p(io::valueOf(scan, i, "x"), io::valueOf(scan, i, "y"), io::valueOf(scan, i, "z"));
      for (std::size_t k = 0; k < back.size(); ++k) {
        const double distance = signedDistance(boxes, back[k] * p);
        if (!(distance >= distances[i])) distances[i] = distance, poses[i] = static_cast<int>(k);
      }
    }
  }

  std::size_t within(double clearance) const
  {
    return static_cast<std::size_t>(
        std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= clearance; }));
  }

  double smallest() const
  {
    return std::accumulate(distances.begin(), distances.end(), double(INFINITY),
                           [](double least, double d) { return d < least ? d : least; });
  }
};

constexpr double kRounding = 1e-8; ///< metres: double's steps at a northing of 5.4e6 are 1e-9

class Hall : public testing::Test {
protected:
  void SetUp() override { bash("bash " PCL_BSH_SOURCE_DIR "/examples/hall/make_hall.sh ."); }

  void bash(const std::string& command) const
  {
    const Outcome done = runCommands("PATH=" PCL_BSH_PROGRAM_DIR ":$PATH; " + command, folder.path());
    ASSERT_EQ(done.exit_code, 0) << command << '\n' << done.err;
  }

  HallJson json(const std::string& file) const { return HallJson::parse(io::contentOf(folder / file)); }

  /// A list of where the machines stand.
  void expectStanding(const HallJson& list, const pcl::PCLPointCloud2& scan) const
  {
    ASSERT_EQ(list["obstacles"].size(), 3U);
    for (const HallJson& told : list["obstacles"]) {
      const std::string name = told["name"];
      const Truth truth(scan, machines.at(name), {places.at(name)});
      EXPECT_EQ(told["colliding"], truth.within(clearanceOf(name))) << name;
      EXPECT_EQ(told["state"], truth.within(clearanceOf(name)) > 0 ? "clash" : "clear") << name;
      EXPECT_NEAR(told["distance"], truth.smallest(), kRounding) << name;
      std::size_t in_clashes = 0;
      double deepest = INFINITY;
      for (const HallJson& clash : list["clashes"])
        if (clash["obstacle_name"] == name && clash["status"] != "resolved") {
          in_clashes += clash["points"].get<std::size_t>();
          deepest = std::min(deepest, clash["distance"].get<double>());
        }
      EXPECT_EQ(in_clashes, told["colliding"]) << name;
      if (in_clashes == 0) continue;
      EXPECT_NEAR(deepest, truth.smallest(), kRounding) << name;
    }
    ASSERT_EQ(list["between"].size(), 3U);
    for (const HallJson& pair : list["between"]) {
      EXPECT_NEAR(pair["distance"], distanceOf(pair["first"], pair["second"]), kRounding) << pair;
      EXPECT_EQ(pair["clearance"], std::max(clearanceOf(pair["first"]), clearanceOf(pair["second"])));
    }
  }

  /// A list of the mill's way.
  void expectCarried(const HallJson& list, const pcl::PCLPointCloud2& scan, const pcl::PCLPointCloud2& marked) const
  {
    const Truth truth(scan, machines.at("mill"), io::readPoses(folder / "poses.txt"));
    ASSERT_EQ(marked.width, scan.width);
    for (std::size_t i = 0; i < scan.width; ++i)
      ASSERT_EQ(io::valueOf(marked, i, "collision"), truth.distances[i] <= 0.05 ? 1 : 0) << i;
    std::size_t in_clashes = 0;
    for (const HallJson& clash : list["clashes"]) {
      in_clashes += clash["points"].get<std::size_t>();
      const std::size_t point = clash["closest_pair"]["input"]["point"];
      EXPECT_NEAR(clash["distance"], truth.distances[point], 1e-7) << clash;
      EXPECT_EQ(clash["closest_pose"], truth.poses[point]) << clash;
    }
    EXPECT_EQ(in_clashes, truth.within(0.05));
  }

  static std::map<std::string, int> statusesOf(const HallJson& list)
  {
    std::map<std::string, int> statuses;
    for (const HallJson& clash : list["clashes"]) ++statuses[clash["status"]];
    return statuses;
  }

  io::TemporaryFolder folder;
};

using Statuses = std::map<std::string, int>;

TEST_F(Hall, IsPlannedByProgramsAndByAPipeline)
{
  bash("bash " PCL_BSH_SOURCE_DIR "/examples/hall/fit.sh .");
  const std::vector<Eigen::Isometry3d> way = io::readPoses(folder / "poses.txt");
  EXPECT_TRUE(way.front().isApprox(place(11, 4, 0), 1e-12));
  EXPECT_TRUE(way.back().isApprox(place(7.5, 6, 1.5707963267948966), 1e-12));
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_LE((way[i].translation() - way[i - 1].translation()).norm(), 0.05 + kRounding) << i;
    EXPECT_LE(Eigen::AngleAxisd(way[i].linear().transpose() * way[i - 1].linear()).angle(), 0.035) << i; // 2 degrees
  }
  for (const std::string week : {"week_47", "week_48"}) {
    const pcl::PCLPointCloud2 scan = io::readCloud(folder / (week + ".las"));
    expectStanding(json(week + "_fit.json"), scan);
    expectCarried(json(week + "_way.json"), scan, io::readCloud(folder / (week + "_way.las")));
    EXPECT_NE(io::contentOf(folder / (week + "_fit.html")).find("By obstacle"), std::string::npos);
  }
  EXPECT_EQ(statusesOf(json("week_47_fit.json")), (Statuses{{"new", 2}}));
  EXPECT_EQ(statusesOf(json("week_48_fit.json")), (Statuses{{"persisting", 1}, {"resolved", 1}}));
  EXPECT_EQ(statusesOf(json("week_48_way.json")), (Statuses{{"new", 1}, {"persisting", 1}}));

  const std::string pipeline = "pcl_bsh_pipeline " PCL_BSH_SOURCE_DIR "/examples/hall/fit.json ";
  bash(pipeline);
  bash(pipeline + "--stage.scan.filename=week_48.las --stage.fit.previous=fit.json --stage.fit.filename=fit_48.json "
                  "--stage.way.previous=way.json --stage.way.filename=way_48.json");
  for (const auto& [of_pipeline, of_program] :
       {std::pair("fit", "week_47_fit"), std::pair("way", "week_47_way"), std::pair("fit_48", "week_48_fit"),
        std::pair("way_48", "week_48_way")}) {
    const HallJson list = json(std::string(of_pipeline) + ".json"), other = json(std::string(of_program) + ".json");
    EXPECT_EQ(list["clashes"], other["clashes"]) << of_program;
    EXPECT_EQ(list.value("between", HallJson()), other.value("between", HallJson())) << of_program;
  }
}

} // namespace
} // namespace pcl_bsh
