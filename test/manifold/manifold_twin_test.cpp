// SPDX-License-Identifier: BSD-3-Clause
// PCL_BSH_ATTACKS in the environment: how many cases of each kind.
#include <pcl_bsh/manifold/contact_manifold.h>

#include "manifold_twin.h"
#include "support/attacks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

using test::TestMesh;
using test::Thing;
using test::TwinCandidate;

constexpr double kNoScore = -std::numeric_limits<double>::infinity();

/// The next contact as the specification has it, without regard to time.
class TwinPatches {
public:
  TwinPatches(std::vector<TwinCandidate> all, double margin, double thickness, std::optional<double> height)
  : all_(std::move(all)),
    margin_(margin),
    thickness_(thickness),
    height_(height)
  {
  }

  const TwinCandidate* deepest() const
  {
    const TwinCandidate* best = nullptr;
    for (const TwinCandidate& one : all_)
      if (!isTaken(one) && (!best || one < *best)) best = &one;
    return best;
  }

  void begin(const TwinCandidate& first, const Eigen::Vector3d& normal)
  {
    const double usual = 2.0 * (margin_ + thickness_ + std::abs(first.gap));
    slabs_.push_back({first.place, normal, height_.value_or(usual)});
    first_ = &first;
    chosen_ = {first.place};
  }

  void add(const TwinCandidate& next) { chosen_.push_back(next.place); }

  double score(const TwinCandidate& one) const
  {
    for (std::size_t i = 0; i + 1 < slabs_.size(); ++i)
      if (slabs_[i].holds(one.place)) return kNoScore;
    if (!slabs_.back().holds(one.place)) return kNoScore;
    const double room = margin_ - first_->gap;
    const double weight = room > 0.0 ? (margin_ - one.gap) / room : 1.0;
    return weight * extent(one.place);
  }

  double greatestScore() const
  {
    double greatest = kNoScore;
    for (const TwinCandidate& one : all_) greatest = std::max(greatest, score(one));
    return greatest;
  }

  /// The candidates that a contact may be: edges of one pair of triangles may be several.
  std::vector<const TwinCandidate*> like(const Contact& contact) const
  {
    std::vector<const TwinCandidate*> found;
    for (const TwinCandidate& one : all_)
      if (one.pair == contact.pair && one.gap == contact.distance) found.push_back(&one);
    return found;
  }

private:
  struct Slab {
    Eigen::Vector3d place, normal;
    double height;
    bool holds(const Eigen::Vector3d& at) const { return std::abs(normal.dot(at - place)) <= height; }
  };

  bool isTaken(const TwinCandidate& one) const
  {
    return std::any_of(slabs_.begin(), slabs_.end(), [&](const Slab& slab) { return slab.holds(one.place); });
  }

  double extent(const Eigen::Vector3d& place) const
  {
    Eigen::Vector3d normal = slabs_.back().normal;
    if (normal.isZero(0.0)) normal = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
    const auto flat = [&](const Eigen::Vector3d& p) {
      return Eigen::Vector2d(x.dot(p - first_->place), y.dot(p - first_->place));
    };
    if (chosen_.size() == 1) return flat(place).norm();
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector3d& p : chosen_) points.push_back(flat(p));
    const double before = test::hullArea(points);
    points.push_back(flat(place));
    return test::hullArea(points) - before;
  }

  std::vector<TwinCandidate> all_;
  double margin_, thickness_;
  std::optional<double> height_;
  std::vector<Slab> slabs_;
  const TwinCandidate* first_ = nullptr;
  std::vector<Eigen::Vector3d> chosen_;
};

struct Case {
  const Thing &a, &b;
  Eigen::Isometry3d pose_a, pose_b;
  ManifoldRequest request;
  double size;
};

