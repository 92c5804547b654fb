// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/making/tile_partition.h>
#include <pcl_bsh/site/site.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace pcl_bsh::site {

namespace {

class TilePartition {
public:
  TilePartition(const std::vector<CountedVoxel>& voxels, const std::vector<DividedVoxel>& above,
                std::uint64_t tile_points)
  : voxels_(voxels),
    above_(above),
    tile_points_(tile_points),
    order_(voxels.size()),
    tiles_(voxels.size()),
    seen_(above.size(), 0)
  {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) divide(order_.begin(), order_.end());
  }

  std::vector<std::uint32_t> tiles() && { return std::move(tiles_); }

private:
  using Numbers = std::vector<std::uint32_t>::iterator;

  void divide(Numbers begin, Numbers end)
  {
    const std::uint64_t most = mostIn(begin, end);
    if (end - begin == 1 || most <= tile_points_) {
      for (Numbers voxel = begin; voxel != end; ++voxel) tiles_[*voxel] = next_;
      ++next_;
      return;
    }
    const std::size_t axis = longestAxis(begin, end);
    std::sort(begin, end, [&](std::uint32_t i, std::uint32_t j) {
      return std::pair(voxels_[i].middle[axis], i) < std::pair(voxels_[j].middle[axis], j);
    });
    const Numbers middle = cut(begin, end, most);
    divide(begin, middle);
    divide(middle, end);
  }

  /// Returns the most points that a tile of these voxels may get.
  std::uint64_t mostIn(Numbers begin, Numbers end)
  {
    ++stamp_;
    std::uint64_t most = 0;
    for (Numbers voxel = begin; voxel != end; ++voxel) most += moreWith(*voxel);
    return most;
  }

  /// Returns the most points that one more voxel adds to it. Points of each divided voxel above are added once.
  std::uint64_t moreWith(std::uint32_t voxel)
  {
    std::uint64_t more = voxels_[voxel].points;
    for (std::uint32_t i = voxels_[voxel].above; i != DividedVoxel::none && seen_[i] != stamp_; i = above_[i].above) {
      seen_[i] = stamp_;
      more += above_[i].points;
    }
    return more;
  }

  /// Returns the longest axis of the box about the voxels that have points.
  std::size_t longestAxis(Numbers begin, Numbers end) const
  {
    std::optional<Bounds> box;
    for (Numbers voxel = begin; voxel != end; ++voxel)
      if (voxels_[*voxel].points > 0) extend(box, voxels_[*voxel].middle);
    if (!box) return 0;
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (box->high[k] - box->low[k] > box->high[longest] - box->low[longest]) longest = k;
    return longest;
  }

  /// Returns the end of the first of two parts. It is the place in the middle half where the parts need the fewest
  /// tiles and, of several, the fewest points may lie on either side.
  /// @param most points that all of them may have. @pre at least two voxels
  Numbers cut(Numbers begin, Numbers end, std::uint64_t most)
  {
    const auto count = static_cast<std::size_t>(end - begin);
    std::vector<std::uint64_t> after(count + 1, 0);
    std::uint64_t shared = 0;
    ++stamp_;
    for (std::size_t i = count; i > 0; --i) {
      const std::uint32_t voxel = begin[static_cast<std::ptrdiff_t>(i - 1)];
      after[i - 1] = after[i] + moreWith(voxel);
      shared = std::max(shared, voxels_[voxel].most_above);
    }
    const std::uint64_t room = std::max<std::uint64_t>(tile_points_ - std::min(shared, tile_points_ / 4 * 3), 1);
    const auto tilesFor = [&](std::uint64_t points) {
      return std::max<std::uint64_t>((points - std::min(points, shared) + room - 1) / room, 1);
    };
    std::size_t best = count / 2;
    using Cost = std::pair<std::uint64_t, std::uint64_t>;
    Cost least = {std::numeric_limits<std::uint64_t>::max(), 0};
    std::uint64_t before = 0;
    ++stamp_;
    for (std::size_t i = 1; i < count; ++i) {
      before += moreWith(begin[static_cast<std::ptrdiff_t>(i - 1)]);
      if (before < most / 4 || after[i] < most / 4) continue;
      const Cost cost = {tilesFor(before) + tilesFor(after[i]), before + after[i]};
      if (cost >= least) continue;
      least = cost;
      best = i;
    }
    return begin + static_cast<std::ptrdiff_t>(best);
  }

  const std::vector<CountedVoxel>& voxels_;
  const std::vector<DividedVoxel>& above_;
  const std::uint64_t tile_points_;
  std::vector<std::uint32_t> order_, tiles_;
  std::vector<std::uint32_t> seen_; ///< of each divided voxel, the `stamp_` of the last sum that has it
  std::uint32_t stamp_ = 0, next_ = 0;
};

} // namespace

std::vector<std::uint32_t> tilesOf(const std::vector<CountedVoxel>& voxels, const std::vector<DividedVoxel>& above,
                                   std::uint64_t tile_points)
{
  return TilePartition(voxels, above, tile_points).tiles();
}

} // namespace pcl_bsh::site
