// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_peers.h"

#include <pcl_bsh/tools/accuracy/stopwatch.h>

#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace pcl_bsh::accuracy {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Tree = pcl::KdTreeFLANN<pcl::PointXYZ>;
using Octree = pcl::octree::OctreePointCloudSearch<pcl::PointXYZ>;
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

/// The answer of one way of asking PCL at one pose.
struct Answer {
  std::vector<Verdict> flags; ///< per finite point of a; empty: not asked
  double distance = infinity;
};

/// The leaf sizes that users try first: from below the clearance to several times it, in round numbers.
std::vector<double> leavesFor(const Subject& subject)
{
  const double base = subject.clearance > 0.0 ? subject.clearance : 1e-3 * subject.diameter;
  std::vector<double> leaves;
  for (const double part : {0.3, 1.0, 3.0, 10.0}) leaves.push_back(roundLength(part * base));
  return leaves;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud, double leaf)
{
  auto thin = pcl::make_shared<Cloud>();
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(static_cast<float>(leaf), static_cast<float>(leaf), static_cast<float>(leaf));
  grid.filter(*thin);
  return thin;
}

/// The squared distance to the nearest point.
auto nearestIn(const Tree& tree)
{
  return [&tree, index = pcl::Indices(1), squared = std::vector<float>(1)](const pcl::PointXYZ& p) mutable {
    return tree.nearestKSearch(p, 1, index, squared) > 0 ? squared[0] : std::numeric_limits<float>::infinity();
  };
}

/// One way down the octree, without a look at the neighbouring cells.
auto roughlyIn(Octree& tree)
{
  return [&tree](const pcl::PointXYZ& p) {
    pcl::index_t index = 0;
    float squared = 0.0f;
    tree.approxNearestSearch(p, index, squared);
    return squared;
  };
}

class Peers {
public:
  Peers(const Subject& subject, unsigned repetitions, const Progress& progress)
  : subject_(subject),
    repetitions_(repetitions),
    progress_(progress),
    origin_a_(middleOf(subject.a)),
    origin_b_(middleOf(subject.b)),
    a_(finiteOf(subject.a, origin_a_)),
    b_(finiteOf(subject.b, origin_b_)),
    a_asks_(a_.cloud->size() <= b_.cloud->size())
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
    const std::vector<double> leaves = leavesFor(subject_);
    const Cloud& asking = a_asks_ ? *a_.cloud : *b_.cloud;
    const Cloud::Ptr asked = a_asks_ ? b_.cloud : a_.cloud;
    for (const float epsilon : {0.0f, 0.5f, 2.0f}) {
      Tree tree;
      tree.setEpsilon(epsilon);
      begin(epsilon == 0.0f ? "k-d tree" : "approximate k-d tree", "epsilon", epsilon);
      const double making = secondsOf([&] { tree.setInputCloud(asked); });
      measure("flags", making, [&](const Eigen::Affine3f& to_b) { return flagsOf(asking, tree, to_b); });
      measure("distance", making,
              [&](const Eigen::Affine3f& to_b) { return nearestOf(asking, nearestIn(tree), to_b); });
    }
    for (const double leaf : leaves) {
      if (leaf < subject_.clearance) continue; // finds still less, and takes much memory
      begin("octree", "leaf", leaf);
      Octree tree(leaf);
      const double making = secondsOf([&] {
        tree.deleteTree();
        tree.setInputCloud(asked);
        tree.addPointsFromInputCloud();
      });
      measure("distance", making,
              [&](const Eigen::Affine3f& to_b) { return nearestOf(asking, roughlyIn(tree), to_b); });
      measure("flags", making, [&](const Eigen::Affine3f& to_b) { return sharedVoxels(asking, tree, to_b); });
    }
    for (const double leaf : leaves) {
      begin("VoxelGrid + k-d tree", "leaf", leaf);
      Cloud::Ptr thin_a, thin_b;
      const double thinning_a = secondsOf([&] { thin_a = thinned(a_.cloud, leaf); });
      const double thinning_b = secondsOf([&] { thin_b = thinned(b_.cloud, leaf); });
      Tree tree;
      const Cloud& few = a_asks_ ? *thin_a : *thin_b;
      const double making = secondsOf([&] { tree.setInputCloud(a_asks_ ? thin_b : thin_a); });
      measure("distance", thinning_a + thinning_b + making,
              [&](const Eigen::Affine3f& to_b) { return nearestOf(few, nearestIn(tree), to_b); });
      // Flags are wanted of every point of a, which therefore is not thinned.
      const Cloud& flagging = a_asks_ ? *a_.cloud : *thin_b;
      const double making_all = secondsOf([&] { tree.setInputCloud(a_asks_ ? thin_b : a_.cloud); });
      measure("flags", thinning_b + making_all,
              [&](const Eigen::Affine3f& to_b) { return flagsOf(flagging, tree, to_b); });
    }
    return std::move(measurements_);
  }

