// SPDX-License-Identifier: BSD-3-Clause
// The stages that ask for collisions, along trajectories, and the list of clashes: against the filter called directly.
#include "../filters/clouds.h"
#include "io/clouds/samples.h"
#include "run_stage.h"
#include "support/verdicts.h"

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/find_field.h>

#include <nlohmann/json.hpp>

#include <iomanip>
#include <sstream>

namespace pcl_bsh::pipeline {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using Poses = std::vector<Eigen::Isometry3d>;

std::shared_ptr<const pcl::PCLPointCloud2> pcl2Of(const StageCloudPtr& cloud)
{
  return {cloud, &cloud->cloud};
}

std::string quoted(const std::filesystem::path& path)
{
  return '"' + path.string() + '"';
}

std::ptrdiff_t linesWith(const std::string& text, const PipelineResult& result)
{
  return std::count_if(result.warnings.begin(), result.warnings.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

/// A cloud in a cube about the origin, and a smaller one that turns and passes through a part of it.
class CollisionStages : public testing::Test {
protected:
  CollisionStages()
  {
    auto scan_cloud = std::make_shared<StageCloud>();
    scan_cloud->cloud = *test::fieldCloud<double>(test::randomPoints(2000, 1));
    scan = scan_cloud;
    test::Points model_points = test::randomPoints(200, 2);
    for (Eigen::Vector3d& p : model_points) p *= 0.2;
    auto model_cloud = std::make_shared<StageCloud>();
    model_cloud->cloud = *test::fieldCloud<float>(model_points);
    model = model_cloud;
    for (int i = 0; i < 4; ++i) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d::UnitZ()));
      pose.translation() = Eigen::Vector3d(0.5 * i - 0.75, 0.1 * i, 0);
      poses.push_back(pose);
    }
    io::writePoses(track, poses);
  }

  CollisionFilter<pcl::PCLPointCloud2> filter(double swept = 0) const
  {
    CollisionFilter<pcl::PCLPointCloud2> direct;
    direct.setInputCloud(pcl2Of(scan));
    direct.setObstacleCloud(pcl2Of(model));
    direct.setClearance(0.03);
    direct.setTrajectory(poses);
    direct.setSwept(swept);
    return direct;
  }

  /// @param options after those that say what filter() is told
  StageCloudPtr output(const std::string& type, const std::string& options = "") const
  {
    return outputOf(scan, stage(type, R"("clearance": 0.03, "trajectory": )" + quoted(track) + options), model);
  }

  /// With a clearance, where the options have none.
  static std::string stage(const std::string& type, const std::string& options)
  {
    const std::string clearance = options.find("clearance") == std::string::npos ? R"("clearance": 0.03, )" : "";
    return R"({"type": ")" + type + R"(", "obstacle": "other", )" + clearance + options + "}";
  }

  std::string error(const std::string& type, const std::string& options) const
  {
    return errorOf([&] { runStage(scan, stage(type, options), model); });
  }

  const io::TemporaryFolder folder;
  const std::filesystem::path track = folder / "track.txt";
  StageCloudPtr scan, model;
  Poses poses;
};

TEST_F(CollisionStages, FlagAlongATrajectory)
{
  for (const double swept : {0.0, 0.01}) {
    auto direct = filter(swept);
    direct.setKeepFlagged(true);
    pcl::PCLPointCloud2 expected;
    direct.filter(expected);
    const StageCloudPtr flagged = output("filters.bsh_flag", R"(, "swept": )" + std::to_string(swept));
    ASSERT_EQ(flagged->cloud.fields.size(), scan->cloud.fields.size() + 4);
    EXPECT_EQ(flagged->cloud.fields.back().name, "closest_pose");
    EXPECT_TRUE(flagged->cloud.data == expected.data) << swept;
  }
}

