// SPDX-License-Identifier: BSD-3-Clause
// CollisionFilter in a chain of PCL filters: thins a scan, then removes what touches an obstacle given in its frame.
#include "cli/command_line.h"
#include "cli/used_files.h"

#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/filters/collision_filter.h>

#include <pcl/filters/voxel_grid.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

namespace {

using Cloud = pcl::PCLPointCloud2;

constexpr auto program = "pcl_bsh_filter_chain";

Cloud::Ptr read(const std::string& path)
{
  auto cloud = std::make_shared<Cloud>(pcl_bsh::io::readCloud(path));
  std::printf("%s: %zu points\n", path.c_str(), pcl_bsh::viewOf(*cloud).count);
  return cloud;
}

Cloud::Ptr thinned(const Cloud::ConstPtr& scan, float leaf)
{
  if (!(leaf > 0.0f && std::isfinite(leaf))) {
    throw std::runtime_error("LEAF: " + std::to_string(leaf) + ": give a finite length > 0");
  }
  // VoxelGrid would print a line and return one point.
  if (pcl_bsh::viewOf(*scan).scalar != pcl_bsh::Scalar::float32) {
    throw std::runtime_error("SCAN: x y z are float64: convert them, pcl::VoxelGrid reads float32 only");
  }
  pcl::VoxelGrid<Cloud> voxels;
  voxels.setInputCloud(scan);
  voxels.setLeafSize(leaf, leaf, leaf);
  auto result = std::make_shared<Cloud>();
  voxels.filter(*result);
  std::printf("after VoxelGrid: %u points\n", result->width * result->height);
  return result;
}

Cloud withoutCollisions(const Cloud::ConstPtr& scan, const Cloud::ConstPtr& obstacle, double clearance)
{
  pcl_bsh::CollisionFilter<Cloud> filter;
  filter.setInputCloud(scan);
  filter.setObstacleCloud(obstacle);
  filter.setClearance(clearance);
  Cloud result;
  filter.filter(result);
  std::printf("after CollisionFilter: %u points\n", result.width);
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  CLI::App app("Thins a scan with pcl::VoxelGrid, then removes its points that collide with an obstacle.");
  std::string scan, obstacle, output;
  float leaf = 0.0f;
  double clearance = 0.0;
  app.add_option("SCAN", scan, "Point cloud with float32 coordinates: .pcd or .ply")->required();
  app.add_option("OBSTACLE", obstacle, "Point cloud in the frame of SCAN: any file that is read")->required();
  app.add_option("OUTPUT", output, ".pcd or .ply")->required();
  app.add_option("LEAF", leaf, "Edge of VoxelGrid's cells, in the clouds' unit")->required();
  app.add_option("CLEARANCE", clearance, "Points no farther than this from OBSTACLE are removed")->required();
  return pcl_bsh::cli::runProgram(program, [&] {
    if (!pcl_bsh::cli::understood(app, program, argc, argv)) return 0;
    pcl_bsh::cli::CommandFiles()
        .reads("SCAN", scan)
        .reads("OBSTACLE", obstacle)
        .writesFile("OUTPUT", output)
        .requireApart();
    pcl_bsh::io::requireWritableCloud(output);
    const Cloud::Ptr thin = thinned(read(scan), leaf);
    pcl_bsh::io::writeCloud(output, withoutCollisions(thin, read(obstacle), clearance));
    return 0;
  });
}
