// SPDX-License-Identifier: BSD-3-Clause
// The answers about a site and several obstacles are those of one cloud of all its points.
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_QUERIES
#include "two_ranks.h"

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/site_obstacles.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <random>

namespace pcl_bsh::site {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

constexpr auto box_corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";

/// Two clouds of a floor with things on it: as a site of many tiles, and as one file.
class SiteObstacles : public testing::Test {
protected:
  SiteObstacles()
  {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::string one, two;
    for (int i = 0; i < 5000; ++i) {
      std::string& text = i < first ? one : two;
      const double x = (i < first ? 0.0 : 14.0) + 16 * unit(random), y = 6 * unit(random);
      text +=
          std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(i % 3 == 0 ? unit(random) : 0.0) + '\n';
    }
    folder.write("one.xyz", one);
    folder.write("two.xyz", two);
    folder.write("all.xyz", one + two);
    folder.write("crate.off", std::string("OFF\n8 6 0\n") + box_corners +
                                  "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
    std::string parts;
    for (int k = 0; k < 3; ++k) {
      parts += "o part" + std::to_string(k) + '\n';
      for (int c = 0; c < 8; ++c)
        parts += "v " + std::to_string(5.2 + 4.4 * k + (c == 1 || c == 2 || c == 5 || c == 6)) + ' ' +
                 std::to_string(4 + (c % 4 > 1)) + ' ' + std::to_string(0.03 + 0.6 * (k % 2) + (c > 3)) + '\n';
      const auto at = [&](int c) { return ' ' + std::to_string(8 * k + c); };
      for (const auto& [a, b, c, d] : {std::array{1, 4, 3, 2}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}})
        parts += "f" + at(a) + at(b) + at(c) + at(d) + '\n';
    }
    folder.write("parts.obj", parts);
    folder.write("poses.txt", "0 0 0 0 0 0 0 1\n1 0.6 0.1 0 0 0 0.05 0.9987492\n2 1.7 0.1 0.05 0 0 0 1\n");
    MakeOptions options;
    options.tile_points = 400;
    site = makeSite({folder / "one.xyz", folder / "two.xyz"}, folder / "site", options);
  }

  Outcome ofSite(const std::string& arguments) const
  {
    return run("pcl_bsh_site", "collide site " + arguments, folder.path());
  }

  /// Expects the list of clashes that the program for clouds writes, whose points are numbers of one file.
  void expectSame(const std::string& arguments)
  {
    SCOPED_TRACE(arguments);
    const std::string question = obstacles + " --clearance 0.05 --cluster-distance 0.5 " + arguments;
    const Outcome cloud =
        run("pcl_bsh_collide", "all.xyz marked.pcd " + question + " --clashes cloud.json", folder.path());
    ASSERT_EQ(cloud.exit_code, 0) << cloud.err;
    std::filesystem::remove_all(folder / "marked");
    const Outcome here =
        ofSite(question + " --clashes site.json --clashes site.html --out marked --report report.json");
    ASSERT_EQ(here.exit_code, 0) << here.err;
    Json list = read("site.json");
    for (Json& one : list["obstacles"])
      if (!one["closest_pair"].is_null()) one["closest_pair"][0] = numberOf(one["closest_pair"][0]);
    for (Json& clash : list["clashes"]) {
      if (!clash.contains("closest_pair")) continue; // unseen
      Json& input = clash["closest_pair"]["input"];
      input = {{"point", numberOf(input)}, {"at", input["at"]}};
    }
    Json of_cloud = read("cloud.json");
    of_cloud["input"] = list["input"];
    for (Json* const some : {&list, &of_cloud}) some->erase("date");
    EXPECT_EQ(list, of_cloud);
    EXPECT_GE(list["clashes"].size(), 3U);
    expectSameFields();
    if (!hasMpirun()) return;
    const std::string on_one = io::contentOf(folder / "site.html"), as_json = io::contentOf(folder / "site.json");
    const Outcome on_two = runOnTwoRanks(
        "collide site " + question + " --threads 2 --clashes site.json --clashes site.html", folder.path());
    ASSERT_EQ(on_two.exit_code, 0) << on_two.err;
    EXPECT_EQ(io::contentOf(folder / "site.json"), as_json);
    EXPECT_EQ(io::contentOf(folder / "site.html"), on_one);
  }

