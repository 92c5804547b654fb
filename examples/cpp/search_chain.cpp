// SPDX-License-Identifier: BSD-3-Clause
// BoundingSphereSearch in a chain of PCL algorithms: aligns a scan with another (ICP), estimates its normals, and parts
// it into clusters.
//
//   pcl_bsh_search_chain scan.pcd reference.pcd 0.1
#include <pcl_bsh/search/bounding_sphere_search.h>

#include <pcl/common/point_tests.h>
#include <pcl/features/normal_3d.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/segmentation/extract_clusters.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Search = pcl_bsh::search::BoundingSphereSearch<Point>;

/// The finite points of a file: ICP and clustering expect no others.
Cloud::Ptr read(const std::string& path)
{
  Cloud all;
  if (pcl::io::loadPCDFile(path, all) != 0) throw std::runtime_error(path + ": cannot be read: give a .pcd file");
  auto cloud = std::make_shared<Cloud>();
  for (const Point& p : all)
    if (pcl::isFinite(p)) cloud->push_back(p);
  if (cloud->empty()) throw std::runtime_error(path + ": no finite points: give a scan that has some");
  std::printf("%s: %zu finite points\n", path.c_str(), cloud->size());
  return cloud;
}

Cloud::Ptr aligned(const Cloud::Ptr& scan, const Cloud::Ptr& reference)
{
  pcl::IterativeClosestPoint<Point, Point> icp;
  icp.setSearchMethodTarget(std::make_shared<Search>());
  icp.setInputSource(scan);
  icp.setInputTarget(reference);
  icp.setMaximumIterations(20);
  auto result = std::make_shared<Cloud>();
  icp.align(*result);
  if (!icp.hasConverged()) throw std::runtime_error("ICP did not converge: give scans that overlap");
  std::printf("after ICP: mean squared distance %g\nT_reference_scan:\n", icp.getFitnessScore());
  std::cout << icp.getFinalTransformation() << '\n';
  return result;
}

void reportNormals(const Cloud::Ptr& cloud, const Search::Ptr& search)
{
  pcl::NormalEstimation<Point, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(search);
  estimation.setKSearch(12);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  double curvature = 0.0;
  for (const pcl::Normal& normal : normals) curvature += std::isfinite(normal.curvature) ? normal.curvature : 0.0;
  std::printf("normals: %zu, mean curvature %g\n", normals.size(), curvature / static_cast<double>(normals.size()));
}

void reportClusters(const Cloud::Ptr& cloud, const Search::Ptr& search, double tolerance)
{
  pcl::EuclideanClusterExtraction<Point> extraction;
  extraction.setInputCloud(cloud);
  extraction.setSearchMethod(search);
  extraction.setClusterTolerance(tolerance);
  extraction.setMinClusterSize(100);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  std::printf("clusters of 100 points or more: %zu\n", clusters.size());
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 4) {
    std::fprintf(stderr, "usage: pcl_bsh_search_chain SCAN.pcd REFERENCE.pcd TOLERANCE\n"
                         "Points no farther apart than TOLERANCE, in the clouds' unit, share a cluster.\n");
    return 2;
  }
  try {
    const Cloud::Ptr cloud = aligned(read(argv[1]), read(argv[2]));
    const auto search = std::make_shared<Search>();
    reportNormals(cloud, search);
    reportClusters(cloud, search, std::stod(argv[3]));
    return 0;
  }
  catch (const std::exception& error) {
    std::fprintf(stderr, "pcl_bsh_search_chain: %s\n", error.what());
    return 1;
  }
}
