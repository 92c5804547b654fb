// SPDX-License-Identifier: BSD-3-Clause
// Every query obeys an effort: it tells its progress, and ends when it is told to.
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/trace.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/scene/scene.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>

namespace pcl_bsh {
namespace {

using test::Cloud;

constexpr double kClearance = 0.86; ///< less than the lattices are apart

/// A cubic lattice with a spacing of 1, `shift` along each axis from the origin.
Cloud lattice(double shift)
{
  std::vector<Point3> points;
  for (int i = 0; i < 4096; ++i) points.push_back({shift + i % 16, shift + i / 16 % 16, shift + i / 256});
  return Cloud(points);
}

std::vector<float> uncertainties()
{
  return std::vector<float>(4096, 0.01f);
}

/// Two lattices, one amid the other, that a query has to search from end to end. Everything is static: queries refer to
/// it.
struct Lattices {
  static PointsView view(double shift)
  {
    static const Cloud one = lattice(0.0), other = lattice(0.5);
    return shift > 0.0 ? other.view() : one.view();
  }
  static HierarchyOptions inVoxels()
  {
    HierarchyOptions options;
    options.voxel_edge = 4.0;
    return options;
  }
  static PointsView uncertain(double shift)
  {
    static const std::vector<float> all = uncertainties();
    PointsView points = view(shift);
    points.uncertainties = all.data();
    return points;
  }

  const std::shared_ptr<SphereHierarchy> shared_a = std::make_shared<SphereHierarchy>(view(0.0), inVoxels());
  const std::shared_ptr<SphereHierarchy> shared_b = std::make_shared<SphereHierarchy>(view(0.5), inVoxels());
  const SphereHierarchy &a = *shared_a, &b = *shared_b;
  const SphereHierarchy uncertain_a{uncertain(0.0), inVoxels()}, uncertain_b{uncertain(0.5), inVoxels()};
};

/// A query, as a number that its answer has.
struct Call {
  std::string name;
  std::function<double(const Lattices&, const Effort&)> ask;
  unsigned threads = 1;
  Accuracy accuracy = {};
};

double sum(const std::vector<Verdict>& verdicts)
{
  double all = 0.0;
  for (const Verdict verdict : verdicts) all += static_cast<double>(verdict);
  return all;
}

double any(const Lattices& of, const Effort& effort)
{
  return anyCollision({of.a}, {of.b}, {kClearance, effort}).interval.lower;
}
double anyUncertain(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(anyCollision({of.uncertain_a}, {of.uncertain_b}, {kClearance, effort}).verdict);
}
double closest(const Lattices& of, const Effort& effort)
{
  return closestPair({of.a}, {of.b}, effort).interval.upper;
}
double nearest(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(nearestContacts({of.a}, {of.b}, {0.9, 100, effort}).contacts.size());
}
double within(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(pairsWithin({of.a}, {of.b}, {0.9, ContactsRequest::kAll, effort}).pairs.size());
}
double flags(const Lattices& of, const Effort& effort)
{
  const FlagsResult found = collisionFlags({of.a}, {of.b}, {0.9, Flagged::both, effort});
  return sum(found.a) + sum(found.b);
}
double guardedFlags(const Lattices& of, const Effort& effort)
{
  static const std::vector<float> spacings(4096, 1.0f);
  FlagsRequest request(0.5, Flagged::a, effort);
  request.spacings_of_b = spacings.data();
  return sum(collisionFlags({of.a}, {of.b}, request).a);
}
double indices(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(collidingIndices({of.a}, {of.b}, {0.9, Flagged::both, effort}).a.size());
}
double traced(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(traceCollision({of.a}, {of.b}, {kClearance, effort}).a.size());
}
double clusters(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(euclideanClusters(of.a, 0.9, effort).sizes.size());
}
double balls(const Lattices& of, const Effort& effort)
{
  static const std::vector<float> radii(4096, 0.87f);
  PointsView view = Lattices::view(0.5);
  view.radii = radii.data();
  double all = 0.0;
  for (const std::uint8_t flag : anyInBalls(of.a, view, effort)) all += flag;
  return all;
}
double radii(const Lattices& of, const Effort& effort)
{
  double all = 0.0;
  for (const std::uint8_t flag : flagAnyInRadius(of.a, Lattices::view(0.5), 0.87, effort)) all += flag;
  return all;
}
double manyRadii(const Lattices& of, const Effort& effort)
{
  NeighborLists found;
  radiusSearch(of.a, Lattices::view(0.5), 0.87, found, {}, effort);
  double all = 0.0;
  for (const auto& list : found.indices) all += static_cast<double>(list.size());
  return all;
}
double manyNearest(const Lattices& of, const Effort& effort)
{
  NeighborLists found;
  nearestKSearch(of.a, Lattices::view(0.5), 3, found, effort);
  double all = 0.0;
  for (const auto& list : found.squared_distances) all += static_cast<double>(list.at(0));
  return all;
}
double spacings(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(patchSpacings(of.a, 2.0, effort).at(7));
}
double atPoses(const Lattices& of, const Effort& effort)
{
  const std::vector<Eigen::Isometry3d> poses(300, Eigen::Isometry3d::Identity());
  return sum(anyCollisionAtPoses({of.a}, of.b, poses, {kClearance, effort}).flags);
}

Scene sceneOf(const Lattices& of, const Effort& effort)
{
  SceneOptions options;
  static_cast<Effort&>(options) = effort;
  options.clearance = 0.9;
  options.effects.any = options.effects.flags = options.effects.swept = options.effects.self = true;
  options.effects.distance = 1.0;
  options.effects.contacts = 10;
  Scene scene(options);
  scene.add(fixedObject("a", of.shared_a));
  scene.add(object("b", of.shared_b));
  return scene;
}
double look(const Lattices& of, const Effort& effort)
{
  return static_cast<double>(sceneOf(of, effort).query().flags.at(0).colliding);
}
double move(const Lattices& of, const Effort& effort)
{
  Scene scene = sceneOf(of, effort);
  scene.setMotion(1, VelocityMotion{{0.01, 0, 0}});
  return static_cast<double>(scene.step(1.0).flags.at(0).colliding);
}

/// All queries that one question may need.
double ofQuestion(const Lattices& of, const Effort& effort)
{
  Question question;
  static_cast<Effort&>(question) = effort;
  question.clearance = 0.5;
  question.max_distance = 2.0;
  question.density = true;
  question.wanted.flags = question.wanted.closest = question.wanted.distances = true;
  Shape input("a", of.shared_a), obstacle("b", of.shared_b);
  const Answer answer = ask(question, input, obstacle);
  return sum(answer.collisions.flags) + answer.closest.distance + answer.distances.a.greatest;
}

class Efforts : public testing::TestWithParam<Call> {
protected:
  /// Times that the caller is surely told: other threads may do all of the work before this one takes its share.
  static int callsForCertain() { return GetParam().threads == 1 ? 2 : 1; }

