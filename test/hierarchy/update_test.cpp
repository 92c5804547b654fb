// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/update.h>

#include "support/random_clouds.h"
#include "support/refusal.h"
#include "support/verdicts.h"

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using test::Random;
using test::refusalOf;
using test::Shape;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// x y z of a cloud that changes, in floats or doubles, at an address that changes too.
template <class T>
class ChangingCloud {
public:
  ChangingCloud(const std::vector<Point3>& points, bool with_radii, Random& random) : with_radii_(with_radii)
  {
    for (const Point3& p : points) append(p, random);
  }

  void append(const Point3& p, Random& random)
  {
    for (const double x : p) xyz_.push_back(static_cast<T>(x));
    radii_.push_back(static_cast<float>(random.uniform(0, 0.05)));
  }

  void set(std::size_t i, const Point3& p)
  {
    for (std::size_t k = 0; k < 3; ++k) xyz_[3 * i + k] = static_cast<T>(p[k]);
  }

  void move() { xyz_ = std::vector<T>(xyz_); }

  std::size_t size() const { return radii_.size(); }

  PointsView view() const
  {
    PointsView view = viewOf(xyz_.data(), size());
    if (with_radii_) view.radii = radii_.data();
    return view;
  }

private:
  std::vector<T> xyz_;
  std::vector<float> radii_;
  bool with_radii_;
};

void expectSound(const SphereHierarchy& hierarchy)
{
  const HierarchyDefects defects = hierarchy.validate();
  EXPECT_TRUE(defects.none()) << defects.lines.front();
}

/// Same points, same answers as a hierarchy built anew.
void expectAsNew(const SphereHierarchy& updated, const PointsView& view, Random& random)
{
  const SphereHierarchy anew(view);
  ASSERT_EQ(updated.size(), anew.size());
  const std::vector<Point3> points = test::makePoints(Shape::uniform, 50, 1, random);
  const test::Cloud probe_cloud(points);
  const SphereHierarchy probe(probe_cloud.view());
  FlagsRequest request;
  request.clearance = 0.1;
  const Eigen::Isometry3d pose = random.pose(0.5);
  EXPECT_EQ(collisionFlags({updated}, {probe, pose}, request).a, collisionFlags({anew}, {probe, pose}, request).a);
  EXPECT_EQ(closestPair({updated}, {probe, pose}).distance, closestPair({anew}, {probe, pose}).distance);
  EXPECT_EQ(closestPair({updated}, {probe, pose}).pair, closestPair({anew}, {probe, pose}).pair);
}

template <class T>
void replaceEraseAndInsert(std::uint64_t seed)
{
  SCOPED_TRACE(seed);
  Random random(seed);
  const Shape shape = random.pick(test::all_shapes);
  const auto count = static_cast<std::size_t>(random.chance(0.3) ? random.integer(0, 20) : random.integer(100, 1500));
  ChangingCloud<T> cloud(test::makePoints(shape, count, 1, random), random.chance(0.3), random);
  HierarchyOptions options;
  options.voxel_edge = random.chance(0.7) ? 0.25 : 0.0;
  SphereHierarchy hierarchy(cloud.view(), options);
  if (random.chance(0.5)) hierarchy.buildAll();
  for (int round = 0; round < 6; ++round) {
    std::vector<std::int32_t> changed;
    const Point3 center = random.point([&] { return random.uniform(-1, 1); });
    const double reach = random.uniform(0.05, 0.6);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Point3 p = cloud.view().point(static_cast<std::uint32_t>(i));
      const double far = std::max({std::abs(p[0] - center[0]), std::abs(p[1] - center[1]), std::abs(p[2] - center[2])});
      if (!(far > reach) ? random.chance(0.7) : random.chance(0.01)) changed.push_back(static_cast<std::int32_t>(i));
    }
    const int more = random.chance(0.5) ? random.integer(0, 50) : 0;
    for (int i = 0; i < more; ++i) changed.push_back(static_cast<std::int32_t>(cloud.size()) + i);
    std::reverse(changed.begin(), changed.end());
    if (!changed.empty()) changed.push_back(changed.front()); // twice does no harm

    HierarchyUpdate update(hierarchy, changed.data(), changed.size());
    const auto somewhere = [&]() -> Point3 {
      if (random.chance(0.2)) return {nan, 0, 0};
      const double wide = random.chance(0.02) ? 3.0 : reach;
      const Point3 d = random.point([&] { return random.uniform(-wide, wide); });
      return {center[0] + d[0], center[1] + d[1], center[2] + d[2]};
    };
    for (int i = 0; i < more; ++i) cloud.append(somewhere(), random);
    for (const std::int32_t i : changed) cloud.set(static_cast<std::size_t>(i), somewhere());
    cloud.move();
    update.commit(cloud.view());
    expectSound(hierarchy);
    expectAsNew(hierarchy, cloud.view(), random);
    if (testing::Test::HasFailure()) return;
    if (random.chance(0.3)) hierarchy.buildAll();
  }
}

