// SPDX-License-Identifier: BSD-3-Clause
// Workload A: motions of 1 radian of an arm among sampled shelves, certified, and beside that sampled at 32 a radian by
// our own query for the neighbours of a point. One thread.
#include "harness.h"
#include "program.h"
#include "support/arm_problems.h"

#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/robot/robot_world.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;
using robots::RobotState;

namespace {

struct Options : ProgramOptions {
  std::filesystem::path data = std::filesystem::path(PCL_BSH_SHARED_DIR) / "data/arms/panda";
  std::size_t every = 10;
  std::size_t motions = 200;
  std::size_t points = 10'000;
};

constexpr double kPointRadius = 0.0025;

std::vector<robots::RobotWorld::Motion> madeMotions(const robots::Robot& arm, std::size_t count, test::Random& random)
{
  std::vector<robots::RobotWorld::Motion> motions;
  while (motions.size() < count) {
    robots::RobotWorld::Motion motion;
    std::vector<double> way;
    bool inside = true;
    for (const std::size_t link : variablesOf(arm)) {
      motion.from.push_back(random.uniform(arm.links[link].joint->lower, arm.links[link].joint->upper));
      way.push_back(random.uniform(-1, 1));
    }
    const double length = std::sqrt(std::inner_product(way.begin(), way.end(), way.begin(), 0.0));
    std::size_t i = 0;
    for (const std::size_t link : variablesOf(arm)) {
      motion.to.push_back(motion.from[i] + way[i] / length);
      inside &= motion.to[i] >= arm.links[link].joint->lower && motion.to[i] <= arm.links[link].joint->upper;
      ++i;
    }
    if (inside && length <= 1.0) motions.push_back(std::move(motion));
  }
  return motions;
}

/// Checks at so many states of a motion whether a ball of a link holds a point.
class Sampled {
public:
  Sampled(const robots::Robot& arm, const SphereHierarchy& cloud) : kinematics_(arm), cloud_(cloud)
  {
    for (std::size_t link = 0; link < arm.links.size(); ++link)
      for (const robots::Shape& shape : arm.links[link].shapes)
        balls_.push_back({kinematics_.bodyOf(link), (kinematics_.inBody(link) * shape.pose).translation(),
                          std::get<robots::Sphere>(shape.form).radius + kPointRadius});
  }

  bool isFree(const robots::RobotWorld::Motion& motion, int samples)
  {
    RobotState state = motion.from;
    for (int sample = 0; sample <= samples; ++sample) {
      for (std::size_t i = 0; i < state.size(); ++i)
        state[i] = motion.from[i] + sample / static_cast<double>(samples) * (motion.to[i] - motion.from[i]);
      kinematics_.poses(state, {}, kinematics_.bodies().size(), poses_);
      for (const Ball& ball : balls_) {
        const Eigen::Vector3d p = poses_[ball.body] * ball.center;
        if (anyInRadius(cloud_, {p.x(), p.y(), p.z()}, ball.radius)) return false;
      }
    }
    return true;
  }

private:
  struct Ball {
    std::size_t body;
    Eigen::Vector3d center;
    double radius;
  };

  robots::Kinematics kinematics_;
  const SphereHierarchy& cloud_;
  std::vector<Ball> balls_;
  std::vector<robots::Kinematics::Pose> poses_;
};

struct Racer {
  std::vector<double> times; ///< us, of all motions
  std::size_t free = 0, undecided = 0, wrong = 0;

  std::vector<std::string> row(const std::string& name) const
  {
    const double mean = std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
    return {name,
            text(mean),
            text(median(times)),
            text(quantile(times, 0.95)),
            std::to_string(free),
            std::to_string(undecided),
            std::to_string(wrong)};
  }
};

/// @param check gives the verdict of a motion
template <class Check>
std::vector<Verdict> race(Racer& racer, const std::vector<robots::RobotWorld::Motion>& motions, const Check& check)
{
  std::vector<Verdict> verdicts;
  for (const robots::RobotWorld::Motion& motion : motions) {
    const Stopwatch watch;
    verdicts.push_back(check(motion));
    racer.times.push_back(1e6 * watch.seconds());
    racer.free += verdicts.back() == Verdict::free ? 1 : 0;
    racer.undecided += verdicts.back() == Verdict::undecided ? 1 : 0;
  }
  return verdicts;
}

/// A cloud of points of one radius, as sensors give it to a world.
struct Scan {
  Scan(const test::ArmProblem& problem, std::size_t points, test::Random& random)
  : xyz(problem.cloud(points, random)),
    radii(xyz.size() / 3, static_cast<float>(kPointRadius))
  {
  }

