// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/scene_robots.h>

#include "io/clouds/samples.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/robot/robot_world.h>
#include <pcl_bsh/search/cloud_view.h>

#include <gmock/gmock.h>

#include <fstream>
#include <random>
#include <sstream>

namespace pcl_bsh::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A foot, an arm of two boxes that bends, and a hand, which is a mesh and spins.
constexpr auto urdf = R"(<robot name="arm">
<link name="foot"><collision><geometry><box size="0.3 0.3 0.2"/></geometry></collision></link>
<link name="upper"><collision><origin xyz="0 0 0.3"/><geometry><box size="0.1 0.1 0.5"/></geometry></collision></link>
<link name="lower"><collision><origin xyz="0 0 0.3"/><geometry><box size="0.08 0.08 0.5"/></geometry></collision></link>
<link name="hand"><collision><geometry><mesh filename="hand.off"/></geometry></collision></link>
<joint name="a" type="revolute"><parent link="foot"/><child link="upper"/><origin xyz="0 0 0.15"/><axis xyz="0 1 0"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.6"/><axis xyz="0 1 0"/>
<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="c" type="continuous"><parent link="lower"/><child link="hand"/><origin xyz="0 0 0.6"/><axis xyz="1 0 0"/></joint>
</robot>)";

class SceneRobots : public testing::Test {
protected:
  SceneRobots()
  {
    write("arm.urdf", urdf);
    write("hand.off", "OFF\n4 4 0\n0 0 0\n0.2 0 0\n0 0.1 0.1\n0 -0.1 0.1\n3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n");
    write("points.xyz", "9 9 9\n");
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

  std::filesystem::path scene(const std::string& robot, const std::string& effects = R"("any": true)",
                              const std::string& more = "", const std::string& of_object = "") const
  {
    write("scene.json", R"({"clouds": {"points": "points.xyz"}, "objects": [
      {"name": "points", "cloud": "points", "fixed": true},
      {"name": "arm", "robot": {"urdf": "arm.urdf")" +
                            robot + "}" + of_object + R"(}], "effects": {)" + effects + "}" + more + "}");
    return folder / "scene.json";
  }

  SceneFile read(const std::string& robot, const std::string& effects = R"("any": true)", const std::string& more = "",
                 const std::string& of_object = "") const
  {
    SceneFile file = readSceneFile(scene(robot, effects, more, of_object));
    addRobots(file);
    return file;
  }

  /// One line.
  void expectRefused(const std::string& why, const std::string& robot, const std::string& effects = R"("any": true)",
                     const std::string& more = "", const std::string& of_object = "") const
  {
    try {
      read(robot, effects, more, of_object);
      ADD_FAILURE() << why;
    }
    catch (const std::exception& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(why), Not(HasSubstr("\n"))));
    }
  }

  const io::TemporaryFolder folder;
};

/// The distance of a point from a box of an arm; negative inside.
double distanceOf(const Eigen::Vector3d& point, const robots::Shape& box, const Eigen::Isometry3d& T_world_link)
{
  const Eigen::Vector3d half = 0.5 * std::get<robots::Box>(box.form).size;
  const Eigen::Vector3d away = ((T_world_link * box.pose).inverse() * point).cwiseAbs() - half;
  return away.cwiseMax(0.0).norm() + std::min(away.maxCoeff(), 0.0);
}

