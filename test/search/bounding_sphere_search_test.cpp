// SPDX-License-Identifier: BSD-3-Clause
// The promises of the declaration, against brute force and against PCL's own classes.
#include <pcl_bsh/search/bounding_sphere_search.h>

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>
#include <type_traits>

namespace pcl_bsh::search {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// PCL's face as it is up to 1.13 (Result: void) and from 1.14 on (bool).
template <typename Result>
class FaceOfPcl {
public:
  using PointCloudConstPtr = Cloud::ConstPtr;
  virtual ~FaceOfPcl() = default;
  virtual Result setInputCloud(const PointCloudConstPtr& cloud,
                               const pcl::IndicesConstPtr& indices = pcl::IndicesConstPtr()) = 0;
};

/// Overrides as our class does.
template <typename Base>
class OverFace : public Base {
public:
  SetInputCloudResultOf<Base> setInputCloud(const typename Base::PointCloudConstPtr& cloud,
                                            const pcl::IndicesConstPtr&) override
  {
    size = cloud->size();
    if constexpr (!std::is_void_v<SetInputCloudResultOf<Base>>) return true;
  }

  std::size_t size = 0;
};

static_assert(std::is_void_v<SetInputCloudResultOf<FaceOfPcl<void>>>);
static_assert(std::is_same_v<SetInputCloudResultOf<FaceOfPcl<bool>>, bool>);
static_assert(std::is_same_v<BoundingSphereSearch<Point>::SetInputCloudResult,
                             SetInputCloudResultOf<pcl::search::KdTree<Point>>>);

Cloud::Ptr cloudOf(std::initializer_list<Point> points)
{
  auto cloud = std::make_shared<Cloud>();
  for (const Point& p : points) cloud->push_back(p);
  return cloud;
}

/// On a coarse lattice, so that distances tie; every twentieth point is not finite.
Cloud::Ptr latticeCloud(std::size_t count)
{
  std::mt19937 random(7);
  auto cloud = std::make_shared<Cloud>();
  const auto coordinate = [&] { return static_cast<float>(random() % 65) / 16.0f; };
  for (std::size_t i = 0; i < count; ++i) {
    cloud->emplace_back(coordinate(), coordinate(), coordinate());
    if (i % 20 == 7) cloud->back().y = i % 40 == 7 ? kNan : -kInfinity;
  }
  cloud->is_dense = true; // a lie, as clouds tell it
  return cloud;
}

struct Hit {
  double squared;
  int index;
  bool operator<(const Hit& other) const
  {
    return squared != other.squared ? squared < other.squared : index < other.index;
  }
};

/// Exact for points of latticeCloud().
std::vector<Hit> bruteForce(const Cloud& cloud, const pcl::Indices* indices, const Point& q, double radius)
{
  std::vector<Hit> hits;
  const std::size_t count = indices ? indices->size() : cloud.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int index = indices ? (*indices)[i] : static_cast<int>(i);
    const Point& p = cloud[static_cast<std::size_t>(index)];
    if (!std::isfinite(p.x + p.y + p.z)) continue;
    const double x = double{p.x} - q.x, y = double{p.y} - q.y, z = double{p.z} - q.z;
    const double squared = x * x + y * y + z * z;
    if (squared <= radius * radius) hits.push_back({squared, index});
  }
  std::sort(hits.begin(), hits.end());
  return hits;
}

void expectHits(const std::vector<Hit>& hits, std::size_t most, int returned, const pcl::Indices& indices,
                const std::vector<float>& squared)
{
  pcl::Indices expected;
  std::vector<float> expected_squared;
  for (std::size_t i = 0; i < std::min(most, hits.size()); ++i) {
    expected.push_back(hits[i].index);
    expected_squared.push_back(static_cast<float>(hits[i].squared));
  }
  EXPECT_EQ(returned, static_cast<int>(expected.size()));
  EXPECT_EQ(indices, expected);
  EXPECT_EQ(squared, expected_squared);
}

/// Whether a search gives what brute force gives: the check that must notice one point missing.
bool findsEverything(const pcl::search::Search<Point>& search, const Cloud& cloud)
{
  pcl::Indices indices;
  std::vector<float> squared;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!std::isfinite(cloud[i].x + cloud[i].y + cloud[i].z)) continue;
    search.radiusSearch(cloud[i], 0.0, indices, squared);
    if (std::find(indices.begin(), indices.end(), static_cast<int>(i)) == indices.end()) return false;
  }
  search.radiusSearch(Point(2, 2, 2), 10.0, indices, squared);
  return indices.size() == bruteForce(cloud, nullptr, Point(2, 2, 2), 10.0).size();
}

