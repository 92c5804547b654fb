// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/bounding_sphere_search.h>

#include "../filters/clouds.h"
#include "contents.h"
#include "support/every_allocation.h"

#include <pcl/point_types.h>

#include <tuple>

namespace pcl_bsh::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Search = search::BoundingSphereSearch<pcl::PointXYZ>;

const Cloud::Ptr& cloud()
{
  static const Cloud::Ptr made = [] {
    Cloud::Ptr points = typedCloud<pcl::PointXYZ>(randomPoints(400, 1));
    for (std::size_t i = 0; i < 60; ++i) (*points)[i] = (*points)[0]; // equal distances
    return points;
  }();
  return made;
}
const Cloud::Ptr& queries()
{
  static const Cloud::Ptr made = typedCloud<pcl::PointXYZ>(randomPoints(300, 2));
  return made;
}
const Cloud::Ptr& otherCloud()
{
  static const Cloud::Ptr made = typedCloud<pcl::PointXYZ>(randomPoints(200, 3));
  return made;
}

const pcl::PointXYZ& place()
{
  return (*queries())[20];
}

std::unique_ptr<Search> fresh(const Cloud::Ptr& input, unsigned threads = 1)
{
  auto search = std::make_unique<Search>();
  search->setNumberOfThreads(threads);
  if (input) search->setInputCloud(input);
  return search;
}

class SearchAllocationFailure : public testing::Test {
protected:
  SearchAllocationFailure() : before_(contentsOf(*cloud())), queries_before_(contentsOf(*queries())) {}
  ~SearchAllocationFailure() override
  {
    EXPECT_TRUE(contentsOf(*cloud()) == before_);
    EXPECT_TRUE(contentsOf(*queries()) == queries_before_);
  }

  template <typename Make, typename Ask>
  static void failEach(const Make& make, const Ask& ask)
  {
    EXPECT_GT(failEachAllocation(make, ask), 0u) << "nothing was tried";
  }

  decltype(contentsOf(Cloud())) before_, queries_before_;
};

TEST_F(SearchAllocationFailure, OfOneQuery)
{
  const auto make = [] { return fresh(cloud()); };
  for (const bool sorted : {true, false})
    for (const unsigned most : {0u, 5u})
      failEach(make, [&](const auto& search) {
        search->setSortedResults(sorted);
        pcl::Indices within{1, 2};
        std::vector<float> squares{3};
        const int count = search->radiusSearch(place(), 0.4, within, squares, most);
        return std::tuple(count, within, bitsOf(squares));
      });
  for (const int k : {1, 12, 1000})
    failEach(make, [&](const auto& search) {
      pcl::Indices nearest;
      std::vector<float> squares;
      const int count = search->nearestKSearch(place(), k, nearest, squares);
      return std::tuple(count, nearest, bitsOf(squares));
    });
  failEach(make, [](const auto& search) {
    pcl::Indices box;
    const int count = search->boxSearch({-0.3f, -0.3f, -0.5f}, {0.3f, 0.2f, 0.5f}, box);
    return std::tuple(count, box, search->anyInRadius(place(), 0.3));
  });
}

/// Through pcl::search::Search, as PCL's algorithms ask: by number, and of points of another type.
TEST_F(SearchAllocationFailure, OfPclsOverloads)
{
  failEach([] { return fresh(cloud()); },
           [](const auto& search) {
             const pcl::search::Search<pcl::PointXYZ>& base = *search;
             pcl::Indices nearest, within, by_number;
             std::vector<float> squares, squares_within;
             pcl::PointXYZI other;
             other.x = 0.1f, other.y = 0.2f, other.z = 0.3f;
             base.nearestKSearch(80, 4, nearest, squares);
             base.radiusSearchT(other, 0.3, within, squares_within);
             base.radiusSearch(*queries(), 3, 0.3, by_number, squares_within);
             return std::tuple(nearest, within, by_number, bitsOf(squares), bitsOf(squares_within));
           });
}

TEST_F(SearchAllocationFailure, OfBatchesInThreads)
{
  const pcl::Indices some{5, 200, 7, 7};
  for (const unsigned threads : {1u, 2u})
    for (const pcl::Indices& which : {pcl::Indices(), some})
      failEach([threads] { return fresh(cloud(), threads); },
               [&](const auto& search) {
                 std::vector<pcl::Indices> within(2), nearest;
                 std::vector<std::vector<float>> squares, nearest_squares;
                 search->radiusSearch(*queries(), which, 0.2, within, squares);
                 search->nearestKSearch(*queries(), which, 10, nearest, nearest_squares);
                 return std::tuple(within, squares, nearest, nearest_squares);
               });
  failEach(
      [] { return fresh(cloud()); },
      [](const auto& search) { return search->anyInBalls(*queries(), std::vector<float>(queries()->size(), 0.05f)); });
}

/// Until the new input is ready the former one answers, or no search is possible.
TEST_F(SearchAllocationFailure, OfInputs)
{
  const auto indices = std::make_shared<pcl::Indices>();
  for (int i = 399; i > 100; i -= 2) indices->push_back(i);
  const auto nearest = [](const Search& search) {
    pcl::Indices found;
    std::vector<float> squares;
    search.nearestKSearch(place(), 30, found, squares);
    return found;
  };
  const pcl::Indices of_former = nearest(*fresh(otherCloud()));
  for (const unsigned threads : {1u, 2u})
    for (const Cloud::Ptr& former : {Cloud::Ptr(), otherCloud()}) {
      const auto expected = fresh(nullptr);
      expected->setInputCloud(cloud(), indices);
      const pcl::Indices of_new = nearest(*expected);
      ASSERT_NE(of_new, of_former);
      for (const Shortage shortage : {Shortage::once, Shortage::lasting})
        for (std::size_t k = 1;; k = nextFailure(k, shortage)) {
          releaseRetainedMemory();
          const auto search = fresh(former, threads);
          bool thrown = false, failed = false;
          {
            const FailingAllocation failing(k, shortage);
            try {
              search->setInputCloud(cloud(), indices);
            }
            catch (const std::bad_alloc&) {
              thrown = true;
            }
            failed = failing.hasHappened();
          }
          if (thrown) {
            ASSERT_EQ(search->getInputCloud(), former) << k;
            ASSERT_EQ(search->getIndices(), nullptr) << k;
            if (former)
              ASSERT_EQ(nearest(*search), of_former) << k;
            else
              ASSERT_THROW(nearest(*search), std::invalid_argument) << k;
            search->setInputCloud(cloud(), indices);
          }
          ASSERT_EQ(search->getInputCloud(), cloud());
          ASSERT_EQ(nearest(*search), of_new) << k;
          if (!failed) {
            EXPECT_FALSE(thrown);
            break;
          }
        }
    }
}

TEST_F(SearchAllocationFailure, LeaksNothing)
{
  EXPECT_EQ(leakedBy([] {
              for (std::size_t k = 1;; k = nextFailure(k, Shortage::once)) {
                const FailingAllocation failing(k);
                try {
                  const auto search = fresh(cloud());
                  pcl::Indices nearest;
                  std::vector<float> squares;
                  search->nearestKSearch(place(), 5, nearest, squares);
                }
                catch (const std::bad_alloc&) {
                  continue;
                }
                if (!failing.hasHappened()) break;
              }
            }),
            0);
}

} // namespace
} // namespace pcl_bsh::test