TEST_F(CollisionStages, SelectAlongATrajectory)
{
  for (const double swept : {0.0, 0.01}) {
    auto direct = filter(swept);
    for (const bool colliding : {false, true}) {
      direct.setNegative(colliding);
      pcl::PCLPointCloud2 expected;
      direct.filter(expected);
      ASSERT_GT(expected.width, 0U);
      const std::string options = R"(, "swept": )" + std::to_string(swept);
      for (const char* const keep : {R"(, "keep": "colliding")", R"(, "negative": true)"}) {
        const StageCloudPtr kept = output("filters.bsh_collision", options + (colliding ? keep : ""));
        EXPECT_TRUE(kept->cloud.data == expected.data) << swept << keep;
      }
    }
  }
}

TEST_F(CollisionStages, SweptFindsMoreThanPosesAlone)
{
  const auto colliding = [&](double swept) {
    std::vector<Verdict> flags;
    filter(swept).computeFlags(flags);
    return std::count(flags.begin(), flags.end(), Verdict::colliding);
  };
  EXPECT_LT(colliding(0), colliding(0.01));
}

TEST_F(CollisionStages, AccuracyIsTheFilters)
{
  const std::string at_pose = R"("clearance": 0.03, "accuracy": )";
  for (const std::string accuracy : {"exact", "tolerance=0.01", "level=1", "pairs=20"}) {
    auto direct = filter();
    direct.setPose(Eigen::Isometry3d::Identity());
    direct.setAccuracy(Accuracy::parse(accuracy));
    std::vector<Verdict> flags;
    direct.computeFlags(flags);
    const auto undecided = static_cast<std::size_t>(std::count(flags.begin(), flags.end(), Verdict::undecided));
    EXPECT_EQ(undecided > 0, direct.getQuestion().accuracy.stopsEarly()) << accuracy;

    const std::string options = at_pose + '"' + accuracy + '"';
    const PipelineResult result = runStage(scan, stage("filters.bsh_flag", options), model);
    const pcl::PCLPointCloud2& flagged = result.clouds.begin()->second->cloud;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      ASSERT_EQ(flagged.data[i * flagged.point_step + flagged.fields.back().offset], bytesOf(flags)[i]) << accuracy;
    }
    EXPECT_EQ(linesWith("stay undecided", result), undecided > 0 ? 1 : 0);
    const auto free = static_cast<std::size_t>(std::count(flags.begin(), flags.end(), Verdict::free));
    const PipelineResult kept = runStage(scan, stage("filters.bsh_collision", options), model);
    EXPECT_EQ(kept.clouds.begin()->second->cloud.width, free) << accuracy << ": what is undecided is not free";
    EXPECT_EQ(linesWith("stay undecided", kept), undecided > 0 ? 1 : 0);
    for (const char* const keep : {R"(, "keep": "colliding")", R"(, "negative": true)"}) {
      EXPECT_EQ(outputOf(scan, stage("filters.bsh_collision", options + keep), model)->cloud.width, flags.size() - free)
          << accuracy << keep;
    }
  }
}

TEST_F(CollisionStages, UncertaintyIsTheFilters)
{
  for (const std::string& along : {std::string(), R"(, "trajectory": )" + quoted(track)}) {
    auto direct = filter();
    if (along.empty()) direct.setPose(Eigen::Isometry3d::Identity());
    direct.setInputUncertainty(0.01);
    direct.setObstacleUncertainty(0.005);
    std::vector<Verdict> flags;
    direct.computeFlags(flags);
    ASSERT_GT(countOf(flags, Verdict::colliding), 0U);
    ASSERT_GT(countOf(flags, Verdict::undecided), 0U);
    const std::string options = R"("clearance": 0.03, "uncertainty": 0.01, "obstacle_uncertainty": 0.005)" + along;
    const PipelineResult result = runStage(scan, stage("filters.bsh_flag", options), model);
    const pcl::PCLPointCloud2& flagged = result.clouds.begin()->second->cloud;
    const pcl::PCLPointField* const field = findField(flagged, "collision");
    ASSERT_NE(field, nullptr);
    for (std::size_t i = 0; i < flags.size(); ++i)
      ASSERT_EQ(flagged.data[i * flagged.point_step + field->offset], bytesOf(flags)[i]) << along;
    EXPECT_THAT(result.warnings, testing::Contains(HasSubstr(std::to_string(countOf(flags, Verdict::undecided)) +
                                                             " points stay undecided")));
    EXPECT_EQ(outputOf(scan, stage("filters.bsh_collision", options), model)->cloud.width,
              countOf(flags, Verdict::free));
  }
}

