// SPDX-License-Identifier: BSD-3-Clause
// Results of triangles, gathered for groups of them.
#include <pcl_bsh/filters/gathered_result.h>

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Groups = std::vector<std::vector<std::size_t>>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Verdict none = Verdict::free, hit = Verdict::colliding, maybe = Verdict::undecided;

TrajectoryResult gathered(const TrajectoryResult& found, std::size_t groups, const Groups& of)
{
  return gatheredResult(found, groups, [&](std::size_t t) { return of[t]; });
}

TEST(GatheredResult, HasTheGravestOfEachGroup)
{
  TrajectoryResult found;
  found.flags = {none, hit, maybe, none, maybe};
  const TrajectoryResult result = gathered(found, 4, {{0}, {0}, {1, 2}, {1}, {0}});
  EXPECT_THAT(result.flags, ElementsAre(hit, maybe, maybe, none)) << "a group of none is free";
  EXPECT_EQ(result.colliding, 1U);
  EXPECT_EQ(result.undecided, 2U);
  EXPECT_THAT(result.distance, IsEmpty());
  EXPECT_THAT(result.first_pose, IsEmpty());
  EXPECT_THAT(result.certain_pose, IsEmpty());
  EXPECT_THAT(result.closest_pose, IsEmpty());
  EXPECT_THAT(result.closest_point, IsEmpty());
}

TEST(GatheredResult, HasTheFirstPosesThatThereAre)
{
  TrajectoryResult found;
  found.flags = {hit, hit, maybe, none};
  found.first_pose = {5, 0, 3, -1};
  found.certain_pose = {5, 2, -1, -1};
  const TrajectoryResult result = gathered(found, 4, {{0}, {0, 1}, {1, 2}, {0, 3}});
  EXPECT_THAT(result.first_pose, ElementsAre(0, 0, 3, -1));
  EXPECT_THAT(result.certain_pose, ElementsAre(2, 2, -1, -1));
}

TEST(GatheredResult, HasTheSmallestDistanceWithItsPoseAndPoint)
{
  TrajectoryResult found;
  found.flags = {hit, hit, hit, none, hit, hit};
  found.distance = {0.5f, 0.25f, 0.25f, nan, 0.0f, 1.0f};
  found.closest_pose = {1, 7, 6, -1, 9, 8};
  found.closest_point = {10, 11, 12, kNothing, 14, 15};
  TrajectoryResult result = gathered(found, 3, {{0}, {0}, {0, 1}, {0, 1}, {2}, {2}});
  EXPECT_THAT(result.distance, ElementsAre(0.25f, 0.25f, 0.0f));
  EXPECT_THAT(result.closest_pose, ElementsAre(6, 6, 9)) << "of the same distance, the first pose";
  EXPECT_THAT(result.closest_point, ElementsAre(12u, 12u, 14u));
  found.closest_pose.clear();
  result = gathered(found, 3, {{0}, {0}, {0, 1}, {0, 1}, {2}, {2}});
  EXPECT_THAT(result.closest_point, ElementsAre(11u, 12u, 14u)) << "without poses, the first triangle";
  EXPECT_THAT(result.closest_pose, IsEmpty());
  found.flags.clear();
  result = gathered(found, 4, {{0}, {0}, {0}, {1}, {2}, {2}});
  EXPECT_EQ(result.distance[0], 0.25f) << "distances alone";
  EXPECT_TRUE(std::isnan(result.distance[1]));
  EXPECT_TRUE(std::isnan(result.distance[3]));
  EXPECT_EQ(result.closest_point[3], kNothing);
}

/// Records that a solid holds have distances less than 0.
TEST(GatheredResult, ADepthIsADistance)
{
  TrajectoryResult found;
  found.flags = {hit, hit, hit};
  found.distance = {0.25f, -0.5f, -0.75f};
  found.closest_pose = {0, 1, 2};
  found.interval = {{NAN, NAN}, {-0.625, -0.5}, {-0.75, -0.75}};
  const TrajectoryResult result = gathered(found, 2, {{0}, {0}, {1}});
  EXPECT_EQ(result.distance[0], -0.5f);
  EXPECT_EQ(result.closest_pose[0], 1);
  EXPECT_EQ(result.interval[0].lower, -0.625);
  EXPECT_EQ(result.interval[0].upper, -0.5);
  EXPECT_EQ(result.distance[1], -0.75f);
}

TEST(GatheredResult, KeepsContactsAndWorkAndNoSummaries)
{
  TrajectoryResult found;
  found.flags = {hit};
  found.first_contact = FirstContact{3, 0.25};
  found.certain_contact = FirstContact{4, 0.5};
  found.work.leaf_pairs = 7;
  found.poses.resize(2);
  const TrajectoryResult result = gathered(found, 1, {{0}});
  ASSERT_TRUE(result.first_contact && result.certain_contact);
  EXPECT_EQ(result.first_contact->pose, 3U);
  EXPECT_EQ(result.certain_contact->fraction, 0.5);
  EXPECT_EQ(result.work.leaf_pairs, 7U);
  EXPECT_THAT(result.poses, IsEmpty());
}

} // namespace
} // namespace pcl_bsh
