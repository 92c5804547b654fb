// SPDX-License-Identifier: BSD-3-Clause
// A question to a site that was killed goes on with the tiles that it has answered, and says what it would have said.
#include "float64_cloud.h"
#include "site_questions.h"
#include "support/in_a_fork.h"
#include "support/verdicts.h"
#include "tools/programs/process.h"
#include "tools/programs/program_run.h"
#include "two_ranks.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/make_site.h>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/site/result_site.h>
#include <pcl_bsh/site/site_clashes.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <map>
#include <random>
#include <thread>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using Cloud = pcl::PCLPointCloud2;
using Json = nlohmann::json;

std::map<std::string, std::string> contentsOf(const fs::path& folder)
{
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) contents[fs::relative(entry.path(), folder).string()] = files::contentOf(entry.path());
  return contents;
}

/// Whether a run has answered about a tile.
bool hasAnswer(const fs::path& out)
{
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(out / tiles_folder_name, error))
    if (entry.path().extension() == answer_extension) return true;
  return false;
}

/// Where a run is killed.
enum class At : std::uint8_t { before_writing, before_keeping, after_tile, nowhere };

class ResumedSite : public testing::Test {
protected:
  ResumedSite()
  {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 3000; ++i) scan.push_back({9 * unit(random), 9 * unit(random), 0.2 * unit(random)});
    for (int i = 0; i < 300; ++i) body.push_back({unit(random), 0.1 * unit(random), 0.1 * unit(random)});
    for (int k = 0; k < 12; ++k) poses.emplace_back(Eigen::Translation3d(1.2 * k - 7, 0.5 * k - 3, 0));
    io::writeCloud(folder / "scan.pcd", float64Cloud(scan));
    io::writeCloud(folder / "body.pcd", float64Cloud(body));
    io::writePoses(folder / "poses.txt", poses);
    MakeOptions options;
    options.tile_points = 300;
    options.overview_points = 500;
    site = makeSite({folder / "scan.pcd"}, folder / "site", options);
  }

  /// The answer about a path, with its clashes as lines.
  struct QuestionPart : SiteAnswer {
    std::vector<std::string> clashes;
  };

  /// Each clash as a line.
  static std::vector<std::string> linesOf(const SiteClashes& list)
  {
    std::vector<std::string> lines;
    for (const Clash& clash : list.clashes) {
      std::string line = clash.id;
      for (const std::size_t number :
           {clash.points, clash.records.size(), std::size_t{list.points[clash.scan_point].record}})
        line += " " + std::to_string(number);
      if (!list.met.empty()) line += " " + std::to_string(list.met[clash.model_point].point.record);
      lines.push_back(std::move(line));
    }
    return lines;
  }

  /// Asks about the path, on a site of results. @param kill the tile, counted as they are asked, at which this process
  /// dies
  QuestionPart ask(const fs::path& out, bool goes_on, At at = At::nowhere, std::uint64_t kill = 0,
                   const std::string& question = "where?")
  {
    const SphereHierarchy model(viewOf(body.front().data(), body.size()));
    ResultSite results(site, out,
                       {{"collision", pcl::PCLPointField::UINT8, 0.0},
                        {"distance", pcl::PCLPointField::FLOAT32, std::numeric_limits<double>::quiet_NaN()}},
                       {question, goes_on});
    std::uint64_t asked = 0;
    const auto dieAt = [&](At here, std::uint64_t tile) {
      if (here == at && tile == kill) ::kill(::getpid(), SIGKILL);
    };
    SiteQuestion request;
    request.clearance = 0.3;
    request.wanted.poses = true;
    ClashFinder finder(site, 0.5);
    request.clashes = &finder;
    request.answers = results.answers();
    request.progress = [&, done = std::uint64_t{0}](double) mutable {
      dieAt(At::after_tile, ++done);
      return true;
    };
    const SiteAnswer passage =
        collideAlong(site, model, poses, request, [&](const Tile& tile, const Cloud& cloud, const Answer& found) {
          dieAt(At::before_writing, ++asked);
          results.write(tile, cloud, {found.collisions.flags.data(), found.collisions.distance.data()});
          dieAt(At::before_keeping, asked);
        });
    results.finish();
    return {passage, linesOf(finder.finish())};
  }

  /// In a process that is killed there. @return whether it was
  bool askAndDie(const fs::path& out, bool goes_on, At at, std::uint64_t kill)
  {
    return !files::endsInAFork([&] { ask(out, goes_on, at, kill); });
  }

  static void expectSame(const QuestionPart& a, const QuestionPart& b)
  {
    EXPECT_EQ(a.clashes, b.clashes);
    EXPECT_EQ(a.collisions.colliding, b.collisions.colliding);
    EXPECT_EQ(a.closest.distance, b.closest.distance);
    EXPECT_EQ(a.first_pose, b.first_pose);
    EXPECT_EQ(a.tiles.needed, b.tiles.needed);
    const std::vector<PoseSummary>&of_a = a.collisions.poses, &of_b = b.collisions.poses;
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t k = 0; k < of_a.size(); ++k) {
      EXPECT_EQ(of_a[k].colliding_points, of_b[k].colliding_points) << k;
      EXPECT_TRUE(of_a[k].distance == of_b[k].distance ||
                  (std::isnan(of_a[k].distance) && std::isnan(of_b[k].distance)))
          << k;
    }
  }

  files::TemporaryFolder folder;
  std::vector<Point3> scan, body;
  std::vector<Eigen::Isometry3d> poses;
  Site site;
};

