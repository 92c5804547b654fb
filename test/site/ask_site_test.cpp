// SPDX-License-Identifier: BSD-3-Clause
// One question about a site, and what sites refuse by name.
#include "float64_cloud.h"
#include "io/clouds/samples.h"
#include "support/random.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/site/make_site.h>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/site/ask_site.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

namespace pcl_bsh::site {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class AskSite : public testing::Test {
protected:
  AskSite()
  {
    test::Random random(5);
    for (int i = 0; i < 900; ++i)
      points.push_back({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-0.1, 0.1)});
    for (int i = 0; i < 100; ++i)
      body.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.0, 0.5)});
    io::writeCloud(folder / "a.pcd", float64Cloud(points));
    MakeOptions options;
    options.tile_points = 60;
    site = makeSite({folder / "a.pcd"}, folder / "site", options);
    question.clearance = 0.2;
  }

  Shape shape() const { return {"the body", viewOf(body.front().data(), body.size())}; }

  std::string refusal(const Question& asked, bool of_site) const
  {
    try {
      Shape obstacle = shape();
      of_site ? ask(asked, site, site) : ask(asked, site, obstacle);
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
    return "none";
  }

  files::TemporaryFolder folder;
  std::vector<Point3> points, body;
  Site site;
  Question question;
};

TEST_F(AskSite, AnswersAllThatIsWantedAsMemoryDoes)
{
  Wanted& wanted = question.wanted;
  wanted.flags = wanted.obstacle_flags = wanted.any = wanted.closest = wanted.distances = true;
  std::vector<double> told;
  question.progress = [&](double done) {
    told.push_back(done);
    return true;
  };
  std::vector<Verdict> flags(points.size(), Verdict::free);
  std::vector<double> distances(points.size(), -1.0);
  SiteMeans means;
  means.receiver = [&](const Tile&, const pcl::PCLPointCloud2& cloud, const Answer& found) {
    for (std::uint32_t i = 0; i < cloud.width; ++i) {
      const auto record = static_cast<std::size_t>(io::valueOf(cloud, i, record_field_name));
      if (found.distances.a.distance.empty())
        flags[record] = found.collisions.flags[i];
      else
        distances[record] = found.distances.a.distance[i];
    }
  };
  Shape obstacle = shape(), all("all", viewOf(points.front().data(), points.size()));
  const SiteAnswer found = ask(question, site, obstacle, means);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_GT(told.size(), site.tiles.size()) << "of one visit to all, and more";
  EXPECT_EQ(found.tiles.read, found.tiles.costs.size());
  EXPECT_GT(found.tiles.read, found.tiles.needed);
  question.progress = nullptr;
  const Answer right = pcl_bsh::ask(question, all, obstacle);
  EXPECT_EQ(flags, right.collisions.flags);
  EXPECT_EQ(found.collisions.colliding, right.collisions.colliding);
  EXPECT_EQ(found.obstacle_flags, right.obstacle_flags);
  EXPECT_EQ(found.any.verdict, right.any.verdict);
  EXPECT_EQ(found.closest.distance, right.closest.distance);
  EXPECT_EQ(found.pair->a.record, right.closest.pair->a);
  EXPECT_EQ(found.pair->b.record, right.closest.pair->b);
  EXPECT_EQ(distances, right.distances.a.distance);
  EXPECT_EQ(found.distances.a.greatest, right.distances.a.greatest);

  wanted = {};
  wanted.contacts = wanted.poses = true;
  question.path = {Eigen::Isometry3d(Eigen::Translation3d(0, 0, 9)), Eigen::Isometry3d::Identity()};
  const SiteAnswer along = ask(question, site, obstacle, {});
  wanted.closest = true;
  const Answer in_memory = pcl_bsh::ask(question, all, obstacle);
  EXPECT_EQ(along.collisions.colliding, in_memory.collisions.colliding);
  EXPECT_EQ(along.closest.distance, double{static_cast<float>(in_memory.closest.distance)});
  EXPECT_EQ(along.first_pose, std::optional<std::size_t>(1));
  EXPECT_EQ(along.collisions.poses.at(1).colliding_points, in_memory.collisions.poses.at(1).colliding_points);
}

