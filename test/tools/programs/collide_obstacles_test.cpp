// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_collide with several obstacles in one question.
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <set>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using SeveralJson = nlohmann::json;

/// Points on a floor and two crates, a metre wide.
class CollideObstacles : public testing::Test {
protected:
  Outcome collide(const std::string& arguments) const
  {
    return run("pcl_bsh_collide", "scan.xyz out.pcd --clearance 0.1 " + arguments, folder.path());
  }

  std::string refused(const std::string& arguments) const
  {
    const Outcome done = collide(arguments);
    EXPECT_NE(done.exit_code, 0) << arguments;
    return done.err;
  }

  std::vector<double> column(const std::string& name) const
  {
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / "out.pcd");
    std::vector<double> values;
    for (std::size_t i = 0; i < cloud.width; ++i) values.push_back(io::valueOf(cloud, i, name));
    return values;
  }

  SeveralJson json(const std::string& file) const { return SeveralJson::parse(io::contentOf(folder / file)); }

  io::TemporaryFolder folder;
  std::filesystem::path crate =
      folder.write("crate.off", "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  std::filesystem::path copy = folder.write("copy.off", io::contentOf(crate));
  std::filesystem::path scan = folder.write("scan.xyz", "0.5 0.5 0\n5.5 0.5 0.3\n9 9 9\n0.5 0.55 0\n");
  const std::string two = "--obstacle press=crate.off --obstacle \"mill=copy.off;pose=5,0,0,0,0,0;solid=true\" ";
};

TEST_F(CollideObstacles, AreToldOneByOneAndTogether)
{
  const Outcome done = collide(two + "--clashes list.json --clashes list.csv --clashes list.html --report report.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("press: clash of 2 points, smallest distance 0\n"));
  EXPECT_THAT(done.out, HasSubstr("mill: clash of 1 point, smallest distance -0.3 (0.3 deep)\n"));
  EXPECT_THAT(done.out, HasSubstr("3 of 4 points collide"));
  EXPECT_THAT(column("collision"), ElementsAre(1, 1, 0, 1));
  const SeveralJson list = json("list.json");
  EXPECT_FALSE(list.contains("obstacle"));
  ASSERT_EQ(list["obstacles"].size(), 2U);
  EXPECT_EQ(list["obstacles"][1]["name"], "mill");
  EXPECT_EQ(list["obstacles"][1]["state"], "clash");
  EXPECT_EQ(list["obstacles"][1]["options"]["solid"], "true");
  EXPECT_FALSE(list["obstacles"][0]["options"].contains("solid"));
  ASSERT_EQ(list["clashes"].size(), 2U); // the deepest first
  EXPECT_EQ(list["clashes"][0]["obstacle_name"], "mill");
  EXPECT_EQ(list["clashes"][0]["id"].get<std::string>().rfind("mill/C", 0), 0U);
  EXPECT_EQ(list["clashes"][1]["points"], 2);
  EXPECT_EQ(json("report.json")["obstacles"][0]["colliding"], 2);
  EXPECT_EQ(json("report.json")["closest_obstacle"], "mill");
  const std::string csv = io::contentOf(folder / "list.csv");
  EXPECT_THAT(csv, HasSubstr("obstacle_name,obstacle_part,obstacle_record"));
  EXPECT_THAT(csv, HasSubstr(",mill,triangle,"));
  const std::string page = io::contentOf(folder / "list.html");
  EXPECT_THAT(page, HasSubstr("By obstacle"));
  EXPECT_THAT(page, HasSubstr("of mill;"));
}

TEST_F(CollideObstacles, OneWithoutANameIsAsItWas)
{
  const Outcome done =
      run("pcl_bsh_collide", "scan.xyz crate.off out.pcd --clearance 0.1 --clashes list.json", folder.path());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, Not(HasSubstr("crate:")));
  EXPECT_EQ(json("list.json")["obstacle"], "crate.off");
  EXPECT_FALSE(json("list.json").contains("obstacles"));
}

