// SPDX-License-Identifier: BSD-3-Clause
// Workload R: two statues under many rigid poses. Does any pair lie within one spacing; how far apart are they?
#include "program.h"
#include "rigid_racers.h"
#include "workload/nearest.h"
#include "workload/random.h"
#include "workload/rigid_poses.h"
#include "workload/statue.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::vector<std::size_t> sizes = {100000, 1000000};
  std::vector<std::string> racers = availableRigidRacers();
  std::size_t poses = 1000;
  std::size_t slow_poses = 60;
  std::size_t motions = 0;
};

struct Bodies {
  Points a, b;
  double spacing;
  std::vector<PosedCase> cases;
};

Bodies makeBodies(std::size_t count, std::size_t poses)
{
  progress("making two statues of " + std::to_string(count) + " points");
  Bodies bodies{statue(count, 1), statue(count, 2), 0.0, {}};
  bodies.spacing = static_cast<float>(medianSpacing(bodies.a));
  progress("finding " + std::to_string(poses) + " poses");
  bodies.cases = rigidPoses(ReferenceTree(bodies.a), ReferenceTree(bodies.b), bodies.spacing, poses, 3);
  return bodies;
}

const char* name(PoseClass kind)
{
  switch (kind) {
  case PoseClass::hit:
    return "hit";
  case PoseClass::near_miss:
    return "near miss";
  default:
    return "far";
  }
}

/// Times of one racer at one question, and how many answers were wrong.
struct Score {
  std::vector<double> microseconds; ///< per pose, the median of the repetitions
  std::size_t wrong = 0;
};

template <typename Ask, typename Judge>
Score score(const Bodies& bodies, PoseClass kind, std::size_t at_most, unsigned repeat, const Ask& ask,
            const Judge& right)
{
  std::vector<const PosedCase*> cases;
  for (const auto& posed : bodies.cases)
    if (posed.kind == kind && cases.size() < at_most) cases.push_back(&posed);
  std::vector<std::vector<double>> times(cases.size());
  Score result;
  for (unsigned round = 0; round < repeat; ++round) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const Stopwatch watch;
      const auto answer = ask(cases[i]->pose);
      times[i].push_back(1e6 * watch.seconds());
      if (round == 0) result.wrong += !right(answer, cases[i]->distance);
    }
  }
  for (auto& t : times) result.microseconds.push_back(median(std::move(t)));
  return result;
}

/// Turned by up to `spread` about any axis, moved by up to `spread` along each axis.
RigidPose poseAround(const RigidPose& middle, double spread, Random& random)
{
  RigidPose pose;
  const std::array<double, 3> axis = random.direction();
  const double angle = spread * random.uniform(-1, 1), c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  const auto [x, y, z] = axis;
  const std::array<double, 9> turn = {c + x * x * d,     x * y * d - z * s, x * z * d + y * s,
                                      y * x * d + z * s, c + y * y * d,     y * z * d - x * s,
                                      z * x * d - y * s, z * y * d + x * s, c + z * z * d};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      pose.rotation[3 * i + j] = 0.0;
      for (std::size_t k = 0; k < 3; ++k) pose.rotation[3 * i + j] += middle.rotation[3 * i + k] * turn[3 * k + j];
    }
    pose.translation[i] = middle.translation[i] + spread * random.uniform(-1, 1);
  }
  return pose;
}

/// A tree of poses that grows about a near miss, as planners make it: each pose by a step from an earlier one, with a
/// motion from that one and from the one before that.
Roadmap roadmapAround(const PosedCase& middle, std::size_t motions, double step)
{
  Random random(6);
  Roadmap map;
  map.poses.push_back(middle.pose);
  std::vector<std::uint32_t> parent = {0};
  while (map.motions.size() < motions) {
    const auto from = static_cast<std::uint32_t>(random.bits() % map.poses.size());
    const auto to = static_cast<std::uint32_t>(map.poses.size());
    map.poses.push_back(poseAround(map.poses[from], step, random));
    parent.push_back(from);
    map.motions.emplace_back(from, to);
    if (from != 0) map.motions.emplace_back(to, parent[from]);
  }
  map.motions.resize(motions);
  return map;
}