TEST_F(CollisionStages, RefuseUncertaintiesThatAreNone)
{
  for (const std::string type : {"filters.bsh_flag", "filters.bsh_collision", "writers.clashes"}) {
    const std::string file = type == "writers.clashes" ? R"("filename": )" + quoted(folder / "a.csv") + ", " : "";
    for (const std::string option : {"uncertainty", "obstacle_uncertainty"}) {
      const std::string key = file + '"' + option + R"(": )";
      EXPECT_THAT(error(type, key + "-0.1"),
                  HasSubstr("/" + option + ": is -0.1: give a number of at least 0, in m, or the name of a field"));
      EXPECT_THAT(error(type, key + "[1]"), HasSubstr("/" + option + ": is [1]: give a number"));
      EXPECT_THAT(error(type, key + R"("sigma")"),
                  HasSubstr("/" + option + ": field 'sigma' of its points' sigmas is missing: give a length, or one"));
    }
    EXPECT_THAT(error(type, file + R"("uncertainty": 0.1, "sigmas": 2)"),
                EndsWith("/sigmas: is given, but no uncertainty is a field: give the length itself"));
    EXPECT_THAT(error(type, file + R"("sigmas": -2)"), HasSubstr("/sigmas: is -2: give a number of at least 0"));
  }
}

TEST_F(CollisionStages, DensityIsTheFilters)
{
  auto direct = filter();
  direct.setPose(Eigen::Isometry3d::Identity());
  direct.setDensityGuard(true);
  direct.setWidestGap(0.1);
  std::vector<Verdict> flags;
  direct.computeFlags(flags);
  ASSERT_GT(direct.getSparseCount(), 0U);
  const std::string options = R"("clearance": 0.03, "density": true, "widest_gap": 0.1)";
  const PipelineResult result = runStage(scan, stage("filters.bsh_flag", options), model);
  const pcl::PCLPointCloud2& flagged = result.clouds.begin()->second->cloud;
  for (std::size_t i = 0; i < flags.size(); ++i)
    ASSERT_EQ(flagged.data[i * flagged.point_step + flagged.fields.back().offset], bytesOf(flags)[i]);
  const std::string sparse = std::to_string(direct.getSparseCount());
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr(sparse + " points stay undecided, of which " + sparse +
                                                           " where the obstacle is not scanned densely enough")));
  EXPECT_THAT(error("filters.bsh_flag", R"("density": true, "trajectory": )" + quoted(track)),
              HasSubstr("/density: is about which points collide at one pose: leave out the path"));
  EXPECT_THAT(error("filters.bsh_flag", R"("widest_gap": 1)"),
              EndsWith("/widest_gap: is given, but not `density`: give `density`, too"));
}

TEST_F(CollisionStages, FieldsOfATrajectoryAreKnownBeforehand)
{
  io::writeCloud(folder / "scan.pcd", scan->cloud);
  const auto validate = [&](const std::string& options) {
    Pipeline::parse("[" + quoted(folder / "scan.pcd") +
                    R"(, {"type": "filters.bsh_flag", "clearance": 1, "obstacle": )" + quoted(folder / "scan.pcd") +
                    options + R"(}, {"type": "filters.pass_through", "filter_field_name": "first_pose"}, )" +
                    quoted(folder / "out.pcd") + "]")
        .validate();
  };
  EXPECT_NO_THROW(validate(R"(, "trajectory": )" + quoted(track)));
  EXPECT_THAT(errorOf([&] { validate(""); }), HasSubstr("/2/filter_field_name: "));
}

