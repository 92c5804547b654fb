// SPDX-License-Identifier: BSD-3-Clause
// Space that scanners saw to be empty: a machine on its way through a hall with pillars, scanned from several places.
// How long do verdicts take, how much of what is truly visible is recognised, and what is called free that is not?
// Beside it OctoMap, whose cells answer the same question.
#include "program.h"
#include "support/made_scans.h"

#include <pcl_bsh/seen/unseen_points.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
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
  std::vector<std::string> rooms = {"hall", "building"};
  std::string room;
  std::string building = PCL_BSH_SOURCE_DIR "/build/demo/building.ply";
  double step = 0.000667;     ///< between beams
  std::size_t points = 50000; ///< of the machine
  std::size_t poses = 100;
  double clearance = 0.05;
  double noise = 0.002;     ///< and none
  double cell = 0.05;       ///< of OctoMap
  double angle = 0.001;     ///< 0: measured
  std::size_t judged = 100; ///< every so many points
};

/// Cubes of a grid that are full, and all else is empty: what a scanned building leaves of itself.
class FullCells {
public:
  FullCells(const Eigen::AlignedBox3d& box, double edge)
  : low_(box.min()),
    edge_(edge),
    size_((box.sizes() / edge).array().ceil().cast<int>() + 1),
    full_(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]))
  {
  }

  void fill(const Eigen::Vector3d& place)
  {
    const Cell cell = cellOf(place);
    if (isInside(cell)) full_[numberOf(cell)] = true;
  }

  /// To the first full cell, or to the end of the grid. @pre the origin is in it and in no full cell
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const
  {
    Cell cell = cellOf(origin);
    Eigen::Array3d next, step;
    Eigen::Array3i turn;
    for (Eigen::Index k = 0; k < 3; ++k) {
      turn[k] = direction[k] < 0.0 ? -1 : 1;
      step[k] = edge_ / std::abs(direction[k]);
      const double wall = low_[k] + edge_ * (cell[k] + (turn[k] > 0 ? 1 : 0));
      next[k] = direction[k] == 0.0 ? std::numeric_limits<double>::infinity() : (wall - origin[k]) / direction[k];
    }
    for (;;) {
      Eigen::Index axis = 0;
      const double range = next.minCoeff(&axis);
      cell[axis] += turn[axis];
      if (!isInside(cell) || full_[numberOf(cell)]) return range;
      next[axis] += step[axis];
    }
  }

  /// To the nearest full cell, if it is within a cell's edge; negative in one.
  double distance(const Eigen::Vector3d& place) const
  {
    const Cell cell = cellOf(place);
    double nearest = edge_;
    for (int n = 0; n < 27; ++n) {
      const Cell near = cell + Cell(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
      if (!isInside(near)) return -1.0;
      if (!full_[numberOf(near)]) continue;
      const Eigen::Vector3d corner = low_ + edge_ * near.cast<double>().matrix();
      const Eigen::AlignedBox3d box(corner, corner + Eigen::Vector3d::Constant(edge_));
      nearest = std::min(nearest, box.contains(place) ? -1.0 : box.exteriorDistance(place));
    }
    return nearest;
  }

private:
  using Cell = Eigen::Array3i;

  Cell cellOf(const Eigen::Vector3d& place) const { return ((place - low_) / edge_).array().floor().cast<int>(); }
  bool isInside(const Cell& cell) const { return (cell >= 0).all() && (cell < size_).all(); }
  std::size_t numberOf(const Cell& cell) const
  {
    return (static_cast<std::size_t>(cell[0]) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(cell[1])) *
               static_cast<std::size_t>(size_[2]) +
           static_cast<std::size_t>(cell[2]);
  }

  Eigen::Vector3d low_;
  double edge_;
  Cell size_;
  std::vector<bool> full_;
};

