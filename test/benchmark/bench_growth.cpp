// SPDX-License-Identifier: BSD-3-Clause
// How work and time grow where nearly all pairs of points are alike: by which power of the number of points.
#include "../support/adversarial_clouds.h"
#include "../support/made_meshes.h"
#include "program.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cmath>
#include <functional>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;
using test::HardPair;
using test::Random;
namespace hard = test::adversarial;

namespace {

struct Options : ProgramOptions {
  std::vector<std::size_t> sizes = {2000, 4000, 8000, 16000};
};

struct Corner {
  std::string name;
  std::function<HardPair(std::size_t)> make;
};

std::vector<Point3> cylinder(std::size_t n)
{
  Random random(1);
  std::vector<Point3> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = random.uniform(0, 6.2831853);
    points.push_back({std::cos(turn), std::sin(turn), random.uniform(-1, 1)});
  }
  return points;
}

std::vector<Point3> shellOf(std::size_t n, double radius)
{
  std::vector<Point3> points = hard::shells(n, 1, 0);
  for (Point3& p : points) p = hard::scaled(p, radius);
  return points;
}

/// A scene of 200 m with nine points in ten within 1e-7 m.
std::vector<Point3> crowd(std::size_t n, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Point3> points(n);
  for (std::size_t i = 0; i < n; ++i)
    points[i] =
        random.point([&] { return i % 10 == 0 ? random.uniform(-100, 100) : 30 + random.uniform(-1e-7, 1e-7); });
  return points;
}

const std::vector<Corner>& corners()
{
  static const std::vector<Corner> all = {
      {"a ring and its axis",
       [](std::size_t n) {
         return HardPair{hard::axis(n, 1), hard::helix(n, 1, 0)};
       }},
      {"a cylinder and its axis",
       [](std::size_t n) {
         return HardPair{hard::axis(n, 1), cylinder(n)};
       }},
      {"a shell about a tiny ball",
       [](std::size_t n) {
         return HardPair{shellOf(n, 1e-3), shellOf(n, 1)};
       }},
      {"a place that floats do not tell apart",
       [](std::size_t n) {
         return HardPair{crowd(n, 1), crowd(n, 2)};
       }},
  };
  return all;
}

struct Query {
  std::string name;
  std::function<Work(const SphereHierarchy&, const SphereHierarchy&, double)> ask;
};

TrajectoryRequest pathRequest(double clearance, bool distances)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  request.distances = distances;
  return request;
}

/// Five poses, a tenth of a micrometre in all.
std::vector<Eigen::Isometry3d> path()
{
  std::vector<Eigen::Isometry3d> poses(5, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < poses.size(); ++k) poses[k].translation().x() = 2e-8 * static_cast<double>(k);
  return poses;
}

const std::vector<Query>& queries()
{
  static const std::vector<Query> all = {
      {"flags",
       [](const SphereHierarchy& a, const SphereHierarchy& b, double clearance) {
         FlagsRequest request;
         request.clearance = clearance;
         return collisionFlags(a, b, request).work;
       }},
      {"closest pair",
       [](const SphereHierarchy& a, const SphereHierarchy& b, double) { return closestPair(a, b).work; }},
      {"path of 5 poses, flags",
       [](const SphereHierarchy& a, const SphereHierarchy& b, double clearance) {
         return collideAlong(a, b, path(), pathRequest(clearance, false)).work;
       }},
      {"path of 5 poses, distances",
       [](const SphereHierarchy& a, const SphereHierarchy& b, double clearance) {
         return collideAlong(a, b, path(), pathRequest(clearance, true)).work;
       }},
      {"distances of all points",
       [](const SphereHierarchy& a, const SphereHierarchy& b, double) { return pointDistances(a, b).work; }},
  };
  return all;
}

double stepsOf(const Work& work)
{
  return static_cast<double>(work.node_pairs + work.leaf_pairs + work.exact_decisions);
}

std::string exponent(double less, double more, std::size_t from, std::size_t to)
{
  return text(std::log(more / less) / std::log(static_cast<double>(to) / static_cast<double>(from)));
}

/// Rows of one query, of clouds of several sizes.
/// @param askOf(size) makes clouds; what it returns makes hierarchies, asks, and tells the seconds and the work
template <class AskOf>
void measure(const std::string& clouds, const std::string& query, const Options& options, Table& table,
             const AskOf& askOf)
{
  double first_steps = 0.0, first_seconds = 0.0;
  for (const std::size_t size : options.sizes) {
    progress(clouds + ", " + query + ", " + std::to_string(size) + " points");
    const auto ask = askOf(size);
    std::vector<double> seconds;
    double steps = 0.0;
    for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
      double taken = 0.0;
      steps = stepsOf(ask(taken));
      seconds.push_back(taken);
    }
    const bool is_first = size == options.sizes.front();
    if (is_first) first_steps = steps, first_seconds = median(seconds);
    table.add({clouds, query, std::to_string(size), text(steps / static_cast<double>(size)),
               text(1e3 * median(seconds)), is_first ? "-" : exponent(first_steps, steps, options.sizes.front(), size),
               is_first ? "-" : exponent(first_seconds, median(seconds), options.sizes.front(), size)});
  }
}

