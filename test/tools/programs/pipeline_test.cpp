// SPDX-License-Identifier: BSD-3-Clause
// The program, and each sample pipeline on clouds of which the answer is known.
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace pcl_bsh {
namespace {

using io::addField;
using io::allocate;
using io::contentOf;
using io::Field;
using io::readCloud;
using io::valueOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Place {
  double x, y, z;
};

/// x y z as float32 or float64, and an intensity: the point's number.
pcl::PCLPointCloud2 cloudOf(const std::vector<Place>& places, std::uint8_t datatype = Field::FLOAT32)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, datatype);
  addField(cloud, "intensity", Field::FLOAT32);
  allocate(cloud, static_cast<std::uint32_t>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::uint8_t* const record = &cloud.data[i * cloud.point_step];
    const double xyz[] = {places[i].x, places[i].y, places[i].z};
    const std::size_t size = io::sizeOf(datatype);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto narrow = static_cast<float>(xyz[k]);
      std::memcpy(record + k * size, datatype == Field::FLOAT32 ? static_cast<const void*>(&narrow) : &xyz[k], size);
    }
    const auto number = static_cast<float>(i);
    std::memcpy(record + 3 * size, &number, sizeof number);
  }
  return cloud;
}

std::vector<Place> wall(double x, double step = 0.1, double size = 2)
{
  std::vector<Place> places;
  for (double y = 0; y < size; y += step) {
    for (double z = 0; z < size; z += step) places.push_back({x, y, z});
  }
  return places;
}

/// Runs in a folder that holds what the samples name.
class PipelineProgram : public testing::Test {
protected:
  Outcome runIn(const std::string& arguments) const { return run("pcl_bsh_pipeline", arguments, folder.path()); }

  void put(const std::string& name, const pcl::PCLPointCloud2& cloud) const { io::writeCloud(folder / name, cloud); }

  Outcome runSample(const std::string& name, const std::string& arguments = "") const
  {
    const std::string sample = std::string(PCL_BSH_SOURCE_DIR) + "/examples/pipelines/" + name;
    const Outcome valid = runIn(sample + " --validate " + arguments);
    EXPECT_EQ(valid.exit_code, 0) << valid.err;
    EXPECT_EQ(valid.out, sample + " is valid\n");
    const Outcome done = runIn(sample + " " + arguments);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done;
  }

  const io::TemporaryFolder folder;
};

TEST_F(PipelineProgram, SampleDownsampleAndFlag)
{
  // A wall at x = 1.5; the robot is a line along its own x, turned by the pose so that it runs along y from (1.5, 2,
  // 0).
  std::vector<Place> scan = wall(1.5, 0.01, 1);
  for (Place& place : scan) place.y += 1.5;
  put("scan.pcd", cloudOf(scan));
  std::vector<Place> robot;
  for (int i = 0; i < 50; ++i) robot.push_back({0.01 * i, 0, 0.2});
  put("robot.pcd", cloudOf(robot));
  runSample("downsample_and_flag.json");

  const pcl::PCLPointCloud2 flagged = readCloud(folder / "flagged.pcd");
  EXPECT_LT(flagged.width, 3000U);
  EXPECT_GT(flagged.width, 2400U);
  std::size_t colliding = 0;
  for (std::size_t i = 0; i < flagged.width; ++i) {
    const double y = valueOf(flagged, i, "y");
    const double z = valueOf(flagged, i, "z");
    const double beyond = std::max({2 - y, y - 2.49, 0.0});
    const double distance = std::hypot(beyond, z - 0.2);
    if (std::abs(distance - 0.05) < 0.002) continue; // the robot's points are 1 cm apart
    EXPECT_EQ(valueOf(flagged, i, "collision"), distance < 0.05 ? 1 : 0) << y << ' ' << z;
    colliding += distance < 0.05 ? 1 : 0;
  }
  EXPECT_GT(colliding, 50U);
}

