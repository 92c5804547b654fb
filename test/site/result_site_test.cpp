// SPDX-License-Identifier: BSD-3-Clause
// Sites of results: the same tiles, with what a question has found of each point.
#include "io/clouds/samples.h"
#include "support/verdicts.h"
#include "tools/programs/process.h"
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_QUERIES
#include "two_ranks.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/export_site.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/result_site.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::Not;
using Cloud = pcl::PCLPointCloud2;

class SiteResults : public testing::Test {
protected:
  SiteResults()
  {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto cloudOf = [&](std::uint32_t points, float size) {
      Cloud cloud;
      for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, io::Field::FLOAT32);
      io::allocate(cloud, points);
      for (std::size_t i = 0; i < points; ++i) {
        float p[3] = {size * unit(random), size * unit(random), 0.3F * unit(random)};
        if (i % 501 == 7) p[1] = std::numeric_limits<float>::quiet_NaN();
        std::memcpy(&cloud.data[12 * i], p, sizeof p);
      }
      return cloud;
    };
    scan = cloudOf(8000, 20);
    machine = cloudOf(300, 1);
    io::writeCloud(folder / "scan.pcd", scan);
    io::writeCloud(folder / "machine.pcd", machine);
    for (int i = 0; i < 9; ++i) poses.emplace_back(Eigen::Translation3d(i - 4.0, 0.5 * i, 0.1));
    io::writePoses(folder / "poses.txt", poses);
    MakeOptions options;
    options.tile_points = 500;
    site = makeSite({folder / "scan.pcd"}, folder / "site", options);
  }

  /// The points of a site of results in their first order. Checks the site.
  Cloud resultOf(const std::string& name)
  {
    const Site out = readSite(folder / name);
    checkSite(out);
    EXPECT_EQ(out.tiles.size(), site.tiles.size());
    EXPECT_EQ(io::readCloud(folder / name / overview_file_name).width, 8000u);
    exportSource(out, 0, folder / (name + ".pcd"));
    return io::readCloud(folder / (name + ".pcd"));
  }

  int collide(const std::string& arguments)
  {
    const auto outcome = run("pcl_bsh_site", "collide " + (folder / "site").string() + " " +
                                                 (folder / "machine.pcd").string() + " " + arguments);
    err = outcome.err;
    return outcome.exit_code;
  }
  std::string in(const std::string& name) const { return (folder / name).string(); }

  files::TemporaryFolder folder;
  Cloud scan, machine;
  std::vector<Eigen::Isometry3d> poses;
  Site site;
  std::string err;
};

TEST(StaleFields, AreThoseOfAnEarlierQuestionThatThisOneDoesNotAnswer)
{
  Site asked;
  asked.sources.resize(2);
  for (const char* name : {collision_field_name, distance_field_name, "intensity"}) {
    asked.sources[1].fields.emplace_back();
    asked.sources[1].fields.back().name = name;
  }
  const ResultField collision{collision_field_name, io::Field::UINT8},
      distance{distance_field_name, io::Field::FLOAT32};
  EXPECT_THAT(staleFields(asked, {}), ElementsAre(collision_field_name, distance_field_name));
  EXPECT_THAT(staleFields(asked, {collision}), ElementsAre(distance_field_name));
  EXPECT_THAT(staleFields(asked, {collision, distance}), IsEmpty());
}

TEST_F(SiteResults, AreThoseOfMemory)
{
  const SphereHierarchy a(viewOf(scan)), b(viewOf(machine));
  FlagsRequest flags;
  flags.clearance = 0.3;
  flags.flagged = Flagged::a;
  const FlagsResult in_memory = collisionFlags({a}, {b}, flags);
  ASSERT_GT(in_memory.colliding_a, 0u);
  ASSERT_EQ(collide("--clearance 0.3 --out " + in("flags")), 0) << err;
  io::expectSame(resultOf("flags"), withField(scan, "collision", in_memory.a));

  TrajectoryRequest along;
  along.clearance = 0.3;
  along.distances = along.first_poses = along.closest_poses = true;
  const TrajectoryResult way = collideAlong({a}, b, poses, along);
  ASSERT_EQ(collide("--clearance 0.3 --trajectory " + in("poses.txt") + " --out " + in("way")), 0) << err;
  io::expectSame(resultOf("way"), withFields(scan, fieldsOf(way)));

  // A site of results may be asked again: its field `collision` is written anew.
  fs::rename(folder / "site", folder / "first");
  fs::rename(folder / "way", folder / "site");
  ASSERT_EQ(collide("--clearance 0.3 --out " + in("again")), 0) << err;
  Cloud again = withFields(scan, fieldsOf(way));
  io::expectSame(resultOf("again"), withField(again, "collision", in_memory.a));
  ASSERT_EQ(collide("--distances --max-distance 2 --out " + in("distances")), 0) << err;
  PointDistancesRequest near;
  near.max_distance = 2.0;
  std::vector<float> distance;
  for (const double d : pointDistances({a}, {b}, near).distance) distance.push_back(static_cast<float>(d));
  io::expectSame(resultOf("distances"), withFields(again = withFields(scan, fieldsOf(way)), {{"distance", &distance}}));
}

