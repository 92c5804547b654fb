// SPDX-License-Identifier: BSD-3-Clause
// Counted costs of each query, on inputs that never change: the table work_counts.txt, to the last count.
//
// A changed count is no mistake by itself. Judge it by three questions: was a change of the search meant, do the tests
// of answers pass, and do the counts fall, or is what rises paid for by what falls (test/benchmark/count_instructions)?
// Then write the table anew: PCL_BSH_WRITE_WORK_COUNTS=1 query_test --gtest_filter='WorkCounts.*', and commit it with
// the change. A count that changes where none was meant to is a mistake that answers do not show: a bound that is too
// wide, a case that never holds, a pair that is decided twice.
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/trace.h>
#include <pcl_bsh/scene/scene.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/solid/enclosure.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/made_meshes.h"
#include "support/meshes.h"
#include "support/question.h"
#include "support/random_clouds.h"
#include "support/work_counts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

/// The table: a line for each question about each kind of input.
class Table {
public:
  void add(const std::string& name, const std::map<std::string, std::uint64_t>& counts)
  {
    for (const auto& [count, value] : counts) rows_[name][count] += value;
  }

  void add(const std::string& name, const Work& work) { add(name, test::countsOf(work)); }

  /// Adds a scene's costs, by effect.
  void add(const std::string& name, const SceneResult& result)
  {
    for (std::size_t i = 0; i < kEffects; ++i) {
      const EffectCost& cost = result.costs[i];
      if (cost.pairs + cost.reused == 0) continue;
      const std::string effect = name + " " + nameOf(static_cast<Effect>(i));
      add(effect, cost.work);
      add(effect, {{"pairs", cost.pairs}, {"reused", cost.reused}});
    }
    const BroadPhaseCost& broad = result.broad_phase;
    add(name + " broad phase", {{"moved", broad.moved},
                                {"voxels_left", broad.voxels_left},
                                {"voxels_entered", broad.voxels_entered},
                                {"box_tests", broad.box_tests},
                                {"candidates", broad.candidates},
                                {"pairs_sharing", broad.pairs_sharing}});
  }

  /// Compares it with the lines of the file that begin with `kind`, or writes these anew.
  void check(const std::string& kind) const
  {
    const std::string file = PCL_BSH_SOURCE_DIR "/test/query/work_counts.txt";
    std::map<std::string, std::string> stored, now;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) stored[line.substr(0, line.find(':'))] = line;
    for (const auto& [name, counts] : rows_) {
      std::string line = kind + ", " + name + ":";
      for (const auto& [count, value] : counts)
        if (value != 0) line += " " + count + " " + std::to_string(value);
      now[kind + ", " + name] = line;
    }
    const auto ours = [&](const std::string& name) { return name.compare(0, kind.size() + 1, kind + ",") == 0; };
    if (std::getenv("PCL_BSH_WRITE_WORK_COUNTS") != nullptr) {
      std::erase_if(stored, [&](const auto& row) { return ours(row.first); });
      stored.merge(now);
      std::ofstream out(file);
      for (const auto& [name, line] : stored) out << line << '\n';
      return;
    }
    for (const auto& [name, line] : now) EXPECT_EQ(line, stored[name]);
    for (const auto& [name, line] : stored)
      EXPECT_TRUE(!ours(name) || now.count(name) != 0) << "no longer asked: " << line;
  }

private:
  std::map<std::string, std::map<std::string, std::uint64_t>> rows_;
};

const Accuracy kAccuracies[] = {Accuracy::exact(), Accuracy::tolerance(0.05), Accuracy::level(2),
                                Accuracy::nodePairs(300)};

/// Poses of b on its way: some steps, a turn by an eighth, and back.
std::vector<Eigen::Isometry3d> wayOf(const test::Scene& scene)
{
  const Eigen::Quaterniond turn(12.0 / 13.0, 0, 5.0 / 13.0, 0);
  std::vector<Eigen::Isometry3d> poses(7, scene.pose_b);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    poses[k].translation() += Eigen::Vector3d(0.25, -0.125, 0.0625) * static_cast<double>(k % 4) * 0.5;
    if (k >= 3) poses[k].linear() = poses[k].linear() * turn.toRotationMatrix();
  }
  return poses;
}

