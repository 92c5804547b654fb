// SPDX-License-Identifier: BSD-3-Clause
// What scanners saw to be empty: a machine on its way through a hall with pillars, scanned from several places. How
// long do verdicts take, how much of what is truly visible is recognised, and what is called free that is not? Beside
// it OctoMap, whose cells answer the same question.
#include "program.h"
#include "support/made_scans.h"

#include <pcl_bsh/seen/unseen_points.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#ifdef PCL_BSH_BENCH_OCTOMAP
#include <octomap/OcTree.h>
#endif

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::size_t beams = 3000000; ///< of each scanner
  std::size_t points = 50000;  ///< of the machine
  std::size_t poses = 100;
  double clearance = 0.05;
  double noise = 0.0;
  double cell = 0.05;       ///< of OctoMap
  double angle = 0.0;       ///< 0: measured
  std::size_t judged = 100; ///< every so many points
};

struct World {
  explicit World(const Options& options) : room(test::hallOfPillars(30.0, 18.0, 6.0, 4.5))
  {
    test::Random random(1);
    // Of rows and columns so far apart, from almost straight down to straight up, there are as many as asked for.
    const double lowest = -1.2, highest = 1.57;
    const double step = std::sqrt((highest - lowest) * 2.0 * test::kPi / static_cast<double>(options.beams));
    for (const Eigen::Vector3d& origin : {Eigen::Vector3d(2, 2, 1.7), Eigen::Vector3d(28, 2, 1.7),
                                          Eigen::Vector3d(2, 16, 1.7), Eigen::Vector3d(15, 11, 1.7)}) {
      origins.push_back(origin);
      made.push_back(test::makeScan(room, {origin, step, lowest, highest, options.noise}, random));
    }
    for (std::size_t s = 0; s < made.size(); ++s) {
      scans.push_back(made[s].scan(origins[s]));
      scans.back().returns.uncertainty = 3.0 * options.noise;
    }
    for (std::size_t i = 0; i < options.points; ++i) { // the surface of a box
      Eigen::Vector3d p(random.uniform(-0.8, 0.8), random.uniform(-0.5, 0.5), random.uniform(0.0, 1.4));
      const auto axis = static_cast<Eigen::Index>(random.integer(0, 2));
      const double low[] = {-0.8, -0.5, 0.0}, high[] = {0.8, 0.5, 1.4};
      p[axis] = random.chance(0.5) ? low[axis] : high[axis];
      for (const double x : {p.x(), p.y(), p.z()}) machine.push_back(static_cast<float>(x));
    }
    for (std::size_t k = 0; k < options.poses; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(options.poses);
      Eigen::Isometry3d pose(Eigen::AngleAxisd(6.0 * share, Eigen::Vector3d::UnitZ()));
      pose.translation() = Eigen::Vector3d(2.25 + 25.0 * share, 6.75 + 4.5 * std::sin(12.0 * share), 0.3);
      poses.push_back(pose);
    }
  }

  Eigen::Vector3d placed(std::size_t pose, std::size_t point) const
  {
    return poses[pose] * Eigen::Vector3f(&machine[3 * point]).cast<double>();
  }

  test::MadeRoom room;
  std::vector<Eigen::Vector3d> origins;
  std::vector<test::MadeScan> made;
  std::vector<ScanBeams> scans;
  std::vector<float> machine;
  std::vector<Eigen::Isometry3d> poses;
};

/// Against the room itself.
struct Judgement {
  std::size_t visible = 0, recognised = 0, seen = 0, wrong = 0;

  /// @param all_round whether some scanner looks all round the ball about the place
  void add(bool is_seen, bool all_round, bool is_empty)
  {
    visible += all_round;
    recognised += all_round && is_seen;
    seen += is_seen;
    wrong += is_seen && !is_empty;
  }
};

Judgement judge(const Options& options, const World& world, const std::vector<std::vector<std::uint8_t>>& seen)
{
  Judgement judgement;
  for (std::size_t k = 0; k < world.poses.size(); ++k) {
    for (std::size_t i = k % options.judged; i < options.points; i += options.judged) {
      const Eigen::Vector3d place = world.placed(k, i);
      bool all_round = false;
      for (const Eigen::Vector3d& origin : world.origins)
        all_round = all_round || world.room.shows(origin, place, options.clearance, 40);
      judgement.add(seen[k][i] != 0, all_round, world.room.distance(place) > options.clearance);
    }
  }
  return judgement;
}