TEST(BoundingSphereSearch, OverridesEitherFaceOfPcl)
{
  const auto cloud = cloudOf({{1, 2, 3}});
  OverFace<FaceOfPcl<void>> older;
  OverFace<FaceOfPcl<bool>> newer;
  static_cast<FaceOfPcl<void>&>(older).setInputCloud(cloud);
  EXPECT_TRUE(static_cast<FaceOfPcl<bool>&>(newer).setInputCloud(cloud));
  EXPECT_EQ(older.size, 1u);
  EXPECT_EQ(newer.size, 1u);
}

TEST(BoundingSphereSearch, LikeBruteForceWithAndWithoutIndices)
{
  const auto cloud = latticeCloud(3000);
  auto subset = std::make_shared<pcl::Indices>();
  for (int i = 2999; i > 0; i -= 3) subset->push_back(i);
  for (const auto& chosen : {pcl::IndicesPtr(), pcl::IndicesPtr(subset)}) {
    BoundingSphereSearch<Point> search;
    search.setInputCloud(cloud, chosen);
    EXPECT_EQ(search.getInputCloud(), cloud);
    EXPECT_EQ(search.getIndices(), chosen);
    pcl::Indices indices;
    std::vector<float> squared;
    for (std::size_t i = 0; i < 200; ++i) {
      const Point q((*cloud)[13 * i].x, static_cast<float>(i % 64) / 16.0f, (*cloud)[13 * i].z);
      const double radius = static_cast<double>(i % 9) / 16.0;
      const auto hits = bruteForce(*cloud, chosen.get(), q, radius);
      expectHits(hits, hits.size(), search.radiusSearch(q, radius, indices, squared), indices, squared);
      expectHits(hits, 3, search.radiusSearch(q, radius, indices, squared, 3), indices, squared);
      EXPECT_EQ(search.anyInRadius(q, radius), !hits.empty());
      const auto all = bruteForce(*cloud, chosen.get(), q, 1e3);
      expectHits(all, 17, search.nearestKSearch(q, 17, indices, squared), indices, squared);
    }
  }
}

TEST(BoundingSphereSearch, ADroppedPointIsNoticed)
{
  const auto cloud = latticeCloud(500);
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloud);
  EXPECT_TRUE(findsEverything(search, *cloud));

  class Dropping : public BoundingSphereSearch<Point> {
  public:
    using BoundingSphereSearch<Point>::radiusSearch;
    int radiusSearch(const Point& p, double radius, pcl::Indices& indices, std::vector<float>& squared,
                     unsigned int max_nn = 0) const override
    {
      BoundingSphereSearch<Point>::radiusSearch(p, radius, indices, squared, max_nn);
      const auto dropped = std::find(indices.begin(), indices.end(), 321);
      if (dropped != indices.end()) {
        squared.erase(squared.begin() + (dropped - indices.begin()));
        indices.erase(dropped);
      }
      return static_cast<int>(indices.size());
    }
  } dropping;
  dropping.setInputCloud(cloud);
  EXPECT_FALSE(findsEverything(dropping, *cloud));
}

TEST(BoundingSphereSearch, RadiusIncludesItsEnd)
{
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloudOf({{0, 0, 0}, {3, 4, 0}}));
  pcl::Indices indices;
  std::vector<float> squared;
  EXPECT_EQ(search.radiusSearch(Point(0, 0, 0), 5.0, indices, squared), 2);
  EXPECT_THAT(squared, ElementsAre(0.0f, 25.0f));
  EXPECT_EQ(search.radiusSearch(Point(0, 0, 0), std::nextafter(5.0, 0.0), indices, squared), 1);
  EXPECT_EQ(search.radiusSearch(Point(0, 0, 0), 0.0, indices, squared), 1);
}

