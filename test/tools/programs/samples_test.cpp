// SPDX-License-Identifier: BSD-3-Clause
// Texts that users copy run as they stand: the README's commands, in their order, and each sample scene and pipeline.
#include "program_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace pcl_bsh {
namespace {

namespace fs = std::filesystem;

const fs::path source = PCL_BSH_SOURCE_DIR;

/// A clone after the README's first command: its samples, the programs, and the scans of the demonstration. Two files
/// stand for a reader's own.
class Samples : public testing::Test {
protected:
  Samples()
  {
    fs::create_directory(clone / "build");
    fs::create_directory_symlink(source / "examples", clone / "examples");
    fs::create_directory(clone / "build/release");
    fs::create_directory_symlink(PCL_BSH_PROGRAM_DIR, clone / "build/release/bin");
    if (haveScans()) fs::create_directory_symlink(source / "build/demo", clone / "build/demo");
    fs::copy_file(source / "test/fuzz/corpus/laz/f1_v2_chunks", clone / "hall.laz");
    clone.write("machine.stl", tetrahedron());
  }

  static std::string tetrahedron()
  {
    constexpr const char* faces[4][3] = {{"0 0 0", "0 1 0", "1 0 0"},
                                         {"0 0 0", "1 0 0", "0 0 1"},
                                         {"0 0 0", "0 0 1", "0 1 0"},
                                         {"1 0 0", "0 1 0", "0 0 1"}};
    std::string stl = "solid machine\n";
    for (const auto& corners : faces) {
      stl += "facet normal 0 0 0\nouter loop\n";
      for (const char* const corner : corners) stl += std::string("vertex ") + corner + '\n';
      stl += "endloop\nendfacet\n";
    }
    return stl + "endsolid machine\n";
  }

  static bool haveScans()
  {
    return fs::exists(source / "build/demo/building.ply") && fs::exists(source / "build/demo/man.off");
  }

  /// In the clone's folder, by bash, up to the first command that fails.
  void expectDone(const std::string& script) const
  {
    clone.write("script.sh", "set -euo pipefail\n" + script);
    const Outcome done = runCommands("bash script.sh </dev/null", clone.path());
    EXPECT_EQ(done.exit_code, 0) << script << '\n' << done.out << done.err;
  }

  const files::TemporaryFolder clone;
};

constexpr auto no_scans = "the demonstration's scans are not there: run bash examples/demo/fetch_scans.sh build/demo";

/// The blocks of commands, without those whose first line says that they need more than a clone and its programs.
std::vector<std::string> blocksOf(const fs::path& document)
{
  std::istringstream lines(files::contentOf(document));
  std::vector<std::string> blocks;
  for (std::string line; std::getline(lines, line);) {
    if (line != "```bash") continue;
    std::string block;
    while (std::getline(lines, line) && line != "```") block += line + '\n';
    const auto begins = [&](const char* text) { return block.rfind(text, 0) == 0; };
    if (!begins("# needs root") && !begins("# opens windows") && !begins("# builds")) blocks.push_back(block);
  }
  return blocks;
}

/// The commands of a document, in their order, in a clone of its own.
class Documents : public Samples, public testing::WithParamInterface<const char*> {};

TEST_P(Documents, CommandsRunInTheirOrder)
{
  if (!haveScans()) GTEST_SKIP() << no_scans;
  if (!fs::exists(clone / "build/release/bin/pcl_bsh_view"))
    GTEST_SKIP() << "pcl_bsh_view is not built: install libvtk9-dev, libegl-dev and libx11-dev";
  std::string all = "export PATH=\"$PWD/build/release/bin:$PATH\"\n";
  const std::vector<std::string> blocks = blocksOf(source / GetParam());
  EXPECT_FALSE(blocks.empty());
  for (const std::string& block : blocks) all += block;
  expectDone(all);
}

INSTANTIATE_TEST_SUITE_P(Each, Documents,
                         testing::Values("README.md", "YOU_ASKED.md", "filters/pipeline/PIPELINES.md",
                                         "pcl_bsh/io/FORMATS.md", "pcl_bsh/query/ACCURACY.md",
                                         "pcl_bsh/scene/SCENES.md", "pcl_bsh/site/SITES.md",
                                         "pcl_bsh/tools/viewer/VIEWER.md", "pcl_bsh/track/TRACKS.md",
                                         "pcl_bsh/trajectory/PATHS.md"));

/// Links of documents lead to files.
TEST_F(Samples, LinksOfDocumentsLead)
{
  const auto skipped = [](const fs::path& path) {
    const std::string name = path.filename().string();
    return name == "build" || name == ".git" || name == "corpus";
  };
  std::size_t links = 0;
  for (auto file = fs::recursive_directory_iterator(source); file != fs::recursive_directory_iterator(); ++file) {
    if (skipped(file->path())) file.disable_recursion_pending();
    if (file->path().extension() != ".md") continue;
    const std::string text = files::contentOf(file->path());
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      std::string link = text.substr(at + 2, text.find(')', at) - at - 2);
      link = link.substr(0, link.find('#'));
      if (link.empty() || link.rfind("http", 0) == 0 || link.find(' ') != std::string::npos) continue;
      EXPECT_TRUE(fs::exists(file->path().parent_path() / link)) << file->path() << " points at " << link;
      ++links;
    }
  }
  EXPECT_GT(links, 50U);
}