/// @return how many contacts there are
std::size_t expectAsTheTwin(const Case& of)
{
  const Manifold found = contactManifold({*of.a.collider, of.pose_a}, {*of.b.collider, of.pose_b}, of.request);
  TwinPatches twin(test::candidatesOf(of.a, of.pose_a, of.b, of.pose_b, of.request.margin, found.thickness),
                   of.request.margin, found.thickness, of.request.height);
  const double slack = 1e-9 * of.size, area_slack = slack * of.size;
  std::size_t i = 0;
  for (std::uint32_t patch = 0; patch < of.request.most_patches; ++patch) {
    const TwinCandidate* deepest = twin.deepest();
    if (!deepest) break;
    if (i >= found.contacts.size()) {
      ADD_FAILURE() << "patch " << patch << " is missing";
      return i;
    }
    const Contact& first = found.contacts[i];
    EXPECT_EQ(first.distance, deepest->gap) << "patch " << patch << ", channel " << deepest->channel;
    EXPECT_EQ(first.pair, deepest->pair) << "patch " << patch << ", channel " << deepest->channel;
    EXPECT_EQ(first.patch, patch);
    if (testing::Test::HasFailure()) return i;
    twin.begin(*deepest, first.normal);
    std::size_t taken = 1;
    for (++i; i < found.contacts.size() && found.contacts[i].patch == patch; ++i, ++taken) {
      double score = kNoScore;
      const TwinCandidate* chosen = nullptr;
      for (const TwinCandidate* like : twin.like(found.contacts[i]))
        if (twin.score(*like) > score) score = twin.score(*like), chosen = like;
      if (!chosen) {
        ADD_FAILURE() << "contact " << i << " of (" << found.contacts[i].pair.a << ", " << found.contacts[i].pair.b
                      << "), gap " << found.contacts[i].distance << ", is no candidate";
        return i;
      }
      EXPECT_GE(score, twin.greatestScore() - (taken == 1 ? slack : area_slack)) << "contact " << i;
      twin.add(*chosen);
    }
    if (taken < of.request.most) {
      EXPECT_LE(twin.greatestScore(), taken == 1 ? slack : area_slack) << "patch " << patch << " lacks a contact";
    }
    EXPECT_LE(taken, of.request.most);
  }
  EXPECT_EQ(i, found.contacts.size());
  for (const Contact& contact : found.contacts) EXPECT_GT(contact.id, 0u);
  return found.contacts.size();
}

/// Points within a box, on a lattice where they may be at equal distances.
std::vector<Point3> anyPoints(test::Random& random, int most, bool on_lattice, const Point3& size)
{
  std::vector<Point3> points(static_cast<std::size_t>(random.integer(1, most)));
  for (Point3& p : points)
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = size[k] * (on_lattice ? random.integer(-4, 4) / 4.0 : random.uniform(-1, 1));
  return points;
}

std::unique_ptr<Thing> anyThing(test::Random& random, bool with_meshes)
{
  const bool on_lattice = random.chance(0.5);
  const Point3 size = {random.pick({1.0, 0.5, 2.0}), 1.0, random.pick({1.0, 0.25, 0.0})};
  const int kind = random.integer(0, with_meshes ? 5 : 1);
  switch (kind) {
  case 0:
    return std::make_unique<Thing>(anyPoints(random, 40, on_lattice, size));
  case 1: {
    std::vector<Point3> points = anyPoints(random, 30, on_lattice, size);
    std::vector<float> radii(points.size());
    for (float& radius : radii) radius = static_cast<float>(random.integer(0, 4)) / 16.0f;
    return std::make_unique<Thing>(std::move(points), std::move(radii));
  }
  case 2: {
    const bool is_rough = random.chance(0.5);
    return std::make_unique<Thing>(test::gridMesh(2, 2, [&](double u, double v) -> Point3 {
      return {2 * u - 1, 2 * v - 1, is_rough ? random.integer(-2, 2) / 8.0 : 0.0};
    }));
  }
  case 3:
    return std::make_unique<Thing>(test::soup(static_cast<std::uint64_t>(random.integer(0, 1 << 20)), 5, 1.0, 1.0));
  default: {
    TestMesh box = test::boxMesh(size[0], 1.0, random.pick({1.0, 0.25, 0.5}));
    box.move(Eigen::Isometry3d(Eigen::Translation3d(-0.5 * size[0], -0.5, 0)));
    return std::make_unique<Thing>(std::move(box), kind == 4);
  }
  }
}

