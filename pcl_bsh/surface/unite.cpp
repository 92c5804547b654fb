// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/unite.h>

#include <pcl_bsh/surface/piece_ball.h>

#include <boost/container_hash/hash.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace pcl_bsh::surface {

namespace {

constexpr std::size_t kPartners = 8; ///< of a patch, the nearest, are tried

using GridCube = std::array<std::int64_t, 3>;

/// In rooms: no patch has more leeway. Beyond what leewayOf() adds, for rounding.
constexpr double kMostLeeway = 1.00001;

/// How far another centre may be for one ball of radius `room` to hold this, too. From any place, the farthest point of
/// a set is at least as far as its smallest ball's radius and the place's distance from that ball's centre have it by
/// Pythagoras; so centres of sets that one ball holds are no farther apart than both leeways together.
double leewayOf(const Patch& patch, double room)
{
  return std::sqrt(std::max(0.0, room * room - patch.least * patch.least)) + 1e-6 * room;
}

/// A patch where it can be seen from its neighbours, without going to its pieces.
struct Entry {
  Vector3d middle;
  double leeway;
  std::size_t patch;
};

/// The patches in each cube, two rooms wide: those that one ball may hold lie in the same or in neighbouring cubes.
class Grid {
public:
  explicit Grid(double room) : room_(room), edge_(2.1 * room) {}

  void add(const Patch& patch, std::size_t i)
  {
    entries_[cubeOf(patch)].push_back({patch.middle, leewayOf(patch, room_), i});
  }
  void remove(const Patch& patch, std::size_t i)
  {
    std::erase_if(entries_[cubeOf(patch)], [i](const Entry& entry) { return entry.patch == i; });
  }

  /// Calls visit(squared distance, patch) for those that may take in a patch.
  template <class Visit>
  void forEachNear(const Patch& patch, const Visit& visit) const
  {
    const GridCube middle = cubeOf(patch);
    const double leeway = leewayOf(patch, room_);
    const double farthest =
        leeway + kMostLeeway * room_; // most cubes are farther away: what is in them is not looked up
    for (std::int64_t k = 0; k < 27; ++k) {
      const GridCube cube = {middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1};
      if (squaredDistance(cube, patch.middle) > farthest * farthest) continue;
      const auto found = entries_.find(cube);
      if (found == entries_.end()) continue;
      for (const Entry& entry : found->second) {
        const double squared = (entry.middle - patch.middle).squaredNorm(), most = leeway + entry.leeway;
        if (squared <= most * most) visit(squared, entry.patch);
      }
    }
  }

private:
  GridCube cubeOf(const Patch& patch) const
  {
    GridCube cube;
    for (std::size_t k = 0; k < 3; ++k)
      cube[k] = static_cast<std::int64_t>(std::floor(patch.middle[static_cast<Eigen::Index>(k)] / edge_));
    return cube;
  }

  double squaredDistance(const GridCube& cube, const Vector3d& p) const
  {
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = edge_ * static_cast<double>(cube[k]), at = p[static_cast<Eigen::Index>(k)];
      const double beside = std::max({low - at, at - low - edge_, 0.0});
      squared += beside * beside;
    }
    return squared;
  }

  double room_, edge_;
  std::unordered_map<GridCube, std::vector<Entry>, boost::hash<GridCube>> entries_;
};

class Union {
public:
  Union(const Mesh& mesh, const std::vector<Vector3d>& corners, std::vector<Patch>& patches)
  : room_(mesh.room),
    corners_(corners),
    patches_(patches),
    grid_(mesh.room)
  {
  }

  void operator()()
  {
    // Smallest first; what grew is asked again in its new place.
    using Next = std::pair<double, std::size_t>;
    std::priority_queue<Next, std::vector<Next>, std::greater<>> order;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      grid_.add(patches_[i], i);
      order.push({patches_[i].radius, i});
    }
    while (!order.empty()) {
      const auto [radius, i] = order.top();
      order.pop();
      if (patches_[i].pieces.empty() || patches_[i].radius != radius) continue;
      if (joinBestOf(i)) order.push({patches_[i].radius, i});
    }
    handOutPieces();
    std::erase_if(patches_, [](const Patch& patch) { return patch.pieces.empty(); });
  }