TEST_F(PipelineProgram, SampleSelfFilter)
{
  std::vector<Place> scan = wall(3, 0.1, 1);
  for (const Place& place : wall(0.5, 0.1, 1)) scan.push_back(place);
  pcl::PCLPointCloud2 organised = cloudOf(scan);
  organised.height = 2;
  organised.width /= 2;
  organised.row_step /= 2;
  put("scan.pcd", organised);
  put("robot.pcd", cloudOf(wall(0, 0.1, 1)));
  folder.write("T_scan_robot.txt", "1 0 0 0.51\n0 1 0 0\n0 0 1 0\n");
  runSample("self_filter.json");

  const pcl::PCLPointCloud2 free = readCloud(folder / "without_robot.pcd");
  EXPECT_EQ(free.height, 2U);
  ASSERT_EQ(free.width * free.height, scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_EQ(std::isnan(valueOf(free, i, "x")), scan[i].x < 1) << i;
    EXPECT_EQ(valueOf(free, i, "intensity"), static_cast<double>(i)) << "other fields stay";
  }
}

TEST_F(PipelineProgram, SampleWhatChanged)
{
  std::vector<Place> before = wall(0), after = wall(0.01);
  for (const Place& place : wall(5, 0.1, 0.5)) before.push_back(place);
  for (const Place& place : wall(7, 0.1, 0.4)) after.push_back(place);
  after.push_back({20, 20, 20}); // noise
  put("before.pcd", cloudOf(before));
  put("after.pcd", cloudOf(after));
  runSample("what_changed.json");

  const pcl::PCLPointCloud2 gone = readCloud(folder / "gone.pcd");
  const pcl::PCLPointCloud2 come = readCloud(folder / "come.pcd");
  EXPECT_EQ(gone.width, 25U);
  for (std::size_t i = 0; i < gone.width; ++i) EXPECT_EQ(valueOf(gone, i, "x"), 5);
  EXPECT_EQ(come.width, 16U);
  for (std::size_t i = 0; i < come.width; ++i) EXPECT_EQ(valueOf(come, i, "x"), 7);
}

TEST_F(PipelineProgram, SampleWagonClearance)
{
  // A wall 35 cm from the wagon's side, a post 10 cm from it that no pose of the track comes near, and a bracket at 5
  // cm.
  std::vector<Place> tunnel, wagon;
  for (int i = 0; i <= 200; ++i) {
    for (int k = 0; k <= 10; ++k) tunnel.push_back({0.1 * i, 1.6, 0.1 * k});
  }
  const std::size_t post = tunnel.size();
  for (int k = 5; k < 9; ++k) tunnel.push_back({8.5, 1.35, 0.1 * k});
  const std::size_t bracket = tunnel.size();
  for (int k = 2; k < 4; ++k) tunnel.push_back({15, 1.3, 0.1 * k});
  for (int i = -2; i <= 2; ++i) {
    for (int k = 0; k <= 10; ++k) {
      for (const double side : {-1.25, 1.25}) wagon.push_back({0.1 * i, side, 0.1 * k});
    }
  }
  put("tunnel.pcd", cloudOf(tunnel));
  put("wagon.pcd", cloudOf(wagon));
  std::string track;
  for (int pose = 0; pose <= 20; ++pose) track += "1 0 0 " + std::to_string(pose) + " 0 1 0 0 0 0 1 0\n";
  folder.write("track.txt", track);
  runSample("wagon_clearance.json");

  const auto list = nlohmann::json::parse(contentOf(folder / "clashes.json"));
  EXPECT_EQ(list["input"], "tunnel.pcd");
  EXPECT_EQ(list["poses"], 21);
  const auto& clashes = list["clashes"];
  ASSERT_EQ(clashes.size(), 2U);
  EXPECT_EQ(clashes[0]["points"], 2);
  EXPECT_NEAR(clashes[0]["distance"].get<double>(), 0.05, 0.005);
  EXPECT_EQ(clashes[0]["first_pose"], 14) << "on the way from pose 14 to the next";
  EXPECT_EQ(clashes[1]["points"], 4);
  EXPECT_NEAR(clashes[1]["distance"].get<double>(), 0.1, 0.005);
  EXPECT_EQ(clashes[1]["first_pose"], 8);
  const std::string page = contentOf(folder / "clashes.html");
  EXPECT_THAT(page, HasSubstr("<h1>2 clashes</h1>"));
  EXPECT_THAT(page, HasSubstr("wagon along 21 poses through tunnel.pcd"));

  const pcl::PCLPointCloud2 flagged = readCloud(folder / "tunnel_clearance.pcd");
  ASSERT_EQ(flagged.width, tunnel.size());
  for (std::size_t i = 0; i < tunnel.size(); ++i) {
    EXPECT_EQ(valueOf(flagged, i, "collision"), i < post ? 0 : 1) << i;
    EXPECT_EQ(valueOf(flagged, i, "first_pose"), i < post ? -1 : i < bracket ? 8 : 14) << i;
    EXPECT_EQ(std::isnan(valueOf(flagged, i, "distance")), i < post) << i;
  }
}

