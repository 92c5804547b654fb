// SPDX-License-Identifier: BSD-3-Clause
#include "peer.h"

#include "../workload/points_adaptor.h"

#include <cmath>
#include <limits>

namespace pcl_bsh::bench {
namespace {

/// Refuses to go on after the first point; nanoflann compares with <, so the bound is one float above d * d.
class FirstHit {
public:
  using DistanceType = float; // as nanoflann 1.5 and later asks
  void sort() {}

  explicit FirstHit(float d) : bound_(std::nextafter(d * d, std::numeric_limits<float>::infinity())) {}

  bool addPoint(float, std::uint32_t)
  {
    found_ = true;
    return false;
  }
  float worstDist() const { return bound_; }
  bool full() const { return found_; }
  bool found() const { return found_; }

private:
  float bound_;
  bool found_ = false;
};

class NanoflannTree : public ExistencePeer {
public:
  void build(const Points& points, float) override
  {
    release();
    adaptor_ = std::make_unique<PointsAdaptor>(PointsAdaptor{points});
    tree_ = std::make_unique<NanoflannIndex<float>>(3, *adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  }

  void release() override { tree_.reset(); }

  void flag(const Points& queries, std::size_t begin, std::size_t end, float d, std::uint8_t* out) const override
  {
    for (std::size_t i = begin; i < end; ++i) out[i] = near(queries[i], d);
  }

  bool any(const Point* queries, std::size_t count, float d) const override
  {
    for (std::size_t i = 0; i < count; ++i)
      if (near(queries[i], d)) return true;
    return false;
  }

private:
  bool near(const Point& query, float d) const
  {
    FirstHit hit(d);
    tree_->findNeighbors(hit, &query.x, {});
    return hit.found();
  }

  std::unique_ptr<PointsAdaptor> adaptor_;
  std::unique_ptr<NanoflannIndex<float>> tree_;
};

} // namespace

std::unique_ptr<ExistencePeer> makeNanoflannTree()
{
  return std::make_unique<NanoflannTree>();
}

} // namespace pcl_bsh::bench