/// Asks about two clouds all that can be asked of them, each of hierarchies that nothing has built yet.
class Asked {
public:
  Asked(test::Scene scene, Table& table) : scene_(std::move(scene)), table_(table) {}

  void all()
  {
    pairs();
    flags();
    distances();
    paths();
    neighbors();
  }

  void pairs()
  {
    for (const Accuracy& accuracy : kAccuracies) {
      ask("any " + accuracy.text(), [&](auto& a, auto& b) {
        return anyCollision(a, b, {scene_.clearance, accuracy}).work;
      });
      ask("any, apart, " + accuracy.text(), [&](const Placed& a, Placed b) {
        b.pose.translation() += Eigen::Vector3d(1.75, 0.25, 0.0);
        return anyCollision(a, b, {scene_.clearance, accuracy}).work;
      });
      ask("closest " + accuracy.text(), [&](auto& a, auto& b) { return closestPair(a, b, {accuracy}).work; });
    }
    ask("contacts", [&](auto& a, auto& b) { return nearestContacts(a, b, {scene_.clearance, 20}).work; });
    ask("pairs", [&](auto& a, auto& b) { return pairsWithin(a, b, {scene_.clearance, 300}).work; });
    ask("trace", [&](auto& a, auto& b) { return traceCollision(a, b, {scene_.clearance}).result.work; });
  }

  void flags()
  {
    for (const Accuracy& accuracy : kAccuracies)
      for (const Flagged side : {Flagged::a, Flagged::both}) {
        const std::string name = std::string(side == Flagged::a ? "flags " : "flags of both ") + accuracy.text();
        ask(name, [&](auto& a, auto& b) { return collisionFlags(a, b, {scene_.clearance, side, {accuracy}}).work; });
      }
    if (!scene_.b.view().triangles) guardedFlags();
    ask("indices", [&](auto& a, auto& b) { return collidingIndices(a, b, {scene_.clearance, Flagged::both}).work; });
  }

  void guardedFlags()
  {
    ask("flags, guarded", [&](auto& a, auto& b) {
      const std::vector<float> spacings(b.hierarchy().view().count, 0.0625f);
      FlagsRequest request(scene_.clearance);
      request.spacings_of_b = spacings.data();
      return collisionFlags(a, b, request).work;
    });
  }

  void distances()
  {
    for (const Accuracy& accuracy : kAccuracies)
      for (const double most : {scene_.clearance + 0.125, std::numeric_limits<double>::infinity()}) {
        PointDistancesRequest request;
        request.accuracy = accuracy;
        request.max_distance = most;
        const std::string name = std::string(most < 1e9 ? "distances up to, " : "distances ") + accuracy.text();
        ask(name, [&](auto& a, auto& b) { return pointDistances(a, b, request).work; });
      }
    ask("distances of both", [&](auto& a, auto& b) {
      const SymmetricDistances found = symmetricDistances(a, b);
      Work work = found.a.work;
      return work += found.b.work;
    });
    ask("hausdorff", [&](auto& a, auto& b) { return hausdorffDistance(a, b).work; });
  }

  void paths()
  {
    const std::vector<Eigen::Isometry3d> poses = wayOf(scene_);
    const double tolerance = std::max(0.03125, scene_.clearance / 16);
    for (const bool swept : {false, true})
      for (unsigned wanted = 0; wanted < 4; ++wanted) {
        TrajectoryRequest request;
        request.clearance = scene_.clearance;
        request.first_poses = (wanted & 1) != 0;
        request.distances = request.closest_poses = (wanted & 2) != 0;
        request.pose_summaries = wanted == 3 && !swept;
        if (swept) request.swept = tolerance;
        ask(std::string(swept ? "swept " : "path ") + std::to_string(wanted),
            [&](auto& a, auto& b) { return collideAlong(a, b.hierarchy(), poses, request).work; });
      }
    for (const Accuracy& accuracy : kAccuracies)
      ask("path " + accuracy.text(), [&](auto& a, auto& b) {
        TrajectoryRequest request;
        request.clearance = scene_.clearance;
        request.accuracy = accuracy;
        return collideAlong(a, b.hierarchy(), poses, request).work;
      });
    ask("poses",
        [&](auto& a, auto& b) { return anyCollisionAtPoses(a, b.hierarchy(), poses, {scene_.clearance}).work; });
    ask("closest at poses", [&](auto& a, auto& b) { return closestPairAtPoses(a, b.hierarchy(), poses).work; });
    ask("motions", [&](auto& a, auto& b) {
      MotionsRequest request;
      request.clearance = scene_.clearance;
      request.swept = tolerance;
      return anyCollisionOnMotions(a, b.hierarchy(), poses, {{0, 1}, {1, 2}, {2, 5}, {6, 0}, {3, 3}}, request).work;
    });
  }

