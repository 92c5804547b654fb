// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/robot_world.h>
#include <pcl_bsh/question/warnings/robot_warnings.h>

#include <utility>

namespace pcl_bsh::python {
namespace {

std::shared_ptr<Cloud> obstacleOf(const std::string& name, py::handle thing)
{
  if (py::isinstance<Cloud>(thing)) return thing.cast<std::shared_ptr<Cloud>>();
  const PointsView view = viewOfPoints(name, {py::reinterpret_borrow<py::object>(thing)});
  return unlocked([&] { return std::make_shared<Cloud>(view); });
}

PyWorld::Obstacles obstaclesOf(const ObstaclesLike& given)
{
  if (py::isinstance<Cloud>(given) || py::isinstance<py::array>(given)) return {obstacleOf("obstacles", given)};
  if (!py::isinstance<py::sequence>(given) || py::isinstance<py::str>(given))
    throw py::type_error("obstacles: give a SphereHierarchy, an array of points, or a list of these");
  PyWorld::Obstacles obstacles;
  for (const py::handle one : given)
    obstacles.push_back(obstacleOf("obstacles[" + std::to_string(obstacles.size()) + "]", one));
  return obstacles;
}

/// @throws as robots::RobotWorld does
std::shared_ptr<const PyWorld::Placed> placedOf(const PyWorld& world)
{
  const auto make = [robot = world.robot, obstacles = world.obstacles, options = world.options, poses = world.poses] {
    std::vector<const SphereHierarchy*> hierarchies;
    for (const auto& obstacle : obstacles) hierarchies.push_back(obstacle.get());
    const auto made = std::make_shared<robots::RobotWorld>(robot->robot, hierarchies, options);
    if (!poses.empty()) made->setObstaclePoses(poses);
    return made;
  };
  auto placed = std::make_shared<const PyWorld::Placed>(
      PyWorld::Placed::Clouds(world.obstacles.begin(), world.obstacles.end()), make);
  unlocked([&] { placed->now(); });
  return placed;
}

void warnOfObstacles(const PyWorld& world)
{
  std::vector<std::string> texts;
  unlocked([&] {
    for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
      const std::string number = world.obstacles.size() == 1 ? "" : "[" + std::to_string(i) + "]";
      const NamedCloud facts = world.obstacles[i]->named("obstacles" + number).facts(true);
      addTexts(warningsOf(facts, world.options.clearance), texts);
      if (const auto holes = warningOfHoles(facts, world.robot->robot.name, world.options.clearance))
        addTexts({*holes}, texts);
    }
  });
  for (const std::string& text : texts) warn(text);
}

/// Replaces the robot by a changed one. @param change is called with a world of the robot alone
template <class Change>
void changeRobot(PyWorld& world, const Change& change)
{
  robots::RobotWorld alone(world.robot->robot, {}, world.options);
  change(alone);
  PyWorld next = world;
  next.robot = std::make_shared<RobotModel>(alone.robot(), world.robot->groups);
  next.placed = placedOf(next);
  world = next;
}

} // namespace

std::unique_ptr<PyWorld> makeWorld(const std::shared_ptr<RobotModel>& robot, const ObstaclesLike& obstacles,
                                   double clearance, double self_clearance, double tolerance, bool with_self,
                                   const PoseLike& base, const OptionalArray& joint_uncertainties)
{
  const robots::WorldOptions options{
      clearance,
      self_clearance,
      tolerance,
      with_self,
      rigidPoseOf("base", base),
      joint_uncertainties.is_none() ? std::vector<double>() : rowsOf("joint_uncertainties", joint_uncertainties, 1)};
  auto world = std::make_unique<PyWorld>(PyWorld{robot, obstaclesOf(obstacles), options, {}, nullptr});
  world->placed = placedOf(*world);
  warnOfObstacles(*world);
  return world;
}

void setObstacles(PyWorld& world, const ObstaclesLike& obstacles)
{
  PyWorld next{world.robot, obstaclesOf(obstacles), world.options, {}, nullptr};
  next.placed = placedOf(next);
  world = next;
  warnOfObstacles(next);
}

void setBase(PyWorld& world, const ArrayLike& base)
{
  PyWorld next = world;
  next.options.base = rigidPoseOf("base", base);
  next.placed = placedOf(next);
  world = next;
}

void setObstaclePoses(PyWorld& world, const PosesLike& poses)
{
  PyWorld next = world;
  next.poses.clear();
  for (const py::handle pose : poses)
    next.poses.push_back(rigidPoseOf("poses[" + std::to_string(next.poses.size()) + "]",
                                     PoseLike(py::reinterpret_borrow<py::object>(pose))));
  if (next.poses.size() != next.obstacles.size())
    throw InvalidInput(Input::pose, "poses", "are " + std::to_string(next.poses.size()),
                       "give one for each of the " + counted(next.obstacles.size(), "obstacle"));
  next.placed = placedOf(next);
  world = next;
}

void attachTo(PyWorld& world, const std::string& name, const std::string& link, std::vector<robots::Shape> shapes,
              const std::vector<std::string>& ignored)
{
  const robots::Robot& robot = world.robot->robot;
  std::vector<std::size_t> links;
  for (const std::string& other : ignored) links.push_back(robot.linkNamed(other));
  changeRobot(world,
              [&](robots::RobotWorld& alone) { alone.attach(name, robot.linkNamed(link), std::move(shapes), links); });
}

void detachFrom(PyWorld& world, const std::string& name)
{
  changeRobot(world, [&](robots::RobotWorld& alone) { alone.detach(name); });
}

} // namespace pcl_bsh::python
