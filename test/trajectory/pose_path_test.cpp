// SPDX-License-Identifier: BSD-3-Clause
// The bounds of a path, each attacked by a search that climbs towards the place where it is tight.
#include <pcl_bsh/trajectory/boxes/box_tree.h>
#include <pcl_bsh/trajectory/pose_path.h>

#include "support/allocations.h"
#include "support/journeys.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::identity;
using test::Poses;
using test::Random;

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;

/// Climbs from any start in [-1, 1]^Count: a step in any direction is kept where it gains, and steps get shorter where
/// none does. @return the largest value seen
template <std::size_t Count, class Value>
double climb(const Value& value, int starts, int steps, Random& random)
{
  double highest = 0.0;
  for (int start = 0; start < starts; ++start) {
    std::array<double, Count> at;
    for (double& x : at) x = random.uniform(-1, 1);
    double best = value(at), length = 0.5;
    for (int i = 0; i < steps; ++i) {
      std::array<double, Count> next = at;
      for (double& x : next) x = std::clamp(x + length * random.uniform(-1, 1), -1.0, 1.0);
      const double there = value(next);
      if (there > best) {
        best = there;
        at = next;
      }
      else {
        length = std::max(length * 0.97, 1e-6);
      }
    }
    highest = std::max(highest, best);
  }
  return highest;
}

PosePath pathOf(const Poses& poses, const PosePath::Sweep* sweep = nullptr)
{
  const std::function<bool(double)> silent;
  Progress progress(silent);
  return sweep ? PosePath(identity, poses, {0, 0, 0}, *sweep, progress)
               : PosePath(identity, poses, {0, 0, 0}, progress);
}

Vector seen(const Eigen::Isometry3d& pose, const Vector& world)
{
  return pose.linear().cast<Real>().transpose() * (world - pose.translation().cast<Real>());
}

Eigen::Isometry3d poseOf(const double* x, double reach, double turn)
{
  Eigen::Isometry3d pose = identity;
  pose.translation() = reach * Eigen::Vector3d(x[0], x[1], x[2]);
  const Eigen::Vector3d axis(x[3], x[4], x[5]);
  if (axis.norm() > 0.0) pose.linear() = Eigen::AngleAxisd(turn * axis.norm(), axis.normalized()).toRotationMatrix();
  return pose;
}

/// The parabola through three places, the second of them at t = `at_middle`.
Vector onParabola(const Vector& from, const Vector& middle, const Vector& to, Real at_middle, Real t)
{
  const Vector line = (1 - at_middle) * from + at_middle * to;
  return (1 - t) * from + t * to + (middle - line) * (t * (1 - t) / (at_middle * (1 - at_middle)));
}

/// How much of the bound on straying from a parabola a point of the world reaches, at the poses of an interval.
double bendShareAtPoses(const PathInterval& interval, const Poses& poses, const Vector& point)
{
  const Vector pivot(interval.pivot[0], interval.pivot[1], interval.pivot[2]);
  const Real bound = interval.bend_drift + interval.bend_turn * (point - pivot).norm();
  if (interval.last - interval.first < 3) return 0.0; // through all
  const Real steps = interval.last - interval.first, middle = interval.middle() - interval.first;
  Real most = 0;
  for (std::uint32_t k = interval.first; k <= interval.last; ++k)
    most = std::max(most, (seen(poses[k], point) - onParabola(seen(poses[interval.first], point),
                                                              seen(poses[interval.middle()], point),
                                                              seen(poses[interval.last], point), middle / steps,
                                                              static_cast<Real>(k - interval.first) / steps))
                              .norm());
  return static_cast<double>(bound > 0 ? most / bound : Real(most > 0));
}

/// Four poses and a point: 4 x 6 + 3 numbers.
double bendShare(const std::array<double, 27>& x, double reach, double turn, double away)
{
  const Poses poses = {poseOf(&x[0], reach, turn), poseOf(&x[6], reach, turn), poseOf(&x[12], reach, turn),
                       poseOf(&x[18], reach, turn)};
  for (std::size_t k = 1; k < poses.size(); ++k)
    if (poses[k].matrix() == poses[k - 1].matrix()) return 0.0;
  const PosePath path = pathOf(poses);
  return bendShareAtPoses(path.intervals[0], poses, away * Vector(x[24], x[25], x[26]));
}