  void neighbors()
  {
    const double radius = scene_.clearance;
    ask("clusters", [&](auto& a, auto&) { return euclideanClusters(a.hierarchy(), radius).work; });
    if (scene_.a.view().triangles) return; // no query looks for triangles near a place
    const auto search = [&](const std::string& name, const auto& one) {
      ask(name, [&](auto& a, auto& b) {
        Work work;
        const PointsView& asked = b.hierarchy().view();
        for (std::size_t i = 0; i < asked.size(); i += 7)
          if (isFinite(asked.point(asked.record(i)))) one(a.hierarchy(), asked.point(asked.record(i)), work);
        return work;
      });
    };
    Neighbors found;
    std::vector<std::int32_t> boxed;
    for (const std::size_t most : {0u, 3u})
      search("radius " + std::to_string(most), [&](const SphereHierarchy& cloud, const Point3& at, Work& work) {
        radiusSearch(cloud, at, radius, found, {most, true}, &work);
      });
    for (const std::size_t k : {1u, 9u})
      search("nearest " + std::to_string(k), [&](const SphereHierarchy& cloud, const Point3& at, Work& work) {
        nearestKSearch(cloud, at, k, found, &work);
      });
    search("any in radius",
           [&](const SphereHierarchy& cloud, const Point3& at, Work& work) { anyInRadius(cloud, at, radius, &work); });
    search("box", [&](const SphereHierarchy& cloud, const Point3& at, Work& work) {
      boxSearch(cloud, at, {at[0] + 0.25, at[1] + 0.5, at[2] + 0.25}, boxed, &work);
    });
  }

private:
  template <class Query>
  void ask(const std::string& name, const Query& query)
  {
    const SphereHierarchy a(scene_.a.view()), b(scene_.b.view());
    const Placed placed_a(a, scene_.pose_a), placed_b(b, scene_.pose_b);
    table_.add(name, query(placed_a, placed_b));
  }

  const test::Scene scene_;
  Table& table_;
};

/// Far from each other's place, or not; turned, or not.
test::Scene sceneOf(Cloud a, Cloud b, double clearance, bool turned, Random& random)
{
  Eigen::Isometry3d pose_a = turned ? random.pose(100.0) : Eigen::Isometry3d::Identity();
  Eigen::Isometry3d pose_b = pose_a;
  pose_b.translation() += Eigen::Vector3d(0.375, -0.25, 0.125);
  return {std::move(a), std::move(b), pose_a, pose_b, clearance, ""};
}

Cloud cloudOf(std::vector<Point3> points, bool wide, double far)
{
  for (Point3& p : points) p[0] += far;
  return Cloud(points, {wide ? Scalar::float64 : Scalar::float32, 0, 4});
}

/// Bent sheets, a little apart.
std::vector<Point3> sheet(std::size_t count, double height, Random& random)
{
  std::vector<Point3> points(count);
  for (Point3& p : points) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    p = {x, y, 0.3 * x * x - 0.2 * x * y + height + 0.002 * random.uniform(-1, 1)};
  }
  return points;
}

test::Mesh wavyMesh(std::uint32_t side, double height, Random& random)
{
  test::Mesh mesh;
  for (std::uint32_t i = 0; i <= side; ++i)
    for (std::uint32_t j = 0; j <= side; ++j) {
      const double x = 2.0 * i / side - 1.0, y = 2.0 * j / side - 1.0;
      mesh.vertices.push_back({x, y, height + 0.3 * x * y + 0.01 * random.uniform(-1, 1)});
    }
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      const std::uint32_t a = i * (side + 1) + j, b = a + 1, c = a + side + 1, d = c + 1;
      mesh.corners.insert(mesh.corners.end(), {a, b, c, c, b, d});
    }
  return mesh;
}