private:
  struct Partner {
    double measure;
    std::size_t patch;
    friend bool operator<(const Partner& a, const Partner& b)
    {
      return std::tie(a.measure, a.patch) < std::tie(b.measure, b.patch);
    }
  };

  /// The nearest patches that may take in another, which is not one of them.
  std::vector<Partner> partnersOf(std::size_t i, const Patch& taken) const
  {
    std::vector<Partner> near;
    grid_.forEachNear(taken, [&](double squared, std::size_t j) {
      if (j != i) near.push_back({squared, j});
    });
    const auto tried = static_cast<std::ptrdiff_t>(std::min(kPartners, near.size()));
    std::partial_sort(near.begin(), near.begin() + tried, near.end());
    near.resize(static_cast<std::size_t>(tried));
    return near;
  }

  Patch united(Patch patch, const std::vector<Piece>& pieces) const
  {
    patch.pieces.insert(patch.pieces.end(), pieces.begin(), pieces.end());
    fitBall(corners_, patch);
    return patch;
  }

  /// Whether no ball in the room holds both, told by the corner of one that is farthest from the middle of the other. A
  /// centre that is t nearer to that corner than the middle is, at most, has by Pythagoras (see leewayOf()) a point of
  /// the other at least as far as the root of least^2 + t^2, and the corner at d - t: together never below
  /// (d^2 + least^2) / 2d.
  bool isTooFar(const Patch& patch, const Patch& from) const
  {
    double squared = 0.0;
    for (const Piece& piece : patch.pieces) {
      for (std::size_t k = piece.first; k < piece.first + piece.count; ++k)
        squared = std::max(squared, (corners_[k] - from.middle).squaredNorm());
    }
    const double least = from.least * from.least;
    return squared > least && squared + least > 2.000002 * room_ * std::sqrt(squared);
  }

  /// Takes in the partner that leaves the least room; the partner is then empty.
  bool joinBestOf(std::size_t i)
  {
    Patch best;
    std::size_t partner = i;
    for (const Partner& near : partnersOf(i, patches_[i])) {
      if (isTooFar(patches_[near.patch], patches_[i]) || isTooFar(patches_[i], patches_[near.patch])) continue;
      Patch both = united(patches_[i], patches_[near.patch].pieces);
      if (both.radius > room_ || (partner != i && both.radius <= best.radius)) continue;
      best = std::move(both);
      partner = near.patch;
    }
    if (partner == i) return false;
    grid_.remove(patches_[partner], partner);
    patches_[partner].pieces.clear();
    replace(i, std::move(best));
    return true;
  }

  void replace(std::size_t i, Patch patch)
  {
    grid_.remove(patches_[i], i);
    patches_[i] = std::move(patch);
    grid_.add(patches_[i], i);
  }

  /// A patch that no other can take in as a whole may be needed by none: its pieces go to several.
  void handOutPieces()
  {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < patches_.size(); ++i)
      if (!patches_[i].pieces.empty() && patches_[i].pieces.size() <= kMostHandedOut) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return std::tie(patches_[i].radius, i) < std::tie(patches_[j].radius, j);
    });
    for (const std::size_t i : order) handOut(i);
  }

  void handOut(std::size_t i)
  {
    std::vector<std::pair<std::size_t, Patch>> grown;
    for (const Piece& piece : patches_[i].pieces) {
      Patch alone;
      alone.pieces = {piece};
      fitBall(corners_, alone);
      bool taken = false;
      for (const Partner& partner : partnersOf(i, alone)) {
        const auto known =
            std::find_if(grown.begin(), grown.end(), [&](const auto& entry) { return entry.first == partner.patch; });
        Patch both = united(known != grown.end() ? known->second : patches_[partner.patch], {piece});
        if (both.radius > room_) continue;
        if (known != grown.end())
          known->second = std::move(both);
        else
          grown.emplace_back(partner.patch, std::move(both));
        taken = true;
        break;
      }
      if (!taken) return;
    }
    grid_.remove(patches_[i], i);
    patches_[i].pieces.clear();
    for (auto& [j, patch] : grown) replace(j, std::move(patch));
  }

  static constexpr std::size_t kMostHandedOut = 64;

  double room_;
  const std::vector<Vector3d>& corners_;
  std::vector<Patch>& patches_;
  Grid grid_;
};

} // namespace

void unite(const Mesh& mesh, const std::vector<Vector3d>& corners, std::vector<Patch>& patches)
{
  Union(mesh, corners, patches)();
}

} // namespace pcl_bsh::surface