TEST(BoundingSphereSearch, EqualDistancesByIndexAndDuplicatesAll)
{
  BoundingSphereSearch<Point> search;
  auto cloud = cloudOf({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
  for (int i = 0; i < 40; ++i) cloud->emplace_back(0.0f, 0.0f, 1.0f);
  search.setInputCloud(cloud);
  pcl::Indices indices;
  std::vector<float> squared;
  EXPECT_EQ(search.radiusSearch(Point(0, 0, 0), 1.0, indices, squared), 43);
  EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
  EXPECT_EQ(search.nearestKSearch(Point(0, 0, 0), 5, indices, squared), 5);
  EXPECT_THAT(indices, ElementsAre(0, 1, 2, 3, 4));
}

TEST(BoundingSphereSearch, QueriesThatAreNotFiniteFindNothing)
{
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloudOf({{0, 0, 0}, {kNan, 0, 0}}));
  pcl::Indices indices = {5};
  std::vector<float> squared = {5.0f};
  for (const Point& q : {Point(kNan, 0, 0), Point(0, kInfinity, 0)}) {
    EXPECT_EQ(search.radiusSearch(q, 1.0, indices, squared), 0);
    EXPECT_EQ(search.nearestKSearch(q, 1, indices, squared), 0);
    EXPECT_FALSE(search.anyInRadius(q, 1.0));
  }
  EXPECT_EQ(search.nearestKSearch(1, 1, indices, squared), 0) << "the point by its index";
  EXPECT_THAT(indices, IsEmpty());
  EXPECT_THAT(squared, IsEmpty());
}

TEST(BoundingSphereSearch, EmptyCloudClearsTheOutputs)
{
  BoundingSphereSearch<Point> search;
  search.setInputCloud(std::make_shared<Cloud>());
  pcl::Indices indices = {5};
  std::vector<float> squared = {5.0f};
  EXPECT_EQ(search.radiusSearch(Point(0, 0, 0), 1.0, indices, squared), 0);
  EXPECT_THAT(indices, IsEmpty());
  EXPECT_THAT(squared, IsEmpty());
  indices = {5};
  EXPECT_EQ(search.nearestKSearch(Point(0, 0, 0), 3, indices, squared), 0);
  EXPECT_THAT(indices, IsEmpty());
  EXPECT_THAT(search.anyInBalls(Cloud(), {}), IsEmpty());
}

TEST(BoundingSphereSearch, MoreThanThereAreIsAll)
{
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloudOf({{0, 0, 0}, {1, 0, 0}}));
  pcl::Indices indices;
  std::vector<float> squared;
  EXPECT_EQ(search.nearestKSearch(Point(0, 0, 0), 7, indices, squared), 2);
  EXPECT_EQ(search.radiusSearch(Point(0, 0, 0), 9.0, indices, squared, 7), 2);
  EXPECT_EQ(search.nearestKSearch(Point(0, 0, 0), 0, indices, squared), 0);
}

TEST(BoundingSphereSearch, OverloadsByIndexFollowTheSubset)
{
  const auto cloud = cloudOf({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloud, pcl::IndicesPtr(new pcl::Indices{3, 1}));
  pcl::Indices indices;
  std::vector<float> squared;
  EXPECT_EQ(search.nearestKSearch(0, 1, indices, squared), 1); // place 0 of the subset: point 3
  EXPECT_THAT(indices, ElementsAre(3));
  EXPECT_EQ(search.radiusSearch(*cloud, 0, 1.5, indices, squared), 1); // point 0 of a cloud
  EXPECT_THAT(indices, ElementsAre(1));
  std::vector<pcl::Indices> many;
  std::vector<std::vector<float>> many_squared;
  search.nearestKSearch(*cloud, {2, 0}, 2, many, many_squared);
  EXPECT_THAT(many, ElementsAre(ElementsAre(1, 3), ElementsAre(1, 3)));
}

TEST(BoundingSphereSearch, ManyAtOnceAsOneByOne)
{
  const auto cloud = latticeCloud(2000);
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloud);
  for (const unsigned threads : {1u, 2u, 0u}) {
    search.setNumberOfThreads(threads);
    for (const bool sorted : {true, false}) {
      search.setSortedResults(sorted);
      std::vector<pcl::Indices> many;
      std::vector<std::vector<float>> many_squared;
      search.radiusSearch(*cloud, {}, 0.25, many, many_squared);
      ASSERT_EQ(many.size(), cloud->size());
      pcl::Indices indices;
      std::vector<float> squared;
      for (std::size_t i = 0; i < cloud->size(); ++i) {
        search.radiusSearch((*cloud)[i], 0.25, indices, squared);
        EXPECT_EQ(many[i], indices);
        EXPECT_EQ(many_squared[i], squared);
      }
      search.nearestKSearch(*cloud, {}, 6, many, many_squared);
      for (std::size_t i = 0; i < cloud->size(); ++i) {
        search.nearestKSearch((*cloud)[i], 6, indices, squared);
        EXPECT_EQ(many[i], indices);
        EXPECT_EQ(many_squared[i], squared);
      }
    }
  }
}