Cloud cloudOf(const test::Mesh& mesh, bool wide)
{
  Cloud cloud(mesh.vertices, {wide ? Scalar::float64 : Scalar::float32, 0, 0});
  cloud.setTriangles(mesh.corners);
  return cloud;
}

void askAll(Table& table, test::Scene scene)
{
  Asked(std::move(scene), table).all();
}

TEST(WorkCounts, OfSmallClouds)
{
  Table table;
  for (std::uint64_t seed = 100; seed < 130; ++seed) askAll(table, test::anyScene(seed, 200));
  table.check("small clouds");
}

TEST(WorkCounts, OfClouds)
{
  Table table;
  Random random(1);
  int number = 0;
  for (const test::Shape shape : test::all_shapes) {
    const bool odd = number++ % 2 != 0;
    const auto points = [&] { return cloudOf(test::makePoints(shape, 1500, 1.0, random), odd, odd ? 1e5 : 0.0); };
    Cloud a = points(), b = points();
    askAll(table, sceneOf(std::move(a), std::move(b), odd ? 0.05 : 0.125, number % 4 < 2, random));
  }
  table.check("clouds");
}

/// Where most points collide, many at once.
TEST(WorkCounts, OfDenseClouds)
{
  Table table;
  Random random(10);
  for (const bool turned : {false, true}) {
    const auto points = [&] { return cloudOf(test::makePoints(test::Shape::uniform, 6000, 0.5, random), turned, 0.0); };
    const Cloud a = points(), b = points();
    for (const double clearance : {0.01, 0.05, 0.2}) {
      Asked asked(sceneOf(a, b, clearance, turned, random), table);
      asked.pairs();
      asked.flags();
    }
  }
  table.check("dense clouds");
}

/// Places of many points each that lie closer together than floats tell.
TEST(WorkCounts, OfCrowdedClouds)
{
  Table table;
  Random random(11);
  for (const double spread : {1e-6, 1e-4, 4e-3}) {
    const std::vector<Point3> places = test::makePoints(test::Shape::uniform, 12, 1000.0, random);
    const auto points = [&] {
      std::vector<Point3> crowded;
      for (const Point3& place : places)
        for (int i = 0; i < 50; ++i)
          crowded.push_back({place[0] + spread * random.uniform(-1, 1), place[1] + spread * random.uniform(-1, 1),
                             place[2] + spread * random.uniform(-1, 1)});
      return cloudOf(crowded, true, 0.0);
    };
    const Cloud a = points(), b = points();
    test::Scene scene{a, b, Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(), 0.1 * spread, ""};
    Asked asked(scene, table);
    asked.pairs();
    asked.flags();
    asked.distances();
    asked.neighbors();
  }
  table.check("crowded clouds");
}

TEST(WorkCounts, OfSheets)
{
  Table table;
  Random random(2);
  for (const double gap : {0.004, 0.03, 0.2}) {
    Cloud a = cloudOf(sheet(2000, 0.0, random), false, 0.0), b = cloudOf(sheet(2000, gap, random), gap < 0.1, 0.0);
    test::Scene scene = sceneOf(std::move(a), std::move(b), gap, true, random);
    scene.pose_b = scene.pose_a;
    askAll(table, scene);
  }
  table.check("sheets");
}

TEST(WorkCounts, OfBalls)
{
  Table table;
  Random random(3);
  for (const bool turned : {false, true}) {
    const auto balls = [&] {
      Cloud cloud = cloudOf(test::makePoints(test::Shape::uniform, 600, 1.0, random), turned, 0.0);
      std::vector<float> radii(600);
      for (float& radius : radii) radius = static_cast<float>(random.integer(0, 4)) / 128;
      cloud.setRadii(std::move(radii));
      return cloud;
    };
    Cloud a = balls(), b = balls();
    askAll(table, sceneOf(std::move(a), std::move(b), 0.03125, turned, random));
  }
  table.check("balls");
}