  double ask(const std::function<bool(double)>& progress) const
  {
    const Lattices fresh; // voxels are built anew
    return GetParam().ask(fresh, {GetParam().accuracy, GetParam().threads, progress});
  }
};

TEST_P(Efforts, ReportHowFarTheyAre)
{
  std::vector<double> told;
  const double answer = ask([&](double done) {
    told.push_back(done);
    return true;
  });
  ASSERT_GE(told.size(), static_cast<std::size_t>(callsForCertain()));
  EXPECT_GE(told.front(), 0.0);
  if (told.size() > 1) {
    EXPECT_LT(told.front(), 1.0) << "while there is still something to do";
  }
  if (GetParam().threads == 1 && GetParam().accuracy.mode == Accuracy::Mode::exact) {
    EXPECT_GT(told[told.size() - 2], 0.5) << "before the end";
  }
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(ask({}), answer);
}

TEST_P(Efforts, EndWhenTheyAreTold)
{
  for (int last = 1; last <= callsForCertain(); ++last) {
    int calls = 0;
    EXPECT_THROW(ask([&](double) { return ++calls < last; }), Cancelled);
    EXPECT_EQ(calls, last) << "no call after the one that asked to stop";
  }
}

TEST_P(Efforts, LetOutWhatTheCallerThrows)
{
  struct Mine {};
  EXPECT_THROW(ask([](double) -> bool { throw Mine(); }), Mine);
}

TEST_P(Efforts, AnswerRightlyAfterTheyWereEnded)
{
  const Lattices fresh;
  EXPECT_THROW(GetParam().ask(fresh, {GetParam().accuracy, GetParam().threads, [](double) { return false; }}),
               Cancelled);
  EXPECT_EQ(GetParam().ask(fresh, {GetParam().accuracy, GetParam().threads}), ask({}));
}

INSTANTIATE_TEST_SUITE_P(
    Queries, Efforts,
    testing::Values(Call{"Any", any}, Call{"AnyInThreads", any, 2},
                    Call{"AnyToATolerance", any, 1, Accuracy::tolerance(1e-3)},
                    Call{"AnyToALevel", any, 1, Accuracy::level(20)},
                    Call{"AnyOfPairs", any, 1, Accuracy::nodePairs(100000000)}, Call{"AnyUncertain", anyUncertain},
                    Call{"AnyUncertainToALevel", anyUncertain, 1, Accuracy::level(20)}, Call{"Closest", closest},
                    Call{"ClosestInThreads", closest, 2}, Call{"ClosestToALevel", closest, 1, Accuracy::level(20)},
                    Call{"NearestContacts", nearest}, Call{"PairsWithin", within}, Call{"Flags", flags},
                    Call{"FlagsInThreads", flags, 2}, Call{"FlagsToALevel", flags, 1, Accuracy::level(20)},
                    Call{"FlagsOfPairs", flags, 1, Accuracy::nodePairs(100000000)}, Call{"GuardedFlags", guardedFlags},
                    Call{"Indices", indices}, Call{"Traced", traced}, Call{"Clusters", clusters},
                    Call{"AnyInBalls", balls}, Call{"AnyInRadius", radii}, Call{"RadiusSearch", manyRadii},
                    Call{"NearestKSearch", manyNearest}, Call{"NearestInThreads", manyNearest, 2},
                    Call{"PatchSpacings", spacings}, Call{"AtPoses", atPoses},
                    Call{"AtPosesToATolerance", atPoses, 1, Accuracy::tolerance(1e-3)}, Call{"SceneQuery", look},
                    Call{"SceneStep", move}, Call{"SceneInThreads", look, 2}, Call{"Question", ofQuestion}),
    [](const testing::TestParamInfo<Call>& info) { return info.param.name; });

TEST(Effort, OfExactQueriesIsExact)
{
  const Lattices lattices;
  const Effort less(Accuracy::tolerance(0.1));
  for (const auto& ask : {nearest, within, clusters, balls, radii, manyRadii, manyNearest, spacings})
    EXPECT_THROW(ask(lattices, less), std::invalid_argument);
}

TEST(Effort, IsAsShortAsItWas)
{
  const AnyRequest any = {0.05}, in_threads = {0.05, 4}, less = {0.05, Accuracy::tolerance(0.1)};
  EXPECT_EQ(any.clearance, 0.05);
  EXPECT_EQ(any.threads, 1U);
  EXPECT_EQ(in_threads.threads, 4U);
  EXPECT_EQ(less.accuracy.value, 0.1);
}

} // namespace
} // namespace pcl_bsh
