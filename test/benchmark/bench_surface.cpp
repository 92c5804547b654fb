// SPDX-License-Identifier: BSD-3-Clause
// Workload S: questions about meshes, ours beside the libraries that answer some of them. They are about a million scan
// points, a mesh and itself shifted, two bodies, and a large mesh that a scan touches at a corner.
#include "harness.h"
#include "peer/surface_peer.h"
#include "program.h"
#include "workload/path_scene.h"
#include "workload/surfaces.h"

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/bounds.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/solid.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::size_t scan = 1000000;    ///< points
  std::size_t corner = 10000000; ///< triangles of the large mesh
  double budget = 2.0;           ///< s that a library is asked for, at each row
  std::vector<std::string> only; ///< meshes
  bool peers = true;
};

struct Mesh {
  std::string name;
  TestMesh mesh;
};

/// One row of the table, as far as it is known.
struct Measured {
  double build = 0.0, query = 0.0, again = std::numeric_limits<double>::quiet_NaN();
  double asked = 1.0; ///< share of the questions; times are those of all, in proportion
  std::size_t bytes = 0;
  std::size_t wrong = 0; ///< answers that differ from ours, of those asked
};

class Rows {
public:
  Rows(Table& table, const Options& options) : table_(table), options_(options) {}

  void add(const std::string& question, const Mesh& mesh, const std::string& racer, const Measured& m) const
  {
    const double triangles = static_cast<double>(mesh.mesh.triangles.size());
    table_.add({question, mesh.name, std::to_string(mesh.mesh.triangles.size()), racer, text(m.build), text(m.query),
                text(m.build + m.query), std::isnan(m.again) ? "" : text(m.again), text(m.asked),
                text(static_cast<double>(m.bytes) / triangles), std::to_string(m.wrong)});
    progress(question + ", " + mesh.name + ", " + racer + ": " + text(m.build + m.query) + " s");
  }

  /// Measures ours: the least of several. @param make makes the input anew. @param ask takes it
  template <class Make, class Ask>
  void ours(const std::string& question, const Mesh& mesh, const Make& make, const Ask& ask) const
  {
    Measured best;
    for (unsigned i = 0; i < options_.repeat; ++i) {
      const MemoryPeak peak;
      const Stopwatch building;
      const auto made = make();
      const double build = building.seconds();
      const Stopwatch asking;
      ask(made);
      const double query = asking.seconds();
      const std::size_t bytes = peak.bytes();
      const Stopwatch asking_again;
      ask(made);
      const double again = asking_again.seconds();
      if (i == 0 || build + query < best.build + best.query) best.build = build, best.query = query;
      best.again = i == 0 ? again : std::min(best.again, again);
      best.bytes = i == 0 ? bytes : std::min(best.bytes, bytes);
    }
    add(question, mesh, "pcl_bsh", best);
  }

  /// Measures every library that can answer: as many questions as the budget has room for.
  /// @param ask takes a peer and a range of questions, returns how many answers are wrong, or nothing
  template <class Ask>
  void peers(const std::string& question, const Mesh& mesh, bool labels, std::size_t questions, std::size_t batch,
             const Ask& ask) const
  {
    if (!options_.peers) return;
    for (const SurfaceLibrary& library : surfaceLibraries()) {
      if (library.labels != labels) continue;
      Measured m;
      const MemoryPeak peak;
      const Stopwatch building;
      const auto peer = library.make(mesh.mesh.vertices, mesh.mesh.triangles);
      m.build = building.seconds();
      m.bytes = peak.bytes();
      std::size_t asked = 0;
      bool can = true;
      for (; can && asked < questions && m.query < options_.budget; asked += std::min(batch, questions - asked)) {
        const Stopwatch asking;
        const std::optional<std::size_t> wrong = ask(*peer, asked, std::min(asked + batch, questions));
        m.query += asking.seconds();
        can = wrong.has_value();
        m.wrong += wrong.value_or(0);
      }
      if (!can) continue;
      m.asked = static_cast<double>(asked) / static_cast<double>(questions);
      m.query /= m.asked;
      add(question, mesh, library.name, m);
    }
  }

private:
  Table& table_;
  const Options& options_;
};