/// The site has two sources. One has fields of answers to an earlier question.
TEST_F(SiteResults, AreExportedToEachSource)
{
  Cloud asked = scan, other = scan;
  const std::vector<std::uint8_t> old_flags(scan.width, 7);
  const std::vector<float> old_distance(scan.width, 77.0F);
  const std::vector<std::int32_t> old_pose(scan.width, 777);
  asked = withFields(asked, {{"collision", &old_flags}, {"distance", &old_distance}, {"first_pose", &old_pose}});
  other = withFields(other, {{"distance", &old_distance}}); // a range, as scanners measure it
  io::writeCloud(folder / "asked.pcd", asked);
  io::writeCloud(folder / "plain.pcd", scan);
  io::writeCloud(folder / "other.pcd", other);
  fs::remove_all(folder / "site");
  MakeOptions options;
  options.tile_points = 500;
  makeSite({folder / "asked.pcd", folder / "plain.pcd"}, folder / "site", options);
  const SphereHierarchy a(viewOf(scan)), b(viewOf(machine));
  FlagsRequest flags;
  flags.clearance = 0.3;
  const Cloud flagged = withField(scan, "collision", collisionFlags({a}, {b}, flags).a);

  ASSERT_EQ(collide("--clearance 0.3 --out " + in("flags")), 0);
  EXPECT_THAT(err, HasSubstr("leaves out fields of " + in("site") +
                             " that answer an earlier question: distance, "
                             "first_pose\n"));
  EXPECT_NO_THROW(checkSite(readSite(folder / "flags")));
  ASSERT_EQ(run("pcl_bsh_site", "export flags sources", folder.path()).exit_code, 0);
  for (const char* name : {"asked.pcd", "plain.pcd"}) io::expectSame(io::readCloud(folder / "sources" / name), flagged);

  // Fields of a path replace the fields that were there.
  ASSERT_EQ(collide("--clearance 0.3 --trajectory " + in("poses.txt") + " --out " + in("way")), 0);
  EXPECT_THAT(err, Not(HasSubstr("leaves out")));
  EXPECT_NO_THROW(checkSite(readSite(folder / "way")));
  ASSERT_EQ(run("pcl_bsh_site", "export way of_way", folder.path()).exit_code, 0);
  TrajectoryRequest along;
  along.clearance = 0.3;
  along.distances = along.first_poses = along.closest_poses = true;
  const TrajectoryResult found = collideAlong({a}, b, poses, along);
  for (const char* name : {"asked.pcd", "plain.pcd"}) {
    const Cloud written = io::readCloud(folder / "of_way" / name);
    EXPECT_EQ(written.fields.size(), 7U);
    for (std::uint32_t i = 0; i < written.width; i += 37) {
      EXPECT_EQ(io::valueOf(written, i, "collision"), bytesOf(found.flags)[i]);
      EXPECT_EQ(io::valueOf(written, i, "first_pose"), found.first_pose[i]);
      EXPECT_EQ(io::valueOf(written, i, "closest_pose"), found.closest_pose[i]);
    }
  }

  // A field `distance` without a field `collision` is no answer, and stays.
  fs::remove_all(folder / "site");
  makeSite({folder / "other.pcd", folder / "plain.pcd"}, folder / "site", options);
  ASSERT_EQ(collide("--clearance 0.3 --out " + in("ranges")), 0);
  EXPECT_THAT(err, Not(HasSubstr("leaves out")));
  ASSERT_EQ(run("pcl_bsh_site", "export ranges of_ranges", folder.path()).exit_code, 0);
  io::expectSame(io::readCloud(folder / "of_ranges/plain.pcd"), flagged);
  const Cloud kept = io::readCloud(folder / "of_ranges/other.pcd");
  EXPECT_EQ(io::valueOf(kept, 5, "distance"), 77.0);
  EXPECT_EQ(io::valueOf(kept, 5, "collision"), io::valueOf(flagged, 5, "collision"));
}