private:
  /// Begins the measurements of this way.
  void begin(const std::string& knob, const char* dial, double value)
  {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%s=%.3g", dial, value);
    knob_ = knob;
    setting_ = text.data();
    progress_(knob_ + " " + setting_, 0.9);
  }

  /// The median of the repetitions.
  template <class Make>
  double secondsOf(const Make& make) const
  {
    std::vector<double> seconds;
    for (unsigned repetition = 0; repetition < repetitions_; ++repetition) {
      const Stopwatch watch(1);
      make();
      seconds.push_back(watch.seconds());
    }
    return spreadOf(seconds).median;
  }

  /// @param making seconds that were spent before there was anything to ask
  template <class Ask>
  void measure(const char* query, double making, const Ask& ask)
  {
    Measurement m;
    m.query = query;
    m.knob = knob_;
    m.setting = setting_;
    m.peer = true;
    m.certified = false;
    m.poses = subject_.poses.size();
    std::vector<std::vector<double>> seconds(m.poses);
    for (unsigned repetition = 0; repetition < repetitions_; ++repetition) {
      for (std::size_t i = 0; i < subject_.poses.size(); ++i) {
        const Stopwatch watch(1);
        const Answer answer = ask(fromAToB(i));
        seconds[i].push_back(watch.seconds());
        if (repetition == 0) judge(answer, i, m);
      }
    }
    if (m.query == "flags")
      m.actual_error = static_cast<double>(m.wrong) /
                       static_cast<double>(subject_.poses.size() * std::max<std::size_t>(1, a_.cloud->size()));
    m.seconds = spreadOfPoses(seconds);
    m.once = {making + m.seconds.low, making + m.seconds.median, making + m.seconds.high};
    measurements_.push_back(std::move(m));
  }

  void judge(const Answer& answer, std::size_t pose, Measurement& m) const
  {
    if (m.query == "distance") m.actual_error = std::max(m.actual_error, std::abs(answer.distance - distances_[pose]));
    for (std::size_t i = 0; i < answer.flags.size(); ++i)
      m.wrong += answer.flags[i] != truths_[pose][a_.records[i]] ? 1 : 0;
  }

  /// From the frame about a's middle to that about b's.
  Eigen::Affine3f fromAToB(std::size_t pose) const
  {
    const Eigen::Vector3d about_a(origin_a_[0], origin_a_[1], origin_a_[2]),
        about_b(origin_b_[0], origin_b_[1], origin_b_[2]);
    const Eigen::Isometry3d b_a = subject_.poses[pose].inverse();
    return Eigen::Affine3f(
        (Eigen::Translation3d(-about_b) * b_a * Eigen::Translation3d(about_a)).matrix().cast<float>());
  }

  Eigen::Affine3f toTree(const Eigen::Affine3f& to_b) const
  {
    return a_asks_ ? to_b : Eigen::Affine3f(Eigen::Isometry3f(to_b.matrix()).inverse().matrix());
  }

  static pcl::PointXYZ moved(const pcl::PointXYZ& point, const Eigen::Affine3f& motion)
  {
    pcl::PointXYZ p;
    p.getVector3fMap() = motion * point.getVector3fMap();
    return p;
  }

  /// The points of a that ask whether any of the tree is near, or those that points of b find in the tree of a.
  Answer flagsOf(const Cloud& asking, const Tree& tree, const Eigen::Affine3f& to_b) const
  {
    const Eigen::Affine3f motion = toTree(to_b);
    Answer answer;
    answer.flags.resize(a_.cloud->size());
    pcl::Indices found;
    std::vector<float> squared;
    for (std::size_t i = 0; i < asking.size(); ++i) {
      const int count =
          tree.radiusSearch(moved(asking[i], motion), subject_.clearance, found, squared, a_asks_ ? 1 : 0);
      if (a_asks_)
        answer.flags[i] = count > 0 ? Verdict::colliding : Verdict::free;
      else
        for (const pcl::index_t index : found) answer.flags[static_cast<std::size_t>(index)] = Verdict::colliding;
    }
    return answer;
  }

  /// Points in one voxel of the octree count as colliding.
  Answer sharedVoxels(const Cloud& asking, Octree& tree, const Eigen::Affine3f& to_b) const
  {
    const Eigen::Affine3f motion = toTree(to_b);
    Answer answer;
    answer.flags.resize(a_.cloud->size());
    pcl::Indices found;
    for (std::size_t i = 0; i < asking.size(); ++i) {
      const pcl::PointXYZ point = moved(asking[i], motion);
      if (!tree.isVoxelOccupiedAtPoint(point)) continue;
      if (a_asks_) {
        answer.flags[i] = Verdict::colliding;
        continue;
      }
      found.clear();
      tree.voxelSearch(point, found);
      for (const pcl::index_t index : found) answer.flags[static_cast<std::size_t>(index)] = Verdict::colliding;
    }
    return answer;
  }

  template <class Nearest>
  Answer nearestOf(const Cloud& asking, Nearest nearest, const Eigen::Affine3f& to_b) const
  {
    const Eigen::Affine3f motion = toTree(to_b);
    float least = std::numeric_limits<float>::infinity();
    for (const pcl::PointXYZ& point : asking) least = std::min(least, nearest(moved(point, motion)));
    return {{}, std::sqrt(static_cast<double>(least))};
  }

  const Subject& subject_;
  unsigned repetitions_;
  const Progress& progress_;
  Point3 origin_a_, origin_b_;
  Finite a_, b_;
  bool a_asks_; ///< the smaller cloud asks a tree of the larger, which is the faster way round
  std::string knob_, setting_;
  std::vector<std::vector<Verdict>> truths_;
  std::vector<double> distances_;
  std::vector<Measurement> measurements_;
};

} // namespace

std::vector<Measurement> measurePeers(const Subject& subject, unsigned repetitions, const Progress& progress)
{
  if (subject.a.triangles || subject.b.triangles)
    throw std::invalid_argument("A, B: a mesh has faces, and PCL's ways ask about points: give --vertices-only");
  return Peers(subject, repetitions, progress).run();
}

} // namespace pcl_bsh::accuracy