/// By the table of options: none is ignored.
TEST_F(AskSite, RefusesOptionsOfOthersByTheirNames)
{
  int refused = 0;
  for (const QuestionOption& row : questionOptions()) {
    if (row.of_sites == OptionOfSites::all) continue;
    SCOPED_TRACE(row.name);
    Question given = question;
    given.wanted.flags = true;
    for (const char* const name : {row.with, row.name}) {
      if (!name) continue;
      const std::string option = name;
      const bool is_switch = std::holds_alternative<bool Question::*>(questionOption(option)->member);
      setOption(given, option,
                is_switch                           ? "true"
                : option == "origin"                ? "0,0,9"
                : option.ends_with("ignore_points") ? "box=0,0,0,1,1,1"
                                                    : "0.01");
    }
    // A switch is told of first.
    const std::string name = row.with ? row.with : row.name;
    EXPECT_THAT(refusal(given, true), StartsWith(name + ": is not answered of "));
    if (row.of_sites == OptionOfSites::none) {
      const bool has_switch = row.with && questionOption(row.with)->of_sites != OptionOfSites::none;
      EXPECT_THAT(refusal(given, false),
                  StartsWith((has_switch ? row.name : name) + ": is not answered of sites: leave it out"));
      EXPECT_THROW(check(given, false), InvalidOption);
    }
    ++refused;
  }
  EXPECT_EQ(refused, 10);
}

TEST_F(AskSite, RefusesAnswersThatItDoesNotHave)
{
  const auto refused = [&](bool Wanted::*member, const char* name) {
    Question given = question;
    given.wanted.flags = true;
    given.wanted.*member = true;
    EXPECT_THAT(refusal(given, false), StartsWith(std::string(name) + ": ")) << name;
    EXPECT_THROW(check(given, false), InvalidInput);
  };
  refused(&Wanted::indices, "indices");
  refused(&Wanted::obstacle_indices, "obstacle_indices");
  refused(&Wanted::within, "within");
  refused(&Wanted::both_ways, "both_ways");
  question.wanted.contacts = true;
  refused(&Wanted::obstacle_flags, "obstacle_flags");
  question.wanted = {};

  Question moved = question;
  moved.wanted.flags = true;
  moved.pose_of_input.translation().x() = 1.0;
  EXPECT_THAT(refusal(moved, false), StartsWith("pose_of_input: "));
  Question path = question;
  path.path = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0))};
  path.wanted.distances = true;
  path.max_distance = 1.0;
  EXPECT_THAT(refusal(path, false), StartsWith("path: "));
  path.wanted = {};
  path.wanted.poses = true;
  path.swept = 0.01;
  EXPECT_THAT(refusal(path, false), StartsWith("swept: "));
  Question early = question;
  early.wanted.distances = early.wanted.intervals = true;
  early.accuracy = Accuracy::level(2);
  EXPECT_EQ(refusal(early, false), "none");
  EXPECT_THAT(refusal(early, true), HasSubstr("distances of two sites cannot stop early"));
}

TEST_F(AskSite, KeepsAnswersOfOneVisitAlone)
{
  struct Kept : TileAnswers {
    const std::vector<double>* known(std::size_t) const override { return nullptr; }
    void keep(std::size_t, const std::vector<double>&) override { ++tiles; }
    std::uint64_t tiles = 0;
  } kept;
  Shape obstacle = shape();
  SiteMeans means;
  means.answers = &kept;
  question.wanted.flags = question.wanted.any = true;
  const SiteAnswer found = ask(question, site, obstacle, means);
  EXPECT_EQ(kept.tiles, found.tiles.needed);
  question.wanted.distances = true;
  EXPECT_THROW(ask(question, site, obstacle, means), InvalidInput);
}

} // namespace
} // namespace pcl_bsh::site
#endif