TEST_F(CollisionStages, RefuseWhatMakesNoSense)
{
  const std::string along = R"("trajectory": )" + quoted(track);
  for (const std::string type : {"filters.bsh_flag", "filters.bsh_collision", "writers.clashes"}) {
    const std::string file = type == "writers.clashes" ? R"("filename": )" + quoted(folder / "a.csv") + ", " : "";
    EXPECT_THAT(error(type, file + along + R"(, "pose": [0, 0, 0, 0, 0, 0])"),
                EndsWith("/trajectory: and `pose` are both given: give one of them"));
    EXPECT_THAT(error(type, file + R"("swept": 0.1)"),
                EndsWith("/swept: is given, but nothing moves: give a path of poses, too"));
    EXPECT_THAT(error(type, file + along + R"(, "swept": -1)"),
                HasSubstr("/swept: is -1: give a number of at least 0"));
    EXPECT_THAT(error(type, file + R"("trajectory": "none.txt")"),
                EndsWith("/trajectory: none.txt: no such file: check the name"));
    EXPECT_THAT(error(type, file + R"("pose": [1,0,0,0, 0,2,0,0, 0,0,1,0])"), HasSubstr("/pose: "));
    EXPECT_THAT(error(type, file + R"("clearance": -0.1)"), HasSubstr("/clearance: is -0.1: give a number"));
    const auto skewed = folder.write("skewed.txt", "1 0 0 0 0 2 0 0 0 0 1 0\n");
    EXPECT_THAT(error(type, file + R"("trajectory": )" + quoted(skewed)),
                HasSubstr("skewed.txt: line 1 holds no pose, not rigid"));
  }
}

/// As everywhere: nobody collides within a length that nobody has thought of.
TEST_F(CollisionStages, NeedAClearance)
{
  for (const std::string type : {"filters.bsh_flag", "filters.bsh_collision", "writers.clashes"}) {
    const std::string file = type == "writers.clashes" ? R"(, "filename": )" + quoted(folder / "a.csv") : "";
    EXPECT_THAT(
        errorOf([&] { runStage(scan, R"({"type": ")" + type + R"(", "obstacle": "other")" + file + "}", model); }),
        HasSubstr("/clearance: is missing: give a number of at least 0"));
  }
}

/// As all faces tell it.
TEST_F(CollisionStages, TellWhatTheAnswerDoesNot)
{
  const auto told = [&](const std::string& type, const std::string& options) {
    return runStage(scan, stage(type, options), model).warnings;
  };
  const std::string list = R"(, "filename": )" + quoted(folder / "a.csv");
  const auto far = HasSubstr("the boxes of the input and of the obstacle, with all of its motion, are 5e+06 apart");
  const auto sparse = HasSubstr("apart in the input and ");
  const auto angle = HasSubstr("pose: an angle of 90 radians is 14.3239 turns: give radians: 90 degrees are 1.5708");
  for (const std::string type : {"filters.bsh_flag", "filters.bsh_collision", "writers.clashes"}) {
    const std::string more = type == "writers.clashes" ? list : "";
    EXPECT_THAT(told(type, R"("clearance": 0.5, "pose": [0, 0, 0, 0, 0, 1.5])" + more), testing::IsEmpty());
    EXPECT_THAT(told(type, R"("clearance": 0.01)" + more), testing::ElementsAre(sparse));
    EXPECT_THAT(told(type, R"("clearance": 0.5, "pose": [5e6, 0, 0, 0, 0, 90])" + more),
                testing::ElementsAre(angle, far));
  }
  EXPECT_THAT(
      runStage(scan, R"({"type": "filters.bsh_distance", "obstacle": "other", "pose": [5e6, 0, 0, 90, 0, 0]})", model)
          .warnings,
      testing::ElementsAre(angle, far));
  EXPECT_THAT(
      runStage(scan,
               R"({"type": "writers.distances", "obstacle": "other", "pose": [5e6, 0, 0, 0, 90, 0], "filename": )" +
                   quoted(folder / "d.json") + "}",
               model)
          .warnings,
      testing::ElementsAre(angle, far));
}