void report(Table& table, const std::string& name, double making, double asking, std::size_t bytes,
            const Judgement& judgement)
{
  table.add({name, text(making), text(asking), text(static_cast<double>(bytes) / 1e6),
             std::to_string(judgement.visible), std::to_string(judgement.recognised), std::to_string(judgement.seen),
             std::to_string(judgement.wrong)});
}

void measureOurs(const Options& options, const World& world, Table& table)
{
  const MemoryPeak memory;
  const Stopwatch making;
  SeenOptions how;
  if (options.angle > 0.0) how.angle = options.angle;
  const SeenSpace space(world.scans, how);
  const double made = making.seconds();
  progress("angle " + text(space.angle(0)));
  const SphereHierarchy machine(viewOf(world.machine.data(), options.points));
  machine.buildAll();
  std::vector<std::vector<std::uint8_t>> verdicts(world.poses.size(), std::vector<std::uint8_t>(options.points, 0));
  UnseenRequest request;
  request.clearance = options.clearance;
  const Stopwatch asking;
  for (std::size_t k = 0; k < world.poses.size(); ++k)
    markUnseen(space, {machine, world.poses[k]}, request, verdicts[k]);
  const double asked = asking.seconds();
  for (auto& of_pose : verdicts)
    for (std::uint8_t& verdict : of_pose) verdict = verdict == 0;
  report(table, "pcl_bsh", made, asked, memory.bytes(), judge(options, world, verdicts));
}

#ifdef PCL_BSH_BENCH_OCTOMAP
/// Whether all cells that the ball touches are known to be free.
bool isFree(const octomap::OcTree& map, const Eigen::Vector3d& place, double radius)
{
  const double cell = map.getResolution();
  const int reach = static_cast<int>(std::ceil(radius / cell));
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k) {
        const Eigen::Vector3d at = place + cell * Eigen::Vector3d(i, j, k);
        Eigen::Vector3d low;
        for (Eigen::Index axis = 0; axis < 3; ++axis) low[axis] = cell * std::floor(at[axis] / cell);
        if (Eigen::AlignedBox3d(low, low + Eigen::Vector3d::Constant(cell)).squaredExteriorDistance(place) >
            radius * radius)
          continue;
        const octomap::OcTreeNode* const node = map.search(low.x() + cell / 2, low.y() + cell / 2, low.z() + cell / 2);
        if (!node || map.isNodeOccupied(node)) return false;
      }
  return true;
}

void measureOctoMap(const Options& options, const World& world, Table& table)
{
  const MemoryPeak memory;
  const Stopwatch making;
  octomap::OcTree map(options.cell);
  for (std::size_t s = 0; s < world.made.size(); ++s) {
    octomap::Pointcloud cloud;
    const std::vector<double>& ends = world.made[s].returns;
    for (std::size_t i = 0; i < ends.size(); i += 3)
      cloud.push_back(static_cast<float>(ends[i]), static_cast<float>(ends[i + 1]), static_cast<float>(ends[i + 2]));
    const Eigen::Vector3d& o = world.origins[s];
    map.insertPointCloud(cloud, {static_cast<float>(o.x()), static_cast<float>(o.y()), static_cast<float>(o.z())});
    progress("OctoMap: scan " + std::to_string(s));
  }
  const double made = making.seconds();
  std::vector<std::vector<std::uint8_t>> seen(world.poses.size(), std::vector<std::uint8_t>(options.points, 0));
  const Stopwatch asking;
  for (std::size_t k = 0; k < world.poses.size(); ++k)
    for (std::size_t i = 0; i < options.points; ++i) seen[k][i] = isFree(map, world.placed(k, i), options.clearance);
  report(table, "OctoMap", made, asking.seconds(), memory.bytes(), judge(options, world, seen));
}
#endif

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("What scanners saw to be empty: time, and what is recognised.");
  app.add_option("--beams", options.beams, "of each of four scanners");
  app.add_option("--points", options.points, "of the machine");
  app.add_option("--poses", options.poses, "of its way");
  app.add_option("--clearance", options.clearance, "m");
  app.add_option("--noise", options.noise, "a third of how far ranges are off at most, m");
  app.add_option("--cell", options.cell, "of OctoMap, m; 0: without it");
  app.add_option("--angle", options.angle, "that a beam speaks for; 0: measured");
  Table table({"method", "make (s)", "ask (s)", "memory (MB)", "visible", "recognised", "called seen", "wrongly"});
  return runProgram(app, argc, argv, options, std::move(table), [&](Table& rows) {
    const World world(options);
    progress("scans made");
    measureOurs(options, world, rows);
#ifdef PCL_BSH_BENCH_OCTOMAP
    if (options.cell > 0.0) measureOctoMap(options, world, rows);
#endif
    return true;
  });
}
