// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/read_robot.h>

#include "io/clouds/samples.h"

#include <pcl_bsh/io/files/file_error.h>

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <numbers>

namespace pcl_bsh::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using robots::Box;
using robots::Robot;
using robots::Sphere;

constexpr double pi = std::numbers::pi;

std::string link(const std::string& name, const std::string& inside = "")
{
  return "<link name=\"" + name + "\">" + inside + "</link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside = "")
{
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + inside + "<limit lower=\"-9\" upper=\"9\" effort=\"1\" velocity=\"1\"/></joint>";
}

class RobotTest : public testing::Test {
protected:
  Robot read(const std::string& inside, const std::map<std::string, std::filesystem::path>& packages = {}) const
  {
    std::ofstream(urdf) << "<robot name=\"r\">" << inside << "</robot>";
    return readRobot(urdf, packages);
  }

  /// One line that names the file.
  void expectRefused(const std::string& inside, const std::string& why) const
  {
    try {
      read(inside);
      ADD_FAILURE() << inside;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(urdf.string() + ": "), HasSubstr(why), Not(HasSubstr("\n"))));
    }
  }

  /// Where the origin of a link is.
  static Eigen::Vector3d originOf(const Robot& robot, const std::string& link_name, const JointValues& values)
  {
    robot.requireValues(values);
    return linkPoses(robot, values)[robot.linkNamed(link_name)].translation();
  }

  const io::TemporaryFolder folder;
  const std::filesystem::path urdf = folder / "robot.urdf";
  const std::string ab = link("a") + link("b");
};

