// SPDX-License-Identifier: BSD-3-Clause
// BoundingSphereSearch in a chain of PCL algorithms: aligns a scan with another (ICP), estimates its normals, and parts
// it into clusters.
#include "cli/command_line.h"
#include "cli/used_files.h"

#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/search/bounding_sphere_search.h>

#include <pcl/common/point_tests.h>
#include <pcl/conversions.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/segmentation/extract_clusters.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Search = pcl_bsh::search::BoundingSphereSearch<Point>;

constexpr auto program = "pcl_bsh_search_chain";

/// The finite points of a file: ICP and clustering expect no others.
Cloud::Ptr read(const std::string& path)
{
  const pcl::PCLPointCloud2 file = pcl_bsh::io::readCloud(path);
  if (pcl_bsh::viewOf(file).scalar != pcl_bsh::Scalar::float32) {
    throw std::runtime_error(path + ": x y z are float64: convert them, pcl::PointXYZ holds float32 only");
  }
  Cloud all;
  pcl::fromPCLPointCloud2(file, all);
  auto cloud = std::make_shared<Cloud>();
  for (const Point& p : all)
    if (pcl::isFinite(p)) cloud->push_back(p);
  if (cloud->empty()) throw std::runtime_error(path + ": no finite points: give a scan that has some");
  std::printf("%s: %zu finite points\n", path.c_str(), cloud->size());
  return cloud;
}

Cloud::Ptr aligned(const Cloud::Ptr& scan, const Cloud::Ptr& reference, int iterations)
{
  std::printf("aligning, %d iterations at most ...\n", iterations);
  pcl::IterativeClosestPoint<Point, Point> icp;
  icp.setSearchMethodTarget(std::make_shared<Search>());
  icp.setInputSource(scan);
  icp.setInputTarget(reference);
  icp.setMaximumIterations(iterations);
  auto result = std::make_shared<Cloud>();
  icp.align(*result);
  if (!icp.hasConverged()) throw std::runtime_error("ICP did not converge: give scans that overlap");
  std::printf("after ICP: mean squared distance %g\nT_reference_scan:\n", icp.getFitnessScore());
  std::cout << icp.getFinalTransformation() << '\n';
  return result;
}

void reportNormals(const Cloud::Ptr& cloud, const Search::Ptr& search, int neighbours)
{
  pcl::NormalEstimation<Point, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(search);
  estimation.setKSearch(neighbours);
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
  CLI::App app("Aligns SCAN with REFERENCE, then estimates its normals and parts it into clusters: all of PCL, with\n"
               "pcl_bsh's search class.");
  app.footer("Example: pcl_bsh_search_chain scan.pcd reference.pcd 0.1");
  std::string scan, reference;
  double tolerance = 0.0;
  int neighbours = 12, iterations = 20;
  app.add_option("SCAN", scan, "Point cloud with float32 coordinates: .pcd or .ply")->required();
  app.add_option("REFERENCE", reference, "Likewise, overlapping SCAN")->required();
  app.add_option("TOLERANCE", tolerance, "Points no farther apart share a cluster, in the clouds' unit")
      ->required()
      ->check(CLI::PositiveNumber);
  app.add_option("--neighbours", neighbours, "Points that a normal is fitted to")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str();
  app.add_option("--iterations", iterations, "Of ICP, at most")->check(CLI::Range(1, 1000))->capture_default_str();
  return pcl_bsh::cli::runProgram(program, [&] {
    if (!pcl_bsh::cli::understood(app, program, argc, argv)) return 0;
    pcl_bsh::cli::CommandFiles().reads("SCAN", scan).reads("REFERENCE", reference).requireApart();
    const Cloud::Ptr cloud = aligned(read(scan), read(reference), iterations);
    const auto search = std::make_shared<Search>();
    reportNormals(cloud, search, neighbours);
    reportClusters(cloud, search, tolerance);
    return 0;
  });
}