TEST_F(ResumedSite, SaysTheSameAfterAKillAnywhere)
{
  const QuestionPart whole = ask(folder / "whole", false);
  const auto files = contentsOf(folder / "whole");
  ASSERT_GT(whole.clashes.size(), 4u);
  ASSERT_GT(whole.tiles.read, 5u);
  ASSERT_GT(whole.collisions.colliding, 0u);
  for (const At at : {At::before_writing, At::before_keeping, At::after_tile}) {
    for (const std::uint64_t kill : {std::uint64_t{1}, std::uint64_t{3}, whole.tiles.read}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(at)) + " " + std::to_string(kill));
      ASSERT_TRUE(askAndDie(folder / "out", false, at, kill));
      EXPECT_THROW(readSite(folder / "out"), files::FileError);
      const QuestionPart resumed = ask(folder / "out", true);
      expectSame(resumed, whole);
      EXPECT_EQ(resumed.tiles.read, whole.tiles.read - kill + (at == At::after_tile ? 0 : 1));
      EXPECT_EQ(contentsOf(folder / "out"), files);
      fs::remove_all(folder / "out");
    }
  }
}

TEST_F(ResumedSite, MayBeKilledAgain)
{
  const QuestionPart whole = ask(folder / "whole", false);
  std::uint64_t kills = 0;
  while (askAndDie(folder / "out", kills > 0, At::after_tile, 2)) ASSERT_LT(++kills, whole.tiles.read);
  EXPECT_EQ(kills, whole.tiles.read / 2);
  EXPECT_EQ(contentsOf(folder / "out"), contentsOf(folder / "whole"));
}

