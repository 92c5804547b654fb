// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using Points = std::vector<float>;

std::shared_ptr<const Points> row(float y)
{
  Points xyz;
  for (int i = 0; i < 200; ++i) xyz.insert(xyz.end(), {static_cast<float>(i), y, 0.0f});
  return std::make_shared<const Points>(std::move(xyz));
}

PointsView owned(const std::shared_ptr<const Points>& points)
{
  PointsView view = viewOf(points->data(), points->size() / 3);
  view.owner = points;
  return view;
}

TEST(PointsView, OwnerLivesAsLongAsTheHierarchy)
{
  std::shared_ptr<const Points> points = row(0);
  const std::weak_ptr<const Points> alive = points;
  {
    SphereHierarchy first(owned(points));
    points.reset();
    EXPECT_FALSE(alive.expired());
    const SphereHierarchy moved = std::move(first);
    EXPECT_FALSE(alive.expired());
    EXPECT_EQ(closestPair({moved}, {moved, Eigen::Isometry3d(Eigen::Translation3d(0, 3, 0))}).distance, 3.0);
  }
  EXPECT_TRUE(alive.expired());
}

TEST(PointsView, RefitHoldsTheNewOwnerAndLetsTheOldOneGo)
{
  std::shared_ptr<const Points> before = row(0), after = row(1);
  const std::weak_ptr<const Points> old = before, now = after;
  SphereHierarchy hierarchy(owned(before));
  hierarchy.buildAll();
  before.reset();
  PointsView too_few = owned(after);
  --too_few.count;
  EXPECT_THROW(hierarchy.refit(too_few), std::invalid_argument);
  EXPECT_FALSE(old.expired()); // as it was
  hierarchy.refit(owned(after));
  after.reset();
  too_few = PointsView();
  EXPECT_TRUE(old.expired());
  EXPECT_FALSE(now.expired());
  EXPECT_TRUE(hierarchy.validate().none());
}

TEST(PointsView, RestrictedToNothingHasNoPoint)
{
  const std::shared_ptr<const Points> points = row(0);
  PointsView view = owned(points);
  const std::vector<std::int32_t> some = {2, 0}, none; // whose data() may be null
  view.restrictTo(some.data(), some.size());
  EXPECT_EQ(view.size(), 2U);
  EXPECT_EQ(view.record(0), 2U);
  view.restrictTo(none.data(), none.size());
  EXPECT_EQ(view.size(), 0U);
  EXPECT_EQ(closestPair({SphereHierarchy(view)}, {SphereHierarchy(owned(points))}).pair, std::nullopt);
}

TEST(PointsView, WithoutOwnerBorrows)
{
  const std::shared_ptr<const Points> points = row(0);
  const SphereHierarchy hierarchy(viewOf(points->data(), points->size() / 3));
  EXPECT_EQ(points.use_count(), 1);
  EXPECT_FALSE(hierarchy.view().owner);
}

TEST(Placed, IsCopiedAndAssigned)
{
  static_assert(std::is_copy_assignable_v<Placed> && std::is_copy_constructible_v<Placed>);
  const auto low = row(0), high = row(5);
  const SphereHierarchy a(viewOf(low->data(), 200)), b(viewOf(high->data(), 200));
  Placed placed{a};
  EXPECT_EQ(closestPair({a}, placed).distance, 0.0);
  placed = {b, Eigen::Isometry3d(Eigen::Translation3d(0, 2, 0))};
  EXPECT_EQ(closestPair({a}, placed).distance, 7.0);
  EXPECT_EQ(&placed.hierarchy(), &b);
  std::vector<Placed> many(3, placed);
  many.front() = Placed{a};
  EXPECT_EQ(closestPair(many.front(), many.back()).distance, 7.0);
}

template <class Scalar>
void expectEachCoordinateInChecksum()
{
  const std::vector<Scalar> xyz = {1, 2, 3, 4, 5, 6};
  const PointsView view = viewOf(xyz.data(), 2);
  std::set<std::uint64_t> sums = {checksumOf(view)};
  for (std::size_t k = 0; k < xyz.size(); ++k) {
    std::vector<Scalar> other = xyz;
    other[k] += 1;
    EXPECT_TRUE(sums.insert(checksumOf(viewOf(other.data(), 2))).second) << "coordinate " << k;
    std::vector<Scalar> exchanged = xyz;
    std::swap(exchanged[k], exchanged[(k + 1) % xyz.size()]);
    EXPECT_TRUE(sums.insert(checksumOf(viewOf(exchanged.data(), 2))).second) << "exchanged " << k;
  }
  EXPECT_TRUE(sums.insert(checksumOf(viewOf(xyz.data(), 1))).second) << "one point less";
  EXPECT_EQ(checksumOf(view), checksumOf(viewOf(std::vector<Scalar>(xyz).data(), 2)));
}

TEST(PointsView, ChecksumsKnowEachCoordinateAndItsPlace)
{
  expectEachCoordinateInChecksum<float>();
  expectEachCoordinateInChecksum<double>();
}

} // namespace
} // namespace pcl_bsh