TEST(WorkCounts, OfUncertainPoints)
{
  Table table;
  Random random(4);
  for (int i = 0; i < 4; ++i) {
    const auto points = [&](bool uncertain) {
      Cloud cloud = cloudOf(test::makePoints(test::Shape::uniform, 600, 1.0, random), i % 2 != 0, 0.0);
      if (uncertain) test::makeUncertain(cloud, 0.125, random);
      return cloud;
    };
    Cloud a = points(i != 1), b = points(i != 2);
    askAll(table, sceneOf(std::move(a), std::move(b), 0.0625, i % 2 != 0, random));
  }
  table.check("uncertain points");
}

TEST(WorkCounts, OfMeshes)
{
  using test::MeshKind;
  Table table;
  Random random(5);
  for (const MeshKind kind : {MeshKind::lattice, MeshKind::needles, MeshKind::degenerate, MeshKind::sheet})
    for (const bool turned : {false, true}) {
      const auto made = [&](double height) {
        return kind == MeshKind::sheet ? wavyMesh(8, height, random) : test::makeMesh(kind, 25, 1.0, random);
      };
      Cloud a = cloudOf(made(0.0), turned), b = cloudOf(made(0.125), false);
      if (!turned) b = cloudOf(test::makePoints(test::Shape::uniform, 100, 1.0, random), true, 0.0);
      askAll(table, sceneOf(std::move(a), std::move(b), 0.0625, turned, random));
    }
  table.check("meshes");
}