TEST_F(ResumedSite, AsksAgainWhatIsNotItsOwnAnswer)
{
  const QuestionPart whole = ask(folder / "whole", false);
  const auto expectRead = [&](std::uint64_t tiles, const std::string& question = "where?", bool goes_on = true) {
    const QuestionPart resumed = ask(folder / "out", goes_on, At::nowhere, 0, question);
    expectSame(resumed, whole);
    EXPECT_EQ(resumed.tiles.read, tiles);
    EXPECT_EQ(contentsOf(folder / "out"), contentsOf(folder / "whole"));
    fs::remove_all(folder / "out");
  };
  const auto answers = [&] {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder / "out/tiles"))
      if (entry.path().extension() == answer_extension) found.push_back(entry.path());
    return found;
  };
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 4));
  ASSERT_EQ(answers().size(), 4u);
  EXPECT_THROW(ask(folder / "out", true, At::nowhere, 0, "and when?"), files::FileError);
  EXPECT_EQ(answers().size(), 4u) << "of the first question";
  expectRead(whole.tiles.read, "where?", false); // not to go on
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 4));
  std::ofstream(answers()[0]) << "damaged";
  std::ofstream(answers()[1], std::ios::app) << "longer";
  std::ofstream(answers()[3]).close(); // empty
  fs::path tile = answers()[2];
  std::fstream(tile.replace_extension(".pcd"), std::ios::in | std::ios::out | std::ios::binary).seekp(-1, std::ios::end)
      << '\7';
  expectRead(whole.tiles.read);

  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 4));
  const auto put = [&](std::size_t number, const Json& json) {
    const auto bytes = Json::to_cbor(json);
    std::ofstream(answers()[number], std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  };
  put(0, Json::array({1, 2}));
  put(1, Json::object());
  put(2, {{"question", "where?"}});
  tile = answers()[3];
  tile.replace_extension(".pcd");
  fs::resize_file(tile, fs::file_size(tile) - 1);
  expectRead(whole.tiles.read);

  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 4));
  const std::string answer = files::contentOf(answers()[0]);
  Json json = Json::from_cbor(answer);
  json["numbers"][0] = json["numbers"][0].get<double>() + 1;
  const auto changed = Json::to_cbor(json);
  std::ofstream(answers()[0], std::ios::binary)
      .write(reinterpret_cast<const char*>(changed.data()), static_cast<std::streamsize>(changed.size()));
  expectRead(whole.tiles.read - 3);
}

/// Flags, distances and paths of two sites, killed after some tiles.
TEST_F(ResumedSite, AboutTwoSites)
{
  MakeOptions options;
  options.tile_points = 70;
  const Site other = makeSite({folder / "body.pcd"}, folder / "other", options);
  SiteQuestion request;
  request.clearance = 0.3;
  /// @return what was found, and how many tiles were read
  const auto askBoth = [&](int question, const fs::path& out, bool goes_on, std::uint64_t kill) {
    ResultSite results(site, out, {{"found", pcl::PCLPointField::FLOAT32, -1.0}},
                       {"question " + std::to_string(question), goes_on});
    request.answers = results.answers();
    request.progress = [&, done = std::uint64_t{0}](double) mutable {
      if (++done == kill) ::kill(::getpid(), SIGKILL);
      return true;
    };
    const auto write = [&](const Tile& tile, const Cloud& cloud, const auto& numbers) {
      std::vector<float> values;
      for (const auto number : numbers) values.push_back(static_cast<float>(number));
      results.write(tile, cloud, {values.data()});
    };
    std::pair<std::vector<std::string>, std::uint64_t> found;
    if (question == 0) {
      const SiteAnswer flags =
          collisionFlags(site, {other}, request, [&](const auto& tile, const auto& cloud, const Answer& result) {
            write(tile, cloud, result.collisions.flags);
          });
      found = {{std::to_string(flags.collisions.colliding)}, flags.tiles.read};
    }
    else if (question == 1) {
      const SiteAnswer distances =
          pointDistances(site, {other}, 4.0, request, [&](const auto& tile, const auto& cloud, const Answer& result) {
            write(tile, cloud, result.distances.a.distance);
          });
      found = {{std::to_string(distances.distances.a.greatest), std::to_string(distances.distances.a.measured)},
               distances.tiles.read};
    }
    else {
      ClashFinder finder(site, 0.5);
      request.clashes = &finder;
      const SiteAnswer passage =
          collideAlong(site, other, {}, poses, request, [&](const auto& tile, const auto& cloud, const Answer& result) {
            write(tile, cloud, result.collisions.flags);
          });
      const SiteClashes list = finder.finish();
      EXPECT_FALSE(list.met.empty());
      found = {linesOf(list), passage.tiles.read};
      for (const double number :
           {double(passage.collisions.colliding), passage.closest.distance, double(*passage.first_pose)})
        found.first.push_back(std::to_string(number));
    }
    results.finish();
    return found;
  };
  for (int question = 0; question < 3; ++question) {
    SCOPED_TRACE(question);
    const auto whole = askBoth(question, folder / "whole", false, 0);
    ASSERT_GT(whole.second, 1u);
    ASSERT_FALSE(files::endsInAFork([&] { askBoth(question, folder / "out", false, 1); }));
    const auto resumed = askBoth(question, folder / "out", true, 0);
    EXPECT_EQ(resumed.first, whole.first);
    EXPECT_EQ(resumed.second, whole.second - 1);
    EXPECT_EQ(contentsOf(folder / "out"), contentsOf(folder / "whole"));
    fs::remove_all(folder / "out");
    fs::remove_all(folder / "whole");
  }
}

