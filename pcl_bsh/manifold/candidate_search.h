// SPDX-License-Identifier: BSD-3-Clause
// Finds the best candidate of channels for one goal after another. Nodes that were opened for one goal are not opened
// again for the next.
#pragma once

#include <pcl_bsh/manifold/collider_parts.h>
#include <pcl_bsh/manifold/patch_goal.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh {

/// Records of two sides that may touch: points of the probe against records of the surface, or edges against
/// edges.
struct Channel {
  std::uint8_t number = 0; ///< 0: places of a against b, 1: places of b against a, 2: edges of a against edges of b
  Placed probe, surface;
  const std::vector<SharpEdge>*sharp_probe = nullptr, *sharp_surface = nullptr; ///< of channel 2
  std::vector<std::uint8_t> enclosed; ///< one per probe, not 0 where the other side holds it; empty: it holds none
  std::vector<Candidate> inside;      ///< candidates of the enclosed probes, without scores

  bool isOfEdges() const { return sharp_probe != nullptr; }
};

/// The nearest places of two edges, both within their edges. The unit normal points out of the surface, and reversed
/// out of the probe. crossingOf() returns nothing where edges are parallel, or nearest at an end of one.
struct EdgeCrossing {
  Eigen::Vector3d on_probe, on_surface, normal;
};
std::optional<EdgeCrossing> crossingOf(const Channel& channel, PointPair edges);

/// The place of a channel's probe, in the world.
inline Eigen::Vector3d probePlace(const Channel& channel, std::uint32_t record)
{
  const Point3 p = channel.probe.hierarchy().view().point(record);
  return channel.probe.pose * Eigen::Vector3d(p[0], p[1], p[2]);
}

/// An entry of a search's heap: a pair of nodes, or of records. It is defined here because the standard library's heaps
/// are not compiled for each instruction set.
struct SearchTurn {
  double bound;
  std::pair<std::size_t, bool> of; ///< its number, whether it is a record
  bool operator<(const SearchTurn& other) const { return bound < other.bound; }
};

/// Searches channels.
class CandidateSearch {
public:
  /// Sets `best` to the best candidate of the channels, if that is before `best`.
  virtual void seek(const PatchGoal& goal, Candidate& best, Work& work) = 0;

protected:
  ~CandidateSearch() = default;
};

inline constexpr std::size_t kMostChannels = 3; ///< of a manifold

/// Calls `choose` with a search of these channels, which is valid during this call. Expects the
/// DefaultFloatEnvironment.
/// @param most_gap that candidates have @param thickness taken from gaps
void searchCandidates(const std::vector<Channel>& channels, double most_gap, double thickness,
                      const std::function<void(CandidateSearch&)>& choose);

} // namespace pcl_bsh