TEST(PosePath, NoPointStraysFartherFromTheParabolaAtPoses)
{
  Random random(4);
  double straight = 0.0, any = 0.0;
  for (const double scale : {1e-3, 1.0, 1e4}) {
    const auto of = [&](double reach, double turn, double away) {
      return climb<27>([&](const auto& x) { return bendShare(x, reach, turn, away); }, 6, 400, random);
    };
    straight = std::max(straight, of(scale, 0.0, scale));
    any = std::max(
        {any, of(0.0, 1.5, scale), of(scale, 1.5, scale), of(scale, 0.01, 100 * scale), of(100 * scale, 0.01, scale)});
  }
  EXPECT_LE(straight, 1.0);
  EXPECT_GT(straight, 0.999) << "a translation strays by the drift itself";
  EXPECT_LE(any, 1.0);
  EXPECT_GT(any, 0.65);
  RecordProperty("straight", std::to_string(straight));
  RecordProperty("any", std::to_string(any));
}

/// A bend, as of a track: the parabola's bound falls with the cube of the interval, the line's with its square.
TEST(PosePath, ABendStraysLessFromTheParabola)
{
  Poses poses;
  for (int i = 0; i <= 256; ++i) {
    poses.emplace_back(Eigen::AngleAxisd(0.0002 * i, Eigen::Vector3d::UnitZ()));
    poses.back().translation() = 180.0 * Eigen::Vector3d(std::sin(0.0002 * i), 1 - std::cos(0.0002 * i), 0);
  }
  const PosePath path = pathOf(poses);
  const PathInterval &whole = path.intervals[0], &half = path.intervals[whole.left];
  const auto bend = [](const PathInterval& interval) { return interval.bend_drift + 2.0 * interval.bend_turn; };
  EXPECT_LT(bend(whole), 0.03 * (whole.drift + 2.0 * whole.turn));
  EXPECT_LT(bend(half), 0.14 * bend(whole));
}

/// How much of the bound on straying a point of the world reaches, at the poses of an interval.
double shareAtPoses(const PosePath& path, const PathInterval& interval, const Poses& poses, const Vector& point)
{
  const Vector pivot(interval.pivot[0], interval.pivot[1], interval.pivot[2]);
  const Real bound = interval.drift + interval.turn * (point - pivot).norm();
  const Vector from = seen(poses[interval.first], point), to = seen(poses[interval.last], point);
  Real most = 0;
  for (std::uint32_t k = interval.first; k <= interval.last; ++k) {
    const Real t =
        interval.last > interval.first ? static_cast<Real>(k - interval.first) / (interval.last - interval.first) : 0;
    most = std::max(most, (seen(poses[k], point) - ((1 - t) * from + t * to)).norm());
  }
  EXPECT_EQ(path.poses.size(), poses.size());
  return static_cast<double>(bound > 0 ? most / bound : Real(most > 0));
}

/// Three poses and a point: 6 + 6 + 6 + 3 numbers.
double discreteShare(const std::array<double, 21>& x, double reach, double turn, double away)
{
  const Poses poses = {poseOf(&x[0], reach, turn), poseOf(&x[6], reach, turn), poseOf(&x[12], reach, turn)};
  if (poses[0].matrix() == poses[1].matrix() || poses[1].matrix() == poses[2].matrix()) return 0.0;
  return [&] {
    const PosePath path = pathOf(poses);
    double share = 0.0;
    for (const PathInterval& interval : path.intervals)
      share = std::max(share, shareAtPoses(path, interval, poses, away * Vector(x[18], x[19], x[20])));
    return share;
  }();
}

