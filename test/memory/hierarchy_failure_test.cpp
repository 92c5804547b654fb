// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/hierarchy/update.h>

#include "clouds.h"
#include "support/every_allocation.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <limits>
#include <tuple>

namespace pcl_bsh::test {
namespace {

/// The questions to a hierarchy that has been through a failure.
auto answerOf(const SphereHierarchy& hierarchy)
{
  static const Cloud cloud = richCloud(8, 200);
  static const SphereHierarchy other(cloud.view());
  FlagsRequest request;
  request.clearance = 0.05;
  request.flagged = Flagged::both;
  const FlagsResult found = collisionFlags({hierarchy}, {other}, request);
  return std::tuple(hierarchy.size(), found.a, found.b);
}

TEST(HierarchyAllocationFailure, OfConstruction)
{
  for (const bool radii : {false, true}) {
    const Cloud cloud = richCloud(6, 700, radii);
    for (const double edge : {0.0, 0.5})
      failEachAllocation([] { return 0; },
                         [&](int) {
                           HierarchyOptions options;
                           options.voxel_edge = edge;
                           const SphereHierarchy hierarchy(cloud.view(), options);
                           const HierarchyStatistics statistics = hierarchy.statistics();
                           return std::tuple(statistics.voxels, statistics.points, statistics.nodes);
                         });
  }
}

TEST(HierarchyAllocationFailure, OfConstructionInThreads)
{
  Random random(7);
  const Cloud cloud(makePoints(Shape::uniform, 1 << 17, 1.0, random)); // as many as two threads share
  HierarchyOptions options;
  options.threads = 2;
  failEachAllocation([] { return 0; },
                     [&](int) {
                       const SphereHierarchy hierarchy(cloud.view(), options);
                       return std::tuple(hierarchy.statistics().voxels, hierarchy.size());
                     });
}

TEST(HierarchyAllocationFailure, OfBuildingAll)
{
  for (const unsigned threads : {1u, 2u}) {
    for (const SphereFit fit : {SphereFit::box_center, SphereFit::minimal}) {
      const Cloud cloud = richCloud(9, 700, fit == SphereFit::minimal);
      failEachAllocation([&] { return std::make_unique<SphereHierarchy>(cloud.view(), fineOptions(fit)); },
                         [&](const auto& hierarchy) {
                           hierarchy->buildAll(threads);
                           return hierarchy->statistics().voxels_built;
                         });
      failEachAllocation([&] { return std::make_unique<SphereHierarchy>(cloud.view(), fineOptions(fit)); },
                         [&](const auto& hierarchy) { return hierarchy->validate().none(); });
    }
  }
}

TEST(HierarchyAllocationFailure, OfBuildingPointsInTheOrderOfAScan) // which are not copied before
{
  std::vector<Point3> points;
  for (int i = 0; i < 900; ++i) points.push_back({0.1 * (i % 30), 0.1 * (i / 30), 0.01 * (i % 7)});
  for (const Scalar scalar : {Scalar::float32, Scalar::float64}) {
    const Cloud cloud(points, Layout{scalar, 0, 0});
    failEachAllocation([&] { return std::make_unique<SphereHierarchy>(cloud.view(), fineOptions()); },
                       [&](const auto& hierarchy) {
                         hierarchy->buildAll();
                         return std::tuple(hierarchy->validate().none(), answerOf(*hierarchy));
                       });
  }
}

/// A cloud that changes, before and after in memory of their own.
struct Change {
  Cloud before, after;
  std::vector<std::int32_t> records; ///< that change
};

Change someMove(bool radii)
{
  const Cloud before = richCloud(10, 600, radii);
  std::vector<Point3> points;
  for (std::uint32_t i = 0; i < 600; ++i) {
    const Point3 p = before.view().point(i);
    points.push_back({p[0] * 1.02, p[1] - 0.01 * p[0], p[2] + 0.02});
  }
  Cloud after(points, Layout{Scalar::float64, 0, 0});
  if (radii) after.setRadii(std::vector<float>(600, 0.02f));
  return {before, std::move(after), {}};
}

/// Points in one corner leave or move to another, where some are new: few enough voxels to be updated in place.
Change someUpdate(bool radii)
{
  Cloud before = richCloud(11, 900, radii);
  Change change{before, before, {}};
  std::vector<Point3> points;
  for (std::uint32_t i = 0; i < 900; ++i) points.push_back(before.view().point(i));
  for (std::size_t i = 0; i < 900; ++i) {
    Point3& p = points[i];
    if (!(p[0] < -1.0 && p[1] < -0.2)) continue;
    p = {i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : p[0] + 2.4, p[1], p[2]};
    change.records.push_back(static_cast<std::int32_t>(i));
  }
  for (std::int32_t i = 900; i < 920; ++i) {
    points.push_back({2.1, 0.01 * i - 9.0, 1.1});
    change.records.push_back(i);
  }
  change.after = Cloud(points, Layout{Scalar::float64, 0, 0});
  if (radii) change.after.setRadii(std::vector<float>(points.size(), 0.01f));
  return change;
}

enum class Built { nothing, some, all };

void build(const SphereHierarchy& hierarchy, Built built)
{
  if (built == Built::all) hierarchy.buildAll();
  if (built == Built::some) {
    const Cloud near(std::vector<Point3>{{0.25, 0.25, 0.25}}, Layout{Scalar::float64, 0, 0});
    const SphereHierarchy one(near.view());
    FlagsRequest request;
    request.clearance = 0.1;
    collisionFlags({hierarchy}, {one}, request);
  }
}

/// Fails each allocation of a change. After a failure, the hierarchy answers as before; the same change then succeeds.
template <class Apply>
void failChange(const Change& change, Built built, SphereFit fit, const Apply& apply)
{
  const auto before = answerOf(SphereHierarchy(change.before.view(), fineOptions(fit)));
  const auto after = answerOf(SphereHierarchy(change.after.view(), fineOptions(fit)));
  for (const Shortage shortage : {Shortage::once, Shortage::lasting}) {
    bool failed = true;
    for (std::size_t k = 1; failed; k = nextFailure(k, shortage)) {
      for (const bool asked_between : {true, false}) {
        releaseRetainedMemory();
        SphereHierarchy hierarchy(change.before.view(), fineOptions(fit));
        build(hierarchy, built);
        const auto again = apply(hierarchy);
        bool thrown = false;
        {
          const FailingAllocation failing(k, shortage);
          try {
            again();
          }
          catch (const std::bad_alloc&) {
            thrown = true;
          }
          failed = failing.hasHappened();
        }
        if (thrown && asked_between) {
          ASSERT_EQ(hierarchy.view().data, change.before.view().data) << k;
          ASSERT_TRUE(answerOf(hierarchy) == before) << "after allocation " << k << " had failed";
        }
        if (thrown) again();
        ASSERT_TRUE(answerOf(hierarchy) == after) << "a second time, after allocation " << k << " had failed";
        if (k % 8 == 1) {
          ASSERT_THAT(hierarchy.validate().lines, testing::IsEmpty()) << k;
        }
      }
    }
  }
}

TEST(HierarchyAllocationFailure, OfRefit)
{
  for (const Built built : {Built::nothing, Built::some, Built::all})
    for (const SphereFit fit : {SphereFit::box_center, SphereFit::minimal})
      for (const double growth : {1.0, 1.5}) { // sorted anew, and in place
        const Change change = someMove(built == Built::some);
        failChange(change, built, fit, [&](SphereHierarchy& hierarchy) {
          return [&hierarchy, &change, growth] { hierarchy.refit(change.after.view(), growth); };
        });
      }
}

TEST(HierarchyAllocationFailure, OfUpdate)
{
  for (const Built built : {Built::nothing, Built::some, Built::all}) {
    const bool radii = built == Built::some;
    const Change change = someUpdate(radii);
    failChange(change, built, SphereFit::box_center, [&](SphereHierarchy& hierarchy) {
      const auto update = std::make_shared<HierarchyUpdate>(hierarchy, change.records.data(), change.records.size());
      return [update, &change] { update->commit(change.after.view()); };
    });
  }
}

TEST(HierarchyAllocationFailure, OfAnnouncingAnUpdate)
{
  const Change change = someUpdate(false);
  failEachAllocation([&] { return std::make_unique<SphereHierarchy>(change.before.view(), fineOptions()); },
                     [&](const auto& hierarchy) {
                       HierarchyUpdate(*hierarchy, change.records.data(), change.records.size());
                       return true;
                     });
}

/// A query fails, nobody asks again, and the points change.
TEST(HierarchyAllocationFailure, OfAQueryBeforeAChange)
{
  const Cloud other_cloud = richCloud(12, 300);
  for (const bool updates : {false, true}) {
    const Change change = updates ? someUpdate(false) : someMove(false);
    for (const SphereFit fit : {SphereFit::box_center, SphereFit::minimal}) {
      const auto after = answerOf(SphereHierarchy(change.after.view(), fineOptions(fit)));
      for (std::size_t k = 1;; k = nextFailure(k, Shortage::once)) {
        releaseRetainedMemory();
        SphereHierarchy hierarchy(change.before.view(), fineOptions(fit)), other(other_cloud.view());
        bool failed = false;
        {
          const FailingAllocation failing(k);
          try {
            FlagsRequest request;
            request.clearance = 0.05;
            collisionFlags({hierarchy}, {other}, request);
          }
          catch (const std::bad_alloc&) {
          }
          failed = failing.hasHappened();
        }
        if (updates) {
          HierarchyUpdate update(hierarchy, change.records.data(), change.records.size());
          update.commit(change.after.view());
        }
        else {
          hierarchy.refit(change.after.view());
        }
        ASSERT_TRUE(answerOf(hierarchy) == after) << k;
        if (k % 8 == 1) {
          ASSERT_THAT(hierarchy.validate().lines, testing::IsEmpty()) << k;
        }
        if (!failed) break;
      }
    }
  }
}

TEST(HierarchyAllocationFailure, IsLookedForInPlace)
{
  const Change update_change = someUpdate(false), move = someMove(false);
  SphereHierarchy updated(update_change.before.view(), fineOptions()), moved(move.before.view(), fineOptions());
  HierarchyUpdate update(updated, update_change.records.data(), update_change.records.size());
  EXPECT_FALSE(update.commit(update_change.after.view()).sorted_anew);
  EXPECT_FALSE(moved.refit(move.after.view(), 1.5).sorted_anew);
}

TEST(HierarchyAllocationFailure, LeaksNothing)
{
  EXPECT_EQ(leakedBy([] {
              for (std::size_t k = 1; k < 120; k += 3) {
                const Change change = someUpdate(true);
                SphereHierarchy hierarchy(change.before.view(), fineOptions());
                hierarchy.buildAll();
                const FailingAllocation failing(k);
                try {
                  HierarchyUpdate update(hierarchy, change.records.data(), change.records.size());
                  update.commit(change.after.view());
                  hierarchy.refit(change.after.view(), 1.0);
                }
                catch (const std::bad_alloc&) {
                }
              }
            }),
            0);
}

} // namespace
} // namespace pcl_bsh::test