TEST_F(SceneRobots, CollideAsARobotWorldSaysAtEachStep)
{
  std::mt19937 random(65);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::ostringstream points, states;
  for (int i = 0; i < 300; ++i)
    points << std::copysign(between(0.4, 1.5), between(-1, 1)) << ' ' << between(-0.4, 0.4) << ' ' << between(-0.5, 1.5)
           << '\n';
  states << "a,b,c\n";
  for (int i = 0; i < 200; ++i) states << between(-2, 2) << ',' << between(-3, 3) << ',' << between(-9, 9) << '\n';
  write("points.xyz", points.str());
  write("states.csv", states.str());
  const SceneFile file =
      read(R"(, "states": "states.csv", "interval": 1)", R"("any": true, "self": true, "distance": "all")",
           R"(, "clearance": 0.01, "steps": 398, "dt": 0.5)", R"(, "pose": [0.1, 0, 0.2, 0, 0, 0.4])");
  SceneWorld world(file);

  robots::Robot robot = readRobot(folder / "arm.urdf");
  readMeshes(robot);
  const SphereHierarchy& cloud = *world.scene()[0].parts[0].hierarchy;
  robots::WorldOptions options;
  options.clearance = options.self_clearance = 0.01;
  options.base = world.scene()[1].pose;
  options.with_self = false;
  const robots::RobotWorld among(robot, {&cloud}, options);
  options.with_self = true;
  const robots::RobotWorld alone(robot, {}, options);
  std::vector<robots::RobotState> given;
  for (const JointValues& values : readJointStates(folder / "states.csv")) given.push_back(stateOf(robot, values));
  std::size_t colliding = 0, with_itself = 0, free = 0, of_boxes = 0;
  for (std::size_t step = 0; step <= file.steps; ++step) {
    robots::RobotState state = given[step / 2];
    if (step % 2 == 1)
      for (std::size_t i = 0; i < state.size(); ++i)
        state[i] += 0.5 * (i == 2 ? std::remainder(given[step / 2 + 1][i] - state[i], 2 * std::acos(-1.0))
                                  : given[step / 2 + 1][i] - state[i]);
    if (step > 0) world.setTime(world.scene().time() + file.dt);
    const SceneResult result = step > 0 ? world.scene().step(file.dt) : world.scene().query();
    const Verdict verdict = among.checkState(state).verdict, self = alone.checkState(state).verdict;
    ASSERT_NE(verdict, Verdict::undecided) << step;
    EXPECT_EQ(result.any.empty(), verdict == Verdict::free) << step;
    EXPECT_EQ(result.self.empty(), self == Verdict::free) << step;
    colliding += verdict == Verdict::colliding;
    with_itself += self == Verdict::colliding;
    free += verdict == Verdict::free;
    // Brute force: all points and boxes. The hand may be nearer.
    const std::vector<Eigen::Isometry3d> poses = robots::Kinematics(robot).linkPoses(state);
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t part = 0; part < 3; ++part)
      for (std::uint32_t i = 0; i < cloud.size(); ++i)
        least = std::min(least, distanceOf(Eigen::Vector3d(cloud.view().point(i).data()), robot.links[part].shapes[0],
                                           options.base * poses[part]));
    ASSERT_EQ(result.distance.size(), 1u);
    const DistantPair& nearest = result.distance[0];
    EXPECT_LE(nearest.distance, least + 1e-9) << step;
    if (nearest.part_b == 3) continue;
    EXPECT_NEAR(nearest.distance, least, 1e-9) << step;
    ++of_boxes;
  }
  EXPECT_GT(of_boxes, 40u);
  EXPECT_GT(colliding, 20u);
  EXPECT_GT(with_itself, 10u);
  EXPECT_GT(free, 10u);
}

