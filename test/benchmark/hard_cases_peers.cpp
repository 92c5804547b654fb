// SPDX-License-Identifier: BSD-3-Clause
// How many ordered pairs of points of two files lie within the clearance? Asked of us, or of one of our peers: what
// test/hard_cases/run.py runs.
//
//   hard_cases_peers PEER A.pcd B.pcd CLEARANCE [T_a_b, twelve numbers]
#include <pcl_bsh/collide.h>

#include "support/pcd_points.h"
#include "support/radius_hits.h"
#include "support/random_clouds.h"

#include <nanoflann.hpp>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/brute_force.h>

#include <charconv>
#include <iostream>
#include <string>

namespace pcl_bsh {
namespace {

using Points = std::vector<Point3>;

/// b as given, and as those have it who move points and round them.
struct Question {
  test::PcdPoints a, b;
  Points moved_b;
  double clearance;
  Eigen::Isometry3d pose;
};

// Answers ---------------------------------------------------------------------------------------------------------

std::size_t countOurs(const Question& c)
{
  const test::Cloud b(c.b.points, {c.b.scalar});
  const SphereHierarchy obstacle(b.view());
  FlagsRequest request;
  request.clearance = c.clearance;
  request.flagged = Flagged::b;
  std::size_t pairs = 0;
  for (const Point3& p : c.a.points) {
    const test::Cloud one({p}, {c.a.scalar});
    const SphereHierarchy point(one.view());
    pairs += collisionFlags({point}, {obstacle, c.pose}, request).colliding_b;
  }
  return pairs;
}

pcl::PointXYZ toPcl(const Point3& p)
{
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

pcl::PointCloud<pcl::PointXYZ>::Ptr toPcl(const Points& points)
{
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const Point3& p : points) {
    cloud->push_back(toPcl(p));
    cloud->is_dense = cloud->is_dense && std::isfinite(p[0] + p[1] + p[2]);
  }
  return cloud;
}

template <class Search>
std::size_t countPcl(Search& search, const Question& c)
{
  pcl::Indices found;
  std::vector<float> squared;
  std::size_t pairs = 0;
  for (const Point3& p : c.a.points)
    pairs += static_cast<std::size_t>(search.radiusSearch(toPcl(p), c.clearance, found, squared));
  return pairs;
}

std::size_t countKdTree(const Question& c)
{
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);
  tree.setInputCloud(toPcl(c.moved_b));
  return countPcl(tree, c);
}

std::size_t countOctree(const Question& c)
{
  pcl::octree::OctreePointCloudSearch<pcl::PointXYZ> tree(c.clearance > 0.0 ? c.clearance : 1.0);
  tree.setInputCloud(toPcl(c.moved_b));
  tree.addPointsFromInputCloud();
  return countPcl(tree, c);
}

std::size_t countBruteForce(const Question& c)
{
  pcl::search::BruteForce<pcl::PointXYZ> search;
  search.setInputCloud(toPcl(c.moved_b));
  return countPcl(search, c);
}

template <class T>
struct Adaptor {
  const Points& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  T kdtree_get_pt(std::size_t i, std::size_t axis) const { return static_cast<T>(points[i][axis]); }
  template <class Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }
};

template <class T>
std::size_t countNanoflann(const Question& c)
{
  using Metric = nanoflann::L2_Simple_Adaptor<T, Adaptor<T>>;
  const Adaptor<T> adaptor{c.moved_b};
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Adaptor<T>, 3> tree(3, adaptor, {10});
  tree.buildIndex();
  std::size_t pairs = 0;
  for (const Point3& p : c.a.points) {
    const T query[3] = {static_cast<T>(p[0]), static_cast<T>(p[1]), static_cast<T>(p[2])};
    test::RadiusHits<std::uint32_t, T> found;
    const T d = static_cast<T>(c.clearance);
    pairs += tree.radiusSearch(query, d * d, found, {});
  }
  return pairs;
}

// The program -----------------------------------------------------------------------------------------------------

struct Peer {
  const char* name;
  std::size_t (*count)(const Question&);
};

constexpr Peer peers[] = {{"pcl_bsh", countOurs},
                          {"kd_tree", countKdTree},
                          {"octree", countOctree},
                          {"brute_force", countBruteForce},
                          {"nanoflann_float", countNanoflann<float>},
                          {"nanoflann_double", countNanoflann<double>}};

double numberOf(const std::string& text)
{
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::runtime_error("'" + text + "' is no number: give a clearance, and twelve numbers of a pose");
  return number;
}

Question read(const std::vector<std::string>& words)
{
  Question question{test::readPcdPoints(words[1]),
                    test::readPcdPoints(words[2]),
                    {},
                    numberOf(words[3]),
                    Eigen::Isometry3d::Identity()};
  for (std::size_t i = 4; i < words.size(); ++i)
    question.pose.matrix()(static_cast<Eigen::Index>(i - 4) / 4, static_cast<Eigen::Index>(i - 4) % 4) =
        numberOf(words[i]);
  const bool moved = !question.pose.matrix().isIdentity(0.0);
  for (const Point3& p : question.b.points) {
    const Eigen::Vector3d q = question.pose * Eigen::Vector3d(p[0], p[1], p[2]);
    question.moved_b.push_back(moved ? Point3{q[0], q[1], q[2]} : p);
  }
  return question;
}

} // namespace
} // namespace pcl_bsh

int main(int argc, char** argv)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  const pcl_bsh::Peer* peer = nullptr;
  for (const pcl_bsh::Peer& any : pcl_bsh::peers)
    if (!words.empty() && words.front() == any.name) peer = &any;
  if (peer == nullptr || (words.size() != 4 && words.size() != 16)) {
    std::cerr << "usage: " << argv[0] << " PEER A.pcd B.pcd CLEARANCE [T_a_b, twelve numbers]\nPEER:";
    for (const pcl_bsh::Peer& any : pcl_bsh::peers) std::cerr << ' ' << any.name;
    std::cerr << '\n';
    return 2;
  }
  try {
    std::cout << peer->count(pcl_bsh::read(words)) << '\n';
  }
  catch (const std::exception& error) {
    std::cerr << "hard_cases_peers: " << error.what() << '\n';
    return 1;
  }
}