TEST(HierarchyUpdate, SaysHowManyRecordsMoreThereAre)
{
  const std::vector<float> xyz(15, 0.5f);
  SphereHierarchy hierarchy(viewOf(xyz.data(), 2));
  HierarchyUpdate update(hierarchy, nullptr, 0);
  try {
    update.commit(viewOf(xyz.data(), 5));
    FAIL();
  }
  catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("has 3 more records, of which 0 were announced"), std::string::npos)
        << error.what();
  }
}

TEST(HierarchyRefit, TakesTheSameSubsetAndNoOther)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  const std::vector<std::int32_t> some = {0, 2}, same = {0, 2}, others = {0, 1};
  const auto viewOfSome = [&](const std::vector<std::int32_t>& indices) {
    PointsView view = viewOf(xyz.data(), 3);
    view.indices = indices.data();
    view.index_count = indices.size();
    return view;
  };
  SphereHierarchy hierarchy(viewOfSome(some));
  EXPECT_NO_THROW(hierarchy.refit(viewOfSome(some)));
  EXPECT_NO_THROW(hierarchy.refit(viewOfSome(same)));
  EXPECT_THROW(hierarchy.refit(viewOfSome(others)), std::invalid_argument);
  EXPECT_THROW(hierarchy.refit(viewOf(xyz.data(), 3)), std::invalid_argument);
}

TEST(HierarchyUpdate, EqualToBuildingAnew)
{
  for (std::uint64_t seed = 0; seed < 30; ++seed) replaceEraseAndInsert<float>(seed);
  for (std::uint64_t seed = 100; seed < 130; ++seed) replaceEraseAndInsert<double>(seed);
}

/// Points on a plain of 16 x 16 voxels.
std::vector<Point3> plain(std::size_t count, Random& random)
{
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({random.uniform(0, 16), random.uniform(0, 16), 0.5});
  return points;
}

TEST(HierarchyUpdate, TouchesOnlyTheVoxelsThatChange)
{
  Random random(3);
  ChangingCloud<float> cloud(plain(20000, random), false, random);
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  SphereHierarchy hierarchy(cloud.view(), options);
  hierarchy.buildAll();
  ASSERT_EQ(hierarchy.statistics().voxels, 256u);
  std::vector<std::int32_t> changed;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3 p = cloud.view().point(static_cast<std::uint32_t>(i));
    if (p[0] > 3 && p[0] < 5 && p[1] > 7 && p[1] < 8) changed.push_back(static_cast<std::int32_t>(i));
  }
  HierarchyUpdate update(hierarchy, changed.data(), changed.size());
  for (const std::int32_t i : changed) {
    const auto record = static_cast<std::uint32_t>(i);
    Point3 p = cloud.view().point(record);
    p[2] = 0.75;
    cloud.set(record, p);
  }
  const UpdateReport report = update.commit(cloud.view());
  EXPECT_FALSE(report.sorted_anew);
  EXPECT_EQ(report.voxels_touched, 2u);
  EXPECT_EQ(report.voxels_added, 0u);
  EXPECT_EQ(report.voxels_removed, 0u);
  EXPECT_EQ(report.points_read, changed.size());
  EXPECT_EQ(hierarchy.statistics().voxels_built, 254u);
  expectSound(hierarchy);

  HierarchyUpdate lift(hierarchy, changed.data(), changed.size());
  for (const std::int32_t i : changed) {
    const auto record = static_cast<std::uint32_t>(i);
    Point3 p = cloud.view().point(record);
    p[2] = 1.5;
    cloud.set(record, p);
  }
  const UpdateReport lifted = lift.commit(cloud.view());
  EXPECT_EQ(lifted.voxels_touched, 4u);
  EXPECT_EQ(lifted.voxels_added, 2u);
  EXPECT_EQ(lifted.voxels_removed, 2u);
  EXPECT_EQ(hierarchy.statistics().voxels, 256u);
  expectSound(hierarchy);
}

