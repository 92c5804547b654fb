// SPDX-License-Identifier: BSD-3-Clause
// Workload C: what the contacts of a body's step cost. A statue rolls over a scan, balls over a mesh, beside Bullet's
// mesh where Bullet was found.
#include "program.h"
#include "workload/random.h"
#include "workload/statue.h"

#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/pairs/closest_pair.h>

#if PCL_BSH_BENCH_BULLET
#include <btBulletCollisionCommon.h>
#endif

#include <algorithm>
#include <cmath>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::size_t scan = 10000000;
  std::size_t body = 100000;
  std::size_t triangles = 500000;
  std::size_t balls = 2000;
  std::size_t steps = 1000;
  std::string part = "all";
};

double heightAt(double x, double y)
{
  return 0.6 * std::sin(0.31 * x) * std::cos(0.23 * y) + 0.15 * std::sin(1.7 * x + 0.8 * y) + 0.03 * std::sin(7 * y);
}

/// x y z of scanned ground about the origin, in rows of 2 cm.
std::vector<float> ground(std::size_t count)
{
  constexpr double spacing = 0.02, noise = 0.002;
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
  const double reach = 0.5 * spacing * static_cast<double>(side);
  Random random(7);
  std::vector<float> xyz;
  xyz.reserve(3 * side * side);
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      const double x = spacing * (static_cast<double>(i) + random.uniform(0, 1)) - reach;
      const double y = spacing * (static_cast<double>(j) + random.uniform(0, 1)) - reach;
      const double z = heightAt(x, y) + noise * random.uniform(-1, 1);
      for (const double at : {x, y, z}) xyz.push_back(static_cast<float>(at));
    }
  return xyz;
}

struct Mesh {
  std::vector<float> xyz;
  std::vector<Triangle> triangles;
  TrianglesView view() const
  {
    return {viewOf(xyz.data(), xyz.size() / 3), triangles.front().data(), triangles.size()};
  }
};

/// This ground as a surface of edges of 20 cm.
Mesh groundMesh(std::size_t count)
{
  constexpr double spacing = 0.2;
  const auto side = static_cast<std::uint32_t>(std::sqrt(0.5 * static_cast<double>(count)));
  Mesh mesh;
  for (std::uint32_t i = 0; i <= side; ++i)
    for (std::uint32_t j = 0; j <= side; ++j) {
      const double x = spacing * (i - 0.5 * side), y = spacing * (j - 0.5 * side);
      for (const double at : {x, y, heightAt(x, y)}) mesh.xyz.push_back(static_cast<float>(at));
    }
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::uint32_t at = i * (side + 1) + j, next = at + side + 1;
      mesh.triangles.push_back({at, next, at + 1});
      mesh.triangles.push_back({at + 1, next, next + 1});
    }
  return mesh;
}

std::vector<float> statueXyz(std::size_t count)
{
  std::vector<float> xyz;
  for (const Point& p : statue(count, 1)) xyz.insert(xyz.end(), {p.x, p.y, p.z});
  return xyz;
}

/// A body that rolls along a bent way, at `gap` from the ground in each pose.
std::vector<Eigen::Isometry3d> rollingPoses(const SphereHierarchy& body, const SphereHierarchy& below, double gap,
                                            std::size_t steps)
{
  progress("finding " + std::to_string(steps) + " poses");
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < steps; ++i) {
    const double way = 0.01 * static_cast<double>(i);
    const double x = 3.0 * std::sin(0.2 * way), y = 0.5 * way - 2.5;
    Eigen::Isometry3d pose(Eigen::Translation3d(x, y, heightAt(x, y) + 1.2));
    pose.rotate(Eigen::AngleAxisd(way, Eigen::Vector3d(-1, 0.4, 0.1).normalized()));
    for (int k = 0; k < 12; ++k) {
      const double distance = closestPair({body, pose}, {below}).distance;
      pose.translation().z() -= distance - gap;
      if (std::abs(distance - gap) < 1e-4) break;
    }
    poses.push_back(pose);
  }
  return poses;
}

/// The first tenth of the steps is not counted.
void addRow(Table& table, const std::string& what, const std::string& size, const std::string& racer,
            const std::vector<double>& seconds, const std::string& remark)
{
  std::vector<double> later(seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 10), seconds.end());
  table.add({what, size, racer, std::to_string(later.size()), text(1e3 * median(later)),
             text(1e3 * quantile(later, 0.99)), text(1e3 * quantile(later, 1.0)), remark});
}

void timeManifolds(const Collider& body, const Collider& below, const std::vector<Eigen::Isometry3d>& poses,
                   std::size_t most, const std::string& what, const std::string& size, Table& table)
{
  ManifoldRequest request;
  request.margin = 0.01;
  if (body.spacing() == 0.0 || below.spacing() == 0.0) request.thickness = 0.001;
  request.most = most;
  Manifold now;
  request.previous = &now;
  std::vector<double> seconds;
  std::size_t contacts = 0;
  for (const Eigen::Isometry3d& pose : poses) {
    const Stopwatch watch;
    contactManifold({body, pose}, {below}, request, now);
    seconds.push_back(watch.seconds());
    contacts += now.contacts.size();
  }
  addRow(table, what + ", k = " + std::to_string(most), size, "pcl_bsh", seconds,
         text(static_cast<double>(contacts) / static_cast<double>(poses.size())) + " contacts");
}