/// A matrix with as many digits as printf and streams give stands for the rotation it was printed from.
TEST_F(CollisionStages, PrintedMatricesStandForTheirRotations)
{
  const Eigen::Isometry3d pose = poses[2];
  std::ostringstream numbers;
  for (int i = 0; i < 12; ++i) numbers << (i == 0 ? "" : ", ") << std::setprecision(5) << pose.matrix()(i / 4, i % 4);
  const std::string options = R"("clearance": 0.1, "pose": [)" + numbers.str() + "]";
  auto direct = filter();
  direct.setPose(pose);
  direct.setClearance(0.1);
  std::vector<Verdict> flags;
  direct.computeFlags(flags);
  const PipelineResult result = runStage(scan, stage("filters.bsh_flag", options), model);
  const pcl::PCLPointCloud2& flagged = result.clouds.begin()->second->cloud;
  std::size_t other = 0, colliding = 0;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    other += flagged.data[i * flagged.point_step + flagged.fields.back().offset] != bytesOf(flags)[i] ? 1 : 0;
    colliding += flags[i] == Verdict::colliding;
  }
  EXPECT_GT(colliding, 20U);
  EXPECT_LE(other, colliding / 20) << "a turn by some 1e-5";
  EXPECT_THAT(result.warnings, testing::ElementsAre(HasSubstr(": pose: |R'R - I| is ")));
  // With two digits it is no printed rotation any more.
  std::ostringstream coarse;
  for (int i = 0; i < 12; ++i) coarse << (i == 0 ? "" : ", ") << std::setprecision(2) << pose.matrix()(i / 4, i % 4);
  EXPECT_THAT(error("filters.bsh_flag", R"("pose": [)" + coarse.str() + "]"), HasSubstr("/pose: not rigid, |R'R - I|"));
}

/// "Free" is not all that there is to say of it.
TEST_F(CollisionStages, TellOfAnObstacleWithoutAPoint)
{
  const auto nothing = std::make_shared<StageCloud>(*model);
  nothing->cloud.width = 0;
  nothing->cloud.row_step = 0;
  nothing->cloud.data.clear();
  const PipelineResult result = runStage(scan, stage("filters.bsh_flag", R"("clearance": 0.1)"), nothing);
  EXPECT_THAT(result.warnings,
              testing::ElementsAre(HasSubstr("the obstacle: has no finite point: nothing collides with it")));
}

TEST_F(CollisionStages, AccuracyAlongATrajectory)
{
  const auto kept = [&](const std::string& accuracy, const std::string& keep) {
    return output("filters.bsh_collision", R"(, "accuracy": ")" + accuracy + R"(", "keep": ")" + keep + '"')
        ->cloud.width;
  };
  EXPECT_LT(kept("level=0", "free"), kept("exact", "free")) << "what is undecided is not free";
  EXPECT_GT(kept("level=0", "colliding"), kept("exact", "colliding"));
  EXPECT_GE(kept("tolerance=0.05", "colliding"), kept("exact", "colliding"));
  EXPECT_EQ(output("filters.bsh_flag", R"(, "accuracy": "tolerance=0.05")")->cloud.fields.size(),
            scan->cloud.fields.size() + 4);
}

TEST_F(CollisionStages, RefuseAccuraciesThatAreNone)
{
  const std::string along = R"("trajectory": )" + quoted(track);
  for (const std::string type : {"filters.bsh_flag", "filters.bsh_collision", "writers.clashes"}) {
    const std::string file = type == "writers.clashes" ? R"("filename": )" + quoted(folder / "a.csv") + ", " : "";
    EXPECT_THAT(error(type, file + R"("accuracy": "fast")"),
                EndsWith("/accuracy: 'fast' is none: give exact, tolerance=LENGTH, level=N, pairs=N or "
                         "time=SECONDS"));
    EXPECT_THAT(error(type, file + along + R"(, "accuracy": "tolerance=0.01", "swept": 0.01)"),
                EndsWith("/accuracy: tolerance=0.01: swept motion has a tolerance of its own: give exact"));
    if (type == "filters.bsh_collision") continue;
    EXPECT_THAT(error(type, file + along + R"(, "accuracy": "level=1")"),
                HasSubstr("/accuracy: level=1: decides which points collide, not when and how near"));
  }
}