TEST(HierarchyUpdate, ScatteredOrFarChangesSortAnew)
{
  Random random(4);
  ChangingCloud<float> cloud(plain(5000, random), false, random);
  SphereHierarchy hierarchy(cloud.view());
  std::vector<std::int32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0);
  HierarchyUpdate everything(hierarchy, all.data(), all.size());
  EXPECT_TRUE(everything.commit(cloud.view()).sorted_anew);
  const std::int32_t one = 7;
  HierarchyUpdate far(hierarchy, &one, 1);
  cloud.set(7, {1e9, 0, 0});
  EXPECT_TRUE(far.commit(cloud.view()).sorted_anew);
  expectSound(hierarchy);
}

TEST(HierarchyUpdate, ManyUpdatesDoNotPileUp)
{
  Random random(5);
  ChangingCloud<float> cloud(plain(20000, random), false, random);
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  SphereHierarchy hierarchy(cloud.view(), options);
  hierarchy.buildAll();
  const std::size_t bytes = hierarchy.statistics().bytes;
  for (int round = 0; round < 100; ++round) {
    std::vector<std::int32_t> changed;
    for (std::size_t i = 0; i < 500; ++i) changed.push_back(round % 2 * 500 + static_cast<std::int32_t>(i));
    HierarchyUpdate update(hierarchy, changed.data(), changed.size());
    for (const std::int32_t i : changed)
      cloud.set(static_cast<std::size_t>(i), {random.uniform(0, 5), random.uniform(0, 5), 0.5});
    update.commit(cloud.view());
  }
  hierarchy.buildAll();
  EXPECT_LT(hierarchy.statistics().bytes, 1.7 * static_cast<double>(bytes));
  expectSound(hierarchy);
}

/// Bounds are rounded outward, but not beyond the largest number: a frame of infinities is near to nothing.
TEST(HierarchyUpdate, AtTheLargestNumbers)
{
  constexpr double largest = std::numeric_limits<double>::max();
  std::vector<double> xyz;
  for (int i = 0; i < 60; ++i) {
    const double x = i % 3 == 2 ? 0.0 : largest * (1.0 - 0x1p-22 * (i % 2)); // two that share a voxel
    xyz.insert(xyz.end(), {i % 6 < 2 ? x : -x, 1e306 * (i / 6), 0.0});
  }
  SphereHierarchy hierarchy(viewOf(xyz.data(), 60));
  const std::int32_t record = 2;
  HierarchyUpdate update(hierarchy, &record, 1);
  xyz[7] = 1e300;
  EXPECT_FALSE(update.commit(viewOf(xyz.data(), 60)).sorted_anew);
  expectSound(hierarchy);
  EXPECT_TRUE(closestPair({hierarchy}, {hierarchy}).pair);
  FlagsRequest request;
  EXPECT_EQ(collisionFlags({hierarchy}, {hierarchy}, request).colliding_a, 60u);

  for (double& x : xyz) x = -x;
  hierarchy.refit(viewOf(xyz.data(), 60), 1e9);
  expectSound(hierarchy);
  EXPECT_EQ(collisionFlags({hierarchy}, {hierarchy}, request).colliding_a, 60u);
}

/// Thirty points at one place share a leaf, and one of them answers for all as long as they are alike.
TEST(HierarchyUpdate, OfOtherUncertaintiesWhereNoPointMoved)
{
  Random random(9);
  std::vector<Point3> points = plain(2000, random);
  std::fill_n(points.begin() + 100, 30, Point3{4.5, 4.5, 0.5});
  const test::Cloud cloud(points), probe({{4.5, 4.5, 1.5}});
  const SphereHierarchy of_probe(probe.view());
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  for (const bool had_some : {false, true}) {
    std::vector<float> own(points.size(), 0.0f);
    PointsView view = cloud.view();
    if (had_some) view.uncertainties = own.data();
    SphereHierarchy hierarchy(view, options);
    hierarchy.buildAll();
    HierarchyUpdate update(hierarchy, nullptr, 0); // no record moves
    for (std::size_t i = 101; i < 130; ++i) own[i] = 0.6f;
    view.uncertainties = own.data();
    const UpdateReport report = update.commit(view);
    EXPECT_FALSE(report.sorted_anew);
    EXPECT_EQ(report.voxels_touched, 1u);
    expectSound(hierarchy);
    FlagsRequest request;
    request.clearance = 0.5;
    const FlagsResult found = collisionFlags(hierarchy, of_probe, request);
    EXPECT_EQ(found.undecided_a, 29u);
    EXPECT_EQ(found.a, brute_force::collisionFlags(hierarchy, of_probe, request).a);
    HierarchyUpdate again(hierarchy, nullptr, 0);
    EXPECT_EQ(again.commit(view).voxels_touched, 0u) << "nothing is other than it was";
  }
}