TEST_F(SceneRobots, HoldRoundShapes)
{
  write("arm.urdf", R"(<robot name="round"><link name="ball"><collision><origin xyz="1 2 3" rpy="1 2 3"/><geometry>
    <sphere radius="0.3"/></geometry></collision></link><link name="rod"><collision><geometry><cylinder radius="0.2" length="1"/>
    </geometry></collision></link><joint name="j" type="fixed"><parent link="ball"/><child link="rod"/></joint></robot>)");
  const SceneFile file = read("", R"("any": true)", R"(, "tolerance": 0.001)");
  const robots::Robot robot = readRobot(folder / "arm.urdf");
  ASSERT_EQ(file.objects[1].parts.size(), 2u);
  EXPECT_NO_THROW(SceneWorld{file}) << "they close";
  for (const std::size_t link : {0u, 1u}) {
    const Eigen::Isometry3d T_shape_link = robot.links[link].shapes[0].pose.inverse();
    const Mesh& mesh = *file.clouds[1 + link].mesh;
    const PointsView view = viewOf(mesh.vertices);
    const auto corner = [&](std::uint32_t i) { return T_shape_link * Eigen::Vector3d(view.point(i).data()); };
    double farthest = 0.0;
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3d normal = (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).normalized();
      const double reach = link == 0 ? 0.3 : 0.2 * normal.head<2>().norm() + 0.5 * std::abs(normal.z());
      EXPECT_GE(std::abs(normal.dot(corner(t[0]))), reach - 1e-12);
      for (const std::uint32_t k : t)
        farthest = std::max(farthest, link == 0 ? corner(k).norm() - 0.3 : corner(k).head<2>().norm() - 0.2);
    }
    EXPECT_LE(farthest, 0.001 + 1e-12);
    EXPECT_TRUE(file.objects[1].parts[link].solid);
  }
}

TEST_F(SceneRobots, RestBeforeTheFirstAndAfterTheLastState)
{
  write("states.csv", "c\n3\n-3\n");
  const SceneFile file = read(R"(, "states": "states.csv", "interval": 2)");
  const auto handAt = [&](double time) { return file.objects[1].part_poses(time)[3].linear()(1, 1); };
  EXPECT_NEAR(handAt(-1), std::cos(3.0), 1e-12);
  EXPECT_NEAR(handAt(1), -1.0, 1e-12) << "the shorter way, by pi";
  EXPECT_NEAR(handAt(9), std::cos(3.0), 1e-12);
  EXPECT_EQ(file.objects[1].parts[3].name, "hand");
  EXPECT_FALSE(file.objects[1].parts[3].solid);
  EXPECT_EQ(file.objects[1].adjacent.size(), 3u) << "links and their parents";
  EXPECT_TRUE(read("", R"("any": true)", "", R"(, "solid": true)").objects[1].parts[3].solid);
}

TEST_F(SceneRobots, AreNotHeldAgainstThemselvesWhereAnSrdfSaysSo)
{
  write("arm.srdf", R"(<robot name="arm"><disable_collisions link1="hand" link2="foot" reason="Never"/></robot>)");
  EXPECT_EQ(read(R"(, "srdf": "arm.srdf")").objects[1].adjacent.size(), 4u);
}

TEST_F(SceneRobots, AreRefusedInOneLine)
{
  write("states.csv", "a,b\n0,0\n0,3.5\n");
  const std::string states = R"(, "states": "states.csv")", any = R"("any": true)";
  expectRefused("states.csv: state 1: joint 'b': has the value 3.5", states);
  write("states.csv", "a,d\n0,0\n");
  expectRefused("states.csv: joint 'd': is not one of arm", states);
  for (const char* effect : {R"("first_contact": true)", R"("swept": true)", R"("response": "stop")",
                             R"("response": "slide")", R"("gravity": {})", R"("bodies": {})"})
    expectRefused("objects[1].robot: does not go with the effect '", "", effect);
  expectRefused("leave one out; pcl_bsh_arm --motions certifies the motions of a robot", "", R"("swept": true)");
  for (const char* key : {R"("fixed": true)", R"("adjacent": [["a", "b"]])"})
    expectRefused("does not go with 'robot'", "", any, "", std::string(", ") + key);
  expectRefused("objects[1].robot.srdf: no such file", R"(, "srdf": "none.srdf")");
  write("arm.urdf",
        R"(<robot name="arm"><link name="foot"><collision><geometry><sphere radius="1"/></geometry></collision>
    </link></robot>)");
  expectRefused("objects[1].robot: a circle of radius", "", any, R"(, "tolerance": 1e-12)");
  write("arm.urdf", R"(<robot name="arm"><link name="foot"/></robot>)");
  expectRefused("objects[1].robot.urdf: has no link with a shape", "");
}

} // namespace
} // namespace pcl_bsh::io