constexpr std::size_t kBatch = 512; // points

void askFlags(const Rows& rows, const Mesh& mesh, const std::vector<double>& scan, const SphereHierarchy& points,
              double d, const std::string& question)
{
  FlagsResult flags;
  rows.ours(
      question, mesh, [&] { return SphereHierarchy(viewOf(mesh.mesh.trianglesView())); },
      [&](const SphereHierarchy& surface) { flags = collisionFlags({points}, {surface}, FlagsRequest(d)); });
  std::vector<std::uint8_t> found(kBatch);
  rows.peers(question, mesh, false, scan.size() / 3, kBatch,
             [&](SurfacePeer& peer, std::size_t begin, std::size_t end) -> std::optional<std::size_t> {
               if (!peer.flag(&scan[3 * begin], end - begin, d, found.data())) return {};
               std::size_t wrong = 0;
               for (std::size_t i = begin; i < end; ++i)
                 if ((found[i - begin] != 0) != (flags.a[i] == Verdict::colliding)) ++wrong;
               return wrong;
             });
}

void askDistances(const Rows& rows, const Mesh& mesh, const std::vector<double>& scan, const SphereHierarchy& points)
{
  PointDistances truth;
  rows.ours(
      "distances", mesh, [&] { return SphereHierarchy(viewOf(mesh.mesh.trianglesView())); },
      [&](const SphereHierarchy& surface) { truth = pointDistances({points}, {surface}); });
  const double most = 1e-9 * sizeOf(mesh.mesh); // wrong beyond that
  std::vector<double> found(kBatch);
  rows.peers("distances", mesh, false, scan.size() / 3, kBatch,
             [&](SurfacePeer& peer, std::size_t begin, std::size_t end) -> std::optional<std::size_t> {
               if (!peer.distances(&scan[3 * begin], end - begin, found.data())) return {};
               std::size_t wrong = 0;
               for (std::size_t i = begin; i < end; ++i)
                 if (!(std::abs(found[i - begin] - truth.distance[i]) <= most)) ++wrong;
               return wrong;
             });
}

void askLabels(const Rows& rows, const Mesh& mesh, const std::vector<double>& scan, const SphereHierarchy& points)
{
  LabelsResult truth;
  rows.ours(
      "inside", mesh, [&] { return Solid(mesh.mesh.trianglesView()); },
      [&](const Solid& solid) { labelPoints({points}, {solid}, truth); });
  std::vector<std::uint8_t> found(kBatch);
  rows.peers("inside", mesh, true, scan.size() / 3, kBatch,
             [&](SurfacePeer& peer, std::size_t begin, std::size_t end) -> std::optional<std::size_t> {
               if (!peer.inside(&scan[3 * begin], end - begin, found.data())) return {};
               std::size_t wrong = 0;
               for (std::size_t i = begin; i < end; ++i)
                 if ((found[i - begin] != 0) != (truth.labels[i] != labelOf(Label::outside))) ++wrong;
               return wrong;
             });
}

/// A mesh and itself, moved by so many clearances: of both, which triangles collide.
void askItself(const Rows& rows, const Mesh& mesh)
{
  const double d = sizeOf(mesh.mesh) / 400;
  for (const double clearances : {0.5, 1.0, 2.0, 4.0, 40.0}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = clearances * d * Eigen::Vector3d(1, 2, 3).normalized();
    rows.ours(
        "itself, moved by " + text(clearances) + " clearances", mesh,
        [&] {
          return std::array<SphereHierarchy, 2>{SphereHierarchy(viewOf(mesh.mesh.trianglesView())),
                                                SphereHierarchy(viewOf(mesh.mesh.trianglesView()))};
        },
        [&](const std::array<SphereHierarchy, 2>& both) {
          collisionFlags({both[0]}, {both[1], pose}, FlagsRequest(d, Flagged::both));
        });
  }
}