TEST(HierarchyUpdate, OfOtherRadiiWhereNoPointMoved)
{
  Random random(10);
  std::vector<Point3> points = plain(2000, random);
  std::fill_n(points.begin() + 100, 30, Point3{4.5, 4.5, 0.5});
  const test::Cloud cloud(points), probe({{4.5, 4.5, 1.5}});
  const SphereHierarchy of_probe(probe.view());
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  for (const bool is_built : {false, true}) {
    std::vector<float> radii(points.size(), 0.01f);
    PointsView view = cloud.view();
    view.radii = radii.data();
    SphereHierarchy hierarchy(view, options);
    if (is_built) hierarchy.buildAll();
    HierarchyUpdate update(hierarchy, nullptr, 0);
    for (std::size_t i = 101; i < 130; ++i) radii[i] = 0.6f;
    EXPECT_EQ(update.commit(view).voxels_touched, 1u);
    expectSound(hierarchy);
    FlagsRequest request;
    request.clearance = 0.5;
    EXPECT_EQ(collisionFlags(hierarchy, of_probe, request).a,
              brute_force::collisionFlags(hierarchy, of_probe, request).a);
    EXPECT_EQ(collisionFlags(hierarchy, of_probe, request).colliding_a, 29u);
    radii[7] = -1.0f;
    HierarchyUpdate negative(hierarchy, nullptr, 0);
    EXPECT_THROW(negative.commit(view), std::invalid_argument);
  }
}

TEST(HierarchyUpdate, RefusesWhatItCannotDo)
{
  Random random(6);
  ChangingCloud<float> cloud(plain(100, random), false, random), more(plain(101, random), false, random);
  ChangingCloud<double> doubles(plain(100, random), false, random);
  SphereHierarchy hierarchy(cloud.view());
  const std::int32_t records[] = {3, -1}, beyond = 200;
  EXPECT_THROW(HierarchyUpdate(hierarchy, records, 2), std::invalid_argument);
  HierarchyUpdate update(hierarchy, records, 1);
  EXPECT_THROW(update.commit(more.view()), std::invalid_argument); // one more that nobody announced
  EXPECT_THROW(update.commit(doubles.view()), std::invalid_argument);
  PointsView fewer = cloud.view();
  fewer.count = 99;
  EXPECT_THROW(update.commit(fewer), std::invalid_argument);
  HierarchyUpdate nowhere(hierarchy, &beyond, 1);
  EXPECT_THROW(nowhere.commit(cloud.view()), std::invalid_argument);
  PointsView subset = cloud.view();
  subset.indices = &beyond;
  EXPECT_THROW(update.commit(subset), std::invalid_argument);
  const std::int32_t index = 5;
  subset.indices = &index;
  subset.index_count = 1;
  SphereHierarchy of_subset(subset);
  EXPECT_THROW(HierarchyUpdate(of_subset, records, 1), std::invalid_argument);
  update.commit(cloud.view());
  expectSound(hierarchy);
}

