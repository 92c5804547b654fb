// SPDX-License-Identifier: BSD-3-Clause
#include "peers.h"

#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace pcl_bsh::accuracy {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Clock = std::chrono::steady_clock;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The finite points about `origin`, and which records they were.
struct Finite {
  Cloud::Ptr cloud = pcl::make_shared<Cloud>();
  std::vector<std::uint32_t> records;
};

Finite finiteOf(const PointsView& view, const Point3& origin)
{
  Finite finite;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    finite.cloud->emplace_back(static_cast<float>(p[0] - origin[0]), static_cast<float>(p[1] - origin[1]),
                               static_cast<float>(p[2] - origin[2]));
    finite.records.push_back(view.record(i));
  }
  return finite;
}

Point3 middleOf(const PointsView& view)
{
  Point3 low = {infinity, infinity, infinity}, high = {-infinity, -infinity, -infinity};
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    for (std::size_t k = 0; k < 3; ++k) {
      if (!std::isfinite(p[k])) continue;
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
}

/// What one way of asking PCL found at one pose.
struct Answer {
  std::vector<std::uint8_t> flags; ///< per point of the cloud that asked; empty: not asked
  double distance = infinity;
};

Cloud thinned(const Cloud::Ptr& cloud, double leaf)
{
  Cloud thin;
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(static_cast<float>(leaf), static_cast<float>(leaf), static_cast<float>(leaf));
  grid.filter(thin);
  return thin;
}

class Peers {
public:
  Peers(const Subject& subject, unsigned repetitions, const Progress& progress)
  : subject_(subject),
    repetitions_(repetitions),
    progress_(progress),
    origin_(middleOf(subject.a)),
    a_(finiteOf(subject.a, origin_)),
    b_(finiteOf(subject.b, middleOf(subject.b))),
    origin_b_(middleOf(subject.b))
  {
    const SphereHierarchy a(subject.a), b(subject.b);
    for (const Eigen::Isometry3d& pose : subject.poses) {
      FlagsRequest request;
      request.clearance = subject.clearance;
      truths_.push_back(collisionFlags({a}, {b, pose}, request).a);
      distances_.push_back(closestPair({a}, {b, pose}).distance);
    }
  }

  std::vector<Measurement> run()
  {
    for (const float epsilon : {0.0f, 0.5f, 2.0f}) {
      pcl::KdTreeFLANN<pcl::PointXYZ> tree;
      tree.setEpsilon(epsilon);
      tree.setInputCloud(b_.cloud);
      const std::string knob = epsilon == 0.0f ? "PCL kd-tree" : "PCL approximate kd-tree";
      measure(knob, "epsilon=" + trimmed(epsilon), *a_.cloud, tree, true);
    }
    {
      pcl::octree::OctreePointCloudSearch<pcl::PointXYZ> tree(std::max(subject_.clearance, 1e-4 * subject_.diameter));
      tree.setInputCloud(b_.cloud);
      tree.addPointsFromInputCloud();
      measure("PCL octree", "resolution=clearance", *a_.cloud, tree, true);
    }
    for (const double part : {0.001, 0.003, 0.01, 0.03}) {
      const double leaf = part * subject_.diameter;
      const Cloud thin_a = thinned(a_.cloud, leaf), thin_b = thinned(b_.cloud, leaf);
      pcl::KdTreeFLANN<pcl::PointXYZ> tree;
      tree.setInputCloud(thin_b.makeShared());
      // Flags are wanted of every point; a distance is not.
      measure("VoxelGrid + kd-tree", "leaf=" + trimmed(leaf), *a_.cloud, tree, true, false);
      measure("VoxelGrid + kd-tree", "leaf=" + trimmed(leaf), thin_a, tree, false);
    }
    return std::move(measurements_);
  }

private:
  static std::string trimmed(double value)
  {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
  }

  template <class Search>
  void measure(const std::string& knob, const std::string& setting, const Cloud& asking, Search& search, bool flags,
               bool distance = true)
  {
    progress_(knob + " " + setting, 0.9);
    if (flags) measureQuery("flags", knob, setting, asking, search);
    if (distance) measureQuery("distance", knob, setting, asking, search);
  }

  template <class Search>
  void measureQuery(const char* query, const std::string& knob, const std::string& setting, const Cloud& asking,
                    Search& search)
  {
    const bool flags = std::string(query) == "flags";
    Measurement m;
    m.query = query;
    m.knob = knob;
    m.setting = setting;
    m.certified = false;
    m.poses = subject_.poses.size();
    std::vector<double> seconds;
    for (unsigned repetition = 0; repetition < repetitions_; ++repetition) {
      double total = 0.0;
      for (std::size_t i = 0; i < subject_.poses.size(); ++i) {
        const auto start = Clock::now();
        const Answer answer = flags ? flagsOf(asking, search, i) : nearestOf(asking, search, i);
        total += std::chrono::duration<double>(Clock::now() - start).count();
        if (repetition == 0) judge(answer, i, flags, m);
      }
      seconds.push_back(total / static_cast<double>(subject_.poses.size()));
    }
    const auto poses = static_cast<double>(subject_.poses.size());
    m.actual_error =
        flags ? static_cast<double>(m.wrong) / (poses * static_cast<double>(a_.cloud->size())) : m.actual_error / poses;
    m.seconds = spreadOf(seconds);
    measurements_.push_back(std::move(m));
  }

  void judge(const Answer& answer, std::size_t pose, bool flags, Measurement& m) const
  {
    if (!flags) {
      m.actual_error += std::abs(answer.distance - distances_[pose]);
      return;
    }
    for (std::size_t i = 0; i < answer.flags.size(); ++i)
      m.wrong += answer.flags[i] != truths_[pose][a_.records[i]] ? 1 : 0;
  }

  /// From the frame about a's middle to that about b's.
  Eigen::Affine3f toB(std::size_t pose) const
  {
    const Eigen::Vector3d about_a(origin_[0], origin_[1], origin_[2]),
        about_b(origin_b_[0], origin_b_[1], origin_b_[2]);
    const Eigen::Isometry3d b_a = subject_.poses[pose].inverse();
    return Eigen::Affine3f(
        (Eigen::Translation3d(-about_b) * b_a * Eigen::Translation3d(about_a)).matrix().cast<float>());
  }

  template <class Search>
  Answer flagsOf(const Cloud& asking, Search& search, std::size_t pose) const
  {
    const Eigen::Affine3f motion = toB(pose);
    Answer answer;
    answer.flags.resize(asking.size());
    pcl::Indices indices;
    std::vector<float> squared;
    for (std::size_t i = 0; i < asking.size(); ++i) {
      pcl::PointXYZ p;
      p.getVector3fMap() = motion * asking[i].getVector3fMap();
      answer.flags[i] = search.radiusSearch(p, subject_.clearance, indices, squared, 1) > 0 ? 1 : 0;
    }
    return answer;
  }

  template <class Search>
  Answer nearestOf(const Cloud& asking, Search& search, std::size_t pose) const
  {
    const Eigen::Affine3f motion = toB(pose);
    pcl::Indices indices(1);
    std::vector<float> squared(1);
    float least = std::numeric_limits<float>::infinity();
    for (const pcl::PointXYZ& q : asking) {
      pcl::PointXYZ p;
      p.getVector3fMap() = motion * q.getVector3fMap();
      if (search.nearestKSearch(p, 1, indices, squared) > 0) least = std::min(least, squared[0]);
    }
    return {{}, std::sqrt(static_cast<double>(least))};
  }

  const Subject& subject_;
  unsigned repetitions_;
  const Progress& progress_;
  Point3 origin_;
  Finite a_, b_;
  Point3 origin_b_;
  std::vector<std::vector<std::uint8_t>> truths_;
  std::vector<double> distances_;
  std::vector<Measurement> measurements_;
};

} // namespace

std::vector<Measurement> measurePeers(const Subject& subject, unsigned repetitions, const Progress& progress)
{
  return Peers(subject, repetitions, progress).run();
}

} // namespace pcl_bsh::accuracy