TEST_F(RobotTest, PlacesLinksAsJointsOfEachKindSay)
{
  const Robot robot = read(link("d") + link("c") + link("e") + link("b") + link("a") +
                           joint("slide", "prismatic", "c", "d", "<axis xyz=\"0 0 2\"/>") +
                           joint("turn", "revolute", "a", "b",
                                 "<origin xyz=\"1 0 0\" rpy=\"0 0 1.5707963267948966\"/><axis xyz=\"0 0 3\"/>") +
                           joint("spin", "continuous", "b", "c", "<origin xyz=\"2 0 0\"/><axis xyz=\"1 0 0\"/>") +
                           joint("seat", "fixed", "d", "e", "<origin xyz=\"0 5 0\"/>"));
  EXPECT_EQ(robot.links[0].name, "a");
  for (std::size_t i = 1; i < robot.links.size(); ++i) EXPECT_LT(robot.links[i].joint->parent, i);
  // b's x is a's y; after the turn by a quarter it is a's -x. c spins a quarter about it: its z is what was b's -y.
  const JointValues values = {{"turn", pi / 2}, {"spin", pi / 2}, {"slide", 3}};
  EXPECT_LT((originOf(robot, "b", values) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-14);
  EXPECT_LT((originOf(robot, "c", values) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-14);
  EXPECT_LT((originOf(robot, "d", values) - Eigen::Vector3d(-1, 3, 0)).norm(), 1e-14);
  EXPECT_LT((originOf(robot, "e", values) - Eigen::Vector3d(-1, 3, 5)).norm(), 1e-14);
  EXPECT_LT((originOf(robot, "e", {}) - Eigen::Vector3d(-4, 2, 0)).norm(), 1e-14); // joints not named are at 0
}

TEST_F(RobotTest, MimicsAlongAChain)
{
  const Robot robot =
      read(ab + link("c") + link("d") + joint("one", "prismatic", "a", "b") +
           joint("two", "prismatic", "a", "c", "<mimic joint=\"one\" multiplier=\"-2\" offset=\"1\"/>") +
           joint("three", "prismatic", "a", "d", "<mimic joint=\"two\"/>"));
  EXPECT_EQ(originOf(robot, "c", {{"one", 3}}), Eigen::Vector3d(-5, 0, 0));
  EXPECT_EQ(originOf(robot, "d", {{"one", 3}}), Eigen::Vector3d(-5, 0, 0));
}

TEST_F(RobotTest, TakesBodiesForCollisionsBeforeThoseToLookAt)
{
  const std::string box = "<geometry><box size=\"1 2 3\"/></geometry>",
                    ball = "<geometry><sphere radius=\"4\"/></geometry>";
  const Robot robot = read(
      link("a", "<visual>" + box + "</visual><collision>" + ball + "</collision><collision>" + ball + "</collision>") +
      link("b", "<visual>" + box + "</visual>") + joint("j", "fixed", "a", "b"));
  ASSERT_EQ(robot.links[0].shapes.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<Sphere>(robot.links[0].shapes[0].form));
  ASSERT_EQ(robot.links[1].shapes.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Box>(robot.links[1].shapes[0].form));
}

TEST_F(RobotTest, FindsMeshesBesideTheUrdfAndInPackages)
{
  const auto mesh = [](const std::string& name) {
    return link("a", "<collision><geometry><mesh filename=\"" + name + "\"/></geometry></collision>");
  };
  const auto path = [](const Robot& robot) { return std::get<robots::Mesh>(robot.links[0].shapes[0].form).path; };
  const std::filesystem::path there = folder / "m/a.stl";
  expectRefused(mesh("m/a.stl"), "link 'a' has the mesh " + there.string() + ", which is not there");
  std::filesystem::create_directory(folder / "m");
  std::ofstream(there) << "a mesh";
  EXPECT_EQ(path(read(mesh("m/a.stl"))), there);
  EXPECT_EQ(path(read(mesh("file://" + there.string()))), there);
  EXPECT_EQ(path(read(mesh("package://arm/m/a.stl"), {{"arm", folder.path()}})), there);
  expectRefused(mesh("package://arm/m/a.stl"), "--package arm=FOLDER");
}

/// As catkin_make lays packages out, and as people copy them.
TEST_F(RobotTest, FindsPackagesInRosPackagePath)
{
  namespace fs = std::filesystem;
  const auto put = [&](const std::string& file, const std::string& text) {
    fs::create_directories((folder / file).parent_path());
    std::ofstream(folder / file) << text;
  };
  const auto named = [](const std::string& name) {
    return "<?xml version=\"1.0\"?>\n<!-- <name>other</name> --><package format=\"2\">\n <name> " + name +
           "\n</name></package>";
  };
  put("ws/src/group/folder_of_arm/package.xml", named("arm"));
  put("ws/src/group/folder_of_arm/m/a.stl", "");
  put("ws/src/group/folder_of_arm/below/package.xml", named("hidden_in_arm"));
  put("ws/src/left_out/CATKIN_IGNORE", "");
  put("ws/src/left_out/package.xml", named("left_out_pkg"));
  put("ws/src/left_out/deep/package.xml", named("ignored"));
  put("ws/src/.git/package.xml", named("git"));
  put("old/hand/manifest.xml", "<package/>");
  put("old/hand/m/a.stl", "");
  put("plain/gripper/m/a.stl", "");
  put("second/arm/package.xml", named("arm"));
  put("second/arm/m/a.stl", "");
  fs::create_directory_symlink(folder / "ws/src", folder / "ws/src/group/round"); // does not end in circles
  const std::string path = (folder / "missing").string() + "::" + (folder / "ws/src/").string() + ":" +
                           (folder / "old").string() + ":" + (folder / "plain").string() + ":" +
                           (folder / "second").string();
  const auto meshOf = [&](const std::string& package, const std::map<std::string, fs::path>& packages = {}) {
    std::ofstream(urdf) << "<robot name=\"r\">"
                        << link("a", "<collision><geometry><mesh filename=\"package://" + package +
                                         "/m/a.stl\"/></geometry></collision>")
                        << "</robot>";
    return fs::canonical(std::get<robots::Mesh>(readRobot(urdf, packages, path).links[0].shapes[0].form).path);
  };
  EXPECT_EQ(meshOf("arm"), fs::canonical(folder / "ws/src/group/folder_of_arm/m/a.stl")) << "the first that has it";
  EXPECT_EQ(meshOf("hand"), fs::canonical(folder / "old/hand/m/a.stl"));
  EXPECT_EQ(meshOf("gripper"), fs::canonical(folder / "plain/gripper/m/a.stl"));
  EXPECT_EQ(meshOf("arm", {{"arm", folder / "second/arm"}}), fs::canonical(folder / "second/arm/m/a.stl"))
      << "--package comes first";
  for (const char* none : {"other", "hidden_in_arm", "ignored", "git", "nowhere", "folder_of_arm"}) {
    try {
      meshOf(none);
      ADD_FAILURE() << none;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr(std::string("--package ") + none + "=FOLDER, in Python `packages`, or ROS_PACKAGE_PATH"));
    }
  }
}

TEST_F(RobotTest, RefusesWhatIsNoTree)
{
  expectRefused(ab + link("c") + joint("j", "fixed", "a", "c") + joint("k", "fixed", "b", "c") +
                    joint("l", "fixed", "a", "b"),
                "link 'c' hangs on two joints, 'j' and 'k'");
  expectRefused(link("root") + ab + joint("j", "fixed", "a", "b") + joint("k", "fixed", "b", "a"), "are a cycle");
  expectRefused(ab + joint("j", "fixed", "a", "b") + joint("k", "fixed", "b", "a"), "is refused by urdfdom");
  expectRefused(ab, "is refused by urdfdom"); // two roots
}

TEST_F(RobotTest, RefusesJointsItCannotMove)
{
  expectRefused(ab + joint("j", "floating", "a", "b"), "joint 'j' is neither fixed");
  expectRefused(ab + joint("j", "revolute", "a", "b", "<axis xyz=\"0 0 0\"/>"), "joint 'j' has the axis 0 0 0");
  expectRefused(ab + joint("j", "continuous", "a", "b", "<mimic joint=\"none\"/>"),
                "mimics 'none', which is not there");
  expectRefused(ab + link("c") + joint("j", "continuous", "a", "b", "<mimic joint=\"k\"/>") +
                    joint("k", "continuous", "a", "c", "<mimic joint=\"j\"/>"),
                "mimics itself");
}

TEST_F(RobotTest, RefusesABodyThatUrdfdomLeavesOut)
{
  for (const char* geometry :
       {"<box size=\"1 2\"/>", "<sphere radius=\"nan\"/>", "<sphere/>", "<cone radius=\"1\"/>", ""}) {
    SCOPED_TRACE(geometry);
    for (const char* kind : {"collision", "visual"})
      expectRefused(link("a", std::string("<") + kind + "><geometry>" + geometry + "</geometry></" + kind + ">"),
                    "is refused by urdfdom: ");
  }
  expectRefused(link("a", "<collision/>"), "is refused by urdfdom: ");
}

TEST_F(RobotTest, RefusesWhatIsNoUrdf)
{
  expectRefused("<link", "");
  EXPECT_THROW(readRobot(folder / "none.urdf"), files::FileError);
}

TEST_F(RobotTest, RefusesValuesOfJointsThatTakeNone)
{
  const Robot robot = read(ab + link("c") + joint("seat", "fixed", "a", "b") + joint("turn", "continuous", "a", "c") +
                           link("d") + joint("too", "continuous", "a", "d", "<mimic joint=\"turn\"/>"));
  const auto refused = [&](const JointValues& values) {
    try {
      robot.requireValues(values);
    }
    catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({{"turn", 1}}), "");
  EXPECT_THAT(refused({{"seat", 1}}), HasSubstr("joint 'seat': is fixed"));
  EXPECT_THAT(refused({{"too", 1}}), HasSubstr("joint 'too': mimics 'turn'"));
  EXPECT_THAT(refused({{"trun", 1}}), HasSubstr("joint 'trun': is not one of r"));
  EXPECT_THROW(robot.linkNamed("e"), std::exception);
}

} // namespace
} // namespace pcl_bsh::io