/// Two bodies at so many poses about each other, most of them near misses.
void askBodies(const Rows& rows, const Mesh& mesh)
{
  constexpr std::size_t kPoses = 100;
  test::Random random(17);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < kPoses; ++i) {
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    poses.push_back(Eigen::Isometry3d::Identity());
    poses.back().translation() = random.uniform(0.19, 0.26) * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0) +
                                 Eigen::Vector3d(0, 0, random.uniform(-0.5, 0.5));
  }
  const auto make = [&] { return SphereHierarchy(viewOf(mesh.mesh.trianglesView())); };
  std::vector<double> truth(kPoses);
  rows.ours("two bodies, smallest distance", mesh, make, [&](const SphereHierarchy& body) {
    for (std::size_t i = 0; i < kPoses; ++i) truth[i] = closestPair({body}, {body, poses[i]}).distance;
  });
  rows.ours("two bodies, any", mesh, make, [&](const SphereHierarchy& body) {
    for (std::size_t i = 0; i < kPoses; ++i) anyCollision({body}, {body, poses[i]}, {0.0, {}});
  });
  const auto shift = [&](std::size_t i) {
    const Eigen::Vector3d t = poses[i].translation();
    return std::array<double, 3>{t.x(), t.y(), t.z()};
  };
  rows.peers("two bodies, smallest distance", mesh, false, kPoses, 1,
             [&](SurfacePeer& peer, std::size_t i, std::size_t) -> std::optional<std::size_t> {
               double found = 0.0;
               if (!peer.distance(shift(i), &found)) return {};
               return std::abs(found - truth[i]) <= 1e-9 ? 0 : 1;
             });
  rows.peers("two bodies, any", mesh, false, kPoses, 1,
             [&](SurfacePeer& peer, std::size_t i, std::size_t) -> std::optional<std::size_t> {
               bool found = false;
               if (!peer.any(shift(i), 0.0, &found)) return {};
               return found == (truth[i] <= 0.0) ? 0 : 1;
             });
}

/// A large mesh, and a scan that touches it near one corner.
void askCorner(const Rows& rows, std::size_t triangles)
{
  const auto cells = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 2));
  const Mesh terrain{"terrain", test::gridMesh(cells, cells, [](double u, double v) -> Point3 {
                       return {100 * u, 100 * v, 2 * std::sin(20 * u) * std::cos(15 * v) + 0.1 * std::sin(300 * u * v)};
                     })};
  test::Random random(19);
  std::vector<double> scan;
  for (int i = 0; i < 10000; ++i)
    for (const double most : {1.0, 1.0, 0.5}) scan.push_back(random.uniform(0.0, most));
  const SphereHierarchy points(viewOf(scan.data(), scan.size() / 3));
  rows.ours(
      "a corner", terrain, [&] { return SphereHierarchy(viewOf(terrain.mesh.trianglesView())); },
      [&](const SphereHierarchy& surface) { collisionFlags({points}, {surface}, FlagsRequest(0.05)); });
}

