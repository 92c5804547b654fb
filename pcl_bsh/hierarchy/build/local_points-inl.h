// SPDX-License-Identifier: BSD-3-Clause
// A voxel's points, read from the cloud into the voxel's frame.

#if defined(PCL_BSH_HIERARCHY_BUILD_LOCAL_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_LOCAL_POINTS_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_LOCAL_POINTS_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_LOCAL_POINTS_INL_H_
#endif

#include <pcl_bsh/hierarchy/build/point_reader-inl.h>
#include <pcl_bsh/hierarchy/storage.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Gives points of a cloud the coordinates of a frame. All results are finite and within the frame's reach. So a cloud
/// that was changed unannounced makes answers wrong, but no other memory is touched.
template <class T>
class LocalPlace {
public:
  explicit LocalPlace(const LocalFrame& frame)
  : origin_(GivenPoint<T>::of(0)),
    reach_(Quad::of(0)),
    plain_(frame.unit == 1.0),
    inverse_(1.0 / frame.unit)
  {
    T origin[4] = {};
    float reach[4] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      origin[k] = static_cast<T>(frame.origin[k]);
      scaled_[k] = frame.origin[k] * inverse_;
      reach[k] = static_cast<float>(frame.reach[k]);
    }
    origin_ = GivenPoint<T>::load(origin);
    reach_ = Quad::load(reach);
  }

  Quad operator()(const GivenPoint<T>& p) const { return max(min(local(p), reach_), Quad::of(0) - reach_); }

  /// Whether a point's place is its difference from the origin in float, without a scale.
  bool isPlain() const { return std::is_same_v<T, float> && plain_; }

private:
  Quad local(const GivenPoint<T>& p) const
  {
    if constexpr (std::is_same_v<T, float>)
      if (plain_) return p - origin_;
    T given[4] = {};
    (plain_ ? p - origin_ : p).store(given);
    const float stored[4] = {this->stored(given[0], 0), this->stored(given[1], 1), this->stored(given[2], 2), 0.0f};
    return Quad::load(stored);
  }

  float stored(T value, std::size_t k) const
  {
    if (plain_) return roundToFloat(static_cast<double>(value));
    return roundToFloat(static_cast<double>(value) * inverse_ - scaled_[k]);
  }

  GivenPoint<T> origin_;
  Quad reach_;
  bool plain_;
  double inverse_;
  double scaled_[3];
};

inline void storePoint(const Quad& place, std::uint32_t record, PointRecord& out)
{
  place.store(reinterpret_cast<float*>(&out));
  out.record = record;
}

/// Reads points of a cloud in the coordinates of a frame.
template <class T>
class LocalReader {
public:
  LocalReader(const LocalFrame& frame, const PointsView& view) : read_(view), place_(frame) {}

  /// Reads a run of records. @return the place behind the last one
  PointRecord* operator()(const Run& run, PointRecord* out) const
  {
    const std::uint32_t end = run.number + run.points;
    std::uint32_t record = run.number;
    if (place_.isPlain()) {
      const LocalPlace<T> place = place_; // in registers
      for (const std::uint32_t whole = std::min(end, read_.whole()); record < whole; ++record, ++out)
        storePoint(place(read_.load(record)), record, *out);
    }
    for (; record < end; ++record, ++out) storePoint(place_(read_(record)), record, *out);
    return out;
  }

private:
  const Reader<T> read_;
  const LocalPlace<T> place_;
};

constexpr std::size_t kRunsAhead = kListPadding / 2; // each takes two words at most
constexpr std::size_t kMostAhead = 4096;             // bytes: the rest of a long run comes by itself

/// Calls visit(run) for the runs of records that a voxel lists, until it returns false.
template <class Visit>
void eachListedRun(const Voxel& voxel, const PointsView& view, const Visit& visit)
{
  const auto* const data = static_cast<const unsigned char*>(view.data) + view.offset[0];
  RunReader runs(voxel.list), ahead(voxel.list);
  for (std::size_t k = 0; k < kRunsAhead; ++k) ahead();
  for (std::uint32_t left = voxel.count; left != 0;) {
    // Runs are short, and far from each other: memory is asked for before its turn.
    const Run soon = ahead();
    const auto* const first = data + view.stride * soon.number;
    const std::size_t bytes = std::min(view.stride * soon.points, kMostAhead);
    for (std::size_t byte = 0; byte < bytes; byte += 64) __builtin_prefetch(first + byte);
    const Run run = runs();
    if (!visit(run)) return;
    left -= run.points;
  }
}

/// Reads the points that a voxel lists into its block.
template <class T>
void readPointsOf(const Voxel& voxel, const PointsView& view)
{
  const LocalReader<T> read(voxel.frame, view);
  auto* out = reinterpret_cast<PointRecord*>(voxel.block);
  eachListedRun(voxel, view, [&](const Run& run) {
    out = read(run, out);
    return true;
  });
}

inline void readPoints(const Voxel& voxel, const PointsView& view)
{
  view.scalar == Scalar::float32 ? readPointsOf<float>(voxel, view) : readPointsOf<double>(voxel, view);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
