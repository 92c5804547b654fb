// SPDX-License-Identifier: BSD-3-Clause
// A man walks through a scanned building: what does he touch, how close is the rest, and what does it cost to know?
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace pcl_bsh;

constexpr auto program = "pcl_bsh_demo";
constexpr double clearance = 0.5; // metres, as everything here
constexpr double height = 1.8;    // of the man, whose model is 1 high
constexpr double floor_z = -3.1;
constexpr double marked_x = -6.5; // the pose whose flags are written
constexpr double dial_x = -5.5;   // the pose whose distance is asked for at several accuracies

/// Where the man stands, and what an independent program found there by comparing all pairs of points.
struct Stand {
  double x;
  std::size_t colliding; ///< points of the building
  double distance;       ///< rounded to a millimetre
};

constexpr std::array walk = {
    Stand{-10.0, 0, 2.989}, Stand{-9.0, 0, 1.990},  Stand{-8.0, 0, 0.992}, Stand{-7.0, 39, 0.005},
    Stand{-6.5, 53, 0.004}, Stand{-6.0, 18, 0.372}, Stand{-5.5, 0, 0.569}, Stand{-5.0, 0, 0.644},
    Stand{-3.0, 4, 0.295},  Stand{0.0, 12, 0.068},
};

pcl::PCLPointCloud2 load(const char* path)
{
  cli::Step step("Loading " + std::string(path));
  pcl::PCLPointCloud2 cloud = io::readCloud(path);
  step.done(counted(cloud.width, "point"));
  return cloud;
}

/// x y z of the model, grown to the man's height, with his feet at z = 0.
std::vector<double> grownMan(const PointsView& model)
{
  std::vector<double> xyz;
  xyz.reserve(3 * model.count);
  double feet = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < model.count; ++i) {
    for (const double coordinate : model.point(i)) xyz.push_back(height * coordinate);
    feet = std::min(feet, xyz.back());
  }
  for (std::size_t i = 2; i < xyz.size(); i += 3) xyz[i] -= feet;
  return xyz;
}

bool agrees(const Stand& stand, const FlagsResult& flags, const DistanceResult& closest)
{
  return flags.colliding_a == stand.colliding && std::abs(closest.distance - stand.distance) <= 0.0005;
}

void printRow(const Stand& stand, const FlagsResult& flags, const DistanceResult& closest, double milliseconds)
{
  Work work = flags.work;
  work += closest.work;
  const auto number = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  std::printf("%6.1f %10zu %13.3f %13llu %8llu %8llu %11llu %16llu %10.2f", stand.x, flags.colliding_a,
              closest.distance, number(work.node_pairs), number(work.volumes_carried), number(work.volumes_built),
              number(work.leaf_pairs), number(work.exact_decisions), milliseconds);
  if (!agrees(stand, flags, closest)) std::printf("  not the reference: %zu, %.3f", stand.colliding, stand.distance);
  std::printf("\n");
}

/// The smallest distance at one pose, as sure as each setting of the dial makes it, and what it costs.
void showDial(const SphereHierarchy& building, const Placed& man)
{
  std::printf("\nWhat accuracy costs: the smallest distance with the man at x = %.1f\n\n", dial_x);
  std::printf(" setting          at least [m]  at most [m]  sphere tests  updates  time [ms]\n");
  for (const char* setting :
       {"level=0", "level=2", "pairs=300", "pairs=1000", "pairs=2000", "tolerance=0.01", "exact"}) {
    DistanceRequest request;
    request.accuracy = Accuracy::parse(setting);
    std::vector<double> milliseconds;
    DistanceResult found = closestPair({building}, man, request); // builds what it visits
    for (int i = 0; i < 9; ++i) {
      const auto start = std::chrono::steady_clock::now();
      found = closestPair({building}, man, request);
      milliseconds.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(milliseconds.begin(), milliseconds.begin() + 4, milliseconds.end());
    std::printf(" %-16s %12.4f %12.4f %13llu %8llu %10.3f\n", setting, std::max(found.interval.lower, 0.0),
                found.interval.upper, static_cast<unsigned long long>(found.work.node_pairs),
                static_cast<unsigned long long>(found.work.updates()), milliseconds[4]);
  }
}

void writeMarked(const char* path, const pcl::PCLPointCloud2& building, const FlagsResult& flags)
{
  io::writeCloud(path, withField(building, collision_field_name, flags.a));
  std::printf("\nWrote %s: the building with the man at x = %.1f, field '%s' = 1 where they collide.\n", path, marked_x,
              collision_field_name);
}

int demonstrate(const char* building_path, const char* man_path, const char* output)
{
  using Clock = std::chrono::steady_clock;
  const pcl::PCLPointCloud2 building = load(building_path);
  const pcl::PCLPointCloud2 model = load(man_path);
  const std::vector<double> man = grownMan(viewOf(model));

  const SphereHierarchy building_spheres(viewOf(building));
  const SphereHierarchy man_spheres(viewOf(man.data(), man.size() / 3));
  FlagsRequest request;
  request.clearance = clearance;

  std::printf("A man of %s walks through a scanned building of %s; clearance %.1f m\n\n",
              counted(man_spheres.size(), "point").c_str(), counted(building_spheres.size(), "point").c_str(),
              clearance);
  std::printf(
      " x [m]  colliding  distance [m]  sphere tests  carried    built  leaf pairs  exact decisions  time [ms]\n");

  FlagsResult marked;
  std::size_t agreeing = 0;
  for (const Stand& stand : walk) {
    const auto start = Clock::now();
    const Placed placed = {man_spheres, Eigen::Isometry3d(Eigen::Translation3d(stand.x, 0, floor_z))};
    FlagsResult flags = collisionFlags({building_spheres}, placed, request);
    const DistanceResult closest = closestPair({building_spheres}, placed);
    const std::chrono::duration<double, std::milli> milliseconds = Clock::now() - start;

    printRow(stand, flags, closest, milliseconds.count());
    agreeing += agrees(stand, flags, closest) ? 1 : 0;
    if (stand.x == marked_x) marked = std::move(flags);
  }
  showDial(building_spheres, {man_spheres, Eigen::Isometry3d(Eigen::Translation3d(dial_x, 0, floor_z))});
  writeMarked(output, building, marked);
  std::printf("%zu of %zu rows agree with the reference, a comparison of all pairs of points.\n", agreeing,
              walk.size());
  return agreeing == walk.size() ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    if (argc != 4) throw cli::UsageError("command line: three files are needed: give building.ply man.off OUTPUT.pcd");
    cli::CommandFiles()
        .reads("building.ply", argv[1])
        .reads("man.off", argv[2])
        .writesFile("OUTPUT.pcd", argv[3])
        .requireApart();
    io::requireWritableCloud(argv[3]);
    return demonstrate(argv[1], argv[2], argv[3]);
  });
}