TEST(PosePath, NoPointStraysFartherAtPoses)
{
  Random random(1);
  double straight = 0.0, on_the_spot = 0.0, any = 0.0;
  for (const double scale : {1e-3, 1.0, 1e4}) {
    const auto of = [&](double reach, double turn, double away) {
      return climb<21>([&](const auto& x) { return discreteShare(x, reach, turn, away); }, 6, 400, random);
    };
    straight = std::max(straight, of(scale, 0.0, scale));
    on_the_spot = std::max(on_the_spot, of(0.0, 1.5, scale));
    any = std::max({any, of(scale, 1.5, scale), of(scale, 0.01, 100 * scale), of(100 * scale, 0.01, scale)});
  }
  EXPECT_LE(straight, 1.0);
  EXPECT_GT(straight, 0.999) << "a translation strays by the drift itself";
  EXPECT_LE(on_the_spot, 1.0);
  // Not tight. The difference of rotations is measured by a Frobenius norm, which exceeds the spectral norm: by sqrt(2)
  // for turns about one axis, where two singular values are equal. About any axes the search gets to 0.82 of the bound.
  EXPECT_GT(on_the_spot, 0.65);
  EXPECT_LE(any, 1.0);
  EXPECT_GT(any, 0.65);
  RecordProperty("straight", std::to_string(straight));
  RecordProperty("on_the_spot", std::to_string(on_the_spot));
  RecordProperty("any", std::to_string(any));
}

/// Two poses, the point (at a distance from the pivot's way), an instant: 6 + 6 + 3 + 1 numbers.
double sweptShare(const std::array<double, 16>& x, double reach, double turn, double away)
{
  const Poses poses = {poseOf(&x[0], reach, turn), poseOf(&x[6], reach, turn)};
  const PosePath::Sweep sweep{{0, 0, 0}, 1e30, 1.0, 0.0, 1e30, 1e30}; // so coarse that the motion is one part
  const PosePath path = pathOf(poses, &sweep);
  const PathInterval& interval = path.intervals[0];
  if (path.poses.size() != 2) return 0.0;
  const Vector point = away * Vector(x[12], x[13], x[14]);
  const Real t = (x[15] + 1) / 2;
  // By the definition of the motion, in long double.
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  Matrix first = poses[0].linear().cast<Real>(), last = poses[1].linear().cast<Real>();
  for (Matrix* m : {&first, &last})
    for (int i = 0; i < 3; ++i) *m = (0.5L * (*m + m->inverse().transpose())).eval();
  const Eigen::AngleAxis<Real> rotation(Matrix(last * first.transpose()));
  const Matrix turned = Eigen::AngleAxis<Real>(t * rotation.angle(), rotation.axis()).toRotationMatrix() * first;
  const Vector a = poses[0].translation().cast<Real>(), b = poses[1].translation().cast<Real>();
  const Vector from = first.transpose() * (point - a), to = last.transpose() * (point - b);
  const Real strays = (turned.transpose() * (point - ((1 - t) * a + t * b)) - ((1 - t) * from + t * to)).norm();
  const Vector pivot(interval.pivot[0], interval.pivot[1], interval.pivot[2]);
  const Real bound = interval.drift + interval.turn * (point - pivot).norm();
  // The bound near the model: what the motion is cut by, for a point that comes within `away` of its pivot.
  const Real angle = rotation.angle(), way = (b - a).norm();
  const Real near =
      (angle * angle * (away * 1.7320508075688773L + reach * 1.7320508075688773L + way) + 2 * angle * way) / 8;
  EXPECT_LE(strays, near * (1 + 1e-12L) + 1e-17L * (away + reach));
  return static_cast<double>(bound > 0 ? strays / bound : Real(strays > 0));
}

TEST(PosePath, NoPointStraysFartherBetweenPoses)
{
  Random random(2);
  double on_the_spot = 0.0, any = 0.0;
  for (const double scale : {1e-3, 1.0, 1e4})
    for (const double turn : {1e-3, 0.1, 0.9}) {
      const auto of = [&](double reach, double away) {
        return climb<16>([&](const auto& x) { return sweptShare(x, reach, turn, away); }, 4, 600, random);
      };
      on_the_spot = std::max(on_the_spot, of(0.0, scale));
      any = std::max({any, of(scale, scale), of(scale, 1e-3 * scale), of(1e-3 * scale, scale)});
    }
  EXPECT_LE(on_the_spot, 1.0);
  EXPECT_GT(on_the_spot, 0.99) << "a small turn bows out by its angle squared over eight";
  EXPECT_LE(any, 1.0);
  EXPECT_GT(any, 0.8);
  RecordProperty("on_the_spot", std::to_string(on_the_spot));
  RecordProperty("any", std::to_string(any));
}