TEST_F(PipelineProgram, SampleGeoreferenced)
{
  // A row of ground points in a UTM zone, and a wire that sags past it: 4 cm away at one end, 6 cm at the other.
  std::vector<Place> terrain, wire;
  for (int i = 0; i < 1000; ++i) {
    terrain.push_back({500000.003 + 0.01 * i, 5400000.26, 100});
    wire.push_back({500000.003 + 0.01 * i, 5400000.30 + 0.00002 * i, 100});
  }
  put("terrain.pcd", cloudOf(terrain, Field::FLOAT64));
  pcl::PCLPointCloud2 line = cloudOf(wire, Field::FLOAT64);
  line.fields.pop_back();
  put("power_line.xyz", line);
  runSample("georeferenced.json");

  const pcl::PCLPointCloud2 result = readCloud(folder / "clearance.pcd");
  ASSERT_EQ(result.fields[0].datatype, Field::FLOAT64);
  ASSERT_GT(result.width, 900U);
  for (std::size_t i = 0; i < result.width; ++i) {
    const auto number = static_cast<std::size_t>(valueOf(result, i, "intensity"));
    EXPECT_EQ(valueOf(result, i, "x"), terrain[number].x);
    EXPECT_EQ(valueOf(result, i, "y"), terrain[number].y);
    if (number > 495 && number < 510) continue;
    EXPECT_EQ(valueOf(result, i, "collision"), number < 500 ? 1 : 0) << number;
  }
}

TEST_F(PipelineProgram, SampleOwnStage)
{
  put("scan.pcd", cloudOf(wall(0)));
  const std::string sample = std::string(PCL_BSH_SOURCE_DIR) + "/examples/cpp/every_nth.json";
  const Outcome done = run("pcl_bsh_own_stage", sample, folder.path());
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const pcl::PCLPointCloud2 thin = readCloud(folder / "thin.pcd");
  ASSERT_EQ(thin.width, 40U);
  EXPECT_EQ(valueOf(thin, 3, "intensity"), 30);
  EXPECT_THAT(runIn(sample).err, HasSubstr("\"filters.every_nth\" is no type of stage"));
  EXPECT_EQ(run("pcl_bsh_own_stage", "").exit_code, 2);
}

TEST_F(PipelineProgram, OverridesProgressAndMetadata)
{
  put("scan.pcd", cloudOf(wall(0)));
  folder.write("p.json", R"(["scan.pcd", {"type": "filters.voxel_grid", "tag": "thin", "leaf_size": 0.5}, "out.ply"])");
  const Outcome done = runIn("p.json --stage.thin.leaf_size=1,1,1 --stage.writers_ply1.filename=other.ply --progress "
                             "--metadata run.json --threads 1");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(readCloud(folder / "other.ply").width, 4U);
  EXPECT_THAT(done.err, HasSubstr("> [2/3] thin: filters.voxel_grid [done, "));
  EXPECT_THAT(done.err, HasSubstr(" ms : 4 points]\n"));
  const auto metadata = nlohmann::json::parse(contentOf(folder / "run.json"));
  EXPECT_EQ(metadata["metadata"]["stages"][1]["points_out"], 4);

  const std::string first = contentOf(folder / "other.ply");
  std::filesystem::remove(folder / "other.ply");
  EXPECT_EQ(runIn("run.json").exit_code, 0) << "metadata is a pipeline";
  EXPECT_EQ(contentOf(folder / "other.ply"), first);
  EXPECT_EQ(runIn("p.json").err, "") << "short runs are silent";
}

TEST_F(PipelineProgram, SaysWhatIsWrong)
{
  folder.write("p.json", R"(["scan.pcd", {"type": "filters.voxel_grid", "leafsize": 0.5}, "out.ply"])");
  Outcome failed = runIn("p.json");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "pcl_bsh_pipeline: p.json: filters_voxel_grid1: /1/leafsize: is no option of "
                        "filters.voxel_grid: did you mean 'leaf_size'?\n");
  failed = runIn("none.json");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "pcl_bsh_pipeline: none.json: no such file: check the name\n");
  folder.write("q.json", R"(["scan.pcd", "out.ply"])");
  EXPECT_EQ(runIn("q.json --validate").err,
            "pcl_bsh_pipeline: q.json: readers_pcd1: /0: scan.pcd: no such file: check the name\n");
  failed = runIn("q.json --stage.thin=3");
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_EQ(failed.err, "pcl_bsh_pipeline: --stage.thin=3: is not understood: write --stage.TAG.OPTION=VALUE\n");
  EXPECT_EQ(runIn("").exit_code, 2);
  EXPECT_EQ(runIn("q.json --quick").exit_code, 2);
  EXPECT_EQ(runIn("q.json --metadata none/run.json").exit_code, 1);
  const Outcome help = runIn("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("Example: "));
}