TEST_F(SiteResults, AreTheSameOfTwoRanks)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  for (const std::string asked : {"--clearance 0.3 --accuracy level=3 ", "--clearance 0.3 "}) {
    for (const char* name : {"one", "two"}) fs::remove_all(folder / name);
    ASSERT_EQ(collide(asked + "--out " + in("one") + " --obstacle-out " + in("one.pcd")), 0) << err;
    const Outcome two = runOnTwoRanks("collide site machine.pcd " + asked +
                                          "--out two --obstacle-out two.pcd --report two.json --plan 1,2,1024",
                                      folder.path());
    ASSERT_EQ(two.exit_code, 0) << two.err;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "one")) {
      if (!entry.is_regular_file()) continue;
      const fs::path name = fs::relative(entry.path(), folder / "one");
      EXPECT_TRUE(files::contentOf(entry.path()) == files::contentOf(folder / "two" / name)) << asked << name;
    }
    EXPECT_TRUE(files::contentOf(folder / "one.pcd") == files::contentOf(folder / "two.pcd")) << asked;
  }
  EXPECT_FALSE(fs::exists(folder / "two/unfinished_site"));
  const auto report = nlohmann::json::parse(files::contentOf(folder / "two.json"));
  EXPECT_EQ(report["out"], "two");
  EXPECT_EQ(report["costs"]["ranks"], 2);
  EXPECT_EQ(report["costs"]["tiles"].size(), report["tiles"]["read"]);
  ASSERT_EQ(report["plan"].size(), 3u);
  EXPECT_GE(report["plan"][0]["seconds"], report["plan"][1]["seconds"]);
  EXPECT_GE(report["plan"][1]["seconds"], report["plan"][2]["seconds"]);
  EXPECT_NEAR(report["plan"][1]["seconds"].get<double>(),
              report["costs"]["seconds"].get<double>() + report["costs"]["copying"].get<double>(), 1e-9);
  EXPECT_NE(report["plan"][2]["limit"], "work");
}

