// SPDX-License-Identifier: BSD-3-Clause
// Two files of points, and poses of one about the other, for programs that take a user's clouds.
#pragma once

#include "program.h"
#include "workload/points.h"

#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/path.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh::bench {

/// Options of programs that read two files.
struct PosedFilesOptions : ProgramOptions {
  std::string name, a, b, pose = "0,0,0,0,0,0";
  unsigned poses = 10;

  void addTo(CLI::App& app)
  {
    app.add_option("A", a, "cloud whose points are asked about")->required();
    app.add_option("B", b, "cloud to collide with; of a mesh, its corners")->required();
    app.add_option("--name", name, "of the clouds, for the rows");
    app.add_option("--pose", pose, "of B in A's frame, as for pcl_bsh_collide");
    app.add_option("--poses", poses, "that pose, and others about it")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
  }
};

/// The finite points of a file.
inline Points loadPoints(const std::string& file)
{
  double seconds = 0.0;
  const io::Obstacle loaded = cli::loadObstacle(file, {true}, seconds, {}, nullptr, 1);
  Points points;
  for (std::size_t i = 0; i < loaded.view().size(); ++i) {
    const Point3 p = loaded.view().point(loaded.view().record(i));
    const Point q = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    if (std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z)) points.push_back(q);
  }
  if (points.empty()) throw std::runtime_error(file + ": has no finite point: give another cloud");
  return points;
}

inline Eigen::AlignedBox3d boxOf(const Points& points)
{
  Eigen::AlignedBox3d box;
  for (const Point& p : points) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return box;
}

/// The pose, then others about it: turned about the middle of b by up to 10 degrees, moved by up to 5 % of a's size.
inline std::vector<Eigen::Isometry3d> posesAbout(const PosedFilesOptions& options, const Points& a, const Points& b)
{
  std::vector<std::string> warnings;
  const Eigen::Isometry3d pose = cli::parsePose("--pose", options.pose, warnings);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  const double size = boxOf(a).diagonal().norm();
  const Eigen::Vector3d middle = boxOf(b).center();
  std::vector<Eigen::Isometry3d> poses = {pose};
  while (poses.size() < options.poses) {
    const Eigen::Vector3d axis = vector().normalized(), shift = 0.05 * size * vector();
    const double angle = unit(random) * 0.17453292519943295;
    poses.push_back(Eigen::Translation3d(shift) * pose * Eigen::Translation3d(middle) * Eigen::AngleAxisd(angle, axis) *
                    Eigen::Translation3d(-middle));
  }
  return poses;
}

} // namespace pcl_bsh::bench