TEST_F(PipelineProgram, ReadsPipelinesFromStandardInput)
{
  put("scan.pcd", cloudOf(wall(0)));
  const std::string mark = "\xef\xbb\xbf"; // as some editors begin UTF-8
  folder.write("p.json",
               mark + R"(["scan.pcd", {"type": "filters.voxel_grid", "tag": "thin", "leaf_size": 0.5}, "out.ply"])");
  const Outcome valid = runIn("- --validate <p.json");
  EXPECT_EQ(valid.exit_code, 0) << valid.err;
  EXPECT_EQ(valid.out, "standard input is valid\n");
  EXPECT_EQ(runIn("- --stage.thin.leaf_size=1 <p.json").exit_code, 0);
  EXPECT_EQ(readCloud(folder / "out.ply").width, 4U);
  folder.write("bad.json", "[");
  const Outcome failed = runIn("- <bad.json");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, StartsWith("pcl_bsh_pipeline: standard input: is no JSON"));
}

TEST_F(PipelineProgram, TellsProgramsWhetherItIsValid)
{
  put("scan.pcd", cloudOf(wall(0)));
  folder.write("p.json", R"(["scan.pcd", "out.ply"])");
  const Outcome valid = runIn("p.json --validate --json");
  EXPECT_EQ(valid.exit_code, 0) << valid.err;
  EXPECT_EQ(nlohmann::json::parse(valid.out), (nlohmann::json{{"pipeline", "p.json"}, {"valid", true}}));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.ply"));

  folder.write("q.json", R"(["none.pcd", "out.ply"])");
  for (const char* document : {"q.json", "none.json"}) {
    const Outcome wrong = runIn(std::string(document) + " --validate --json");
    EXPECT_EQ(wrong.exit_code, 1);
    const nlohmann::json told = nlohmann::json::parse(wrong.out);
    EXPECT_EQ(told["valid"], false);
    EXPECT_EQ("pcl_bsh_pipeline: " + told["error"].get<std::string>() + "\n", wrong.err);
  }
  const Outcome alone = runIn("p.json --json");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(alone.err, "pcl_bsh_pipeline: --json: goes with --validate: add it, or give --metadata - instead\n");
}

TEST_F(PipelineProgram, OverridesSetOptionsAlone)
{
  folder.write("p.json", R"(["scan.pcd", {"type": "filters.voxel_grid", "tag": "v", "leaf_size": 0.5}, "out.ply"])");
  EXPECT_EQ(runIn("p.json --stage.v.tag=w").err,
            "pcl_bsh_pipeline: p.json: --stage.v.tag: 'tag' is no option, but what "
            "the document is made of: change it there\n");
}

TEST_F(PipelineProgram, WarningsGoToStderr)
{
  put("scan.pcd", cloudOf(wall(0)));
  folder.write("p.json", R"(["scan.pcd", "out.obj"])");
  EXPECT_EQ(runIn("p.json").err,
            "pcl_bsh_pipeline: warning: writers_obj1: an .obj has no place for the fields intensity: "
            "they are left out\n");
}

TEST_F(PipelineProgram, SchemaAndDocumentationAreCurrent)
{
  const std::string source = PCL_BSH_SOURCE_DIR;
  EXPECT_EQ(runIn("--print-schema").out, contentOf(source + "/examples/pipelines/pcl_bsh_pipeline.schema.json"))
      << "run pcl_bsh_pipeline --print-schema > examples/pipelines/pcl_bsh_pipeline.schema.json";
  EXPECT_EQ(runIn("--print-stages").out, contentOf(source + "/filters/pipeline/STAGES.md"))
      << "run pcl_bsh_pipeline --print-stages > filters/pipeline/STAGES.md";
}

} // namespace
} // namespace pcl_bsh