/// The program, about a site as obstacle: with the same question; one whose obstacle is written anew, or of other
/// clashes, is told from it.
TEST_F(ResumedSite, ByTheProgramAboutTwoSites)
{
  MakeOptions options;
  options.tile_points = 70;
  const Site other = makeSite({folder / "body.pcd"}, folder / "other", options);
  const std::vector<std::string> asked = {"collide",   "site",      "other",    "--clearance", "0.3",   "--trajectory",
                                          "poses.txt", "--clashes", "list.csv", "--report",    "r.json"};
  const auto tilesRead = [&] {
    return Json::parse(files::contentOf(folder / "r.json"))["tiles"]["read"].get<std::size_t>();
  };
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), asked.begin(), asked.end());
    return more;
  };
  ASSERT_EQ(Process("pcl_bsh_site", with({"--out", "whole"}), folder.path()).end(), 0);
  const std::string list = files::contentOf(folder / "list.csv");
  const std::size_t all = tilesRead();
  for (const std::string change : {"", "tile", "clusters"}) {
    SCOPED_TRACE(change);
    fs::remove(folder / "list.csv");
    std::vector<std::string> killed = {"--out", "out"};
    if (change == "clusters") killed.insert(killed.end(), {"--cluster-distance", "30"});
    {
      Process program("pcl_bsh_site", with(killed), folder.path());
      while (!program.hasEnded() && !hasAnswer(folder / "out")) std::this_thread::yield();
      program.send(SIGKILL);
      program.end();
    }
    const bool was_killed = !fs::exists(folder / "out/site.json");
    if (!was_killed) fs::remove_all(folder / "out"); // it was quicker
    if (change == "tile") fs::last_write_time(other.folder / other.tiles[0].file, fs::file_time_type::clock::now());
    Process resumed("pcl_bsh_site", with({"--out", "out", "--resume"}), folder.path());
    const int code = resumed.end();
    if (was_killed && !change.empty()) {
      EXPECT_EQ(code, 1);
      EXPECT_THAT(resumed.err(), HasSubstr("out: holds what another question has found"));
      Process anew("pcl_bsh_site", with({"--out", "out"}), folder.path());
      EXPECT_EQ(anew.end(), 0) << anew.err();
    }
    else
      EXPECT_EQ(code, 0) << resumed.err();
    EXPECT_EQ(contentsOf(folder / "out"), contentsOf(folder / "whole"));
    EXPECT_EQ(files::contentOf(folder / "list.csv"), list);
    EXPECT_EQ(tilesRead() < all, was_killed && change.empty()) << tilesRead() << " of " << all;
    fs::remove_all(folder / "out");
  }
}