/// Tests of the list.
class ClashWriter : public CollisionStages {
protected:
  nlohmann::json listOf(const std::string& options) const
  {
    const std::string merge = R"(, {"type": "filters.merge"})";
    const std::string writer = stage("writers.clashes", R"("clearance": 0.03, "trajectory": )" + quoted(track) +
                                                            R"(, "filename": )" + quoted(list) + options);
    EXPECT_TRUE(outputOf(scan, writer + merge, model)->cloud.data == scan->cloud.data) << "the cloud passes";
    return nlohmann::json::parse(io::contentOf(list));
  }

  const std::filesystem::path list = folder / "clashes.json";
};

TEST_F(ClashWriter, ListsWhatTheFilterFinds)
{
  for (const double swept : {0.0, 0.01}) {
    TrajectoryResult found;
    filter(swept).computeTrajectory(found);
    const std::vector<Clash> expected = findClashes(viewOf(scan->cloud), found, 0.05);
    ASSERT_GT(expected.size(), 5U);
    const nlohmann::json written =
        listOf(R"(, "input_name": "hall", "cluster_distance": 0.05, "swept": )" + std::to_string(swept));
    EXPECT_EQ(written["input"], "hall");
    EXPECT_EQ(written["obstacle"], "other");
    EXPECT_EQ(written["clearance"], 0.03);
    EXPECT_EQ(written["poses"], 4);
    EXPECT_EQ(written["swept"], swept > 0 ? nlohmann::json(swept) : nlohmann::json());
    ASSERT_EQ(written["clashes"].size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const nlohmann::json& clash = written["clashes"][i];
      EXPECT_EQ(clash["id"], expected[i].id);
      EXPECT_EQ(clash["points"], expected[i].points);
      EXPECT_EQ(clash["distance"], expected[i].distance);
      EXPECT_EQ(clash["first_pose"], expected[i].first_pose);
      EXPECT_EQ(clash["closest_pose"], expected[i].closest_pose);
      EXPECT_EQ(clash["closest_pair"]["obstacle"]["point"], expected[i].model_point);
    }
  }
}

