// SPDX-License-Identifier: BSD-3-Clause
// Programs tell errors apart by their code, whatever their text is.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/trace.h>
#include <pcl_bsh/scene/scene.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/question.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The exception that is thrown, the base class included.
InvalidInput thrownBy(const std::function<void()>& ask)
{
  try {
    ask();
  }
  catch (const std::invalid_argument& error) {
    if (const auto* found = dynamic_cast<const InvalidInput*>(&error)) return *found;
    ADD_FAILURE() << "carries no code: " << error.what();
    return {Input::result, "none", ""};
  }
  ADD_FAILURE() << "nothing was found wrong";
  return {Input::result, "none", ""};
}

class InvalidInputTest : public testing::Test {
protected:
  const SphereHierarchy nothing{PointsView{}};
  const std::vector<float> xyz = {0, 0, 0, 1, 1, 1};
  const SphereHierarchy two{viewOf(xyz.data(), 2)};
};

TEST_F(InvalidInputTest, NamesWhatAQueryRefuses)
{
  test::Question request;
  request.clearance = -0.25;
  const InvalidInput clearance = thrownBy([&] { anyCollision({nothing}, {nothing}, request); });
  EXPECT_EQ(clearance.input(), Input::clearance);
  EXPECT_EQ(clearance.value(), -0.25);
  EXPECT_STREQ(clearance.what(), "clearance: -0.25: give a finite length >= 0");
  EXPECT_EQ(clearance.wrong(), "-0.25");
  EXPECT_EQ(clearance.remedy(), "give a finite length >= 0");
  EXPECT_EQ(clearance.advice(), "-0.25: give a finite length >= 0");

  request = {};
  request.accuracy = Accuracy::tolerance(nan);
  EXPECT_EQ(thrownBy([&] { collisionFlags({nothing}, {nothing}, request); }).input(), Input::accuracy);
  EXPECT_EQ(thrownBy([] { Accuracy::parse("fast"); }).input(), Input::accuracy);
  request.accuracy = Accuracy::level(1);
  EXPECT_EQ(thrownBy([&] { traceCollision({nothing}, {nothing}, request); }).input(), Input::accuracy);

  Eigen::Isometry3d stretched = Eigen::Isometry3d::Identity();
  stretched.linear() *= 2.0;
  const InvalidInput pose = thrownBy([&] { closestPair({nothing}, {nothing, stretched}); });
  EXPECT_EQ(pose.input(), Input::pose);
  EXPECT_NEAR(pose.value().value_or(0), 3 * std::sqrt(3.0), 1e-12) << "|R'R - I|";
  EXPECT_FALSE(pose.index());
}

TEST_F(InvalidInputTest, NamesThePoseThatAQueryRefuses)
{
  Eigen::Isometry3d mirrored = Eigen::Isometry3d::Identity();
  mirrored.linear() *= -1.0;
  const Placed right(two), wrong(two, mirrored);
  using Query = void (*)(const Placed&, const Placed&);
  const std::pair<const char*, Query> queries[] = {
      {"any collision", [](const Placed& a, const Placed& b) { anyCollision(a, b, AnyRequest()); }},
      {"closest pair", [](const Placed& a, const Placed& b) { closestPair(a, b); }},
      {"nearest contacts", [](const Placed& a, const Placed& b) { nearestContacts(a, b, ContactsRequest()); }},
      {"pairs within", [](const Placed& a, const Placed& b) { pairsWithin(a, b, ContactsRequest()); }},
      {"trace", [](const Placed& a, const Placed& b) { traceCollision(a, b, AnyRequest()); }},
      {"flags", [](const Placed& a, const Placed& b) { collisionFlags(a, b, FlagsRequest()); }},
      {"indices", [](const Placed& a, const Placed& b) { collidingIndices(a, b, FlagsRequest()); }},
      {"distances", [](const Placed& a, const Placed& b) { pointDistances(a, b, PointDistancesRequest()); }},
      {"both distances", [](const Placed& a, const Placed& b) { symmetricDistances(a, b, PointDistancesRequest()); }},
      {"Hausdorff", [](const Placed& a, const Placed& b) { hausdorffDistance(a, b); }}};
  for (const auto& [name, ask] : queries) {
    SCOPED_TRACE(name);
    EXPECT_THAT(thrownBy([&] { ask(wrong, right); }).what(), testing::HasSubstr("pose of a: "));
    EXPECT_THAT(thrownBy([&] { ask(right, wrong); }).what(), testing::HasSubstr("pose of b: "));
  }
}