TEST_F(ResumedSite, LeavesWhatItFoundOfARunThatFails)
{
  const QuestionPart whole = ask(folder / "whole", false);
  const fs::path last = site.folder / site.tiles.back().file;
  const std::string content = files::contentOf(last);
  std::ofstream(last) << "damaged";
  EXPECT_THROW(ask(folder / "out", false), std::runtime_error);
  EXPECT_THROW(ask(folder / "out", true), std::runtime_error);
  EXPECT_GT(answersIn(folder / "out"), 0U);
  std::ofstream(last) << content;
  const QuestionPart resumed = ask(folder / "out", true);
  expectSame(resumed, whole);
  EXPECT_LE(resumed.tiles.read, 1u);
  EXPECT_EQ(contentsOf(folder / "out"), contentsOf(folder / "whole"));
}

TEST_F(ResumedSite, LeavesNothingOfARunThatFailsAtOnce)
{
  for (const Tile& tile : site.tiles) std::ofstream(site.folder / tile.file) << "damaged";
  EXPECT_THROW(ask(folder / "out", false), std::runtime_error);
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::create_directories(folder / "out");
  EXPECT_THROW(ask(folder / "out", true), std::runtime_error);
  EXPECT_TRUE(fs::is_empty(folder / "out"));
}

/// Killed while it ends: tiles and answers are there, and an overview.
TEST_F(ResumedSite, GoesOnFromTheEnd)
{
  const QuestionPart whole = ask(folder / "whole", false);
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, whole.tiles.read));
  std::ofstream(folder / "out/overview.pcd") << "half";
  const QuestionPart resumed = ask(folder / "out", true);
  expectSame(resumed, whole);
  EXPECT_EQ(resumed.tiles.read, 0u);
  EXPECT_EQ(contentsOf(folder / "out"), contentsOf(folder / "whole"));
}

/// Another one had it when it was looked at, and has made a site of it before it was locked.
TEST_F(ResumedSite, TakesNoSiteForWhatIsLeft)
{
  ask(folder / "out", false);
  const auto files = contentsOf(folder / "out");
  std::ofstream(folder / "out/unfinished_site") << "left";
  EXPECT_THROW(ask(folder / "out", true), files::FileError);
  EXPECT_THROW(ask(folder / "out", false), files::FileError);
  fs::remove(folder / "out/unfinished_site");
  EXPECT_EQ(contentsOf(folder / "out"), files);
}

/// The program, killed at instants that nobody chose.
TEST_F(ResumedSite, ByTheProgram)
{
  const std::string asked = "collide site body.pcd --clearance 0.3 --trajectory poses.txt --clashes list.json --out ";
  ASSERT_EQ(run("pcl_bsh_site", asked + "whole --report whole.json", folder.path()).exit_code, 0);
  const std::string list = files::contentOf(folder / "list.json");
  const auto whole = contentsOf(folder / "whole");
  const auto answerOf = [&](const std::string& report) { // what was read depends on what was known
    const std::string text = files::contentOf(folder / report);
    return text.substr(0, text.find("\"tiles\""));
  };
  for (int instant = 1; instant <= 10; ++instant) {
    const std::string kill = "timeout -s KILL " + std::to_string(0.03 * instant) +
                             " " PCL_BSH_PROGRAM_DIR "/pcl_bsh_site " + asked +
                             "out --report out.json > /dev/null 2>&1";
    EXPECT_NE(std::system(("cd " + folder.path().string() + " && " + kill).c_str()), -1);
    if (fs::exists(folder / "out/site.json")) fs::remove_all(folder / "out"); // it was quicker
    const Outcome outcome = run("pcl_bsh_site", asked + "out --report out.json --resume", folder.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(contentsOf(folder / "out"), whole) << instant;
    EXPECT_EQ(answerOf("out.json"), answerOf("whole.json"));
    EXPECT_EQ(files::contentOf(folder / "list.json"), list);
    fs::remove(folder / "list.json");
    fs::remove_all(folder / "out");
  }
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 3)); // of another question
  const Outcome refused = runOnTwoRanks(asked + "out --report two.json --resume", folder.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("out: holds what another question has found"));
  fs::remove_all(folder / "out");
  const std::string kill = "timeout -s KILL 0.2 " PCL_BSH_PROGRAM_DIR "/pcl_bsh_site " + asked + "out > /dev/null 2>&1";
  EXPECT_NE(std::system(("cd " + folder.path().string() + " && " + kill).c_str()), -1);
  if (fs::exists(folder / "out/site.json")) fs::remove_all(folder / "out"); // it was quicker
  const Outcome two = runOnTwoRanks(asked + "out --report two.json --resume", folder.path());
  ASSERT_EQ(two.exit_code, 0) << two.err;
  EXPECT_EQ(contentsOf(folder / "out"), whole);
  EXPECT_EQ(answerOf("two.json"), answerOf("whole.json"));
  EXPECT_EQ(files::contentOf(folder / "list.json"), list);
}