/// Merged intervals of a swept path, too, at instants between poses; with poses that stretch the model.
TEST(PosePath, NoPointStraysFartherInWholeIntervals)
{
  Random random(3);
  double highest = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double scale = std::exp2(random.integer(-4, 4)), turn = random.uniform(0, 1);
    Poses poses;
    for (int k = random.integer(2, 6); k > 0; --k) {
      double x[6];
      for (double& value : x) value = random.uniform(-1, 1);
      poses.push_back(poseOf(x, scale, turn));
      if (i % 3 == 0) poses.back().linear() *= 1.0 + 2e-7 * random.uniform(-1, 1);
    }
    const double radius = scale;
    const PosePath::Sweep sweep{{0, 0, 0}, radius, radius, scale, 0.05 * scale, scale};
    const PosePath path = pathOf(poses, &sweep);
    for (int sample = 0; sample < 200; ++sample) {
      const PathInterval& interval =
          path.intervals[static_cast<std::size_t>(random.integer(0, static_cast<int>(path.intervals.size()) - 1))];
      if (interval.last == interval.first) continue;
      const Vector point{scale * random.uniform(-2, 2), scale * random.uniform(-2, 2), scale * random.uniform(-2, 2)};
      const Eigen::Vector3d of_model =
          radius * Eigen::Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}.normalized();
      // From a point of the model to the point, seen by the model, at a pose of the path.
      const auto apart = [&](std::uint32_t k) -> Vector {
        const PathPose& pose = path.poses[k];
        const Point3 at =
            pose.see({static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2])});
        const Point3 model = path.stretched(k, {of_model[0], of_model[1], of_model[2]});
        return {at[0] - model[0], at[1] - model[1], at[2] - model[2]};
      };
      const Vector from = apart(interval.first), to = apart(interval.last);
      const Vector pivot(interval.pivot[0], interval.pivot[1], interval.pivot[2]);
      const Real bound = interval.drift + interval.turn * (point - pivot).norm();
      const Real bend_bound = interval.bend_drift + interval.bend_turn * (point - pivot).norm();
      const auto bent = [&](Real t) -> Vector {
        if (interval.last - interval.first < 2) return (1 - t) * from + t * to;
        const Real middle = interval.middle() - interval.first;
        return onParabola(from, apart(interval.middle()), to, middle / (interval.last - interval.first), t);
      };
      for (std::uint32_t k = interval.first; k <= interval.last; ++k) {
        const Real t = static_cast<Real>(k - interval.first) / (interval.last - interval.first);
        const Real strays = (apart(k) - ((1 - t) * from + t * to)).norm();
        ASSERT_LE(strays, bound + 1e-14L * scale) << "pose " << k;
        ASSERT_LE((apart(k) - bent(t)).norm(), bend_bound + 1e-14L * scale) << "pose " << k;
        if (bound > 0) highest = std::max(highest, static_cast<double>(strays / bound));
        if (k == interval.last) continue;
        // Between it and the next, lengths are those of the motion itself, which poseBetween() knows.
        const PathPose &here = path.poses[k], &next = path.poses[k + 1];
        const double f = random.uniform(0, 1), end = next.given == here.given ? next.fraction : 1.0;
        const Eigen::Isometry3d pose =
            poseBetween(poses[here.given], poses[std::min<std::size_t>(here.given + 1, poses.size() - 1)],
                        here.fraction + (end - here.fraction) * f);
        const Real length =
            (point - pose.linear().cast<Real>() * of_model.cast<Real>() - pose.translation().cast<Real>()).norm();
        const Real at = (static_cast<Real>(k - interval.first) + f) / (interval.last - interval.first);
        const Real line = ((1 - at) * from + at * to).norm();
        ASSERT_LE(std::abs(length - line), bound + 1e-13L * scale) << "between " << k << " and the next";
        ASSERT_LE(std::abs(length - bent(at).norm()), bend_bound + 1e-13L * scale)
            << "between " << k << " and the next";
      }
    }
  }
  EXPECT_LE(highest, 1.0 + 1e-9);
  EXPECT_GT(highest, 0.5);
  RecordProperty("highest", std::to_string(highest));
}