TEST_F(CollideObstacles, JoinTheOneThatIsNamedFirst)
{
  const Outcome done =
      run("pcl_bsh_collide", "scan.xyz crate.off out.pcd --clearance 0.1 --obstacle copy.off", folder.path());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("crate: clash of 2 points"));
  EXPECT_THAT(done.out, HasSubstr("copy: clash of 2 points"));
}

TEST_F(CollideObstacles, StandAgainstEachOther)
{
  const std::string three = two + "--obstacle \"crane=copy.off;pose=1.05,0,0,0,0,0\" --report report.json --between ";
  const Outcome done = collide(three);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("press and crane: clash, smallest distance 0.05\n"));
  EXPECT_THAT(done.out, HasSubstr("press and mill: clear, smallest distance 4\n"));
  EXPECT_EQ(json("report.json")["between"].size(), 3U);
  EXPECT_THAT(collide(three + "--ignore \"press:c*\"").out, Not(HasSubstr("press and crane")));
  EXPECT_THAT(collide(three + "--ignore \"mill:input\"").out, HasSubstr("mill: ignored\n"));
}

TEST_F(CollideObstacles, TellHowMuchOfEachOtherIsWithin)
{
  const std::string high =
      "--obstacle press=crate.off --obstacle \"mill=copy.off;pose=0.25,0.25,0.5,0,0,0;solid=true\" ";
  const Outcome done =
      collide(high + "--between --overlap --clashes list.json --clashes list.html --report report.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("deep), area of press inside 1.31"));
  const SeveralJson pair = json("list.json")["between"][0];
  EXPECT_LE(pair["area_of_first_within"][0], 1.3125);
  EXPECT_GE(pair["area_of_first_within"][1], 1.3125);
  EXPECT_FALSE(pair.contains("area_of_second_within")) << "the press is no solid";
  EXPECT_EQ(json("report.json")["between"][0], pair);
  EXPECT_THAT(io::contentOf(folder / "list.html"), HasSubstr("<th>area of it inside the other</th>"));
  EXPECT_EQ(collide(high + "--between --clashes list.html").exit_code, 0);
  EXPECT_THAT(io::contentOf(folder / "list.html"), Not(HasSubstr("area of it")));
  EXPECT_THAT(refused(high + "--overlap"), HasSubstr("--overlap: is of obstacles that are compared with each other"));
  EXPECT_THAT(refused("--obstacle crate.off --obstacle copy.off --between --overlap"),
              HasSubstr("--overlap: no obstacle is a solid: give --solid, or solid=true of one"));
}

