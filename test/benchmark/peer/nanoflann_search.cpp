// SPDX-License-Identifier: BSD-3-Clause
#include "../workload/points_adaptor.h"
#include "peer.h"
#include "search_peer.h"
#include "support/radius_hits.h"

#include <cmath>
#include <limits>

namespace pcl_bsh::bench {
namespace {

using Tree = NanoflannIndex<float>;

/// nanoflann compares with <; one float above makes the radius inclusive.
float inclusive(float radius)
{
  return std::nextafter(radius * radius, std::numeric_limits<float>::infinity());
}

class NanoflannSearch : public SearchRacer {
public:
  void adopt(const Points& cloud) override
  {
    cloud_ = &cloud;
    existence_ = makeNanoflannTree();
  }

  void build() override
  {
    adaptor_ = std::make_unique<PointsAdaptor>(PointsAdaptor{*cloud_});
    tree_ = std::make_unique<Tree>(3, *adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  }

  void release() override { tree_.reset(); }

  std::optional<SearchAnswer> radius(const Points& queries, float radius, unsigned most) const override
  {
    SearchAnswer answer;
    if (most > 0) {
      // The k nearest with a bound from the start: as good as the library gets.
      std::vector<std::uint32_t> indices(most);
      std::vector<float> squared(most);
      for (const Point& q : queries) {
        nanoflann::KNNResultSet<float, std::uint32_t> set(most);
        set.init(indices.data(), squared.data());
        squared[most - 1] = inclusive(radius);
        tree_->findNeighbors(set, &q.x, {});
        answer.found += set.size();
        for (std::size_t i = 0; i < set.size(); ++i) *answer.squared_distances += static_cast<double>(squared[i]);
      }
      return answer;
    }
    test::RadiusHits<std::uint32_t, float> found;
    for (const Point& q : queries) {
      answer.found += tree_->radiusSearch(&q.x, inclusive(radius), found, {});
      for (const auto& hit : found) *answer.squared_distances += static_cast<double>(hit.second);
    }
    return answer;
  }

  std::optional<SearchAnswer> nearest(const Points& queries, unsigned k) const override
  {
    SearchAnswer answer;
    std::vector<std::uint32_t> indices(k);
    std::vector<float> squared(k);
    for (const Point& q : queries) {
      const std::size_t count = tree_->knnSearch(&q.x, k, indices.data(), squared.data());
      answer.found += count;
      for (std::size_t i = 0; i < count; ++i) *answer.squared_distances += static_cast<double>(squared[i]);
    }
    return answer;
  }

  std::optional<SearchAnswer> probes(const Points& centers, const std::vector<float>& radii) const override
  {
    if (!existence_built_) {
      existence_->build(*cloud_, 0.0f);
      existence_built_ = true;
    }
    SearchAnswer answer;
    for (std::size_t i = 0; i < centers.size(); ++i) answer.found += existence_->any(&centers[i], 1, radii[i]);
    return answer;
  }

private:
  const Points* cloud_ = nullptr;
  std::unique_ptr<PointsAdaptor> adaptor_;
  std::unique_ptr<Tree> tree_;
  std::unique_ptr<ExistencePeer> existence_;
  mutable bool existence_built_ = false;
};

} // namespace

std::unique_ptr<SearchRacer> makeNanoflannSearch()
{
  return std::make_unique<NanoflannSearch>();
}

} // namespace pcl_bsh::bench