void rollOverScan(const Options& options, Table& table)
{
  progress("making a scan of " + std::to_string(options.scan) + " points");
  const std::vector<float> scan = ground(options.scan), xyz = statueXyz(options.body);
  const SphereHierarchy below(viewOf(scan.data(), scan.size() / 3)), body(viewOf(xyz.data(), xyz.size() / 3));
  const Collider scan_collider(below), body_collider(body);
  const double rest = 0.5 * std::max(scan_collider.spacing(), body_collider.spacing());
  timeManifolds(body_collider, scan_collider, rollingPoses(body, below, rest, options.steps), 8,
                "body rolls over a scan", std::to_string(options.body) + " on " + std::to_string(scan.size() / 3),
                table);
}

#if PCL_BSH_BENCH_BULLET
/// Spheres in a compound over Bullet's tree of triangles: its broad and narrow phase, one step after another.
void timeBullet(const std::vector<float>& middles, float radius, const Mesh& mesh,
                const std::vector<Eigen::Isometry3d>& poses, const std::string& size, Table& table)
{
  std::vector<int> corners;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) corners.push_back(static_cast<int>(corner));
  btTriangleIndexVertexArray triangles(static_cast<int>(mesh.triangles.size()), corners.data(), 3 * sizeof(int),
                                       static_cast<int>(mesh.xyz.size() / 3), const_cast<float*>(mesh.xyz.data()),
                                       3 * sizeof(float));
  btBvhTriangleMeshShape below(&triangles, true);
  btSphereShape ball(radius);
  btCompoundShape body;
  for (std::size_t i = 0; i < middles.size(); i += 3)
    body.addChildShape(btTransform(btQuaternion::getIdentity(), {middles[i], middles[i + 1], middles[i + 2]}), &ball);
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broad_phase;
  btCollisionWorld world(&dispatcher, &broad_phase, &configuration);
  btCollisionObject fixed, moving;
  fixed.setCollisionShape(&below);
  moving.setCollisionShape(&body);
  for (btCollisionObject* object : {&fixed, &moving}) object->setContactProcessingThreshold(0.01f);
  world.addCollisionObject(&fixed, btBroadphaseProxy::StaticFilter, btBroadphaseProxy::AllFilter);
  world.addCollisionObject(&moving);
  std::vector<double> seconds;
  std::size_t contacts = 0;
  for (const Eigen::Isometry3d& pose : poses) {
    const Eigen::Quaternionf turn(pose.linear().cast<float>());
    const Eigen::Vector3f at = pose.translation().cast<float>();
    const Stopwatch watch;
    moving.setWorldTransform(btTransform({turn.x(), turn.y(), turn.z(), turn.w()}, {at.x(), at.y(), at.z()}));
    world.performDiscreteCollisionDetection();
    seconds.push_back(watch.seconds());
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i)
      contacts += static_cast<std::size_t>(dispatcher.getManifoldByIndexInternal(i)->getNumContacts());
  }
  world.removeCollisionObject(&moving);
  world.removeCollisionObject(&fixed);
  addRow(table, "balls roll over a mesh", size, "bullet", seconds,
         text(static_cast<double>(contacts) / static_cast<double>(poses.size())) + " contacts");
}
#endif

void rollBalls(const Options& options, Table& table)
{
  progress("making a mesh of " + std::to_string(options.triangles) + " triangles");
  const Mesh mesh = groundMesh(options.triangles);
  const std::vector<float> middles = statueXyz(options.balls);
  const std::vector<float> radii(middles.size() / 3, 0.05f);
  PointsView balls = viewOf(middles.data(), radii.size());
  balls.radii = radii.data();
  const SphereHierarchy below(viewOf(mesh.view())), body(balls);
  const Collider mesh_collider(below), body_collider(body);
  const std::vector<Eigen::Isometry3d> poses = rollingPoses(body, below, 0.001, options.steps);
  const std::string size = std::to_string(options.balls) + " on " + std::to_string(mesh.triangles.size());
  for (const std::size_t most : {8u, 64u})
    timeManifolds(body_collider, mesh_collider, poses, most, "balls roll over a mesh", size, table);
#if PCL_BSH_BENCH_BULLET
  timeBullet(middles, radii.front(), mesh, poses, size, table);
#endif
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("What the contacts of a body's step cost while it rolls.\n"
               "Hierarchies warm, one thread; the first tenth of the steps is not counted.",
               "bench_contacts");
  app.footer("Example: bench_contacts --part balls --csv balls.csv");
  app.add_option("--scan", options.scan, "points of the scan that the body rolls over")->capture_default_str();
  app.add_option("--body", options.body, "points of the body")->capture_default_str();
  app.add_option("--triangles", options.triangles, "of the mesh that balls roll over")->capture_default_str();
  app.add_option("--balls", options.balls, "of that body")->capture_default_str();
  app.add_option("--steps", options.steps, "of each row")->check(CLI::Range(20, 1000000))->capture_default_str();
  app.add_option("--part", options.part, "which rows")
      ->check(CLI::IsMember({"all", "scan", "balls"}))
      ->capture_default_str();
  Table table({"what", "size", "racer", "steps", "median [ms]", "p99 [ms]", "max [ms]", "remark"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    const auto isAsked = [&](const char* part) { return options.part == "all" || options.part == part; };
    if (isAsked("scan")) rollOverScan(options, rows);
    if (isAsked("balls")) rollBalls(options, rows);
    return true;
  });
}