TEST(PosePath, RefusesTooLongAPathBeforeItTakesMemory)
{
  Poses poses(100, identity);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    poses[k].linear() = Eigen::AngleAxisd(k % 2 == 0 ? 0.0 : 3.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
    poses[k].translation().x() = k % 2 == 0 ? 0.0 : 100.0;
  }
  const PosePath::Sweep sweep{{0, 0, 0}, 1.0, 1.0, 1.0, 1e-8, 1e-9};
  const std::size_t before = test::allocations();
  try {
    pathOf(poses, &sweep);
    ADD_FAILURE();
  }
  catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("would be cut into"),
                                             testing::HasSubstr("are the most"), testing::HasSubstr("from pose 0")));
  }
  EXPECT_LT(test::allocations() - before, 60u) << "of messages alone: no pose of the path is made";
}

TEST(PosePath, KnowsHowFarFromTheOriginItLeads)
{
  Poses poses(3, identity);
  poses[1].translation() = Eigen::Vector3d(3, -7, 5);
  EXPECT_EQ(pathOf(poses).far, 7.0);
}

/// The longer a part, the coarser a double tells where on it something happens; one of the motions is short.
TEST(PosePath, RefusesPartsInWhichADoubleTellsNoInstant)
{
  Poses poses;
  for (int k = 0; k < 50; ++k) poses.push_back(identity * Eigen::Translation3d(k < 49 ? 1e6 * k : 48e6 + 1.0, 0, 0));
  PosePath::Sweep sweep{{0, 0, 0}, 1.0, 1.0, 1.0, 1e-3, 1e-7};
  EXPECT_EQ(pathOf(poses, &sweep).poses.size(), 50u) << "2^-52 of 50 parts of 1e6 is 1e-8";
  sweep.rounding = 1e-9;
  try {
    pathOf(poses, &sweep);
    ADD_FAILURE();
  }
  catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("tells an instant among 50 parts of the motion"));
  }
}

/// Visits the leaves below a node of boxes, each with all boxes around it.
void forEachLeaf(const std::vector<BoxNode>& boxes, std::uint32_t node,
                 std::vector<std::pair<const BoxNode*, std::uint32_t>>& around,
                 const std::function<void(std::uint32_t leaf)>& visit)
{
  ASSERT_GE(boxes[node].count, 1u);
  for (std::uint32_t lane = 0; lane < boxes[node].count; ++lane) {
    around.emplace_back(&boxes[node], lane);
    if (boxes[node].isLeaf(lane))
      visit(boxes[node].leaf(lane));
    else
      forEachLeaf(boxes, boxes[node].child[lane], around, visit);
    around.pop_back();
  }
}

/// Whether a point is one of many that coincide, and not the first of them.
bool isRepeated(const Voxel& voxel, std::uint32_t place)
{
  for (const Node& node : voxel.nodes)
    for (std::uint32_t lane = 0; lane < node.count; ++lane)
      if (node.isLeaf(lane) && node.begin[lane] <= place && place < node.begin[lane + 1])
        return node.isCoincident(lane) && place > node.begin[lane];
  return false;
}