template <class T>
void deformAndCompare(std::uint64_t seed)
{
  SCOPED_TRACE(seed);
  Random random(seed);
  const auto count = static_cast<std::size_t>(random.chance(0.3) ? random.integer(0, 40) : random.integer(100, 1500));
  ChangingCloud<T> cloud(test::makePoints(random.pick(test::all_shapes), count, 1, random), random.chance(0.3), random);
  HierarchyOptions options;
  options.voxel_edge = random.chance(0.7) ? 0.25 : 0.0;
  SphereHierarchy hierarchy(cloud.view(), options);
  for (int round = 0; round < 5; ++round) {
    if (random.chance(0.5)) hierarchy.buildAll();
    const double reach = random.chance(0.3) ? 0.5 : 0.02;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      Point3 p = cloud.view().point(static_cast<std::uint32_t>(i));
      for (double& x : p) x += random.uniform(-reach, reach);
      if (random.chance(0.1 / static_cast<double>(cloud.size()))) p[0] = nan;
      cloud.set(i, p);
    }
    cloud.move();
    hierarchy.refit(cloud.view(), 1.5);
    expectSound(hierarchy);
    expectAsNew(hierarchy, cloud.view(), random);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(HierarchyRefit, EqualToBuildingAnew)
{
  for (std::uint64_t seed = 200; seed < 220; ++seed) deformAndCompare<float>(seed);
  for (std::uint64_t seed = 300; seed < 320; ++seed) deformAndCompare<double>(seed);
}

TEST(HierarchyRefit, RebuildsWhatHasGrownLoose)
{
  Random random(7);
  ChangingCloud<float> cloud(plain(20000, random), false, random);
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  SphereHierarchy hierarchy(cloud.view(), options);
  hierarchy.buildAll();
  const auto shake = [&](double reach, double most_growth) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      Point3 p = cloud.view().point(static_cast<std::uint32_t>(i));
      for (double& x : p) x += random.uniform(-reach, reach);
      cloud.set(i, p);
    }
    return hierarchy.refit(cloud.view(), most_growth);
  };
  RefitReport report = shake(1e-4, 1.5);
  EXPECT_FALSE(report.sorted_anew);
  EXPECT_EQ(report.voxels_refitted, 256u);
  EXPECT_EQ(report.voxels_dropped, 0u);
  EXPECT_NEAR(report.looseness, 1.0, 0.01);
  report = shake(0.2, 1.3); // leaves are some 0.4 across, voxels 1
  EXPECT_EQ(report.voxels_dropped, 256u);
  EXPECT_EQ(hierarchy.statistics().voxels_built, 0u);
  hierarchy.buildAll();
  EXPECT_TRUE(shake(2, 1.5).sorted_anew);
  expectSound(hierarchy);
}

TEST(HierarchyRefit, SaysInWhatAViewDiffers)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 2, 0, 0}, radii = {1, 1, 1};
  const std::vector<double> doubles(xyz.begin(), xyz.end());
  const std::vector<std::int32_t> all = {0, 1, 2};
  PointsView subset = viewOf(xyz.data(), 3), balls = subset;
  subset.indices = all.data();
  subset.index_count = 3;
  balls.radii = radii.data();
  SphereHierarchy hierarchy(viewOf(xyz.data(), 3)), of_subset(subset), of_balls(balls);
  const auto says = [](SphereHierarchy& refitted, const PointsView& view) {
    return refusalOf([&] { refitted.refit(view); });
  };
  const auto other_type = HasSubstr("SphereHierarchy::refit: the view has coordinates of another type");
  EXPECT_THAT(says(hierarchy, viewOf(doubles.data(), 3)), other_type);
  const auto other_subset = HasSubstr("SphereHierarchy::refit: the view is of another subset");
  EXPECT_THAT(says(hierarchy, subset), other_subset);
  EXPECT_THAT(says(of_subset, viewOf(xyz.data(), 3)), other_subset);
  const auto no_radii = HasSubstr("the view has radii and the one before none, or the other way round");
  EXPECT_THAT(says(hierarchy, balls), no_radii);
  EXPECT_THAT(says(of_balls, viewOf(xyz.data(), 3)), no_radii);
  EXPECT_EQ(says(hierarchy, viewOf(xyz.data(), 3)), "");
  EXPECT_EQ(says(of_balls, balls), "");
}

TEST(HierarchyRefit, OfACrowdAtOnePlaceWhosePointsPart)
{
  Random random(9);
  std::vector<Point3> points(200, Point3{0.25, 0.25, 0.25});
  for (const double x : {-1.0, 1.0}) points.push_back({x, x, x}); // so that the voxel stays as large as it is
  ChangingCloud<float> cloud(points, false, random);
  SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  cloud.set(7, {0.75, 0.25, 0.25}); // one point stood for all of them
  const RefitReport report = hierarchy.refit(cloud.view(), 1e9);
  EXPECT_FALSE(report.sorted_anew);
  EXPECT_EQ(report.voxels_dropped, 1u);
  expectSound(hierarchy);
  expectAsNew(hierarchy, cloud.view(), random);
}