/// The points of the demonstration's building (an ASCII PLY of x y z nx ny nz segment_index), each as a full cube.
FullCells readBuilding(const std::string& file)
{
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line) && line != "end_header") {
  }
  FullCells cells({Eigen::Vector3d(-25, -36, -3.5), Eigen::Vector3d(12, 26, 18)}, 0.25);
  std::size_t count = 0;
  for (; std::getline(in, line); ++count) {
    Eigen::Vector3d p;
    std::istringstream(line) >> p.x() >> p.y() >> p.z();
    cells.fill(p);
  }
  if (count == 0) throw std::invalid_argument(file + ": is not building.ply: see examples/demo/fetch_scans.sh");
  return cells;
}

struct World {
  explicit World(const Options& options) : hall(test::hallOfPillars(30.0, 18.0, 6.0, 4.5))
  {
    const bool in_hall = options.room == "hall";
    if (!in_hall) building.emplace(readBuilding(options.building));
    test::Random random(1);
    // A quarter turn each, and as many rows: some three million beams.
    const double quarter = 0.5 * test::kPi;
    struct Stand {
      double x, y, z, first;
    };
    const std::vector<Stand> stands = in_hall ? std::vector<Stand>{{0.5, 0.5, 1.7, 0.0},
                                                                   {29.5, 0.5, 1.7, quarter},
                                                                   {29.5, 17.5, 1.7, 2.0 * quarter},
                                                                   {0.5, 17.5, 1.7, 3.0 * quarter}}
                                              : std::vector<Stand>{{-18, -25, -1.5, -0.5 * quarter},
                                                                   {-18, -10, -1.5, -0.5 * quarter},
                                                                   {-18, 3, -1.5, -0.5 * quarter},
                                                                   {-18, 16, -1.5, -0.5 * quarter}};
    const double lowest = in_hall ? -0.65 : -0.35;
    for (const Stand& stand : stands) {
      test::MadeScanner scanner{{stand.x, stand.y, stand.z}, options.step, lowest, lowest + 0.85, options.noise};
      scanner.first = stand.first;
      scanner.last = stand.first + quarter;
      scanners.push_back(scanner);
      made.push_back(in_hall ? test::makeScan(hall, scanner, random) : test::makeScan(*building, scanner, random));
    }
    for (std::size_t s = 0; s < made.size(); ++s) {
      scans.push_back(made[s].scan(scanners[s].origin));
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
      pose.translation() = in_hall ? Eigen::Vector3d(2.25 + 25.0 * share, 6.75 + 4.5 * std::sin(12.0 * share), 0.3)
                                   : Eigen::Vector3d(-9.0 + 3.5 * std::sin(20.0 * share), -28.0 + 45.0 * share, -2.6);
      poses.push_back(pose);
    }
  }

  Eigen::Vector3d placed(std::size_t pose, std::size_t point) const
  {
    return poses[pose] * Eigen::Vector3f(&machine[3 * point]).cast<double>();
  }

  double distance(const Eigen::Vector3d& place) const
  {
    return building ? building->distance(place) : hall.distance(place);
  }

  /// Whether some scanner looks all round the ball.
  bool shows(const Eigen::Vector3d& place, double radius) const
  {
    return std::any_of(scanners.begin(), scanners.end(), [&](const test::MadeScanner& scanner) {
      const auto inside = [&](const Eigen::Vector3d& direction) { return scanner.turnsTo(direction); };
      return building ? test::shows(*building, scanner.origin, place, radius, 40, inside)
                      : test::shows(hall, scanner.origin, place, radius, 40, inside);
    });
  }

  test::MadeRoom hall;
  std::optional<FullCells> building; ///< instead
  std::vector<test::MadeScanner> scanners;
  std::vector<test::MadeScan> made;
  std::vector<ScanBeams> scans;
  std::vector<float> machine;
  std::vector<Eigen::Isometry3d> poses;
};

/// Against the room itself.
struct Judgement {
  std::size_t visible = 0, recognised = 0; ///< places that some scanner looks all round, and of these seen
  std::size_t seen = 0, wrong = 0;         ///< and of these not empty
};