TEST_F(ClashWriter, WritesEveryFormatAndComparesRuns)
{
  const std::string near = R"(, "cluster_distance": 0.05)";
  const nlohmann::json first = listOf(near + R"(, "also": )" + quoted(folder / "a.html"));
  EXPECT_THAT(io::contentOf(folder / "a.html"), HasSubstr("<h1>" + std::to_string(first["clashes"].size())));
  EXPECT_EQ(first["clashes"][0]["status"], "new");
  const nlohmann::json again =
      listOf(near + R"(, "previous": )" + quoted(list) + R"(, "also": )" + quoted(folder / "a.csv"));
  EXPECT_EQ(again["clashes"][0]["status"], "persisting") << "the list is brought up to date";
  EXPECT_EQ(again["previous"], list.string());
  const std::string csv = io::contentOf(folder / "a.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), first["clashes"].size() + 1);
  EXPECT_THAT(csv, Not(HasSubstr(",new,")));
}

TEST_F(ClashWriter, WarnsOfAListThatMayBeOfOtherClouds)
{
  listOf(R"(, "input_name": "hall")");
  const std::string options = R"("clearance": 0.03, "trajectory": )" + quoted(track) + R"(, "filename": )" +
                              quoted(folder / "now.json") + R"(, "previous": )" + quoted(list);
  const auto told = [&](const std::string& more) {
    return linesWith("lists clashes of the input 'hall', now it is ",
                     runStage(scan, stage("writers.clashes", options + more), model));
  };
  EXPECT_EQ(told(R"(, "input_name": "yard")"), 1);
  EXPECT_EQ(told(R"(, "input_name": "hall")"), 0);
}

TEST_F(ClashWriter, SaysWhatIsUncertainAndWhereItLooked)
{
  const std::string near = R"(, "cluster_distance": 0.05)", uncertain = near + R"(, "uncertainty": 0.02, "unit": "m")";
  const nlohmann::json first = listOf(uncertain);
  EXPECT_EQ(first["unit"], "m");
  EXPECT_EQ(first["uncertainty"], (nlohmann::json{{"input", 0.02}, {"obstacle", 0.0}}));
  std::size_t perhaps = 0;
  for (const nlohmann::json& clash : first["clashes"]) perhaps += clash["certainty"] == "perhaps" ? 1U : 0U;
  EXPECT_GT(perhaps, 0U);
  std::filesystem::copy(list, folder / "first.json");
  const std::string previous = R"(, "previous": )" + quoted(folder / "first.json");
  EXPECT_THAT(error("writers.clashes", R"("clearance": 0.03, "trajectory": )" + quoted(track) + R"(, "filename": )" +
                                           quoted(list) + near + previous),
              HasSubstr("lists clashes with uncertainty 0.02, now it is not given"));

  // A path that leads elsewhere: what it does not come near to is not resolved.
  folder.write(track.filename().string(), "0 1000 1000 1000 0 0 0 1\n");
  const nlohmann::json elsewhere = listOf(uncertain + previous);
  ASSERT_EQ(elsewhere["clashes"].size(), first["clashes"].size());
  for (const nlohmann::json& clash : elsewhere["clashes"]) EXPECT_EQ(clash["status"], "not_visited");
}

TEST_F(ClashWriter, HasASensibleClusterDistance)
{
  EXPECT_EQ(listOf("")["cluster_distance"],
            io::clusterDistanceFor(0.03, spacingOf(SphereHierarchy(viewOf(scan->cloud)))));
  EXPECT_EQ(io::clusterDistanceFor(0.3, {}), 0.5);
  EXPECT_EQ(io::clusterDistanceFor(0.1, {100, 0.25, 0.25}), 1.0);
  EXPECT_EQ(io::clusterDistanceFor(0, {}), 1.0);
}

TEST_F(ClashWriter, RefusesFilesItCannotWriteOrRead)
{
  const std::string type = "writers.clashes";
  const auto file = [&](const std::string& name) { return R"("filename": )" + quoted(folder / name); };
  EXPECT_THAT(error(type, R"("clearance": 0)"), HasSubstr("/filename: is missing"));
  EXPECT_THAT(error(type, R"("filename": "a.txt")"),
              EndsWith("/filename: a.txt: unknown extension '.txt': give a .json, .csv, .html, .bcf or .bcfzip file"));
  EXPECT_THAT(error(type, file("none/a.csv")), HasSubstr("there is no folder"));
  EXPECT_THAT(error(type, file("a.csv") + R"(, "also": "a.pdf")"), HasSubstr("/also: a.pdf: unknown extension"));
  EXPECT_THAT(error(type, file("a.csv") + R"(, "also": )" + quoted(folder / "a.csv")),
              EndsWith("/also: is the file of writers_clashes1.filename, too: choose another name"));
  EXPECT_THAT(error(type, file("a.csv") + R"(, "previous": "none.json")"), HasSubstr("/previous: none.json: no such"));
  folder.write("odd.json", R"({"clashes": [{"id": 7}]})");
  EXPECT_THAT(error(type, file("a.csv") + R"(, "previous": )" + quoted(folder / "odd.json")),
              HasSubstr("odd.json: is no list of clashes: "));
  EXPECT_THAT(error(type, file("a.csv") + R"(, "cluster_distance": 0)"), HasSubstr("give a number above 0, in m"));
  EXPECT_EQ(folder.files(), 2U) << "the track and the odd list: nothing is half written";
}

} // namespace
} // namespace pcl_bsh::pipeline