  PointsView view() const
  {
    PointsView view = viewOf(xyz.data(), radii.size());
    view.radii = radii.data();
    return view;
  }

  std::vector<float> xyz, radii;
};

/// From a cloud in memory to the answer about the state that a plan begins with, one cloud after the other.
void makeReady(Racer& racer, const robots::Robot& arm, const test::ArmProblem& problem, const Options& options,
               test::Random& random)
{
  const Scan scan(problem, options.points, random);
  const Stopwatch watch;
  const SphereHierarchy cloud(scan.view());
  robots::RobotWorld(arm, {&cloud}).checkState(problem.start);
  racer.times.push_back(1e6 * watch.seconds());
}

bool run(const Options& options, Table& rows)
{
  robots::Robot arm = io::readRobot(options.data / "panda_spherized.urdf");
  io::readGroups(options.data / "panda.srdf", arm);
  robots::Robot meshes = io::readRobot(options.data / "panda.urdf", {{"meshes", options.data}});
  io::readMeshes(meshes);
  io::readGroups(options.data / "panda.srdf", meshes);
  const std::vector<test::ArmProblem> problems = test::armProblems(options.data / "problems.txt");
  test::Random random(1);
  Racer first, again, with_self, sampled, states, ready, mesh_motions, mesh_states;
  for (std::size_t i = 0; i < problems.size(); i += options.every) makeReady(ready, arm, problems[i], options, random);
  for (std::size_t i = 0; i < problems.size(); i += options.every) {
    progress(problems[i].name);
    const Scan scan(problems[i], options.points, random);
    const auto motions = madeMotions(arm, options.motions, random);
    const SphereHierarchy cloud(scan.view());
    robots::WorldOptions alone;
    alone.with_self = false;
    const robots::RobotWorld world(arm, {&cloud}, alone), all(arm, {&cloud});
    const auto certified = [](const robots::RobotWorld& of) {
      return [&of](const robots::RobotWorld::Motion& m) { return of.checkMotion(m.from, m.to).verdict; };
    };
    const std::vector<Verdict> verdicts = race(first, motions, certified(world));
    race(again, motions, certified(world));
    race(with_self, motions, certified(all));
    race(states, motions, [&](const robots::RobotWorld::Motion& m) { return all.checkState(m.from).verdict; });
    const robots::RobotWorld of_meshes(meshes, {&cloud});
    race(mesh_motions, motions, certified(of_meshes));
    race(mesh_states, motions,
         [&](const robots::RobotWorld::Motion& m) { return of_meshes.checkState(m.from).verdict; });
    Sampled samples(arm, cloud);
    const std::vector<Verdict> believed = race(sampled, motions, [&](const robots::RobotWorld::Motion& m) {
      return samples.isFree(m, 32) ? Verdict::free : Verdict::colliding;
    });
    for (std::size_t k = 0; k < motions.size(); ++k) {
      sampled.wrong += believed[k] == Verdict::free && verdicts[k] == Verdict::colliding ? 1 : 0;
      first.wrong += verdicts[k] == Verdict::free && !samples.isFree(motions[k], 1024) ? 1 : 0;
    }
  }
  if (first.times.empty()) throw std::runtime_error(options.data.string() + ": has no problems: give --data FOLDER");
  rows.add(first.row("certified, the first time"));
  rows.add(again.row("certified, again"));
  rows.add(with_self.row("certified, links against links, too"));
  rows.add(sampled.row("32 samples, our anyInRadius()"));
  rows.add(states.row("one state, links against links, too"));
  rows.add(mesh_motions.row("certified, meshes, links against links, too"));
  rows.add(mesh_states.row("one state, meshes, links against links, too"));
  rows.add(ready.row("a new cloud and its first state"));
  return first.wrong == 0;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "Motions of an arm of 59 balls, or of 11 meshes, among sampled shelves, certified and sampled. One thread.",
      "bench_arm");
  app.footer("Example: bench_arm --clock cpu --csv arm.csv");
  app.add_option("--data", options.data, "folder with the arm and its problems")->capture_default_str();
  app.add_option("--every", options.every, "of so many problems one")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--motions", options.motions, "of each")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--points", options.points, "of each object")->check(CLI::PositiveNumber)->capture_default_str();
  Table table({"check", "mean [us]", "median [us]", "95 % [us]", "free", "undecided", "wrong"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return run(options, rows); });
}
