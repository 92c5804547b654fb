// SPDX-License-Identifier: BSD-3-Clause
// A voxel's bin while points are counted.

#if defined(PCL_BSH_HIERARCHY_BUILD_VOXEL_BINS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_VOXEL_BINS_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_VOXEL_BINS_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_VOXEL_BINS_INL_H_
#endif

#include <pcl_bsh/hierarchy/build/point_reader-inl.h>
#include <pcl_bsh/hierarchy/build/point_runs.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The points of one voxel in one chunk of the cloud. Aligned to cache lines.
template <class T>
struct alignas(64) Bin {
  std::uint64_t cell = 0;
  std::uint32_t count = 0;
  std::uint32_t words = 0;       ///< that the chunk's records are stored as
  std::uint32_t voxel = 0;       ///< its number, known after merging
  std::uint32_t first = 0;       ///< place in the voxel of this chunk's first point
  std::uint32_t* list = nullptr; ///< where the chunk's records go, if they are listed
  alignas(16) T low[4];
  alignas(16) T high[4];

  Bin()
  {
    std::fill(low, low + 4, std::numeric_limits<T>::infinity());
    std::fill(high, high + 4, -std::numeric_limits<T>::infinity());
  }

  void add(const GivenPoint<T>& p) { add(p, p, 1, 1); }

  /// `more` points between two corners, whose records are stored as so many words.
  void add(const GivenPoint<T>& lowest, const GivenPoint<T>& highest, std::uint32_t more, std::uint32_t more_words)
  {
    count += more;
    words += more_words;
    min(GivenPoint<T>::load(low), lowest).store(low);
    max(GivenPoint<T>::load(high), highest).store(high);
  }
};

/// Finds or adds the bin of a cell: open addressing. A table is doubled when half of it is in use. A small one is
/// doubled when a sixteenth is: so points in random order hardly ever try a second slot, which no branch predictor
/// foresees.
template <class T>
class BinTable {
public:
  BinTable() : slots_(1024, kNoBin) {}

  std::uint32_t find(std::uint64_t cell)
  {
    for (std::size_t i = hash(cell);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kNoBin) return add(cell, i);
      if (bins[slots_[i]].cell == cell) return slots_[i];
    }
  }

  std::vector<Bin<T>> bins;

private:
  /// A hash of 32 bits, for there are fewer slots than 2^32.
  std::size_t hash(std::uint64_t cell) const { return (cell * 0x9e3779b97f4a7c15u >> 32) & (slots_.size() - 1); }

  std::uint32_t add(std::uint64_t cell, std::size_t slot)
  {
    const auto bin = static_cast<std::uint32_t>(bins.size());
    bins.emplace_back();
    bins.back().cell = cell;
    slots_[slot] = bin;
    if ((slots_.size() < kLargeTable ? 16 : 2) * bins.size() > slots_.size()) grow();
    return bin;
  }

  void grow()
  {
    slots_.assign(2 * slots_.size(), kNoBin);
    for (std::uint32_t bin = 0; bin < bins.size(); ++bin) {
      std::size_t i = hash(bins[bin].cell);
      while (slots_[i] != kNoBin) i = (i + 1) & (slots_.size() - 1);
      slots_[i] = bin;
    }
  }

  static constexpr std::size_t kLargeTable = 1 << 17;

  std::vector<std::uint32_t> slots_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
