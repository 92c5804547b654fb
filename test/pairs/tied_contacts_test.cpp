// SPDX-License-Identifier: BSD-3-Clause
// The nearest contacts of surfaces of which nearly all triangles are equally near.
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/record_distance.h>

#include "support/tied_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::TestMesh;
using test::TiedPair;

/// By comparing all pairs.
std::vector<PointPair> nearestOfAll(const Placed& a, const Placed& b, double clearance, std::size_t most)
{
  const PointsView &of_a = a.hierarchy().view(), &of_b = b.hierarchy().view();
  const RecordDistance distance(of_a, a.pose, of_b, b.pose);
  std::vector<PointPair> pairs;
  for (std::uint32_t i = 0; i < of_a.count; ++i)
    for (std::uint32_t j = 0; j < of_b.count; ++j)
      if (distance.compare({i, j}, clearance) <= 0) pairs.push_back({i, j});
  const std::size_t kept = std::min(most, pairs.size());
  std::partial_sort(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(kept), pairs.end(),
                    [&](PointPair l, PointPair r) {
                      const int sign = distance.compareGaps(l, r);
                      return sign != 0 ? sign < 0 : l < r;
                    });
  pairs.resize(kept);
  return pairs;
}

void expectNearestOfAll(const Placed& a, const Placed& b, double clearance)
{
  const std::vector<PointPair> expected = nearestOfAll(a, b, clearance, 40);
  for (const std::size_t most : {1u, 9u, 39u}) {
    const ContactsResult found = nearestContacts(a, b, {clearance, most});
    ASSERT_EQ(found.contacts.size(), std::min(most, expected.size()));
    ASSERT_EQ(found.complete, expected.size() <= most);
    for (std::size_t k = 0; k < found.contacts.size(); ++k) ASSERT_EQ(found.contacts[k].pair, expected[k]) << k;
  }
}

/// Two plates of cells x cells squares of 0.2, two triangles each, 0.25 apart.
struct Plates {
  enum Kind { flat, turned, turned_in_plane, rounded, rough };

  Plates(std::uint32_t cells, Kind kind) : a(plate(cells, 0.0, kind, 1)), b(plate(cells, 0.25, kind, 2))
  {
    b.move(Eigen::Isometry3d(Eigen::Translation3d(0.03, 0.05, 0.0)));
    Eigen::Isometry3d turn(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()));
    turn.translation() = Eigen::Vector3d(0.3, -0.7, 1.1);
    if (kind == turned) pose_a = pose_b = turn;
    if (kind == turned_in_plane) pose_b.linear() = turnAbout(0.1);
    if (kind == rounded) {
      pose_b = turn;
      b.move(turn.inverse());
    }
  }

  static Eigen::Matrix3d turnAbout(double angle)
  {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }

  static TestMesh plate(std::uint32_t cells, double height, Kind kind, std::uint64_t seed)
  {
    Random random(seed);
    const double size = 0.2 * cells, noise = kind == rough ? 1e-3 : 0.0;
    return test::gridMesh(cells, cells, [&](double u, double v) -> Point3 {
      return {size * u, size * v, height + noise * random.uniform(-1, 1)};
    });
  }

  TestMesh a, b;
  Eigen::Isometry3d pose_a = Eigen::Isometry3d::Identity(), pose_b = pose_a;
};

TEST(TiedContacts, SameAsComparingAllPairs)
{
  int asked = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const TiedPair pair = test::anyTies(seed);
    if (pair.a.triangles.size() * pair.b.triangles.size() > 1500) continue;
    SCOPED_TRACE(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
    expectNearestOfAll({a, pair.pose_a}, {b, pair.pose_b}, pair.gap + 0.01);
    if (HasFatalFailure()) return;
    ++asked;
  }
  EXPECT_GT(asked, 20);
}

TEST(TiedContacts, OfPlatesInAnyOrder)
{
  for (const Plates::Kind kind :
       {Plates::flat, Plates::turned, Plates::turned_in_plane, Plates::rounded, Plates::rough})
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      SCOPED_TRACE(std::to_string(kind) + ", order " + std::to_string(seed));
      Plates plates(7, kind);
      if (seed != 0) shuffle(plates.a, seed), shuffle(plates.b, seed + 7);
      const SphereHierarchy a(viewOf(plates.a.trianglesView())), b(viewOf(plates.b.trianglesView()));
      expectNearestOfAll({a, plates.pose_a}, {b, plates.pose_b}, 0.27);
      if (HasFatalFailure()) return;
    }
}

/// Triangles that meet are all at 0: the smallest numbers are the answer, and no other pair is decided.
TEST(TiedContacts, OfWhatMeets)
{
  Plates plates(8, Plates::flat);
  plates.b = plates.a;
  shuffle(plates.b, 3);
  const SphereHierarchy a(viewOf(plates.a.trianglesView())), b(viewOf(plates.b.trianglesView()));
  for (const double height : {0.0, 0.01}) {
    const Placed above(b, Eigen::Isometry3d(Eigen::Translation3d(0.03, 0.02, height)));
    const Placed aslant(b, above.pose * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
    expectNearestOfAll({a}, above, 0.05);
    expectNearestOfAll({a}, aslant, 0.05);
  }
}

/// Counted, not timed. Few of 230,000 pairs within the clearance are decided.
TEST(TiedContacts, OfPlatesTakeFewDecisions)
{
  struct Limit {
    const char* name;
    Plates::Kind kind;
    std::uint64_t decisions, leaf_pairs;
  };
  for (const Limit& limit : {Limit{"flat", Plates::flat, 500, 500},
                             {"turned", Plates::turned, 500, 500},
                             {"turned in their plane", Plates::turned_in_plane, 1500, 1000},
                             {"rough", Plates::rough, 1000, 6500}}) {
    SCOPED_TRACE(limit.name);
    const Plates plates(50, limit.kind);
    const SphereHierarchy a(viewOf(plates.a.trianglesView())), b(viewOf(plates.b.trianglesView()));
    const ContactsResult found = nearestContacts({a, plates.pose_a}, {b, plates.pose_b}, {0.27, 10});
    EXPECT_EQ(found.contacts.size(), 10u);
    EXPECT_LT(found.work.exact_decisions, limit.decisions);
    EXPECT_LT(found.work.leaf_pairs, limit.leaf_pairs);
  }
}

} // namespace
} // namespace pcl_bsh
