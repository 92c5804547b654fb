// SPDX-License-Identifier: BSD-3-Clause
// The beams of one scan as points on a sphere of directions, under a hierarchy of bounding spheres, each with the least
// and the greatest range below it.
#pragma once

#include <pcl_bsh/seen/ball_view.h>
#include <pcl_bsh/seen/seen_space.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// A stored direction is off by less than this.
inline constexpr double kDirectionError = 0x1p-23;

struct Beam {
  float x, y, z; ///< a unit vector, up to kDirectionError
  float empty;   ///< rounded down
  std::uint32_t record;

  Eigen::Vector3d direction() const { return Eigen::Vector3f(x, y, z).cast<double>(); }
};

struct BeamNode {
  float x, y, z, r; ///< its beams, as stored, are in this sphere
  float least, greatest;

  Eigen::Vector3d center() const { return Eigen::Vector3f(x, y, z).cast<double>(); }
};

/// A beam of a scan. Its record numbers the returns first, then the misses.
struct BeamEnd {
  Eigen::Vector3d way; ///< from the origin; 0: it is no beam
  double empty;        ///< up to here
};
BeamEnd beamOf(const ScanBeams& scan, std::uint32_t record);

/// Calls visit(record, beam) for all beams of a scan.
template <class Visit>
void eachBeam(const ScanBeams& scan, const Visit& visit)
{
  const auto take = [&](std::uint32_t record) {
    const BeamEnd beam = beamOf(scan, record);
    if (beam.way != Eigen::Vector3d::Zero()) visit(record, beam);
  };
  for (std::size_t i = 0; i < scan.returns.size(); ++i) take(scan.returns.record(i));
  if (scan.misses_beyond == 0.0) return;
  const auto first = static_cast<std::uint32_t>(scan.returns.count);
  for (std::size_t i = 0; i < scan.misses.size(); ++i) take(first + scan.misses.record(i));
}

class BeamTree {
public:
  explicit BeamTree(const ScanBeams& scan);

  const ScanBeams& scan() const { return scan_; }
  const std::vector<Beam>& beams() const { return beams_; } ///< in Morton order of their directions

  /// Whether test(beam) is true of any beam below nodes for which enter(node) is.
  template <class Enter, class Test>
  bool any(const Enter& enter, const Test& test) const
  {
    return !nodes_.empty() && enter(nodes_.back()) && below(levels_.size() - 1, 0, enter, test);
  }

private:
  static constexpr std::size_t kLeaf = 16, kChildren = 8;

  template <class Enter, class Test>
  bool below(std::size_t level, std::size_t index, const Enter& enter, const Test& test) const
  {
    if (level == 0) {
      const std::size_t end = std::min(beams_.size(), (index + 1) * kLeaf);
      for (std::size_t i = index * kLeaf; i < end; ++i)
        if (test(beams_[i])) return true;
      return false;
    }
    const std::size_t first = levels_[level - 1], count = levels_[level] - first;
    const std::size_t end = std::min(count, (index + 1) * kChildren);
    for (std::size_t i = index * kChildren; i < end; ++i)
      if (enter(nodes_[first + i]) && below(level - 1, i, enter, test)) return true;
    return false;
  }

  void raise();

  ScanBeams scan_;
  std::vector<Beam> beams_;
  std::vector<BeamNode> nodes_;     ///< level by level, leaves first, the root last
  std::vector<std::size_t> levels_; ///< where each begins
};

/// Whether two spheres among directions are disjoint: one about a unit vector, one of a node.
inline bool areDisjoint(const Eigen::Vector3d& direction, double chord, const BeamNode& node)
{
  const double x = direction.x() - static_cast<double>(node.x), y = direction.y() - static_cast<double>(node.y),
               z = direction.z() - static_cast<double>(node.z), both = chord + static_cast<double>(node.r);
  return x * x + y * y + z * z > both * both * (1.0 + 0x1p-40);
}

/// Whether a stored direction is farther from a unit vector.
inline bool isBeyond(const Eigen::Vector3d& direction, double chord, const Beam& beam)
{
  return areDisjoint(direction, chord, {beam.x, beam.y, beam.z, 0.0f, 0.0f, 0.0f});
}

} // namespace pcl_bsh