void expectManyAsTheTwin(long cases, std::uint64_t from, bool with_meshes)
{
  const auto seeds = static_cast<std::uint64_t>(cases);
  std::size_t contacts = 0;
  for (std::uint64_t seed = from; seed < from + seeds; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const std::unique_ptr<Thing> a = anyThing(random, with_meshes), b = anyThing(random, with_meshes);
    const bool is_plain = random.chance(0.4);
    Eigen::Isometry3d pose_a = is_plain ? Eigen::Isometry3d::Identity() : random.pose(0.5);
    Eigen::Isometry3d pose_b = is_plain ? Eigen::Isometry3d::Identity() : random.pose(0.5);
    pose_a.pretranslate(Eigen::Vector3d(0, 0, random.integer(-8, 8) / 8.0));
    if (random.chance(0.1))
      pose_a.pretranslate(Eigen::Vector3d(5e6, 0, 0)), pose_b.pretranslate(Eigen::Vector3d(5e6, 0, 0));
    ManifoldRequest request;
    request.margin = random.pick({0.0, 0.125, 0.25, 0.5, 0.3});
    if (random.chance(0.7)) request.thickness = random.pick({0.0, 0.125, 0.1});
    request.most = static_cast<std::size_t>(random.pick({1, 2, 4, 4, 8}));
    request.most_patches = static_cast<std::size_t>(random.pick({1, 3, 4}));
    // The twin's places of edges differ by roundings: no place may lie at a patch's very height.
    if (random.chance(0.3)) request.height = with_meshes ? random.pick({0.13, 0.31}) : random.pick({0.0, 0.125, 0.3});
    contacts += expectAsTheTwin({*a, *b, pose_a, pose_b, request, 4.0});
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(contacts, seeds / 2) << "cases are no test";
}

TEST(ManifoldTwin, OfPointsAndBallsIsThatOfComparingAll)
{
  expectManyAsTheTwin(test::attacks(90'000), 0, false);
}

/// Terraces above a floor, with nodes as flat as scans: what a patch holds is passed over by their slabs.
TEST(ManifoldTwin, OfTerracesIsThatOfComparingAll)
{
  std::size_t contacts = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const auto points = [&](double step) {
      std::vector<Point3> all;
      for (int i = 0; i < 500; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        all.push_back({x, y, step * std::floor(2 * x) + random.uniform(0.0, 0.01)});
      }
      return all;
    };
    const Thing terraces(points(random.pick({0.03, 0.06, 0.1}))), floor(points(0.0));
    const Eigen::Isometry3d pose = random.pose(random.pick({1.0, 1e4}));
    Eigen::Isometry3d above = pose * Eigen::Translation3d(0, 0, random.uniform(0.05, 0.25));
    above.rotate(Eigen::AngleAxisd(random.uniform(-0.1, 0.1), Eigen::Vector3d::UnitX()));
    ManifoldRequest request;
    request.margin = random.uniform(0.05, 0.2);
    request.thickness = random.pick({0.0, 0.05});
    request.height = random.pick({0.0251, 0.0513, 0.2017});
    contacts += expectAsTheTwin({terraces, floor, above, pose, request, 4.0});
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(contacts, 500u) << "cases are no test";
}

/// Ids as the specification has them: the pair of contacts that moved least is one, then that of those left. Where
/// pairs moved equally, within rounding, any of them may be taken.
void expectIdsAsTheTwin(const Manifold& before, const Manifold& now, double within)
{
  constexpr double equal = 1e-9;
  const auto movedOf = [&](const Contact& old, const Contact& one) {
    const auto moved = [](const Eigen::Isometry3d& from, const Eigen::Vector3d& old_place, const Eigen::Isometry3d& to,
                          const Eigen::Vector3d& place) {
      return (from.inverse() * old_place - to.inverse() * place).norm();
    };
    return std::min(moved(before.pose_a, old.place_a, now.pose_a, one.place_a),
                    moved(before.pose_b, old.place_b, now.pose_b, one.place_b));
  };
  std::vector<Contact> old_left = before.contacts, left = now.contacts;
  for (;;) {
    double least = std::numeric_limits<double>::infinity();
    for (const Contact& old : old_left)
      for (const Contact& one : left) least = std::min(least, movedOf(old, one));
    if (!(least <= within)) break;
    const auto isTaken = [&](const Contact& old, const Contact& one) {
      return old.id == one.id && movedOf(old, one) <= least + equal;
    };
    bool found = false;
    for (std::size_t i = 0; i < old_left.size() && !found; ++i)
      for (std::size_t k = 0; k < left.size() && !found; ++k) {
        if (!isTaken(old_left[i], left[k])) continue;
        old_left.erase(old_left.begin() + static_cast<std::ptrdiff_t>(i));
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
        found = true;
      }
    ASSERT_TRUE(found) << "no contact lives on that moved by " << least;
  }
  std::uint32_t next = before.next_id;
  for (const Contact& one : left) EXPECT_EQ(one.id, next++) << "is no new one";
  EXPECT_EQ(now.next_id, next);
}

/// A stone wanders over a floor of points in small steps, turns and leaps now and then.
TEST(ManifoldTwin, IdsOfTenThousandStepsAreThoseOfComparingAll)
{
  test::Random random(11);
  std::vector<Point3> stone, floor;
  for (int i = 0; i < 60; ++i) stone.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 0.1)});
  for (int i = 0; i < 300; ++i) floor.push_back({random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(0, 0.1)});
  const Thing a(stone), b(floor);
  Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 0.2));
  Manifold before;
  std::size_t living = 0, born = 0;
  for (int i = 0; i < 10000; ++i) {
    const double step = random.chance(0.01) ? 0.3 : 0.01;
    pose.pretranslate(Eigen::Vector3d(random.uniform(-step, step), random.uniform(-step, step), 0));
    pose.rotate(Eigen::AngleAxisd(random.uniform(-step, step), Eigen::Vector3d::UnitZ()));
    pose.translation() = pose.translation().cwiseMax(-2.0).cwiseMin(2.0);
    pose.translation().z() = random.uniform(0.15, 0.25);
    ManifoldRequest request;
    request.margin = 0.3;
    request.thickness = 0.0;
    request.same_within = 0.6; // several may be one
    request.previous = i > 0 ? &before : nullptr;
    const Manifold now = contactManifold({*a.collider, pose}, {*b.collider}, request);
    if (i > 0) {
      expectIdsAsTheTwin(before, now, *request.same_within);
      ASSERT_FALSE(testing::Test::HasFailure()) << "step " << i;
      for (const Contact& one : now.contacts) (one.id < before.next_id ? living : born) += 1;
    }
    before = now;
  }
  EXPECT_GT(living, 10000u);
  EXPECT_GT(born, 300u);
}

/// An edge that ends at another one does not cross it: a rounding said that it did.
TEST(ManifoldTwin, OfEdgesThatEndAtEachOther)
{
  expectManyAsTheTwin(1, (std::uint64_t{1} << 32) + 13921, true);
}

TEST(ManifoldTwin, OfSurfacesIsThatOfComparingAll)
{
  expectManyAsTheTwin(test::attacks(12'000), std::uint64_t{1} << 32, true);
}

} // namespace
} // namespace pcl_bsh
