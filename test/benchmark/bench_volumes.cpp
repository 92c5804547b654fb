// SPDX-License-Identifier: BSD-3-Clause
// The numbers of the paper's table: tests of bounding volumes (N_v), updates of them (N_u) and milliseconds. They are
// of our spheres, of those in the paper's octants, and of axis-aligned boxes, on two files of points.
#include "peer/box_tree.h"
#include "posed_files.h"

#include <pcl_bsh/collide.h>

#include <algorithm>
#include <array>

namespace {

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

struct Options : PosedFilesOptions {
  double clearance = 0.0;
};

RigidPose plain(const Eigen::Isometry3d& pose)
{
  RigidPose result;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) result.rotation[static_cast<std::size_t>(3 * i + k)] = pose.linear()(i, k);
    result.translation[static_cast<std::size_t>(i)] = pose.translation()[i];
  }
  return result;
}

/// Cost of one kind of volumes for one question, at all poses.
struct Cost {
  std::uint64_t tests = 0, updates = 0, leaf_pairs = 0;
  double milliseconds = 0.0; ///< of each pose the least
  std::vector<std::size_t> found;
};

/// @param ask (pose's number, cost: adds to its counts) how many points it found
template <typename Ask>
Cost measure(std::size_t poses, unsigned repeat, const Ask& ask)
{
  Cost cost;
  for (std::size_t i = 0; i < poses; ++i) {
    cost.found.push_back(ask(i, cost));
    double least = 0.0;
    for (unsigned repetition = 0; repetition < repeat; ++repetition) {
      Cost again;
      const Stopwatch watch;
      ask(i, again);
      const double seconds = watch.seconds();
      if (repetition == 0 || seconds < least) least = seconds;
    }
    cost.milliseconds += 1e3 * least;
  }
  return cost;
}

bool run(const Options& options, Table& table)
{
  const Points a = loadPoints(options.a), b = loadPoints(options.b);
  const auto clearance = static_cast<float>(options.clearance);
  const Stopwatch boxes_watch;
  const BoxTree boxes_a(a), boxes_b(b);
  const double boxes_ms = 1e3 * boxes_watch.seconds();
  const std::vector<Eigen::Isometry3d> poses = posesAbout(options, a, b);
  std::vector<RigidPose> plain_poses;
  for (const Eigen::Isometry3d& p : poses) plain_poses.push_back(plain(p));

  std::array<std::vector<std::size_t>, 2> truth; // any, flags
  std::size_t differ = 0;
  const auto add = [&](const std::string& volumes, std::size_t question, double build_ms, const Cost& cost) {
    if (truth[question].empty()) truth[question] = cost.found;
    std::size_t found = 0, off = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      found += cost.found[i];
      off +=
          cost.found[i] > truth[question][i] ? cost.found[i] - truth[question][i] : truth[question][i] - cost.found[i];
    }
    const auto mean = [&](std::uint64_t sum) {
      return text(static_cast<double>(sum) / static_cast<double>(poses.size()), 4);
    };
    table.add({options.name, std::to_string(a.size()), std::to_string(b.size()), text(options.clearance),
               std::to_string(poses.size()), volumes, question == 0 ? "any" : "all", mean(cost.tests),
               mean(cost.updates), mean(cost.leaf_pairs), text(cost.milliseconds / static_cast<double>(poses.size())),
               text(build_ms), std::to_string(found), std::to_string(off)});
    if (volumes != "boxes") differ += off;
  };

  for (const auto& [volumes, cells] :
       {std::pair("spheres", CellSplit::longest_axis), std::pair("spheres, octants", CellSplit::octants)}) {
    progress(options.name + ": " + volumes);
    HierarchyOptions how;
    how.cells = cells;
    const Stopwatch watch;
    const SphereHierarchy tree_a(viewOf(&a.data()->x, a.size()), how), tree_b(viewOf(&b.data()->x, b.size()), how);
    tree_a.buildAll();
    tree_b.buildAll();
    const double build_ms = 1e3 * watch.seconds();
    const auto counted = [](const Work& work, Cost& cost) {
      cost.tests += work.node_pairs;
      cost.updates += work.volumes_carried; // what is built is kept, and counts for no question
      cost.leaf_pairs += work.leaf_pairs;
    };
    AnyRequest any;
    FlagsRequest flags;
    any.clearance = flags.clearance = clearance;
    add(volumes, 0, build_ms, measure(poses.size(), options.repeat, [&](std::size_t i, Cost& cost) {
          const AnyResult result = anyCollision({tree_a}, {tree_b, poses[i]}, any);
          counted(result.work, cost);
          return result.verdict == Verdict::colliding ? std::size_t{1} : std::size_t{0};
        }));
    FlagsResult result;
    add(volumes, 1, build_ms, measure(poses.size(), options.repeat, [&](std::size_t i, Cost& cost) {
          result = collisionFlags({tree_a}, {tree_b, poses[i]}, flags);
          counted(result.work, cost);
          return static_cast<std::size_t>(result.colliding_a);
        }));
  }

  progress(options.name + ": boxes");
  BoxPair boxes(boxes_a, boxes_b);
  const auto counted = [](const BoxWork& work, Cost& cost) {
    cost.tests += work.tests;
    cost.updates += work.updates;
    cost.leaf_pairs += work.leaf_pairs;
  };
  add("boxes", 0, boxes_ms, measure(poses.size(), options.repeat, [&](std::size_t i, Cost& cost) {
        BoxWork work;
        const bool found = boxes.any(plain_poses[i], clearance, work);
        counted(work, cost);
        return found ? std::size_t{1} : std::size_t{0};
      }));
  std::vector<std::uint8_t> marks;
  add("boxes", 1, boxes_ms, measure(poses.size(), options.repeat, [&](std::size_t i, Cost& cost) {
        BoxWork work;
        boxes.flag(plain_poses[i], clearance, marks, work);
        counted(work, cost);
        return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
      }));
  return differ == 0;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  options.repeat = 5;
  CLI::App app("Counts tests and updates of bounding volumes, as the paper does, and times them.", "bench_volumes");
  options.addTo(app);
  app.add_option("--clearance", options.clearance, "in the clouds' unit")->required();
  return runProgram(app, argc, argv, options,
                    Table({"clouds", "points", "points of b", "clearance", "poses", "volumes", "question", "N_v", "N_u",
                           "leaf pairs", "time [ms]", "build both [ms]", "found", "differ"}),
                    [&](Table& table) { return run(options, table); });
}