TEST_F(InvalidInputTest, NamesWhatATrajectoryRefuses)
{
  const std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
  const auto refused = [&](const std::function<void(TrajectoryRequest&)>& set) {
    TrajectoryRequest request;
    set(request);
    return thrownBy([&] { collideAlong({two}, two, poses, request); });
  };
  EXPECT_EQ(refused([](auto& request) { request.clearance = nan; }).input(), Input::clearance);
  EXPECT_EQ(refused([](auto& request) { request.swept = 0.0; }).input(), Input::swept);
  EXPECT_EQ(refused([](auto& request) { request.swept = 1e-15; }).input(), Input::swept) << "too small for doubles";
  EXPECT_EQ(refused([](auto& request) { request.pivot[1] = nan; }).input(), Input::pivot);
  EXPECT_EQ(refused([](auto& request) {
              request.swept = 0.1;
              request.accuracy = Accuracy::tolerance(0.1);
            }).input(),
            Input::accuracy);
  EXPECT_EQ(refused([](auto& request) {
              request.swept = 0.1;
              request.pose_summaries = true;
            }).input(),
            Input::summaries);
  std::vector<Eigen::Isometry3d> wrong = poses;
  wrong[2].translation().x() = nan;
  const InvalidInput third = thrownBy([&] { collideAlong({two}, two, wrong, {}); });
  EXPECT_EQ(third.input(), Input::pose);
  EXPECT_EQ(third.index(), std::size_t{2});
}

TEST_F(InvalidInputTest, NamesWhatOthersRefuse)
{
  PointsView null;
  null.count = 3;
  EXPECT_EQ(thrownBy([&] { SphereHierarchy{null}; }).input(), Input::points);
  HierarchyOptions options;
  options.voxel_edge = -1;
  EXPECT_EQ(thrownBy([&] { SphereHierarchy{viewOf(xyz.data(), 2), options}; }).input(), Input::voxel_edge);
  const std::vector<float> radii = {1, -1};
  PointsView with_radii = viewOf(xyz.data(), 2);
  with_radii.radii = radii.data();
  EXPECT_EQ(thrownBy([&] { SphereHierarchy{with_radii}; }).input(), Input::radius);
  SphereHierarchy moved{viewOf(xyz.data(), 2)};
  EXPECT_EQ(thrownBy([&] { moved.refit(viewOf(xyz.data(), 1)); }).input(), Input::points);
  EXPECT_EQ(thrownBy([&] { moved.refit(viewOf(xyz.data(), 2), 0.5); }).input(), Input::growth);
  EXPECT_EQ(thrownBy([&] { euclideanClusters(two, nan); }).input(), Input::cluster_distance);
  EXPECT_EQ(thrownBy([&] { findClashes(two.view(), TrajectoryResult(), 0.0); }).input(), Input::cluster_distance);
  EXPECT_EQ(thrownBy([&] { findClashes(two.view(), TrajectoryResult(), 1.0); }).input(), Input::result);
  std::vector<std::int32_t> indices;
  EXPECT_EQ(thrownBy([&] { boxSearch(two, {nan, 0, 0}, {1, 1, 1}, indices); }).input(), Input::box);
  SceneOptions scene;
  scene.tolerance = 0;
  EXPECT_EQ(thrownBy([&] { Scene{scene}; }).input(), Input::scene);
  SceneObject object;
  object.name = "a";
  object.parts.push_back({"a", std::make_shared<SphereHierarchy>(PointsView{}), Eigen::Isometry3d::Identity()});
  object.motion = WaypointMotion{};
  EXPECT_EQ(thrownBy([&] { Scene{SceneOptions{}}.add(object); }).input(), Input::motion);
}

} // namespace
} // namespace pcl_bsh