TEST_F(Samples, EachPipelineRunsOnTheCloudsMadeForIt)
{
  expectDone("bash examples/pipelines/make_clouds.sh build/samples");
  std::size_t run = 0;
  for (const auto& entry : fs::directory_iterator(source / "examples/pipelines")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || name.find(".schema.") != std::string::npos) continue;
    expectDone("cd build/samples; ../release/bin/pcl_bsh_pipeline ../../examples/pipelines/" + name);
    ++run;
  }
  EXPECT_GE(run, 7U);
  // The machine's side passes the column by 5 cm: its corners do not come near, its faces do.
  const std::string clashes = files::contentOf(clone / "build/samples/machine_clashes.json");
  EXPECT_NE(clashes.find("\"closest_pose\""), std::string::npos);
  EXPECT_EQ(clashes.find("\"closest_pose\""), clashes.rfind("\"closest_pose\"")) << "one clash";
  EXPECT_NE(clashes.find("\"triangle\""), std::string::npos);
  EXPECT_GT(fs::file_size(clone / "build/samples/road.las"), 10000U);
}

/// A gauging run on the made line: the cable, the cabinet, and the part that was not scanned.
TEST_F(Samples, TheMadeLineIsGauged)
{
  expectDone(
      "bash examples/track/make_line.sh build/line\n"
      "build/release/bin/pcl_bsh_gauge build/line/scan.xyz --axis build/line/line.axis --profile build/line/gauge.csv "
      "--profile build/line/wagon.csv --vehicle wagon=19,3.7 --unit m --infringements build/line/list.csv "
      "--page build/line/page.html");
  const std::string list = files::contentOf(clone / "build/line/list.csv");
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 3) << list;
  EXPECT_NE(files::contentOf(clone / "build/line/page.html").find("No data at chainages 1640 to 1650"),
            std::string::npos);
  expectDone("cd build/line; ../release/bin/pcl_bsh_pipeline ../../examples/track/gauging.json");
  EXPECT_EQ(files::contentOf(clone / "build/line/infringing.csv"), list);
}

/// Both tracks of the made hall: a sign in the right gauge, a beam in both, and what a cabinet hides.
TEST_F(Samples, TheMadeTracksAreGauged)
{
  expectDone("bash examples/track/make_tracks.sh build/tracks; cd build/tracks\n"
             "../release/bin/pcl_bsh_gauge scan.csv --axis left=left.axis --axis right=right.axis --profile gauge.csv "
             "--unit m "
             "--cluster-distance 1 --origin-path path.csv --seen-spacing 0.3 --infringements list.csv --table "
             "table.csv --page page.html");
  const std::string list = files::contentOf(clone / "build/tracks/list.csv");
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 4) << list;
  EXPECT_NE(list.find(",new,left,gauge,"), std::string::npos) << list;
  EXPECT_NE(list.find("\n1,right:"), std::string::npos) << list;
  const std::string table = files::contentOf(clone / "build/tracks/table.csv");
  EXPECT_NE(table.find("\nright,1029,1030,29,30,gauge,clear,"), std::string::npos);
  EXPECT_NE(table.find("\nright,1035,1036,35,36,gauge,unseen,"), std::string::npos) << "behind the cabinet";
}

/// Two epochs: what came, what went, a page, and a picture.
TEST_F(Samples, WhatChangedIsShown)
{
  expectDone("bash examples/pipelines/make_clouds.sh build/samples; cd build/samples\n"
             "../release/bin/pcl_bsh_pipeline ../../examples/pipelines/what_changed.json");
  const fs::path made = clone / "build/samples";
  EXPECT_NE(files::contentOf(made / "changes.html").find("Hausdorff distance [m]"), std::string::npos);
  if (!fs::exists(clone / "build/release/bin/pcl_bsh_view"))
    GTEST_SKIP() << "pcl_bsh_view is not built: install libvtk9-dev, libegl-dev and libx11-dev";
  expectDone("cd build/samples; ../release/bin/pcl_bsh_view changes.pcd --color distance --range 0.5 --unit m "
             "--screenshot changes.png");
  EXPECT_GT(fs::file_size(made / "changes.png"), 10000U);
}

TEST_F(Samples, EachSceneRuns)
{
  std::size_t run = 0;
  // Links would lead back to the source's folder, where the scans may not be.
  fs::create_directories(clone / "own/scenes");
  for (const char* file : {"cube.off", "robot.urdf", "robot.srdf", "robot.csv"})
    fs::copy_file(source / "examples/scenes" / file, clone / "own/scenes" / file);
  for (const auto& entry : fs::directory_iterator(source / "examples/scenes")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || name.find(".schema.") != std::string::npos) continue;
    const std::string scene = files::contentOf(entry.path());
    const bool scans = scene.find("build/demo/") != std::string::npos;
    if (scans && !haveScans()) continue;
#ifndef PCL_BSH_BODIES
    if (scene.find("\"bodies\"") != std::string::npos) continue;
#endif
#ifndef PCL_BSH_ROBOTS
    if (scene.find("\"robot\"") != std::string::npos) continue;
#endif
    clone.write("own/scenes/" + name, scene);
    expectDone("build/release/bin/pcl_bsh_scene own/scenes/" + name + " --out run_" + name);
    ++run;
  }
  EXPECT_GE(run, 3U);
  if (!haveScans()) GTEST_SKIP() << "all but walk.json ran: " << no_scans;
}

} // namespace
} // namespace pcl_bsh
