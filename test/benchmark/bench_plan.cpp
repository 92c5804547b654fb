// SPDX-License-Identifier: BSD-3-Clause
// RRT-Connect of OMPL among sampled shelves, with our validators: from a cloud to a path that is simplified and
// certified as a whole. One thread.
#include "harness.h"
#include "program.h"
#include "support/arm_problems.h"

#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/ompl/joint_space.h>
#include <pcl_bsh/ompl/validators.h>

#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;
namespace ob = ::ompl::base;
namespace og = ::ompl::geometric;

namespace {

struct Options : ProgramOptions {
  std::filesystem::path data = std::filesystem::path(PCL_BSH_SHARED_DIR) / "data/arms/panda";
  std::size_t every = 1;
  unsigned seeds = 10;
  double seconds = 30.0;
  std::size_t points = 10'000;
};

constexpr float kPointRadius = 0.0025f;

/// Questions to the validators, and their time.
struct Asked {
  double seconds = 0.0;
  std::size_t motions = 0;

  template <class Ask>
  bool timed(const Ask& ask)
  {
    const Stopwatch watch;
    const bool valid = ask();
    seconds += watch.seconds();
    return valid;
  }
};

class TimedStates : public pcl_bsh::ompl::StateValidity {
public:
  TimedStates(const ob::SpaceInformationPtr& information, const pcl_bsh::ompl::World& world, Asked& asked)
  : StateValidity(information, world),
    asked_(asked)
  {
  }

  bool isValid(const ob::State* state) const override
  {
    return asked_.timed([&] { return StateValidity::isValid(state); });
  }

private:
  Asked& asked_;
};

class TimedMotions : public pcl_bsh::ompl::MotionValidity {
public:
  TimedMotions(const ob::SpaceInformationPtr& information, const pcl_bsh::ompl::World& world, Asked& asked)
  : MotionValidity(information, world),
    asked_(asked)
  {
  }

  bool checkMotion(const ob::State* from, const ob::State* to) const override
  {
    ++asked_.motions;
    return asked_.timed([&] { return MotionValidity::checkMotion(from, to); });
  }

  bool checkMotion(const ob::State* from, const ob::State* to, std::pair<ob::State*, double>& last) const override
  {
    ++asked_.motions;
    return asked_.timed([&] { return MotionValidity::checkMotion(from, to, last); });
  }

private:
  Asked& asked_;
};

/// Whether 100 states of each motion are free.
bool sampledFree(const og::PathGeometric& path, const robots::RobotWorld& world)
{
  const ob::StateSpacePtr& space = path.getSpaceInformation()->getStateSpace();
  ob::ScopedState<> state(space);
  for (std::size_t i = 0; i + 1 < path.getStateCount(); ++i)
    for (int sample = 0; sample <= 100; ++sample) {
      space->interpolate(path.getState(static_cast<unsigned>(i)), path.getState(static_cast<unsigned>(i + 1)),
                         sample / 100.0, state.get());
      if (world.checkState(state.reals()).verdict == Verdict::colliding) return false;
    }
  return true;
}

/// Plans of some problems.
struct Plans {
  std::size_t problems = 0, colliding = 0, runs = 0, certified = 0, wrong = 0, motions = 0;
  std::vector<double> ready, planned, whole; ///< s, of runs that were solved
  double validators = 0.0, spent = 0.0;      ///< s, of all runs, without making worlds

  Plans& operator+=(const Plans& other)
  {
    problems += other.problems, colliding += other.colliding, runs += other.runs;
    certified += other.certified, wrong += other.wrong, motions += other.motions;
    for (auto times : {&Plans::ready, &Plans::planned, &Plans::whole})
      (this->*times).insert((this->*times).end(), (other.*times).begin(), (other.*times).end());
    validators += other.validators, spent += other.spent;
    return *this;
  }