TEST(BoundingSphereSearch, ConstQueriesFromSeveralThreads)
{
  const auto cloud = latticeCloud(3000);
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloud);
  const HierarchyStatistics statistics = search.getHierarchy().statistics();
  EXPECT_EQ(statistics.voxels_built, statistics.voxels) << "queries build nothing";
  std::vector<std::vector<int>> counts(4);
  std::vector<std::thread> threads;
  for (auto& mine : counts)
    threads.emplace_back([&] {
      pcl::Indices indices;
      std::vector<float> squared;
      for (const Point& p : *cloud) mine.push_back(search.radiusSearch(p, 0.3, indices, squared));
    });
  for (auto& thread : threads) thread.join();
  std::vector<int> expected;
  for (const Point& p : *cloud) {
    const bool finite = std::isfinite(p.x + p.y + p.z);
    expected.push_back(finite ? static_cast<int>(bruteForce(*cloud, nullptr, p, 0.3).size()) : 0);
  }
  for (const auto& mine : counts) EXPECT_EQ(mine, expected);
}

TEST(BoundingSphereSearch, BallsAndBoxes)
{
  const auto cloud = cloudOf({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  BoundingSphereSearch<Point> search;
  search.setInputCloud(cloud);
  EXPECT_THAT(search.anyInBalls(*cloudOf({{4, 0, 0}, {4, 0, 0}, {kNan, 0, 0}}), {2.0f, 1.9f, 9.0f}),
              ElementsAre(1, 0, 0));
  EXPECT_THROW(search.anyInBalls(*cloud, {1.0f}), std::invalid_argument);
  EXPECT_THROW(search.anyInBalls(*cloud, {1.0f, -1.0f, 0.0f}), std::invalid_argument);
  pcl::Indices indices;
  EXPECT_EQ(search.boxSearch({1, 0, 0}, {2, 0, 0}, indices), 2);
  EXPECT_THAT(indices, ElementsAre(1, 2));
  EXPECT_EQ(search.boxSearch({2, 0, 0}, {1, 0, 0}, indices), 0);
}

TEST(BoundingSphereSearch, SaysWhatIsWrong)
{
  BoundingSphereSearch<Point> search;
  pcl::Indices indices;
  std::vector<float> squared;
  const auto refused = [](const char* text) { return ThrowsMessage<std::invalid_argument>(HasSubstr(text)); };
  EXPECT_THAT([&] { search.nearestKSearch(Point(), 1, indices, squared); }, refused("input cloud is missing"));
  EXPECT_THAT([&] { search.setInputCloud(nullptr); }, refused("input cloud is null"));
  const auto cloud = cloudOf({{0, 0, 0}});
  EXPECT_THAT([&] { search.setInputCloud(cloud, pcl::IndicesPtr(new pcl::Indices{1})); },
              refused("index 1 is outside"));
  search.setInputCloud(cloud);
  EXPECT_THAT([&] { search.radiusSearch(Point(0, 0, 0), -1.0, indices, squared); }, refused("radius: -1"));
  EXPECT_THAT([&] { search.nearestKSearch(Point(0, 0, 0), -1, indices, squared); }, refused("k: -1"));
}

/// setInputCloud() returns void up to PCL 1.13 and bool from 1.14 on: ours follows.
TEST(BoundingSphereSearch, SignatureFollowsTheBase)
{
  using Ours = BoundingSphereSearch<Point>;
  using Theirs = pcl::search::KdTree<Point>;
  static_assert(std::is_same_v<decltype(std::declval<Ours&>().setInputCloud(Cloud::ConstPtr())),
                               decltype(std::declval<Theirs&>().setInputCloud(Cloud::ConstPtr()))>);
  const std::shared_ptr<Theirs> as_tree = std::make_shared<Ours>();
  EXPECT_EQ(as_tree->getName(), "BoundingSphereSearch");
  EXPECT_TRUE(as_tree->getSortedResults());
}

TEST(BoundingSphereSearch, KnowsItsThreads)
{
  BoundingSphereSearch<Point> search;
  EXPECT_EQ(search.getNumberOfThreads(), 0u);
  search.setNumberOfThreads(3);
  EXPECT_EQ(search.getNumberOfThreads(), 3u);
  search.setNumberOfThreads();
  EXPECT_EQ(search.getNumberOfThreads(), 0u);
}

} // namespace
} // namespace pcl_bsh::search