  /// Expects the fields of each point that the program for clouds writes.
  void expectSameFields()
  {
    ASSERT_EQ(run("pcl_bsh_site", "export marked marked_site.pcd", folder.path()).exit_code, 0);
    const pcl::PCLPointCloud2 here = io::readCloud(folder / "marked_site.pcd"),
                              cloud = io::readCloud(folder / "marked.pcd");
    ASSERT_EQ(here.width, cloud.width);
    for (const pcl::PCLPointField& field : cloud.fields)
      for (std::size_t i = 0; i < cloud.width; ++i) {
        const double a = io::valueOf(here, i, field.name), b = io::valueOf(cloud, i, field.name);
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << field.name << " of " << i << ": " << a << ", " << b;
      }
    std::filesystem::remove(folder / "marked_site.pcd");
  }

  std::uint32_t numberOf(const Json& point) const
  {
    const bool is_first = point["source"].get<std::string>().find("one.xyz") != std::string::npos;
    return point["record"].get<std::uint32_t>() + (is_first ? 0U : static_cast<std::uint32_t>(first));
  }

  Json read(const std::string& file) const { return Json::parse(io::contentOf(folder / file)); }

  static constexpr int first = 3000; ///< points of the first cloud
  io::TemporaryFolder folder;
  Site site;
  const std::string obstacles =
      "--obstacle \"press=crate.off;pose=3,1,0.1,0,0,0.3;clearance=0.2\" "
      "--obstacle \"mill=crate.off;pose=15,2,-0.2,0,0,0;solid=true;uncertainty=0.02\" "
      "--obstacle \"far=crate.off;pose=300,2,100,0,0,0\" --obstacle \"above=crate.off;pose=10,3,8,0.1,0,0\" "
      "--obstacle \"m=parts.obj;parts=true\" ";
};

TEST_F(SiteObstacles, HaveTheAnswersOfOneCloud)
{
  EXPECT_GT(site.tiles.size(), 10U);
  expectSame("--between --ignore \"m/*:m/*\" --ignore \"input:m/part1\"");
  EXPECT_EQ(read("report.json")["obstacles"][2]["state"], "clear");
  EXPECT_EQ(read("report.json")["obstacles"][5]["state"], "ignored");
}

TEST_F(SiteObstacles, HaveTheAnswersOfOneCloudAlongAPath)
{
  expectSame("--trajectory poses.txt");
  expectSame("--trajectory poses.txt --swept 0.01 --uncertainty 0.01");
}

TEST_F(SiteObstacles, AreSeenAsInOneCloud)
{
  expectSame("--seen --origin 8,3,4 --seen-angle 0.2 --ignore \"input:m/part1\"");
  EXPECT_GT(read("report.json")["obstacles"][1]["unseen"], 0);
  EXPECT_EQ(read("report.json")["obstacles"][5]["unseen"], 0) << "it ignores the site";
  EXPECT_GT(read("report.json")["unseen"]["beams"], 0);
  EXPECT_EQ(read("report.json")["tiles_of_beams"]["all"], site.tiles.size());
  expectSame("--seen --origin 8,3,4 --seen-angle 0.2 --trajectory poses.txt");
}

TEST_F(SiteObstacles, OneThatHasChangedIsAskedAboutAlone)
{
  const auto with_mill_at = [&](const char* place) {
    return "--obstacle \"press=crate.off;pose=3,1,0.1,0,0,0.3;clearance=0.2\" --obstacle \"mill=crate.off;pose=" +
           std::string(place) +
           ",-0.2,0,0,0;uncertainty=0.02\" --obstacle \"m=parts.obj;parts=true\" --clearance 0.05 "
           "--seen --origin 8,3,4 --seen-angle 0.2 ";
  };
  ASSERT_EQ(ofSite(with_mill_at("15,2") + "--clashes 1.json").exit_code, 0);
  ASSERT_EQ(ofSite(with_mill_at("20,2") + "--clashes 2.json --previous 1.json").exit_code, 0);
  const std::string back = with_mill_at("15.2,2") + "--previous 2.json ";
  ASSERT_EQ(ofSite(back + "--clashes all.json --clashes all.csv").exit_code, 0);
  ASSERT_NE(read("all.json")["clashes"], read("2.json")["clashes"]);
  const Outcome alone =
      ofSite(back + "--only mill --clashes alone.json --clashes alone.csv --clashes alone.html --report report.json");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_THAT(alone.err, HasSubstr("2.json: tells of 4 obstacles"));
  EXPECT_EQ(io::contentOf(folder / "alone.json"), io::contentOf(folder / "all.json"));
  EXPECT_EQ(io::contentOf(folder / "alone.csv"), io::contentOf(folder / "all.csv"));
  EXPECT_LT(read("report.json")["tiles"]["read"], site.tiles.size() / 2);
  EXPECT_EQ(read("report.json")["obstacles"][0]["colliding"], read("all.json")["obstacles"][0]["colliding"]);
  const std::string others = with_mill_at("20,2") + "--previous 2.json --clashes 3.json --only \"m/*\" --only press ";
  ASSERT_EQ(ofSite(others).exit_code, 0) << "the mill has a place that is not visited any more";
  ASSERT_EQ(ofSite(with_mill_at("20,2") + "--previous 2.json --clashes all.json").exit_code, 0);
  EXPECT_EQ(io::contentOf(folder / "3.json"), io::contentOf(folder / "all.json"));
  EXPECT_THAT(io::contentOf(folder / "3.json"), HasSubstr("not_visited"));
  EXPECT_THAT(ofSite(with_mill_at("15.2,2") + "--only press --previous 2.json --clashes 3.json").err,
              HasSubstr("2.json: tells of 'mill' at other poses: ask about it, too"));
  if (!hasMpirun()) return;
  const Outcome on_two = runOnTwoRanks("collide site " + others, folder.path());
  ASSERT_EQ(on_two.exit_code, 0) << on_two.err;
  EXPECT_EQ(io::contentOf(folder / "3.json"), io::contentOf(folder / "all.json"));
}

TEST_F(SiteObstacles, ReadEachTileOnceAndNoneThatIsFar)
{
  const Outcome done = ofSite("--obstacle \"press=crate.off;pose=3,1,0.1,0,0,0.3\" --obstacle "
                              "\"mill=crate.off;pose=3.5,1.2,0.1,0,0,0.3\" --clearance 0.05 --report report.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("press: clash of "));
  const Json tiles = read("report.json")["tiles"];
  EXPECT_LE(tiles["read"], 4);
  EXPECT_EQ(tiles["all"], site.tiles.size());
}

TEST_F(SiteObstacles, CompareWithAnEarlierList)
{
  const std::string two = "--obstacle \"press=crate.off;pose=3,1,0.1,0,0,0.3\" --clearance 0.05 --clashes list.json ";
  ASSERT_EQ(ofSite(two + "--obstacle \"mill=crate.off;pose=15,2,-0.2,0,0,0\"").exit_code, 0);
  const Outcome again = ofSite(two + "--previous list.json");
  EXPECT_THAT(again.err, HasSubstr("lists clashes of 'mill', which is no obstacle now"));
  EXPECT_EQ(read("list.json")["clashes"][0]["status"], "persisting");
}

TEST_F(SiteObstacles, TellOfFacesThatCloseRoundPoints)
{
  folder.write("hall.off",
               "OFF\n8 6 0\n-5 -5 -5\n45 -5 -5\n45 45 -5\n-5 45 -5\n-5 -5 45\n45 -5 45\n45 45 45\n-5 45 45\n"
               "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const Outcome done = ofSite("--obstacle hall.off --obstacle crate.off --clearance 0.05 --report report.json");
  EXPECT_THAT(done.err, HasSubstr("hall.off: its faces close round places of site"));
  EXPECT_THAT(done.err, testing::Not(HasSubstr("crate.off: its faces close")));
}

TEST_F(SiteObstacles, RefuseWhatIsNotToldOfSeveral)
{
  const std::string one = "--obstacle crate.off --clearance 0.05 --report report.json ";
  for (const char* const option : {"--any", "--closest", "--distances", "--obstacle-out x.ply"}) {
    const Outcome done = ofSite(one + option);
    EXPECT_EQ(done.exit_code, 2) << option;
    EXPECT_THAT(done.err, HasSubstr(std::string(option).substr(0, std::string(option).find(' ')) +
                                    ": is not told of several obstacles of a site"));
  }
  EXPECT_THAT(ofSite("--clearance 0.05 --report r.json").err,
              HasSubstr("OBSTACLE is required, or --obstacle NAME=FILE"));
  EXPECT_THAT(ofSite(one + "--obstacle n=site").err, HasSubstr("--obstacle: site: is a folder"));
  EXPECT_THAT(ofSite("crate.off --clearance 0.05 --report r.json --between").err,
              HasSubstr("--between: there is one obstacle"));
  Question question;
  question.wanted.any = true;
  EXPECT_THROW(checkOfSeveral(question), InvalidInput);
  std::vector<PlacedShape> none;
  question.wanted = {};
  question.wanted.flags = true;
  EXPECT_THROW(ask(question, site, none), InvalidInput);
  std::vector<PlacedShape> moving(1);
  moving[0].path.emplace(2, Eigen::Isometry3d::Identity());
  EXPECT_THAT([&] { ask(question, site, moving); },
              testing::ThrowsMessage<InvalidInput>(HasSubstr("has a path of its own, and the input is a site")));
}

} // namespace
} // namespace pcl_bsh::site
#endif