  std::vector<std::string> row(const std::string& kind) const
  {
    const auto ms = [](const std::vector<double>& times, double fraction) {
      return times.empty() ? "-" : text(1e3 * quantile(times, fraction));
    };
    return {kind,
            std::to_string(problems),
            std::to_string(colliding),
            std::to_string(runs),
            std::to_string(whole.size()),
            std::to_string(certified),
            ms(ready, 0.5),
            ms(planned, 0.5),
            ms(whole, 0.5),
            ms(whole, 0.95),
            ms(whole, 1.0),
            text(100.0 * validators / spent),
            runs ? text(static_cast<double>(motions) / static_cast<double>(runs), 4) : "-",
            std::to_string(wrong)};
  }
};

/// One run, whose world is made anew, for it remembers what it was asked.
void plan(const test::ArmProblem& problem, const robots::Robot& arm, const PointsView& view, const Options& options,
          unsigned seed, Plans& plans)
{
  const Stopwatch of_all;
  const SphereHierarchy cloud(view);
  const auto world = std::make_shared<robots::RobotWorld>(arm, std::vector<const SphereHierarchy*>{&cloud});
  const double ready = of_all.seconds();

  ::ompl::RNG::setSeed(seed);
  Asked asked;
  og::SimpleSetup setup(std::make_shared<pcl_bsh::ompl::JointSpace>(arm));
  const ob::SpaceInformationPtr& information = setup.getSpaceInformation();
  setup.setStateValidityChecker(std::make_shared<TimedStates>(information, world, asked));
  information->setMotionValidator(std::make_shared<TimedMotions>(information, world, asked));
  setup.setPlanner(std::make_shared<og::RRTConnect>(information));
  ob::ScopedState<> start(setup.getStateSpace()), goal(setup.getStateSpace());
  start = problem.start, goal = problem.goal;
  setup.setStartAndGoalStates(start, goal);
  const bool is_solved = setup.solve(options.seconds) == ob::PlannerStatus::EXACT_SOLUTION;
  const double planned = of_all.seconds();
  bool is_certified = false;
  if (is_solved) {
    setup.simplifySolution();
    is_certified = setup.getSolutionPath().check();
  }
  const double whole = of_all.seconds();

  ++plans.runs;
  plans.validators += asked.seconds;
  plans.spent += whole - ready;
  plans.motions += asked.motions;
  if (!is_solved) {
    progress(problem.name + " seed " + std::to_string(seed) + ": not solved");
    return;
  }
  plans.ready.push_back(ready);
  plans.planned.push_back(planned - ready);
  plans.whole.push_back(whole);
  plans.certified += is_certified ? 1 : 0;
  plans.wrong += is_certified && sampledFree(setup.getSolutionPath(), *world) ? 0 : 1;
}

bool run(const Options& options, Table& rows)
{
  ::ompl::msg::setLogLevel(::ompl::msg::LOG_NONE);
  robots::Robot arm = io::readRobot(options.data / "panda_spherized.urdf");
  io::readGroups(options.data / "panda.srdf", arm);
  const std::vector<test::ArmProblem> problems = test::armProblems(options.data / "problems.txt");
  if (problems.empty()) throw std::runtime_error(options.data.string() + ": has no problems: give --data FOLDER");
  std::map<std::string, Plans> kinds;
  for (std::size_t i = 0; i < problems.size(); i += options.every) {
    const test::ArmProblem& problem = problems[i];
    progress(problem.name);
    Plans& plans = kinds[problem.name.substr(0, problem.name.find("_panda"))];
    test::Random random(i);
    const std::vector<float> xyz = problem.cloud(options.points, random);
    const std::vector<float> radii(xyz.size() / 3, kPointRadius);
    PointsView view = viewOf(xyz.data(), radii.size());
    view.radii = radii.data();
    const SphereHierarchy cloud(view);
    const robots::RobotWorld world(arm, {&cloud});
    ++plans.problems;
    bool collides = false;
    for (const auto& [which, state] : {std::pair("start", &problem.start), std::pair("goal", &problem.goal)})
      if (world.checkState(*state).verdict != Verdict::free) {
        progress(problem.name + ": its " + which + " is not free");
        collides = true;
      }
    plans.colliding += collides ? 1 : 0;
    for (unsigned seed = 1; seed <= options.seeds && !collides; ++seed) plan(problem, arm, view, options, seed, plans);
  }
  Plans all;
  for (const auto& [kind, plans] : kinds) {
    rows.add(plans.row(kind));
    all += plans;
  }
  rows.add(all.row("all"));
  return all.wrong == 0;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("RRT-Connect with certified motions, for an arm of 59 balls among sampled shelves. One thread.",
               "bench_plan");
  app.footer("Example: bench_plan --clock cpu --every 5 --seeds 2 --csv plan.csv");
  app.add_option("--data", options.data, "folder with the arm and its problems")->capture_default_str();
  app.add_option("--every", options.every, "of so many problems one")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "runs of each problem")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--seconds", options.seconds, "for planning one, at most")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--points", options.points, "of each object")->check(CLI::PositiveNumber)->capture_default_str();
  Table table({"problems of", "problems", "start or goal not free", "runs", "solved", "certified", "world [ms]",
               "plan [ms]", "cloud to certified path [ms]", "95 % [ms]", "longest [ms]", "validators [%]",
               "motions asked", "wrong"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return run(options, rows); });
}