/// A run that is not to go on says what it throws away, and what would not have.
TEST_F(ResumedSite, SaysWhatIsThrownAway)
{
  const std::string asked = "collide site body.pcd --clearance 0.3 --trajectory poses.txt --report r.json --out out";
  const auto warning = [&](std::size_t tiles) {
    return "warning: --out: out: what an earlier run had found of " + std::to_string(tiles) + " of " +
           std::to_string(site.tiles.size()) + " tiles is thrown away, for --resume is not given";
  };
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 4));
  const Outcome anew = run("pcl_bsh_site", asked, folder.path());
  EXPECT_EQ(anew.exit_code, 0);
  EXPECT_THAT(anew.err, HasSubstr(warning(4)));
  EXPECT_THAT(Json::parse(files::contentOf(folder / "r.json"))["warnings"][0].get<std::string>(),
              HasSubstr("is thrown away"));
  fs::remove_all(folder / "out");

  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 3));
  EXPECT_EQ(ResultSite(site, folder / "out", {}, {"where?", false}).thrownAway(), 3U);
  fs::remove_all(folder / "out");
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 3));
  EXPECT_EQ(ResultSite(site, folder / "out",
                       {{"collision", pcl::PCLPointField::UINT8, 0.0},
                        {"distance", pcl::PCLPointField::FLOAT32, std::numeric_limits<double>::quiet_NaN()}},
                       {"where?", true})
                .thrownAway(),
            0U)
      << "goes on with them";
  fs::remove_all(folder / "out");

  // Nothing is thrown away: where no tile was answered, and where another program has the folder.
  ASSERT_TRUE(askAndDie(folder / "out", false, At::before_writing, 1));
  EXPECT_THAT(run("pcl_bsh_site", asked, folder.path()).err, Not(HasSubstr("thrown away")));
  fs::remove_all(folder / "out");
  ASSERT_TRUE(askAndDie(folder / "out", false, At::after_tile, 4));
  const int mark = ::open((folder / "out/unfinished_site").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(mark, LOCK_EX), 0);
  const Outcome refused = run("pcl_bsh_site", asked, folder.path());
  ::close(mark);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, Not(HasSubstr("thrown away")));
  EXPECT_EQ(answersIn(folder / "out"), 4U);

  const Site other = makeSite({folder / "body.pcd"}, folder / "other");
  const Outcome of_obstacle =
      run("pcl_bsh_site", "collide site other --clearance 0.3 --obstacle-out out --report r.json", folder.path());
  EXPECT_EQ(of_obstacle.exit_code, 0);
  const std::string thrown_away = "--obstacle-out: out: what an earlier run had found of 4 ";
  EXPECT_THAT(of_obstacle.err, HasSubstr(thrown_away));
  EXPECT_THAT(Json::parse(files::contentOf(folder / "r.json"))["warnings"][0].get<std::string>(),
              HasSubstr(thrown_away));
}

TEST_F(ResumedSite, IsRefusedWhereNothingCanBeKept)
{
  const Outcome outcome =
      run("pcl_bsh_site", "collide site body.pcd --resume --clearance 1 --report r.json", folder.path());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--resume: "));
}

} // namespace
} // namespace pcl_bsh::site
#endif