void measure(const Corner& corner, const Query& query, const Options& options, Table& table)
{
  measure(corner.name, query.name, options, table, [&](std::size_t size) {
    const HardPair pair = corner.make(size);
    const auto viewOfAll = [](const std::vector<Point3>& points) {
      return viewOf(points.front().data(), points.size());
    };
    // Just below the least distance; about the neighbours' distance where the least is 0.
    const SphereHierarchy some_a(viewOfAll(pair.a)), some_b(viewOfAll(pair.b));
    const double least = closestPair(some_a, some_b).distance, clearance = least > 1e-3 ? least * (1.0 - 1e-6) : 1e-9;
    return [&query, pair, viewOfAll, clearance](double& seconds) {
      const SphereHierarchy a(viewOfAll(pair.a)), b(viewOfAll(pair.b)); // work depends on what was asked before
      const Stopwatch watch;
      const Work work = query.ask(a, b, clearance);
      seconds = watch.seconds();
      return work;
    };
  });
}

/// Two square plates of cells of 0.2 that face each other, 0.25 apart.
struct Plates {
  std::string name;
  double aside = 0.04; ///< of the cells of one to those of the other
  double noise = 0.0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();   ///< of both
  Eigen::Isometry3d placed = Eigen::Isometry3d::Identity(); ///< their corners, rounded
};

void measurePlates(const Plates& plates, const Options& options, Table& table)
{
  const std::vector<Query> asked = {
      {"closest pair",
       [&](const SphereHierarchy& a, const SphereHierarchy& b, double) {
         return closestPair({a, plates.pose}, {b, plates.pose}).work;
       }},
      {"distances of all triangles",
       [&](const SphereHierarchy& a, const SphereHierarchy& b, double) {
         return pointDistances({a, plates.pose}, {b, plates.pose}).work;
       }},
      {"10 contacts",
       [&](const SphereHierarchy& a, const SphereHierarchy& b, double) {
         return nearestContacts({a, plates.pose}, {b, plates.pose}, {0.27, 10}).work;
       }},
  };
  for (const Query& query : asked) {
    measure(plates.name, query.name, options, table, [&](std::size_t size) {
      const auto cells = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(size) / 2)));
      const auto plate = [&](double aside, double height) {
        Random random(height > 0.0 ? 2 : 1);
        test::TestMesh mesh = test::gridMesh(cells, cells, [&](double u, double v) -> Point3 {
          return {0.2 * cells * u + aside, 0.2 * cells * v + aside, height + plates.noise * random.uniform(-1, 1)};
        });
        mesh.move(plates.placed);
        return mesh;
      };
      return [&query, low = plate(0, 0), high = plate(plates.aside, 0.25)](double& seconds) {
        const SphereHierarchy a(viewOf(low.trianglesView())), b(viewOf(high.trianglesView()));
        const Stopwatch watch;
        const Work work = query.ask(a, b, 0.0);
        seconds = watch.seconds();
        return work;
      };
    });
  }
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("How work and time of queries grow on clouds of which nearly all pairs are alike. Steps are tests of\n"
               "spheres and boxes, leaves compared and exact decisions; growth is the power of the number of points,\n"
               "against the first size.",
               "bench_growth");
  app.footer("Example: bench_growth --sizes 2000,4000,8000,16000 --clock cpu --csv growth.csv");
  app.add_option("--sizes", options.sizes, "points per cloud")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  Table table(
      {"clouds", "query", "points of each", "steps per point", "time [ms]", "growth of steps", "growth of time"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    for (const Corner& corner : corners())
      for (const Query& query : queries()) measure(corner, query, options, rows);
    const Eigen::Isometry3d none = Eigen::Isometry3d::Identity();
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()));
    for (const Plates& plates : {Plates{"flat plates of triangles", 0.04, 0.0, none, none},
                                 Plates{"the same, posed by one turn", 0.04, 0.0, turn, none},
                                 Plates{"the same, turned and rounded", 0.04, 0.0, none, turn},
                                 Plates{"corner over corner, posed by one turn", 0.0, 0.0, turn, none},
                                 Plates{"corner over corner, turned and rounded", 0.0, 0.0, none, turn},
                                 Plates{"with noise of 0.001", 0.04, 1e-3, none, none}})
      measurePlates(plates, options, rows);
    return true;
  });
}