TEST(HierarchyUpdate, OfAnEmptyHierarchyBuildsItAnew)
{
  Random random(10);
  ChangingCloud<float> cloud({}, false, random);
  SphereHierarchy hierarchy(cloud.view());
  const std::vector<std::int32_t> records = {0, 1, 2};
  HierarchyUpdate update(hierarchy, records.data(), records.size());
  for (const double x : {0.0, 1.0, 2.0}) cloud.append({x, 0, 0}, random);
  const UpdateReport report = update.commit(cloud.view());
  EXPECT_TRUE(report.sorted_anew);
  EXPECT_EQ(report.points_read, 3u);
  EXPECT_EQ(hierarchy.size(), 3u);
  expectSound(hierarchy);
  expectAsNew(hierarchy, cloud.view(), random);
}

/// 400 points along x, a hundred in each voxel.
std::pair<ChangingCloud<float>, SphereHierarchy> pointsInARow(Random& random)
{
  std::vector<Point3> points;
  for (int i = 0; i < 400; ++i) points.push_back({0.01 * i + 0.005, 0.5, 0.5});
  ChangingCloud<float> cloud(points, false, random);
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  SphereHierarchy hierarchy(cloud.view(), options);
  return {std::move(cloud), std::move(hierarchy)}; // the coordinates stay where they are
}

TEST(HierarchyUpdate, APointThatGoesTouchesItsVoxelAlone)
{
  Random random(12);
  auto [cloud, hierarchy] = pointsInARow(random);
  const double reach = hierarchy.storage().frame.reach[0];
  const std::int32_t record = 150;
  HierarchyUpdate update(hierarchy, &record, 1);
  cloud.set(150, {0.5, nan, 0.5});
  const UpdateReport report = update.commit(cloud.view());
  EXPECT_FALSE(report.sorted_anew);
  EXPECT_EQ(report.voxels_touched, 1u);
  EXPECT_EQ(hierarchy.size(), 399u);
  EXPECT_LT(hierarchy.storage().frame.reach[0], 1.01 * reach) << "as large as it was";
  expectSound(hierarchy);
  expectAsNew(hierarchy, cloud.view(), random);
}

TEST(HierarchyUpdate, OfPointsThatARefitTookOutOfTheirVoxels)
{
  // A refit leaves points in their voxels, wherever they go: their coordinates do not tell which voxel holds them.
  Random random(11);
  auto [cloud, hierarchy] = pointsInARow(random);
  cloud.set(50, {1.005, 0.5, 0.5});  // from the first voxel into the second
  cloud.set(150, {0.505, 0.5, 0.5}); // and the other way: both hold as many as before
  ASSERT_FALSE(hierarchy.refit(cloud.view()).sorted_anew);
  const std::int32_t record = 50;
  HierarchyUpdate update(hierarchy, &record, 1);
  cloud.set(50, {1.105, 0.5, 0.5});
  EXPECT_TRUE(update.commit(cloud.view()).sorted_anew);
  expectSound(hierarchy);
  expectAsNew(hierarchy, cloud.view(), random);
}

TEST(HierarchyUpdate, SaysInWhatAViewDiffers)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 2, 0, 0}, radii = {1, 1, 1};
  PointsView balls = viewOf(xyz.data(), 3);
  balls.radii = radii.data();
  SphereHierarchy hierarchy(viewOf(xyz.data(), 3)), of_balls(balls);
  const auto says = [](SphereHierarchy& updated, const PointsView& view) {
    return refusalOf([&] { HierarchyUpdate(updated, nullptr, 0).commit(view); });
  };
  const auto no_radii = HasSubstr("the new view has radii and the old one none, or the other way round");
  EXPECT_THAT(says(hierarchy, balls), no_radii);
  EXPECT_THAT(says(of_balls, viewOf(xyz.data(), 3)), no_radii);
  EXPECT_EQ(says(of_balls, balls), "");
}

TEST(HierarchyRefit, RefusesWhatDoesNotFit)
{
  Random random(8);
  ChangingCloud<float> cloud(plain(100, random), false, random), more(plain(101, random), false, random);
  SphereHierarchy hierarchy(cloud.view());
  EXPECT_THROW(hierarchy.refit(more.view()), std::invalid_argument);
  EXPECT_THROW(hierarchy.refit(cloud.view(), 0.9), std::invalid_argument);
  EXPECT_THROW(hierarchy.refit(cloud.view(), nan), std::invalid_argument);
  expectSound(hierarchy);
}

} // namespace
} // namespace pcl_bsh