TEST(BoxTree, BoxesHoldTheirPointsExactly)
{
  using Rational = boost::multiprecision::cpp_rational;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double far = random.chance(0.5) ? 1e6 : 0.0;
    const Cloud cloud = test::anyCloud(static_cast<std::size_t>(random.integer(1, 300)),
                                       std::exp2(random.integer(-10, 4)), {far, -far, far / 3}, random);
    const SphereHierarchy hierarchy(cloud.view());
    const bool points = arePoints(cloud.view());
    const Travel travel{{random.uniform(0, 1), random.uniform(0, 0.1), 0}, random.uniform(0, 1e-3)};
    const BoxTree tree(hierarchy.storage(), travel);
    if (hierarchy.empty()) continue;
    Work work;
    for (std::uint32_t v = 0; v < hierarchy.storage().voxel_count; ++v) {
      const BoxedVoxel& boxed = tree.voxel(v, work);
      const Voxel& voxel = hierarchy.storage().voxels[v];
      std::map<std::uint32_t, std::uint32_t> places; // by record
      for (std::uint32_t i = 0; i < voxel.count; ++i) places[voxel.records()[i]] = i;
      std::vector<std::pair<const BoxNode*, std::uint32_t>> around;
      forEachLeaf(boxed.boxes(), 0, around, [&](std::uint32_t number) {
        const BoxLeaf leaf = tree.leaf(v, number);
        ASSERT_GE(leaf.count, 1u);
        ASSERT_LE(leaf.count, kMaxLeafPoints);
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
          const auto place = places.find(leaf.record(i));
          ASSERT_NE(place, places.end()) << "each point once";
          const std::uint32_t stored = place->second;
          places.erase(place);
          if (points) {
            ASSERT_EQ(leaf.x()[i], voxel.x()[stored]);
            ASSERT_EQ(leaf.y()[i], voxel.y()[stored]);
            ASSERT_EQ(leaf.z()[i], voxel.z()[stored]);
          }
          const Rational radius(cloud.view().radius(leaf.record(i)));
          const Point3 p = cloud.view().point(leaf.record(i));
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const Rational at = Rational(p[axis]) - Rational(tree.origin[axis]);
            for (const auto& [box, child] : around) {
              ASSERT_LE(Rational(box->low[axis][child]), at - radius);
              ASSERT_GE(Rational(box->high[axis][child]), at + radius);
            }
            ASSERT_LE(Rational(tree.low[axis]), at - radius);
            ASSERT_GE(Rational(tree.high[axis]), at + radius);
          }
        }
      });
      for (const auto& [record, place] : places) EXPECT_TRUE(isRepeated(voxel, place)) << record;
    }
  }
}

TEST(BoxTree, IsLongerAlongTheWay)
{
  const auto stretchOf = [](const Travel& travel) {
    std::vector<float> xyz;
    for (int i = 0; i < 1000; ++i)
      for (const int x : {i % 10, i / 10 % 10, i / 100}) xyz.push_back(static_cast<float>(x));
    const SphereHierarchy hierarchy(viewOf(xyz.data(), 1000));
    const BoxTree tree(hierarchy.storage(), travel);
    return std::vector<float>(tree.stretch, tree.stretch + 3);
  };
  using Stretch = std::vector<float>;
  EXPECT_EQ(stretchOf({}), (Stretch{1, 1, 1})) << "at rest";
  EXPECT_EQ(stretchOf({{10, 1, 1}, 0}), (Stretch{5, 1, 1}));
  EXPECT_EQ(stretchOf({{0, 10, 0}, 0}), (Stretch{1, 32, 1}));
  EXPECT_EQ(stretchOf({{0, 3, 3}, 0}), (Stretch{1, 1, 1})) << "across the axes";
  EXPECT_EQ(stretchOf({{0, 0, 10}, 6.28}), (Stretch{1, 1, 1})) << "turning about itself";
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(stretchOf({{infinite, 0, 1}, 0}), (Stretch{1, 1, 1})) << "beyond the range of doubles";
}

/// Leaves of all sizes: halves of the space hold one leaf and all others.
TEST(BoxTree, IsNeverDeep)
{
  std::vector<float> xyz;
  for (int i = 0; i < 4000; ++i)
    xyz.insert(xyz.end(),
               {std::exp2(-0.02f * static_cast<float>(i)), 1e-3f * std::exp2(-0.02f * static_cast<float>(i)), 0});
  const SphereHierarchy hierarchy(viewOf(xyz.data(), xyz.size() / 3));
  const BoxTree tree(hierarchy.storage(), {{1, 0, 0}, 0});
  Work work;
  for (std::uint32_t v = 0; v < hierarchy.storage().voxel_count; ++v) {
    const std::vector<BoxNode>& boxes = tree.voxel(v, work).boxes();
    std::size_t deepest = 0;
    std::vector<std::pair<const BoxNode*, std::uint32_t>> around;
    forEachLeaf(boxes, 0, around, [&](std::uint32_t) { deepest = std::max(deepest, around.size()); });
    EXPECT_LE(deepest, 24u);
  }
}

} // namespace
} // namespace pcl_bsh
