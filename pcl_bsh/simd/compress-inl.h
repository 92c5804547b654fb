// SPDX-License-Identifier: BSD-3-Clause
// Moves the lanes of a vector whose bit is set to the front and stores them, without a branch.

#if defined(PCL_BSH_SIMD_COMPRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_COMPRESS_INL_H_
#undef PCL_BSH_SIMD_COMPRESS_INL_H_
#else
#define PCL_BSH_SIMD_COMPRESS_INL_H_
#endif

#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <array>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// [bits]: the numbers of the bits set, in ascending order; then zeros. (Highway's own CompressStore copies its table
/// to the stack in every call.)
using SetBits = std::array<std::array<std::uint8_t, kLanes>, 1u << kLanes>;

constexpr SetBits setBits()
{
  SetBits table{};
  for (std::size_t bits = 0; bits < table.size(); ++bits)
    for (std::size_t bit = 0, place = 0; bit < kLanes; ++bit)
      if ((bits >> bit & 1) != 0) table[bits][place++] = static_cast<std::uint8_t>(bit);
  return table;
}

alignas(64) inline constexpr SetBits kSetBits = setBits();

/// Moves to the front the lanes whose bit is set. Whole vectors are stored: there must be room.
class Compress {
public:
  HWY_INLINE explicit Compress(std::uint32_t bits)
  : numbers_(hn::PromoteTo(Unsigned(), hn::Load(Bytes(), kSetBits[bits].data()))),
    from_(hn::IndicesFromVec(LaneTag(), numbers_))
  {
  }

  HWY_INLINE void store(LaneVector values, float* to) const
  {
    hn::StoreU(hn::TableLookupLanes(values, from_), LaneTag(), to);
  }
  HWY_INLINE void store(const std::uint32_t* values, std::uint32_t* to) const
  {
    const LaneVector lanes = hn::BitCast(LaneTag(), hn::LoadU(Unsigned(), values));
    hn::StoreU(hn::BitCast(Unsigned(), hn::TableLookupLanes(lanes, from_)), Unsigned(), to);
  }

  /// Stores `first` plus the number of each of these lanes.
  HWY_INLINE void storeNumbers(std::uint32_t first, std::uint32_t* to) const
  {
    hn::StoreU(hn::Add(hn::Set(Unsigned(), first), numbers_), Unsigned(), to);
  }

private:
  using Unsigned = hn::RebindToUnsigned<LaneTag>;
  using Bytes = hn::Rebind<std::uint8_t, LaneTag>;

  hn::Vec<Unsigned> numbers_;
  decltype(hn::IndicesFromVec(LaneTag(), hn::Zero(Unsigned()))) from_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