/// The box of a wagon along its way through a tunnel, as its 12 triangles, and as points on them.
void askWay(const Rows& rows, double scale)
{
  const PathScene tunnel = pathScene("tunnel", scale);
  Bounds bounds;
  for (const Point& p : tunnel.model) bounds.add({p.x, p.y, p.z});
  Point3 size;
  for (std::size_t k = 0; k < 3; ++k) size[k] = bounds.high[k] - bounds.low[k];
  Mesh box{"wagon", test::boxMesh(size[0], size[1], size[2])};
  box.mesh.move(Eigen::Isometry3d(Eigen::Translation3d(bounds.low[0], bounds.low[1], bounds.low[2])));
  const std::vector<double> on_it = scanOf(box.mesh, 2 * tunnel.model.size(), 0.0, 7);
  std::vector<double> points; // every other one is on the surface
  for (std::size_t i = 0; i < on_it.size(); i += 6) points.insert(points.end(), &on_it[i], &on_it[i] + 3);
  const SphereHierarchy scan(viewOf(&tunnel.scan.data()->x, tunnel.scan.size()));
  scan.buildAll(1);
  TrajectoryRequest request;
  request.clearance = tunnel.clearance;
  for (const std::string question : {"at each pose", "swept by 1 cm"}) {
    const auto along = [&](const SphereHierarchy& model) { collideAlong({scan}, model, tunnel.poses, request); };
    rows.ours(
        question, box, [&] { return SphereHierarchy(viewOf(box.mesh.trianglesView())); }, along);
    rows.ours(
        question + ", as " + std::to_string(points.size() / 3) + " points", box,
        [&] { return SphereHierarchy(viewOf(points.data(), points.size() / 3)); }, along);
    request.swept = 0.01;
  }
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "Meshes asked about by a scan, half of whose points lie about the mesh, by themselves, and by each other. One "
      "thread.\nThe scan's hierarchy is built before. Each library answers as much as the budget has room for; its "
      "times are those of\nall, in proportion. bytes: the most that was held, less what was before, for each "
      "triangle. wrong: answers that differ\nfrom ours, which are exact; of distances, by 1e-9 of the size.",
      "bench_surface");
  app.footer("Example: bench_surface --clock cpu --csv surface.csv");
  app.add_option("--scan", options.scan, "points of the scan")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--corner", options.corner, "triangles of the large mesh; 0: none")->capture_default_str();
  app.add_option("--budget", options.budget, "seconds that a library is asked for, at each row")->capture_default_str();
  app.add_option("--mesh", options.only, "only these: box, part, bumpy, tubes, statue, rod, knot, wagon")
      ->delimiter(',');
  app.add_flag("!--no-peers", options.peers, "ours alone");
  Table table({"question", "mesh", "triangles", "racer", "build [s]", "query [s]", "both [s]", "again [s]", "asked",
               "bytes / triangle", "wrong"});
  return runProgram(app, argc, argv, options, table, [&](Table& into) {
    const Rows rows(into, options);
    const auto wanted = [&](const std::string& name) {
      return options.only.empty() || std::find(options.only.begin(), options.only.end(), name) != options.only.end();
    };
    const auto withScan = [&](const std::string& name, const std::function<TestMesh()>& make, bool distances) {
      if (!wanted(name)) return;
      const Mesh mesh{name, make()};
      const double size = sizeOf(mesh.mesh);
      for (const double part : {400.0, 40.0}) {
        const double d = size / part;
        const std::vector<double> scan = scanOf(mesh.mesh, options.scan, 2 * d, 5);
        const SphereHierarchy points(viewOf(scan.data(), scan.size() / 3));
        points.buildAll(1);
        askFlags(rows, mesh, scan, points, d, "within 1/" + text(part) + " of its size");
        if (part > 100.0 && distances) askDistances(rows, mesh, scan, points);
        if (part > 100.0) askLabels(rows, mesh, scan, points);
      }
    };
    withScan(
        "box", [] { return test::boxMesh(1, 0.6, 0.4); }, true);
    withScan("part", machinedPart, true);
    withScan("bumpy", bumpySurface, false);
    withScan("tubes", thinTubes, false);
    if (wanted("part")) askBodies(rows, {"part", machinedPart()});
    if (wanted("statue")) askItself(rows, {"statue", statueMesh()});
    if (wanted("rod")) askItself(rows, {"rod", connectingRod()});
    if (wanted("knot")) askItself(rows, {"knot", knottedTube()});
    if (wanted("wagon")) askWay(rows, 0.1);
    if (options.corner > 0 && options.only.empty()) askCorner(rows, options.corner);
    return true;
  });
}