/// All places that are called seen, and of every so many places whether they are visible.
Judgement judge(const Options& options, const World& world, const std::vector<std::vector<std::uint8_t>>& seen)
{
  Judgement judgement;
  for (std::size_t k = 0; k < world.poses.size(); ++k) {
    for (std::size_t i = 0; i < options.points; ++i) {
      const Eigen::Vector3d place = world.placed(k, i);
      const bool is_seen = seen[k][i] != 0;
      judgement.seen += is_seen;
      judgement.wrong += is_seen && !(world.distance(place) > options.clearance);
      if (i % options.judged != k % options.judged || !world.shows(place, options.clearance)) continue;
      ++judgement.visible;
      judgement.recognised += is_seen;
    }
  }
  return judgement;
}

void report(Table& table, const Options& options, const World& world, const std::string& name, double angle,
            double making, double asking, std::size_t bytes, const Judgement& judgement)
{
  table.add({options.room, text(1000.0 * options.noise), name, std::to_string(world.made[0].returns.size() / 3),
             text(1000.0 * angle), text(making), text(asking), text(static_cast<double>(bytes) / 1e6),
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
  std::vector<std::vector<Verdict>> verdicts;
  UnseenRequest request;
  request.clearance = options.clearance;
  std::vector<double> seconds;
  for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
    verdicts.assign(world.poses.size(), std::vector<Verdict>(options.points, Verdict::free));
    const Stopwatch asking;
    for (std::size_t k = 0; k < world.poses.size(); ++k)
      markUnseen(space, {machine, world.poses[k]}, request, verdicts[k]);
    seconds.push_back(asking.seconds());
  }
  const double asked = median(seconds);
  std::vector<std::vector<std::uint8_t>> seen;
  for (const std::vector<Verdict>& of_pose : verdicts) seen.push_back(maskOf(of_pose, true));
  report(table, options, world, "pcl_bsh", space.angle(0), made, asked, memory.bytes(), judge(options, world, seen));
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
    const Eigen::Vector3d& o = world.scanners[s].origin;
    map.insertPointCloud(cloud, {static_cast<float>(o.x()), static_cast<float>(o.y()), static_cast<float>(o.z())});
    progress("OctoMap: scan " + std::to_string(s));
  }
  const double made = making.seconds();
  std::vector<std::vector<std::uint8_t>> seen(world.poses.size(), std::vector<std::uint8_t>(options.points, 0));
  const Stopwatch asking;
  for (std::size_t k = 0; k < world.poses.size(); ++k)
    for (std::size_t i = 0; i < options.points; ++i) seen[k][i] = isFree(map, world.placed(k, i), options.clearance);
  report(table, options, world, "OctoMap", 0.0, made, asking.seconds(), memory.bytes(), judge(options, world, seen));
}
#endif

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("What scanners saw to be empty: time, and what is recognised.");
  app.add_option("--rooms", options.rooms, "hall, building")
      ->delimiter(',')
      ->check(CLI::IsMember({"hall", "building"}))
      ->capture_default_str();
  app.add_option("--building", options.building, "building.ply of the demonstration")->capture_default_str();
  app.add_option("--step", options.step, "between beams, in radians; four scanners turn by a quarter");
  app.add_option("--points", options.points, "of the machine");
  app.add_option("--poses", options.poses, "of its way");
  app.add_option("--clearance", options.clearance, "m");
  app.add_option("--noise", options.noise, "a third of how far ranges are off at most, m; and without any");
  app.add_option("--cell", options.cell, "of OctoMap, m; 0: without it");
  app.add_option("--angle", options.angle, "that a beam speaks for; 0: measured");
  Table table({"room", "noise [mm]", "method", "beams", "angle [mrad]", "make [s]", "ask [s]", "memory [MB]", "visible",
               "recognised", "called seen", "wrongly"});
  return runProgram(app, argc, argv, options, std::move(table), [&](Table& rows) {
    const std::string building = std::exchange(options.building, "");
    const std::vector<std::string> rooms = std::exchange(options.rooms, {});
    for (const std::string& room : rooms) {
      for (const double noise : {0.0, options.noise}) {
        Options one = options;
        one.room = room;
        one.building = building;
        one.noise = noise;
        const World world(one);
        progress(room + ": scans made");
        measureOurs(one, world, rows);
#ifdef PCL_BSH_BENCH_OCTOMAP
        if (options.cell > 0.0 && noise == 0.0) measureOctoMap(one, world, rows);
#endif
      }
    }
    return true;
  });
}
