// SPDX-License-Identifier: BSD-3-Clause
// PCL's own search classes and ours, asked in the same words.
#include "search_peer.h"

#include <pcl_bsh/search/bounding_sphere_search.h>

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>

#include <numeric>

namespace pcl_bsh::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using KdTree = pcl::search::KdTree<pcl::PointXYZ>;
using Octree = pcl::search::Octree<pcl::PointXYZ>;
using Ours = search::BoundingSphereSearch<pcl::PointXYZ>;

Cloud::Ptr toPcl(const Points& points)
{
  auto cloud = std::make_shared<Cloud>();
  cloud->reserve(points.size());
  for (const Point& p : points) cloud->emplace_back(p.x, p.y, p.z);
  return cloud;
}

void count(SearchAnswer& answer, const std::vector<float>& squared)
{
  answer.found += squared.size();
  answer.squared_distances = std::accumulate(squared.begin(), squared.end(), answer.squared_distances.value_or(0.0));
}

template <typename Search>
class PclSearch : public SearchRacer {
public:
  void adopt(const Points& cloud) override { cloud_ = toPcl(cloud); }

  bool tune(float radius) override
  {
    resolution_ = radius;
    return std::is_same_v<Search, Octree>;
  }

  void build() override
  {
    search_ = make();
    search_->setInputCloud(cloud_);
  }

  void release() override { search_.reset(); }

  std::optional<SearchAnswer> radius(const Points& queries, float radius, unsigned most) const override
  {
    SearchAnswer answer;
    pcl::Indices indices;
    std::vector<float> squared;
    for (const Point& q : queries) {
      search_->radiusSearch(pcl::PointXYZ(q.x, q.y, q.z), radius, indices, squared, most);
      count(answer, squared);
    }
    if (std::is_same_v<Search, Octree> && most > 0) answer.squared_distances.reset(); // those of the first points found
    return answer;
  }

  std::optional<SearchAnswer> nearest(const Points& queries, unsigned k) const override
  {
    SearchAnswer answer;
    pcl::Indices indices;
    std::vector<float> squared;
    for (const Point& q : queries) {
      search_->nearestKSearch(pcl::PointXYZ(q.x, q.y, q.z), static_cast<int>(k), indices, squared);
      count(answer, squared);
    }
    return answer;
  }

  std::optional<SearchAnswer> probes(const Points& centers, const std::vector<float>& radii) const override
  {
    SearchAnswer answer;
    pcl::Indices indices;
    std::vector<float> squared;
    for (std::size_t i = 0; i < centers.size(); ++i) {
      const pcl::PointXYZ center(centers[i].x, centers[i].y, centers[i].z);
      if constexpr (std::is_same_v<Search, Ours>)
        answer.found += search_->anyInRadius(center, radii[i]);
      else
        answer.found += search_->radiusSearch(center, radii[i], indices, squared, 1) > 0;
    }
    return answer;
  }

protected:
  std::unique_ptr<Search> make() const
  {
    if constexpr (std::is_same_v<Search, Octree>) {
      return std::make_unique<Search>(resolution_);
    }
    else {
      auto search = std::make_unique<Search>();
      if constexpr (std::is_same_v<Search, Ours>) search->setNumberOfThreads(1);
      return search;
    }
  }

  float resolution_ = 1.0f;
  Cloud::Ptr cloud_;
  std::unique_ptr<Search> search_;
};

class SphereBatch : public PclSearch<Ours> {
public:
  explicit SphereBatch(unsigned threads) : threads_(threads) {}

  void build() override
  {
    PclSearch<Ours>::build();
    search_->setNumberOfThreads(threads_);
  }

  std::optional<SearchAnswer> radius(const Points& queries, float radius, unsigned most) const override
  {
    search_->radiusSearch(asPcl(queries), {}, radius, indices_, squared_, most);
    return SearchAnswer{};
  }

  std::optional<SearchAnswer> nearest(const Points& queries, unsigned k) const override
  {
    search_->nearestKSearch(asPcl(queries), {}, static_cast<int>(k), indices_, squared_);
    return SearchAnswer{};
  }

  std::optional<SearchAnswer> probes(const Points& centers, const std::vector<float>& radii) const override
  {
    const std::vector<std::uint8_t> flags = search_->anyInBalls(asPcl(centers), radii);
    squared_.clear();
    return SearchAnswer{std::accumulate(flags.begin(), flags.end(), std::uint64_t{0}), 0.0};
  }

  SearchAnswer completed(SearchAnswer answer) const override
  {
    for (const auto& one : squared_) count(answer, one);
    return answer;
  }

private:
  /// Callers of batches have their queries as a cloud.
  const Cloud& asPcl(const Points& queries) const
  {
    if (!queries_ || queries_of_ != queries.data()) queries_ = toPcl(queries);
    queries_of_ = queries.data();
    return *queries_;
  }

  unsigned threads_;
  mutable Cloud::ConstPtr queries_;
  mutable const Point* queries_of_ = nullptr;
  mutable std::vector<pcl::Indices> indices_; // kept from batch to batch, as a pipeline's are
  mutable std::vector<std::vector<float>> squared_;
};

} // namespace

std::unique_ptr<SearchRacer> makeSphereSearch()
{
  return std::make_unique<PclSearch<Ours>>();
}
std::unique_ptr<SearchRacer> makeSphereBatch(unsigned threads)
{
  return std::make_unique<SphereBatch>(threads);
}
std::unique_ptr<SearchRacer> makePclKdTreeSearch()
{
  return std::make_unique<PclSearch<KdTree>>();
}
std::unique_ptr<SearchRacer> makePclOctreeSearch()
{
  return std::make_unique<PclSearch<Octree>>();
}

} // namespace pcl_bsh::bench
