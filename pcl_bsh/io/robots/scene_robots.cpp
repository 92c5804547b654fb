// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/scene_robots.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/robots/surface.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/robot_world.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <stdexcept>
#include <utility>
#include <variant>

namespace pcl_bsh::io {

namespace {

using robots::Robot;
using robots::RobotState;

/// A link's shapes that are solid, or its meshes.
struct LinkPart {
  std::string name;
  std::size_t link = 0;
  bool solid = false;
  Surface surface;
};

/// A surface that encloses a shape. For a round shape it is a polyhedron inside the shape enlarged by `excess`. It is
/// nearer to that than `excess`, so it encloses the given shape.
Surface holding(robots::Shape shape, double excess)
{
  constexpr double share = 1.0 - 1e-6; // the rest is for rounding
  std::visit(
      [&](auto& form) {
        if constexpr (requires { form.radius; }) form.radius += excess;
      },
      shape.form);
  return surfaceOf(shape, share * excess);
}

std::vector<LinkPart> partsOf(const Robot& robot, double excess)
{
  std::vector<LinkPart> parts;
  for (std::size_t link = 0; link < robot.links.size(); ++link) {
    const std::string& name = robot.links[link].name;
    Surface solids, meshes;
    for (const robots::Shape& shape : robot.links[link].shapes)
      (std::holds_alternative<robots::Mesh>(shape.form) ? meshes : solids).add(holding(shape, excess));
    const bool has_both = !solids.triangles.empty() && !meshes.triangles.empty();
    if (!solids.triangles.empty()) parts.push_back({name, link, true, std::move(solids)});
    if (!meshes.triangles.empty()) parts.push_back({has_both ? name + " mesh" : name, link, false, std::move(meshes)});
  }
  return parts;
}

std::shared_ptr<const Mesh> meshOf(Surface surface)
{
  auto mesh = std::make_shared<Mesh>();
  for (const char* axis : {"x", "y", "z"}) addField(mesh->vertices, axis, pcl::PCLPointField::FLOAT64);
  allocate(mesh->vertices, static_cast<std::uint32_t>(surface.vertices.size()));
  std::memcpy(mesh->vertices.data.data(), surface.vertices.data(), mesh->vertices.data.size());
  setDense(mesh->vertices);
  mesh->triangles = std::move(surface.triangles);
  return mesh;
}

/// Where the parts of a robot are, in the frame of its root.
class PartsInMotion {
public:
  PartsInMotion(const Robot& robot, const std::vector<LinkPart>& parts, std::vector<RobotState> states, double interval)
  : kinematics_(robot),
    states_(std::move(states)),
    interval_(interval)
  {
    for (const LinkPart& part : parts) links_.push_back(part.link);
    for (const std::size_t link : variablesOf(robot)) joints_.push_back(*robot.links[link].joint);
  }

  std::vector<Eigen::Isometry3d> operator()(double time) const
  {
    const double at = std::clamp(time / interval_, 0.0, static_cast<double>(states_.size() - 1));
    const auto before = static_cast<std::size_t>(at);
    RobotState state = states_[before];
    if (before + 1 < states_.size())
      for (std::size_t i = 0; i < state.size(); ++i)
        state[i] += (at - static_cast<double>(before)) * joints_[i].way(state[i], states_[before + 1][i]);
    const std::vector<Eigen::Isometry3d> of_links = kinematics_.linkPoses(state);
    std::vector<Eigen::Isometry3d> poses;
    for (const std::size_t link : links_) poses.push_back(of_links[link]);
    return poses;
  }

private:
  robots::Kinematics kinematics_;
  std::vector<RobotState> states_;
  double interval_;
  std::vector<std::size_t> links_;
  std::vector<robots::Joint> joints_; ///< of the values of a state
};

class RobotAdder {
public:
  RobotAdder(SceneFile& file, const std::string& package_path) : file_(file), package_path_(package_path) {}

  void add(ObjectEntry& object)
  {
    const RobotEntry& entry = *object.robot;
    Robot robot = readRobot(entry.urdf, entry.packages, package_path_);
    if (!entry.srdf.empty()) readGroups(entry.srdf, robot);
    try {
      const robots::Kinematics kinematics(robot);
      std::vector<LinkPart> parts = partsOf(robot, file_.options.tolerance);
      if (parts.empty()) fail(entry, ".urdf", "has no link with a shape", "give its links <collision> or <visual>");
      object.part_poses = PartsInMotion(robot, parts, statesOf(entry, robot), entry.interval);
      addAdjacent(object, parts, comparedLinks(robot, kinematics));
      const std::vector<Eigen::Isometry3d> poses = object.part_poses(0.0);
      for (LinkPart& part : parts) {
        const bool solid = part.solid || object.solid;
        object.parts.push_back({part.name, newCloud(object, std::move(part)), poses[object.parts.size()], solid});
      }
    }
    catch (const InvalidInput& error) {
      throw std::invalid_argument(entry.urdf.string() + ": " + error.what());
    }
    catch (const FormatError& error) {
      fail(entry, "", error.what(), "give a larger 'tolerance'");
    }
  }

private:
  [[noreturn]] void fail(const RobotEntry& entry, const char* key, const std::string& wrong,
                         const std::string& remedy) const
  {
    throw JsonError(file_.path.string(), entry.place + key, wrong, remedy);
  }

  static std::vector<RobotState> statesOf(const RobotEntry& entry, const Robot& robot)
  {
    const std::filesystem::path& named = entry.states.empty() ? entry.urdf : entry.states;
    try {
      std::vector<RobotState> states;
      if (entry.states.empty())
        states.push_back(stateOf(robot, {}));
      else
        for (const robots::JointValues& values : readJointStates(entry.states))
          states.push_back(stateOf(robot, values));
      Robot bare = robot; // nothing is asked about its shapes
      for (robots::Link& link : bare.links) link.shapes.clear();
      robots::RobotWorld(bare, {}).checkStates(states);
      return states;
    }
    catch (const InvalidInput& error) {
      throw std::invalid_argument(named.string() + ": " + error.what());
    }
  }

  /// Makes pairs of parts adjacent, which are not compared: parts of one link, and of links that are not among
  /// `compared`.
  static void addAdjacent(ObjectEntry& object, const std::vector<LinkPart>& parts,
                          const std::vector<std::array<std::size_t, 2>>& compared)
  {
    const std::set<std::array<std::size_t, 2>> tested(compared.begin(), compared.end());
    for (std::uint32_t a = 0; a < parts.size(); ++a)
      for (std::uint32_t b = a + 1; b < parts.size(); ++b)
        if (!tested.contains({parts[a].link, parts[b].link})) object.adjacent.emplace_back(a, b);
  }

  /// Adds a cloud of the part. @return its name
  std::string newCloud(const ObjectEntry& object, LinkPart part)
  {
    CloudSource cloud;
    cloud.name = object.name + '/' + part.name;
    const auto is_taken = [&](const CloudSource& other) { return other.name == cloud.name; };
    while (std::any_of(file_.clouds.begin(), file_.clouds.end(), is_taken)) cloud.name += '\'';
    cloud.place = object.robot->place;
    cloud.mesh = meshOf(std::move(part.surface));
    file_.clouds.push_back(cloud);
    return cloud.name;
  }

  SceneFile& file_;
  const std::string& package_path_;
};

} // namespace

void addRobots(SceneFile& file, const std::string& package_path)
{
  RobotAdder adder(file, package_path);
  for (ObjectEntry& object : file.objects)
    if (object.robot) adder.add(object);
}

} // namespace pcl_bsh::io