TEST_F(SiteResults, RefuseWhatTheyMustNotWriteOver)
{
  const std::string before = files::contentOf(folder / "site/site.json");
  for (const char* inside : {"site", "site/sub"}) {
    EXPECT_EQ(collide("--clearance 0.3 --out " + in(inside)), 2);
    EXPECT_THAT(err, HasSubstr("lies in the folder of SITE"));
  }
  EXPECT_EQ(files::contentOf(folder / "site/site.json"), before);
  fs::create_directory(folder / "mine");
  folder.write("mine/letter.txt", "dear");
  EXPECT_EQ(collide("--clearance 0.3 --out " + in("mine")), 1);
  EXPECT_THAT(err, HasSubstr("is not empty"));
  EXPECT_EQ(files::contentOf(folder / "mine/letter.txt"), "dear");
  EXPECT_EQ(collide("--clearance 0.3"), 2);
  EXPECT_THAT(err, HasSubstr("--report, --out, --obstacle-out, --clashes: none is given"));
  EXPECT_EQ(collide("--closest --out " + in("none")), 2);
  EXPECT_EQ(collide("--clearance 0.3 --out " + in("none") + " --plan 2"), 2);
  EXPECT_THAT(err, HasSubstr("--plan: is told in the report"));

  ASSERT_EQ(collide("--clearance 0.3 --out " + in("out")), 0);
  Site other = site;
  EXPECT_THROW(ResultSite(readSite(folder / "out"), folder / "new", {{"collision", io::Field::FLOAT32, 0}}),
               std::runtime_error);
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST_F(SiteResults, RefuseFieldsAndPointsThatAreNotAsTheyMustBe)
{
  const auto expectRefusal = [](const std::string& words, const auto& call) {
    try {
      call();
      ADD_FAILURE() << words;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  };
  Cloud pairs;
  for (const char* axis : {"x", "y", "z"}) io::addField(pairs, axis, io::Field::FLOAT32);
  io::addField(pairs, "collision", io::Field::UINT8, 2);
  io::allocate(pairs, 3);
  io::writeCloud(folder / "pairs.pcd", pairs);
  const Site of_pairs = makeSite({folder / "pairs.pcd"}, folder / "pairs");
  expectRefusal("its field 'collision' has another type than the results", [&] {
    ResultSite(of_pairs, folder / "new", {{"collision", io::Field::UINT8, 0}});
  });
  EXPECT_FALSE(fs::exists(folder / "new"));

  Cloud cloud = readTile(site, site.tiles[0]);
  const std::uint32_t source = 1; // there is 0 alone
  for (const auto& field : cloud.fields)
    if (field.name == source_field_name) std::memcpy(&cloud.data[field.offset], &source, sizeof source);
  ResultSite results(site, folder / "new", {});
  expectRefusal(site.tiles[0].file + ": has a point of source 1, which there is not: make the site again",
                [&] { results.write(site.tiles[0], cloud, {}); });
}

TEST_F(SiteResults, OfNothing)
{
  Cloud nothing;
  for (const char* axis : {"x", "y", "z"}) io::addField(nothing, axis, io::Field::FLOAT32);
  io::allocate(nothing, 0);
  io::writeCloud(folder / "nothing.pcd", nothing);
  const Site empty = makeSite({folder / "nothing.pcd"}, folder / "empty");
  ResultSite results(empty, folder / "out", {{"collision", io::Field::UINT8, 0}});
  EXPECT_EQ(results.answers(), nullptr) << "nothing is kept without a question";
  EXPECT_EQ(results.thrownAway(), 0U);
  results.finish();
  EXPECT_NO_THROW(checkSite(readSite(folder / "out")));
  EXPECT_FALSE(fs::exists(folder / "out" / overview_file_name));
  EXPECT_EQ(spaceWanted(empty, folder / "out2", {{"collision", io::Field::UINT8, 0}}), 2U * 4096);
  EXPECT_EQ(spaceWanted(site, folder / "out2", {{"collision", io::Field::UINT8, 0}}),
            16000U * (recordBytes(site) + 1) + (site.tiles.size() + 2) * 4096);
}

/// A tile that is damaged, and a disk that is full, leave nothing; a run that is killed a folder that says so.
TEST_F(SiteResults, AreWholeOrNotThere)
{
  const std::string name = "site/" + site.tiles.back().file, whole = files::contentOf(folder / name);
  std::string damaged = whole;
  damaged[whole.size() - 5] ^= 1;
  folder.write(name, damaged);
  EXPECT_EQ(collide("--clearance 0.3 --out " + in("out")), 1);
  EXPECT_THAT(err, HasSubstr("not those that the site was made with"));
  EXPECT_THAT(err, HasSubstr("; what was found stays, and the same command with --resume goes on"));
  EXPECT_THROW(readSite(folder / "out"), files::FileError);
  fs::remove_all(folder / "out");
  folder.write(name, whole);

  const std::vector<std::string> arguments = {"collide", "site", "machine.pcd", "--clearance", "0.3", "--out", "out"};
  { // In this process: MPI cannot begin where it may not write files itself.
    ResultSite out(site, folder / "out", {{"collision", io::Field::UINT8, 0}});
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before = {};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limits = {4000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limits);
    EXPECT_THROW(out.finish(), files::FileError);
    setrlimit(RLIMIT_FSIZE, &before);
  }
  EXPECT_FALSE(fs::exists(folder / "out"));

  int unfinished = 0;
  for (int wait = 0; wait < 6; ++wait) {
    Process program("pcl_bsh_site", arguments, folder.path());
    while (!program.hasEnded() && !fs::exists(folder / "out/tiles")) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    program.send(SIGKILL);
    program.end();
    if (fs::exists(folder / "out/site.json")) {
      EXPECT_NO_THROW(checkSite(readSite(folder / "out")));
      fs::remove_all(folder / "out");
    }
    else if (fs::exists(folder / "out")) {
      ++unfinished;
      EXPECT_THROW(readSite(folder / "out"), std::runtime_error);
    }
  }
  EXPECT_EQ(collide("--clearance 0.3 --out " + in("out")), 0) << err;
  EXPECT_NO_THROW(checkSite(readSite(folder / "out")));
  EXPECT_GT(unfinished, 0);
}

} // namespace
} // namespace pcl_bsh::site
#endif
