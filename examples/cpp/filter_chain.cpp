// SPDX-License-Identifier: BSD-3-Clause
// CollisionFilter in a chain of PCL filters: thins a scan, then removes what touches an obstacle given in its frame.
//
//   pcl_bsh_filter_chain scan.pcd obstacle.pcd free.pcd 0.02 0.05
#include <pcl_bsh/filters/collision_filter.h>

#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

namespace {

using Cloud = pcl::PCLPointCloud2; // keeps all fields of a file, in their types

Cloud::Ptr read(const std::string& path)
{
  auto cloud = std::make_shared<Cloud>();
  if (pcl::io::loadPCDFile(path, *cloud) != 0) throw std::runtime_error(path + ": cannot be read: give a .pcd file");
  std::printf("%s: %u points\n", path.c_str(), cloud->width * cloud->height);
  return cloud;
}

/// Edge of the cells: `leaf`, in the cloud's unit.
Cloud::Ptr thinned(const Cloud::ConstPtr& scan, float leaf)
{
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
  filter.setClearance(clearance); // in the clouds' unit; touching counts
  Cloud result;
  filter.filter(result);
  std::printf("after CollisionFilter: %u points\n", result.width);
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 6) {
    std::fprintf(stderr, "usage: pcl_bsh_filter_chain SCAN.pcd OBSTACLE.pcd OUTPUT.pcd LEAF CLEARANCE\n");
    return 2;
  }
  try {
    const Cloud::Ptr thin = thinned(read(argv[1]), std::stof(argv[4]));
    const Cloud free = withoutCollisions(thin, read(argv[2]), std::stod(argv[5]));
    return pcl::io::savePCDFile(argv[3], free, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(), true) == 0 ? 0
                                                                                                                   : 1;
  }
  catch (const std::exception& error) {
    std::fprintf(stderr, "pcl_bsh_filter_chain: %s\n", error.what());
    return 1;
  }
}