TEST_F(CollideObstacles, AreClearWithTheirSmallestDistance)
{
  const Outcome done = collide("--obstacle \"crane=copy.off;pose=0,0,3,0,0,0\" --clashes list.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("crane: clear, smallest distance 3\n"));
  EXPECT_EQ(json("list.json")["obstacles"][0]["state"], "clear");
  EXPECT_EQ(json("list.json")["clashes"].size(), 0U);
  const Outcome path = collide("--obstacle \"crane=copy.off;pose=0,0,3,0,0,0\" --from 0,0,0,0,0,0 --to 0,0,2,0,0,0 "
                               "--steps 2 --obstacle press=crate.off --report report.json");
  EXPECT_THAT(path.out, HasSubstr("at pose 0\n")) << path.err;
  EXPECT_EQ(path.exit_code, 0) << path.err;
  EXPECT_EQ(json("report.json")["path"]["table"].size(), 3U);
}

TEST_F(CollideObstacles, AreComparedWithAnEarlierListByName)
{
  ASSERT_EQ(collide(two + "--clashes list.json").exit_code, 0);
  folder.write("scan.xyz", "0.5 0.5 0\n9 9 9\n0.5 0.55 0\n5.5 0.5 -3\n");
  const Outcome done = collide(two + "--clashes now.json --previous list.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const SeveralJson now = json("now.json");
  ASSERT_EQ(now["clashes"].size(), 2U) << now;
  for (const SeveralJson& clash : now["clashes"])
    EXPECT_EQ(clash["status"], clash["obstacle_name"] == "press" ? "persisting" : "resolved") << clash;
  EXPECT_EQ(now["clashes"][0]["id"], json("list.json")["clashes"][1]["id"]);
  EXPECT_THAT(collide("--obstacle press=crate.off --clashes one.json --previous list.json").err,
              HasSubstr("lists clashes of 'mill', which is no obstacle now: its clashes are left out"));
  const Outcome alone =
      run("pcl_bsh_collide", "scan.xyz crate.off out.pcd --clearance 0.1 --clashes one.json --previous list.json",
          folder.path());
  EXPECT_EQ(alone.exit_code, 0) << alone.err; // found by its file
  EXPECT_EQ(json("one.json")["clashes"][0]["status"], "persisting");
  EXPECT_THAT(refused("--obstacle \"press=crate.off;solid=true\" --clashes one.json --previous list.json"),
              HasSubstr("lists clashes with solid not given, now it is true"));
}

/// Two weeks after which a list has clashes of each kind, and then the crane is moved.
class CollideOneAlone : public CollideObstacles {
protected:
  CollideOneAlone()
  {
    folder.write("scan.xyz", "0.5 0.5 0\n5.5 0.5 0.3\n9 9 9\n0.5 0.55 0\n-4 -4 0\n10.5 0.5 0.3\n");
    EXPECT_EQ(collide(two + "--obstacle \"bar=copy.off;pose=10,0,0.25,0,0,0\" --clashes 1.json").exit_code, 0);
    folder.write("scan.xyz", "0.5 0.5 0\n5.5 0.5 -3\n9 9 9\n0.5 0.5 1\n-4 -4 0\n10.5 0.5 0.3\n");
    EXPECT_EQ(collide(three("60,0,0,0,0,0") + "--clashes 2.json --clashes 2.bcf --previous 1.json").exit_code, 0);
  }

  std::string three(const std::string& pose_of_bar) const
  {
    return two +
           "--between --obstacle \"crane=copy.off;pose=9,9,8.5,0,0,0\" --obstacle \"bar=copy.off;pose=" + pose_of_bar +
           "\" ";
  }

  std::string refusedAlone(const std::string& arguments) const
  {
    std::filesystem::remove(folder / "3.json");
    const std::string said = refused("--clashes 3.json --previous 2.json " + arguments);
    EXPECT_FALSE(std::filesystem::exists(folder / "3.json")) << arguments;
    return said;
  }

  const std::string moved = two + "--obstacle \"crane=copy.off;pose=8.6,8.5,8.95,0,0,0\" "
                                  "--obstacle \"bar=copy.off;pose=60,0,0,0,0,0\" ";
};

TEST_F(CollideOneAlone, HasTheListOfAskingAboutAll)
{
  std::set<std::string> states;
  const SeveralJson second = json("2.json");
  for (const SeveralJson& clash : second["clashes"]) states.insert(clash["status"]);
  ASSERT_THAT(states, ElementsAre("new", "not_visited", "persisting", "resolved"));
  for (const std::string previous : {"2.json", "2.bcf"}) {
    const std::string lists = "--previous " + previous + " --clashes ";
    for (const char* const list : {".json", ".csv", ".bcf", ".html"}) {
      ASSERT_EQ(collide(moved + "--between " + lists + "all" + list).exit_code, 0);
      const Outcome alone = collide(moved + "--between --only \"c*e\" " + lists + "alone" + list + " --report r.json");
      ASSERT_EQ(alone.exit_code, 0) << alone.err;
      EXPECT_THAT(alone.err,
                  HasSubstr(previous + ": tells of 3 obstacles: the others alone are asked about and counted"));
      if (list == std::string(".html") || list == std::string(".bcf")) continue;
      EXPECT_EQ(io::contentOf(folder / ("alone" + std::string(list))),
                io::contentOf(folder / ("all" + std::string(list))));
    }
  }
  const std::string page = io::contentOf(folder / "alone.html");
  EXPECT_THAT(page, HasSubstr("compared with 2.bcf, which 3 obstacles are taken over from"));
  EXPECT_THAT(page, Not(HasSubstr("href=\"#press/")));
  EXPECT_THAT(page, HasSubstr("href=\"#crane/"));
  EXPECT_THAT(io::contentOf(folder / "all.html"), HasSubstr("href=\"#press/"));
  EXPECT_EQ(json("r.json")["obstacles"][0]["colliding"], 2);
  EXPECT_EQ(json("r.json")["colliding"], 1) << "of the crane";
  ASSERT_EQ(collide(moved + "--clashes next.json --previous alone.bcf").exit_code, 0);
  ASSERT_EQ(collide(moved + "--clashes of_all.json --previous all.bcf").exit_code, 0);
  EXPECT_EQ(json("next.json")["clashes"], json("of_all.json")["clashes"]);
}

TEST_F(CollideOneAlone, ReadsNoOtherObstacle)
{
  std::filesystem::remove(folder / "crate.off"); // of the press
  const std::string arguments = moved + "--only crane --previous 2.json --clashes 3.json ";
  EXPECT_EQ(collide(arguments).exit_code, 0);
  EXPECT_THAT(refused(arguments + "--between"), HasSubstr("crate.off: no such file"));
}

TEST_F(CollideOneAlone, RefusesAnotherQuestionAboutTheOthers)
{
  EXPECT_THAT(refused(moved + "--only crane --clashes 3.json"),
              HasSubstr("--only: nothing tells of the other obstacles: give --previous FILE"));
  EXPECT_THAT(run("pcl_bsh_collide",
                  "scan.xyz crate.off out.pcd --clearance 0.1 --only a --clashes 3.json --previous 2.json",
                  folder.path())
                  .err,
              HasSubstr("--only: there is one obstacle"));
  EXPECT_THAT(refusedAlone(moved + "--only crane --only lathe"),
              HasSubstr("--only: 'lathe' matches no obstacle: give one of their names"));
  const std::string only = "--only crane ";
  EXPECT_THAT(refusedAlone(only + moved + "--obstacle lathe=crate.off"),
              HasSubstr("2.json: does not tell of 'lathe': ask about it, too"));
  const auto with_press = [&](const std::string& press) {
    return refusedAlone(only + "--obstacle \"press=" + press + "\" --obstacle crane=copy.off");
  };
  EXPECT_THAT(with_press("crate.off;clearance=0.2"),
              HasSubstr("2.json: tells of 'press' with clearance 0.1, now it is 0.2: ask about it, too"));
  EXPECT_THAT(with_press("crate.off;solid=true"), HasSubstr("with solid not given, now it is true"));
  EXPECT_THAT(with_press("crate.off;pose=0,0,0.5,0,0,0"), HasSubstr("tells of 'press' at other poses"));
  EXPECT_THAT(with_press("copy.off"), HasSubstr("with the file crate.off, now it is copy.off"));
  EXPECT_THAT(refusedAlone(only + moved + "--ignore input:press"),
              HasSubstr("tells of 'press' as compared with the input: ask about it, too"));
  EXPECT_THAT(refusedAlone(only + moved + "--cluster-distance 9"),
              HasSubstr("2.json: has the cluster distance 32: give the same"));
  EXPECT_THAT(refusedAlone(only + moved + "--unit m"), HasSubstr("with unit not given, now it is m: ask about all"));
  folder.write("scan.xyz", "0.5 0.5 0\n5.5 0.5 -3\n9 9 9\n0.5 0.5 1\n-4 -4 0\n11.5 0.5 0.3\n");
  EXPECT_THAT(refusedAlone(only + moved), HasSubstr("2.json: is of a scan of another extent: ask about all obstacles"));
  folder.write("other.xyz", io::contentOf(scan));
  EXPECT_THAT(run("pcl_bsh_collide",
                  "other.xyz out.pcd --clearance 0.1 --clashes 3.json --previous 2.json " + only + moved, folder.path())
                  .err,
              HasSubstr("with the input scan.xyz, now it is other.xyz"));
}

TEST_F(CollideObstacles, HaveUnitsOfTheirOwn)
{
  folder.write("small.off", "OFF\n3 1 0\n0 0 0\n1000 0 0\n0 1000 0\n3 0 1 2\n");
  refused("--input-unit m --obstacle \"plate=small.off;unit=mm\" --obstacle crate.off"); // nothing tells its unit
  const Outcome both = collide("--input-unit m --obstacle \"plate=small.off;unit=mm\" --obstacle \"crate.off;unit=m\"");
  ASSERT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("plate: clash of 2 points, smallest distance 0"));
  EXPECT_THAT(refused("--obstacle \"crate.off;unit=ell\""), HasSubstr("unit: "));
}

TEST_F(CollideObstacles, ConvertUncertaintiesOfTheirOwn)
{
  folder.write("dots.csv", "x,y,z,sigma\n500,500,150,1\n900,900,5000,1\n");
  const Outcome done = collide("--input-unit m --obstacle \"dots=dots.csv;unit=mm;uncertainty=sigma\"");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("dots: clear")); // 15 cm away, off by 1 mm
}

