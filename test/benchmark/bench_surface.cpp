// SPDX-License-Identifier: BSD-3-Clause
// Workload S: a scan is asked about the triangles of a mesh. How long, how much memory.
#include "harness.h"
#include "program.h"
#include "support/made_meshes.h"

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cmath>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::size_t scan = 1000000; ///< points
};

struct Row {
  const char* name;
  test::TestMesh mesh;
  double clearance; ///< m
};

/// A milling tool of 0.1 m: flutes wind about its axis.
test::TestMesh tool()
{
  return test::gridMesh(300, 110, [](double u, double v) -> Point3 {
    const double turn = 2 * M_PI * u, radius = 0.01 + 0.002 * std::sin(4 * turn + 40 * v);
    return {radius * std::cos(turn), radius * std::sin(turn), 0.1 * v};
  });
}

test::TestMesh terrain(std::uint32_t cells)
{
  return test::gridMesh(cells, cells, [](double u, double v) -> Point3 {
    return {100 * u, 100 * v, 2 * std::sin(20 * u) * std::cos(15 * v) + 0.1 * std::sin(300 * u * v)};
  });
}

/// Points about the mesh: half of them on it but for the noise of a scanner, half anywhere in its box.
std::vector<double> scanOf(const test::TestMesh& mesh, std::size_t count, double noise)
{
  test::Random random(5);
  Point3 low = mesh.vertices[0], high = low;
  for (const Point3& p : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  std::vector<double> scan;
  scan.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(
        random.uniform(0, static_cast<double>(mesh.triangles.size()) * (1 - 1e-12)))];
    const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = mesh.vertices[t[0]][k], b = mesh.vertices[t[1]][k], c = mesh.vertices[t[2]][k];
      const double on = a + u * (b - a) + v * (c - a) + random.uniform(-noise, noise);
      scan.push_back(i % 2 == 0 ? on : random.uniform(low[k], high[k]));
    }
  }
  return scan;
}

void measure(const Row& row, const Options& options, Table& table)
{
  progress(std::string(row.name) + ", clearance " + text(row.clearance));
  const std::vector<double> scan = scanOf(row.mesh, options.scan, row.clearance);
  FlagsRequest question;
  question.clearance = row.clearance;
  const SphereHierarchy points(viewOf(scan.data(), scan.size() / 3));
  points.buildAll(1);
  const MemoryPeak peak;
  const Stopwatch watch;
  const SphereHierarchy surface(viewOf(row.mesh.trianglesView()));
  const FlagsResult flags = collisionFlags({points}, {surface}, question);
  const double first = watch.seconds();
  const std::size_t bytes = peak.bytes();
  const Stopwatch again;
  collisionFlags({points}, {surface}, question);
  table.add({row.name, std::to_string(row.mesh.triangles.size()), text(row.clearance), text(first, 3),
             text(again.seconds(), 3), std::to_string(flags.colliding_a), text(static_cast<double>(bytes) / 1e6)});
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "Meshes asked about by a scan, half of whose points lie about the mesh, within the clearance. One thread. The "
      "scan's\nhierarchy is built before. peak: memory of the mesh's hierarchy and the query.",
      "bench_surface");
  app.footer("Example: bench_surface --clock cpu --csv surface.csv");
  app.add_option("--scan", options.scan, "points of the scan")->check(CLI::PositiveNumber)->capture_default_str();
  Table table(
      {"mesh", "triangles", "clearance [m]", "build and flags [s]", "flags again [s]", "colliding", "peak [MB]"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    const test::TestMesh wagon = test::boxMesh(26, 3, 3), sphere = test::sphereMesh(1, 200), mill = tool();
    const test::TestMesh fine = terrain(710);
    for (const double clearance : {0.25, 0.025}) measure({"wagon", wagon, clearance}, options, rows);
    for (const double clearance : {0.5, 0.05}) measure({"sphere", sphere, clearance}, options, rows);
    for (const double clearance : {0.005, 0.0005}) measure({"tool", mill, clearance}, options, rows);
    for (const double clearance : {5.0, 0.5}) measure({"terrain", fine, clearance}, options, rows);
    return true;
  });
}
