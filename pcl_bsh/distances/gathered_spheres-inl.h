// SPDX-License-Identifier: BSD-3-Clause
// Spheres of b side by side, so that a leaf of a is compared with eight of them at once.

#if defined(PCL_BSH_DISTANCES_GATHERED_SPHERES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_GATHERED_SPHERES_INL_H_
#undef PCL_BSH_DISTANCES_GATHERED_SPHERES_INL_H_
#else
#define PCL_BSH_DISTANCES_GATHERED_SPHERES_INL_H_
#endif

#include <pcl_bsh/traversal/obstacle_sphere-inl.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A sphere of b, and a lower bound of the distances from a child of a visit to it.
struct NearSphere {
  ObstacleSphere sphere;
  float lower;
};

/// A leaf of b, and a lower bound of the distances from a leaf of a to it.
struct NearLeaf {
  std::uint32_t obstacle;
  LeafRange range;
  float lower;
};

/// The spheres of a list.
class GatheredSpheres {
public:
  static constexpr float kDone = std::numeric_limits<float>::infinity();

  /// Places of one obstacle, that follow each other; the first is a multiple of eight.
  struct Run {
    std::uint32_t obstacle, begin, end;

    std::uint32_t wholeVectors() const { return (end + kStep - 1) / kStep * kStep; }
  };

  void gather(const std::vector<NearSphere>& list)
  {
    runs_.clear();
    std::uint32_t at = 0;
    for (const NearSphere& near : list) {
      const ObstacleSphere& from = near.sphere;
      if (runs_.empty() || runs_.back().obstacle != from.obstacle) {
        if (!runs_.empty()) at = endRun();
        runs_.push_back({from.obstacle, at, at});
      }
      if (sphere_.size() < at + std::size_t{kStep}) makeRoom(2 * std::size_t{at} + kStep);
      x_[at] = from.node->x[from.lane];
      y_[at] = from.node->y[from.lane];
      z_[at] = from.node->z[from.lane];
      r_[at] = from.node->r[from.lane];
      sphere_[at] = from;
      lower_[at] = near.lower;
      runs_.back().end = ++at;
    }
    if (!runs_.empty()) endRun();
  }

  const std::vector<Run>& runs() const { return runs_; }
  const ObstacleSphere& sphere(std::uint32_t place) const { return sphere_[place]; }

  /// Eight, from a place on.
  SphereLanes lanes(std::uint32_t place, float stretch) const
  {
    return {&x_[place], &y_[place], &z_[place], &r_[place], stretch};
  }

  /// Lower bounds of the distances from the leaf, at first the list's; kDone where no sphere is, or it is done.
  float* lower() { return lower_.data(); }

  /// Places that have a lower bound.
  std::uint32_t end() const { return runs_.empty() ? 0 : runs_.back().wholeVectors(); }

  /// The place of the least lower bound, the first of several. @pre there are spheres
  std::uint32_t nearest() const
  {
    const LaneTag d;
    const hn::RebindToSigned<LaneTag> di;
    LaneVector least = hn::Set(d, kDone);
    auto here = hn::Iota(di, 0), place = here;
    for (std::uint32_t i = 0; i < end(); i += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const LaneVector bound = hn::LoadU(d, &lower_[i]);
      const auto nearer = hn::Lt(bound, least);
      place = hn::IfThenElse(hn::RebindMask(di, nearer), here, place);
      least = hn::IfThenElse(nearer, bound, least);
      here = hn::Add(here, hn::Set(di, static_cast<std::int32_t>(hn::Lanes(d))));
    }
    const auto is_least = hn::RebindMask(di, hn::Eq(least, hn::MinOfLanes(d, least)));
    const auto most = hn::Set(di, std::numeric_limits<std::int32_t>::max());
    return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(di, hn::IfThenElse(is_least, place, most))));
  }

  std::size_t bytes() const noexcept
  {
    return runs_.capacity() * sizeof(Run) + 5 * x_.capacity() * sizeof(float) +
           sphere_.capacity() * sizeof(ObstacleSphere);
  }

private:
  static constexpr std::uint32_t kStep = kLanes;

  /// @return where the next one begins
  std::uint32_t endRun()
  {
    const Run& run = runs_.back();
    std::fill(lower_.begin() + run.end, lower_.begin() + run.wholeVectors(), kDone);
    return run.wholeVectors();
  }

  void makeRoom(std::size_t places)
  {
    for (std::vector<float>* const values : {&x_, &y_, &z_, &r_, &lower_}) values->resize(places);
    sphere_.resize(places);
  }

  std::vector<Run> runs_;
  std::vector<float> x_, y_, z_, r_, lower_;
  std::vector<ObstacleSphere> sphere_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
