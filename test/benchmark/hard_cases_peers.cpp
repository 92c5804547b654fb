// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of hard cases, asked of us and of our peers: how many ordered pairs of points lie within the clearance?
// Prints a table in Markdown. Each answer is computed in a process of its own, for some of them crash.
//
//   hard_cases_peers
#include <pcl_bsh/collide.h>

#include "support/hard_cases.h"

#include <nanoflann.hpp>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/brute_force.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <iostream>
#include <string>

namespace pcl_bsh {
namespace {

using hard_cases::HardCase;
using hard_cases::Points;

// Answers ---------------------------------------------------------------------------------------------------------

std::size_t countOurs(const HardCase& c)
{
  const test::Cloud b(c.b, {c.scalar});
  const SphereHierarchy obstacle(b.view());
  FlagsRequest request;
  request.clearance = c.clearance;
  request.flagged = Side::b;
  std::size_t pairs = 0;
  for (const Point3& p : c.a) {
    const test::Cloud one({p}, {c.scalar});
    const SphereHierarchy point(one.view());
    pairs += collisionFlags({point}, {obstacle}, request).colliding_b;
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
std::size_t countPcl(Search& search, const HardCase& c)
{
  pcl::Indices found;
  std::vector<float> squared;
  std::size_t pairs = 0;
  for (const Point3& p : c.a)
    pairs += static_cast<std::size_t>(search.radiusSearch(toPcl(p), c.clearance, found, squared));
  return pairs;
}

std::size_t countKdTree(const HardCase& c)
{
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);
  tree.setInputCloud(toPcl(c.b));
  return countPcl(tree, c);
}

std::size_t countOctree(const HardCase& c)
{
  pcl::octree::OctreePointCloudSearch<pcl::PointXYZ> tree(c.clearance > 0.0 ? c.clearance : 1.0);
  tree.setInputCloud(toPcl(c.b));
  tree.addPointsFromInputCloud();
  return countPcl(tree, c);
}

std::size_t countBruteForce(const HardCase& c)
{
  pcl::search::BruteForce<pcl::PointXYZ> search;
  search.setInputCloud(toPcl(c.b));
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
std::size_t countNanoflann(const HardCase& c)
{
  using Metric = nanoflann::L2_Simple_Adaptor<T, Adaptor<T>>;
  const Adaptor<T> adaptor{c.b};
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Adaptor<T>, 3> tree(3, adaptor, {10});
  tree.buildIndex();
  std::size_t pairs = 0;
  for (const Point3& p : c.a) {
    const T query[3] = {static_cast<T>(p[0]), static_cast<T>(p[1]), static_cast<T>(p[2])};
    std::vector<std::pair<std::uint32_t, T>> found;
    const T d = static_cast<T>(c.clearance);
    pairs += tree.radiusSearch(query, d * d, found, nanoflann::SearchParams());
  }
  return pairs;
}

// The table -------------------------------------------------------------------------------------------------------

/// What a child process answers: a count, or how it ended.
std::string ask(const std::function<std::size_t(const HardCase&)>& count, const std::vector<HardCase>& cases)
{
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("pipe failed");
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    alarm(60);
    close(ends[0]);
    if (!std::freopen("/dev/null", "w", stderr)) _exit(2);
    std::size_t pairs = 0;
    for (const HardCase& c : cases) pairs += count(c);
    const bool written = write(ends[1], &pairs, sizeof pairs) == sizeof pairs;
    _exit(written ? 0 : 2);
  }
  close(ends[1]);
  std::size_t pairs = 0;
  const bool answered = read(ends[0], &pairs, sizeof pairs) == sizeof pairs;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (answered) return std::to_string(pairs);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) return "no answer in 60 s";
  return WIFSIGNALED(status) ? "crash" : "error";
}

struct Row {
  std::string name;
  std::vector<HardCase> cases;
};

/// The catalogue in rows: of H4's series all thousand distances, of H15's only what an octree cannot hold.
std::vector<Row> rowsOf(const std::vector<HardCase>& all)
{
  std::vector<Row> rows;
  for (const HardCase& c : all) {
    if (c.name.rfind("H4 ", 0) == 0 || c.name.rfind("H16", 0) == 0 || c.name.rfind("H17", 0) == 0) continue;
    rows.push_back({c.name, {c}});
  }
  Row series{"H4, 10000 distances", {}};
  for (int k = 1; k <= 10000; ++k)
    series.cases.push_back(hard_cases::pairOf("", {0, 0, 0}, {hard_cases::f(k / 1000.0), 0, 0}, k / 1000.0, false));
  rows.insert(rows.begin() + 3, series);
  HardCase deep{"H15, clearance 1e-7", {{0, 0, 0}, {430, 0, 0}}, {{0, 0, 0}, {430, 0, 0}}, 1e-7};
  rows.push_back({deep.name, {deep}});
  return rows;
}

void printTable()
{
  struct Column {
    const char* name;
    std::function<std::size_t(const HardCase&)> count;
  };
  const Column columns[] = {{"pcl_bsh", countOurs},
                            {"PCL KdTreeFLANN", countKdTree},
                            {"PCL octree", countOctree},
                            {"PCL BruteForce", countBruteForce},
                            {"nanoflann float", countNanoflann<float>},
                            {"nanoflann double", countNanoflann<double>}};
  std::cout << "| case | exact |";
  for (const Column& column : columns) std::cout << ' ' << column.name << " |";
  std::cout << "\n|---|---|";
  for (std::size_t i = 0; i < std::size(columns); ++i) std::cout << "---|";
  std::cout << '\n';
  std::vector<int> wrong(std::size(columns), 0);
  for (const Row& row : rowsOf(hard_cases::smallCases())) {
    const std::string truth = ask(hard_cases::countPairs, row.cases);
    std::cout << "| " << row.name << " | " << truth << " |";
    for (std::size_t i = 0; i < std::size(columns); ++i) {
      const std::string answer = ask(columns[i].count, row.cases);
      const bool right = answer == truth;
      wrong[i] += !right;
      std::cout << ' ' << (right ? "right" : "**" + answer + "**") << " |";
    }
    std::cout << std::endl;
  }
  std::cout << "| wrong rows | |";
  for (const int count : wrong) std::cout << ' ' << count << " |";
  std::cout << '\n';
}

} // namespace
} // namespace pcl_bsh

int main(int argc, char** argv)
{
  if (argc > 1) {
    std::cerr << "usage: " << argv[0] << "\nPrints the catalogue of hard cases as a table: ours and peers' answers.\n";
    return std::string(argv[1]) == "--help" ? 0 : 2;
  }
  try {
    pcl_bsh::printTable();
  }
  catch (const std::exception& error) {
    std::cerr << "hard_cases_peers: " << error.what() << '\n';
    return 1;
  }
}