TEST(WorkCounts, OfSolids)
{
  Table table;
  Random random(6);
  test::TestMesh mesh = test::boxMesh(1.0, 0.75, 0.5);
  for (int i = 0; i < 30; ++i) { // boxes beside each other, and in each other
    const Point3 half = random.point([&] { return random.integer(1, 4) / 8.0; });
    const test::TestMesh box = test::boxMesh(half[0], half[1], half[2]);
    const Point3 at = random.point([&] { return random.integer(-16, 16) / 16.0; });
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point3& p : box.vertices) mesh.vertices.push_back({p[0] + at[0], p[1] + at[1], p[2] + at[2]});
    for (const Triangle& t : box.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const Solid solid(mesh.trianglesView());
  const SolidBodies bodies(solid);
  for (const test::Shape shape : {test::Shape::uniform, test::Shape::grid, test::Shape::clusters})
    for (const bool turned : {false, true}) {
      const Cloud cloud = cloudOf(test::makePoints(shape, 1500, 1.0, random), turned, 0.0);
      const Eigen::Isometry3d pose = turned ? random.pose(1.0) : Eigen::Isometry3d::Identity();
      const SphereHierarchy points(cloud.view());
      table.add("labels", labelPoints({points, pose}, solid).work);
      Work first, inside, within, enclosed, holders;
      firstInside({points, pose}, solid, &first);
      anyInside({points, pose}, solid, &inside);
      anyWithin({points, pose}, solid, &within);
      const QueriedRecords queried(points);
      const std::vector<std::uint32_t> records = enclosedBy(solid, queried, pose, 1, &enclosed);
      holdersOf(bodies, Eigen::Isometry3d::Identity(), queried, pose, records, &holders);
      table.add("first", first), table.add("inside", inside), table.add("within", within);
      table.add("enclosed", enclosed), table.add("holders", holders);
    }
  table.check("solids");
}

TEST(WorkCounts, OfUnseenPoints)
{
  Table table;
  Random random(7);
  const Cloud near = cloudOf(test::makePoints(test::Shape::sphere, 3000, 4.0, random), false, 0.0);
  const Cloud other = cloudOf(test::makePoints(test::Shape::clusters, 3000, 4.0, random), true, 0.0);
  ScanBeams first, second;
  first.returns = near.view();
  second.returns = other.view();
  second.origin = {0.5, 0.25, -2.0};
  SeenOptions options;
  for (const bool given : {false, true}) {
    if (given) options.angle = 0.03125;
    const SeenSpace seen({first, second}, options);
    for (const test::Shape shape : {test::Shape::uniform, test::Shape::plane, test::Shape::clusters}) {
      const Cloud cloud = cloudOf(test::makePoints(shape, 1000, 2.5, random), given, 0.0);
      const SphereHierarchy model(cloud.view());
      std::vector<Verdict> verdicts(cloud.view().count, Verdict::free);
      UnseenRequest request;
      request.clearance = 0.0625;
      const UnseenResult found = markUnseen(seen, {model, random.pose(0.25)}, request, verdicts);
      table.add(given ? "angle given" : "angle measured", found.work);
    }
  }
  table.check("unseen points");
}

TEST(WorkCounts, OfScenes)
{
  Table table;
  const auto run = [&](const std::string& name, Effects effects, bool with_meshes) {
    Random random(8);
    SceneOptions options;
    options.effects = effects;
    options.clearance = 0.0625;
    options.tolerance = 0.0078125;
    Scene scene(options);
    std::vector<Cloud> clouds;
    clouds.reserve(12);
    for (int i = 0; i < 12; ++i) {
      clouds.push_back(with_meshes && i % 3 == 0
                           ? cloudOf(wavyMesh(5, 0.0, random), false)
                           : cloudOf(test::makePoints(test::Shape::uniform, 150, 0.5, random), i % 2 != 0, 0.0));
      Eigen::Isometry3d pose = random.pose(0.0);
      pose.translation() = Eigen::Vector3d{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1)};
      SceneObject made =
          object("object " + std::to_string(i), std::make_shared<SphereHierarchy>(clouds.back().view()), pose);
      made.fixed = i % 4 == 3;
      if (!made.fixed) {
        VelocityMotion motion;
        motion.linear = Eigen::Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), 0.25};
        if (i % 2 == 0) motion.angular = Eigen::Vector3d(0, 0, 0.5);
        made.motion = motion;
      }
      if (i % 4 == 0) made.parts.push_back({"second", made.parts[0].hierarchy, Eigen::Isometry3d::Identity()});
      scene.add(std::move(made));
    }
    std::vector<Point3> plain = sheet(900, 0.0, random);
    for (Point3& p : plain) p = {8 * p[0], 8 * p[1], p[2] - 1.25};
    const Cloud ground = cloudOf(plain, false, 0.0); // which lies in many voxels of the grid
    HierarchyOptions fine;
    fine.voxel_edge = 0.5;
    scene.add(fixedObject("ground", std::make_shared<SphereHierarchy>(ground.view(), fine)));
    table.add(name, scene.query());
    for (int step = 0; step < 4; ++step) table.add(name, scene.step(0.25));
  };
  Effects still, swept, stops, slides;
  still.any = still.flags = still.self = true;
  still.distance = 0.5;
  still.contacts = 5;
  swept.first_contact = swept.swept = true;
  stops.response = Response::stop;
  slides.response = Response::slide;
  slides.gravity = Gravity{};
  for (const bool with_meshes : {false, true}) {
    const std::string of = with_meshes ? ", meshes" : "";
    run("still" + of, still, with_meshes);
    run("swept" + of, swept, with_meshes);
    run("stop" + of, stops, with_meshes);
    run("slide" + of, slides, with_meshes);
  }
  table.check("scenes");
}

/// Counts of a hierarchy's parts, however points lie.
TEST(WorkCounts, OfHierarchies)
{
  Table table;
  Random random(9);
  for (const CellSplit cells : {CellSplit::longest_axis, CellSplit::octants})
    for (const test::Shape shape : test::all_shapes)
      for (const bool wide : {false, true}) {
        const Cloud cloud = cloudOf(test::makePoints(shape, 5000, 1.0, random), wide, wide ? 1e4 : 0.0);
        HierarchyOptions options;
        options.cells = cells;
        const SphereHierarchy hierarchy(cloud.view(), options);
        hierarchy.buildAll();
        const HierarchyStatistics found = hierarchy.statistics();
        table.add(cells == CellSplit::octants ? "octants" : "longest axis",
                  {{"voxels", found.voxels}, {"nodes", found.nodes}, {"leaves", found.leaves}, {"depth", found.depth}});
      }
  table.check("hierarchies");
}

} // namespace
} // namespace pcl_bsh