/// Rates of motions in one call, beside those of a call for each of some of them.
bool raceMotions(const Options& options, const Bodies& bodies, const std::string& racer_name, RigidRacer& racer,
                 Table& table)
{
  const auto middle = std::find_if(bodies.cases.begin(), bodies.cases.end(),
                                   [](const PosedCase& posed) { return posed.kind == PoseClass::near_miss; });
  bool right = true;
  for (const double step : {0.02, 0.1, 0.4}) {
    const Roadmap map = roadmapAround(*middle, options.motions, step);
    const std::size_t some = std::min<std::size_t>(options.motions, 1000);
    const auto addRow = [&](const std::string& how, std::size_t count, double seconds, std::size_t hits) {
      table.add({std::to_string(bodies.a.size()), "any on motions, " + how, "steps of " + text(step), racer_name,
                 std::to_string(count), text(1e6 * seconds / static_cast<double>(count)), "", "", "", "",
                 std::to_string(hits) + " hits; " + racer.remark()});
    };
    racer.remark();
    progress(racer_name + ", " + std::to_string(some) + " motions, steps of " + text(step));
    const Stopwatch watch;
    const std::size_t alone = racer.anyOnEachMotion(map, some);
    addRow("a call for each", some, watch.seconds(), alone);
    right = racer.anyOnMotions(map, some, 1) == alone && right;
    racer.remark();
    for (const unsigned threads : {1u, 2u}) {
      progress(racer_name + ", " + std::to_string(options.motions) + " motions, steps of " + text(step));
      const Stopwatch batch;
      const std::size_t hits = racer.anyOnMotions(map, options.motions, threads);
      addRow("one call, " + std::to_string(threads) + " threads", options.motions, batch.seconds(), hits);
    }
  }
  return right;
}

bool race(const Options& options, std::size_t size, Table& table)
{
  const Bodies bodies = makeBodies(size, options.poses);
  std::size_t wrong = 0;
  for (const auto& racer_name : options.racers) {
    progress(racer_name + ", " + std::to_string(size) + " points: building");
    const auto racer = makeRigidRacer(racer_name);
    std::vector<double> builds;
    const unsigned build_rounds = size <= 200000 ? options.repeat : 1;
    for (unsigned round = 0; round < build_rounds; ++round) {
      const Stopwatch watch;
      racer->build(bodies.a, bodies.b, bodies.spacing);
      builds.push_back(watch.seconds());
    }
    const std::size_t at_most = racer->slow() ? options.slow_poses / 3 : options.poses;
    const unsigned repeat = racer->slow() ? 1 : options.repeat;
    const auto addRow = [&](const std::string& question, PoseClass kind, const Score& score) {
      wrong += score.wrong;
      table.add({std::to_string(size), question, name(kind), racer_name, std::to_string(score.microseconds.size()),
                 text(median(score.microseconds)), text(quantile(score.microseconds, 0.9)),
                 text(quantile(score.microseconds, 1.0)), text(1e3 * median(builds)), std::to_string(score.wrong),
                 racer->remark()});
    };
    for (const PoseClass kind : {PoseClass::hit, PoseClass::near_miss, PoseClass::far}) {
      progress(racer_name + ", " + std::to_string(size) + " points: any, " + name(kind));
      addRow("any", kind,
             score(
                 bodies, kind, at_most, repeat, [&](const RigidPose& pose) { return racer->any(pose); },
                 [&](bool answer, double truth) { return answer == (truth <= bodies.spacing); }));
    }
    if (options.motions != 0 && racer->takesMotions())
      wrong += !raceMotions(options, bodies, racer_name, *racer, table);
    if (!racer->measuresDistance()) continue;
    progress(racer_name + ", " + std::to_string(size) + " points: distance");
    addRow("distance", PoseClass::near_miss,
           score(
               bodies, PoseClass::near_miss, at_most, repeat,
               [&](const RigidPose& pose) { return racer->distance(pose); },
               [&](double answer, double truth) { return std::abs(answer - truth) <= 1e-5 * bodies.spacing; }));
  }
  return wrong == 0;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "Two statue-like surfaces under random rigid poses, a third of them hits, near misses (1.3 to 4 spacings\n"
      "apart) and far: does any pair of points lie within one spacing; and the distance at the near misses.\n"
      "Hierarchies warm, one thread; racers that go point by point get fewer poses.",
      "bench_rigid");
  app.footer("Example: bench_rigid --sizes 100000 --poses 1000 --csv rigid.csv");
  app.add_option("--sizes", options.sizes, "points per body")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--poses", options.poses, "poses")->check(CLI::Range(3, 1000000))->capture_default_str();
  app.add_option("--slow-poses", options.slow_poses, "poses for the slow racers")
      ->check(CLI::Range(3, 1000000))
      ->capture_default_str();
  app.add_option(
         "--motions", options.motions,
         "motions between poses around a near miss in one call, beside a call for each; mean times, in the column of\n"
         "the median")
      ->check(CLI::Range(0, 10000000))
      ->capture_default_str();
  app.add_option("--racers", options.racers, "who runs")
      ->delimiter(',')
      ->check(CLI::IsMember(availableRigidRacers()))
      ->capture_default_str();
  Table table({"points", "query", "class", "racer", "poses", "median [us]", "p90 [us]", "max [us]", "build both [ms]",
               "wrong", "remark"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    bool right = true;
    for (const std::size_t size : options.sizes) right = race(options, size, rows) && right;
    return right;
  });
}
