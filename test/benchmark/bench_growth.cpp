// SPDX-License-Identifier: BSD-3-Clause
// How work and time grow where nearly all pairs of points are alike: by which power of the number of points.
#include "../support/adversarial_clouds.h"
#include "program.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
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

/// Of a scene of 200 m nine points in ten within 1e-7 m.
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

void measure(const Corner& corner, const Query& query, const Options& options, Table& table)
{
  double first_steps = 0.0, first_seconds = 0.0;
  for (const std::size_t size : options.sizes) {
    progress(corner.name + ", " + query.name + ", " + std::to_string(size) + " points");
    const HardPair pair = corner.make(size);
    const auto viewOfAll = [](const std::vector<Point3>& points) {
      return viewOf(points.front().data(), points.size());
    };
    // Just below the least distance, and about that of neighbours where there is none.
    const SphereHierarchy some_a(viewOfAll(pair.a)), some_b(viewOfAll(pair.b));
    const double least = closestPair(some_a, some_b).distance, clearance = least > 1e-3 ? least * (1.0 - 1e-6) : 1e-9;
    std::vector<double> seconds;
    double steps = 0.0;
    for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
      const SphereHierarchy a(viewOfAll(pair.a)), b(viewOfAll(pair.b)); // work depends on what was asked before
      const Stopwatch watch;
      steps = stepsOf(query.ask(a, b, clearance));
      seconds.push_back(watch.seconds());
    }
    const bool is_first = size == options.sizes.front();
    if (is_first) first_steps = steps, first_seconds = median(seconds);
    table.add({corner.name, query.name, std::to_string(size), text(steps / static_cast<double>(size)),
               text(1e3 * median(seconds)), is_first ? "-" : exponent(first_steps, steps, options.sizes.front(), size),
               is_first ? "-" : exponent(first_seconds, median(seconds), options.sizes.front(), size)});
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
    return true;
  });
}
