// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a site, one after the other, on one process or dealt to all ranks of an MPI job. DIY is the engine: a block
// is a tile.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/ask_site.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

PCL_BSH_EXPORT_BEGIN // for programs that gather answers of their own
namespace pcl_bsh::site {

double leastOfAllRanks(double value);
std::uint64_t sumOfAllRanks(std::uint64_t value);

/// The bytes of all ranks, one after the other, on all of them.
std::string gatheredFromAllRanks(const std::string& bytes);

/// The structures of all ranks, one after the other, on all of them. Structures must be trivially copyable.
template <typename Structure>
std::vector<Structure> gatheredFromAllRanks(const std::vector<Structure>& own)
{
  static_assert(std::is_trivially_copyable_v<Structure>);
  std::string bytes(own.size() * sizeof(Structure), '\0');
  if (!own.empty()) std::memcpy(bytes.data(), own.data(), bytes.size());
  bytes = gatheredFromAllRanks(bytes);
  std::vector<Structure> all(bytes.size() / sizeof(Structure));
  if (!all.empty()) std::memcpy(static_cast<void*>(all.data()), bytes.data(), bytes.size());
  return all;
}

/// Lets all ranks fail where one has. To be called by all of them.
/// @param failure of this rank, or null. @throws it; where another rank has one, std::runtime_error
void throwOfAnyRank(const std::exception_ptr& failure);

class TileVisitor {
public:
  /// @param memory bytes for the points of a tile and their hierarchy
  /// @throws std::invalid_argument when the largest tile needs more
  TileVisitor(const Site& site, std::uint64_t memory);

  /// Returns the bytes that the points of the largest tile and their hierarchy need.
  std::uint64_t bytesForLargest() const noexcept { return bytes_for_largest_; }

  using Use = std::function<void(const Tile&, const pcl::PCLPointCloud2&)>;

  /// Calls `use` with each of these tiles, on one of the ranks: each takes the next tile, or run of so many, when it
  /// has done one. To be called by all ranks with the same list.
  /// @param still whether a tile is still needed, asked just before it is read; null: all are
  /// @throws what reading or `use` throws; where another rank has failed, std::runtime_error
  void visitAll(const std::vector<std::uint32_t>& tiles, const Use& use, std::size_t run = 1,
                const std::function<bool(std::uint32_t)>& still = nullptr);

  /// Calls `use` with the first of these tiles, dealt to the ranks in turn.
  /// @param go_on asked by all ranks whenever each has had a tile more, with the number of tiles visited by all: false
  ///   ends the visit on all ranks, so it must be the same on all
  void visitInTurn(const std::vector<std::uint32_t>& tiles, const Use& use,
                   const std::function<bool(std::size_t)>& go_on);

  /// The number in the list of the tile that `use` is called with.
  std::uint64_t place() const noexcept { return place_; }

  /// The cost of each tile that this rank has visited.
  const std::vector<TileCost>& costs() const noexcept { return costs_; }

  /// Tiles that this rank has read.
  std::uint64_t read() const noexcept { return read_; }

private:
  /// @return what reading or `use` has thrown; null: nothing
  std::exception_ptr visit(std::uint32_t tile, std::uint32_t place, const Use& use);

  const Site& site_;
  std::uint64_t bytes_for_largest_ = 0;
  std::uint64_t read_ = 0, place_ = 0;
  pcl::PCLPointCloud2 cloud_; ///< the tile that is visited; its memory is used for the next
  std::vector<TileCost> costs_;
};

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