TEST_F(CollideObstacles, MayAllIgnoreTheInput)
{
  const Outcome done = collide(two + "--ignore \"input:*\" --between --clashes list.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("press: ignored\nmill: ignored\npress and mill: clear, smallest distance 4\n"));
  EXPECT_EQ(json("list.json")["obstacles"][0]["state"], "ignored");
}

TEST_F(CollideObstacles, StandAgainstEachOtherWithoutAClearance)
{
  const Outcome done =
      run("pcl_bsh_collide", "scan.xyz out.pcd --distances --between --report report.json " + two, folder.path());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(json("report.json")["between"][0]["clearance"], 0.0);
}

/// Boxes that stand at x from 0 on, a metre wide, 4 m apart, one an object of its own, a millimetre a unit.
std::string boxesInMillimetres(int count)
{
  std::string obj;
  for (int i = 0; i < count; ++i) {
    obj += "o box_" + std::to_string(i) + '\n';
    for (int k = 0; k < 8; ++k)
      obj += "v " + std::to_string(4000 * i + (k % 2 ? 1000 : 0)) + (k / 2 % 2 ? " 1000" : " 0") +
             (k > 3 ? " 1000\n" : " 0\n");
    for (const char* const face :
         {"-8 -6 -5 -7", "-4 -3 -1 -2", "-8 -7 -3 -4", "-6 -2 -1 -5", "-8 -4 -2 -6", "-7 -5 -1 -3"})
      obj += std::string("f ") + face + '\n';
  }
  return obj;
}

TEST_F(CollideObstacles, AreThePartsOfAFile)
{
  folder.write("plant.obj", boxesInMillimetres(3));
  const Outcome done =
      collide("--input-unit m --obstacle \"plant.obj;unit=mm;parts=true;solid=true;pose=0,0,-0.9,0,0,0\" "
              "--between --ignore \"box_1:box_*\" --clashes list.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("box_0: clash of 2 points, smallest distance -0.1 (0.1 deep)\n"));
  EXPECT_THAT(done.out, HasSubstr("box_1: clear, smallest distance 0.5385"));
  EXPECT_THAT(done.out, HasSubstr("box_0 and box_2: clear, smallest distance 7\n"));
  EXPECT_THAT(done.out, Not(HasSubstr("box_0 and box_1")));
  const SeveralJson list = json("list.json");
  ASSERT_EQ(list["obstacles"].size(), 3U);
  EXPECT_EQ(list["obstacles"][2]["file"], "plant.obj");
  EXPECT_EQ(list["obstacles"][2]["surface"]["triangles"], 12);
  EXPECT_EQ(list["clashes"][0]["obstacle_name"], "box_0");
  EXPECT_THAT(collide("--obstacle \"plant=plant.obj;parts=true\" --obstacle crate.off").out,
              HasSubstr("plant/box_2: clear"));
  EXPECT_EQ(collide("--vertices-only --obstacle \"plant.obj;parts=true\"").exit_code, 0);
  folder.write("some.obj", "o there\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
                           "o nowhere\nv nan nan nan\nv nan nan nan\nv nan nan nan\nf 4 5 6\n");
  EXPECT_THAT(collide("--obstacle \"some.obj;parts=true\"").err,
              testing::AllOf(HasSubstr("nowhere: has no finite triangle: nothing collides with it"),
                             testing::Not(HasSubstr("some.obj: has no finite"))));
  EXPECT_THAT(refused("--obstacle \"crate.off;parts=true\""), HasSubstr("crate.off: has no parts with names"));
  EXPECT_THAT(refused("--obstacle \"plant.obj;parts=1\""), HasSubstr("parts: '1': give true or false"));
  EXPECT_THAT(refused("--obstacle \"plant.obj;parts=true\" --obstacle box_1=crate.off"),
              HasSubstr("two obstacles have the name 'box_1': give each its own"));
}

TEST_F(CollideObstacles, TellRemarksOfTheirFileWhicheverPartIsAsked)
{
  folder.write("plant.obj", boxesInMillimetres(3) + "o empty\n");
  const std::string parts = "--obstacle \"plant.obj;parts=true\" --clashes ", remark = "1 part without faces, 'empty'";
  EXPECT_THAT(collide(parts + "list.json").err, HasSubstr(remark));
  const Outcome one = collide(parts + "next.json --previous list.json --only box_1");
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(one.err, HasSubstr(remark));
  EXPECT_EQ(one.err.find(remark), one.err.rfind(remark));
}

TEST_F(CollideObstacles, RefuseWhatIsNoObstacle)
{
  EXPECT_THAT(refused("--obstacle a=crate.off --obstacle a=copy.off"),
              HasSubstr("--obstacle: two obstacles have the name 'a': give each its own, NAME=FILE"));
  EXPECT_THAT(refused("--obstacle =crate.off"), HasSubstr("names no obstacle: give NAME=FILE"));
  EXPECT_THAT(refused("--obstacle input=crate.off"), HasSubstr("'input' is the input's own name"));
  EXPECT_THAT(refused("--obstacle \"crate.off;size=3\""),
              HasSubstr("'size' is no option of an obstacle: give pose, unit, clearance, solid, uncertainty or parts"));
  EXPECT_THAT(refused("--obstacle \"crate.off;solid\""), HasSubstr("'solid' has no value: give OPTION=VALUE"));
  EXPECT_THAT(refused("--obstacle \"crate.off;clearance=-1\""), HasSubstr("clearance: '-1': give a finite length"));
  EXPECT_THAT(refused("--obstacle none.off"), HasSubstr("none.off: no such file"));
  EXPECT_THAT(refused("--obstacle crate.off --ignore a:b"), HasSubstr("--ignore: 'a' matches no obstacle"));
  EXPECT_THAT(refused("--obstacle crate.off --ignore a"), HasSubstr("--ignore: 'a' is no pair of names"));
  EXPECT_THAT(refused("--obstacle crate.off --obstacle-out o.ply"), HasSubstr("--obstacle-out: is of one obstacle"));
  const Outcome one = run("pcl_bsh_collide", "scan.xyz crate.off out.pcd --clearance 0.1 --between", folder.path());
  EXPECT_THAT(one.err, HasSubstr("--between: there is one obstacle: give --obstacle NAME=FILE for each"));
  const Outcome none = run("pcl_bsh_collide", "scan.xyz crate.off --clearance 0.1", folder.path());
  EXPECT_THAT(none.err, HasSubstr("OUTPUT is required"));
}

TEST_F(CollideObstacles, MeasureToTheNearestOfThem)
{
  ASSERT_EQ(collide(two + "--distances").exit_code, 0);
  const std::vector<double> distances = column("distance");
  EXPECT_EQ(distances[0], 0.0);
  EXPECT_FLOAT_EQ(static_cast<float>(distances[1]), -0.3F);
  EXPECT_THAT(refused(two + "--distances --distance-page p.html"), HasSubstr("--distance-page: is of one obstacle"));
}

} // namespace
} // namespace pcl_bsh
