// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/unite.h>

#include <pcl_bsh/surface/piece_ball.h>

#include <boost/container_hash/hash.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>

namespace pcl_bsh::surface {

namespace {

constexpr std::size_t kPartners = 8; ///< of a patch, the nearest, are tried

using Cube = std::array<std::int64_t, 3>;

/// The patches whose centres lie in each cube, two rooms wide: centres of patches that one ball holds lie in the same
/// or in neighbouring cubes.
class Grid {
public:
  explicit Grid(double room) : edge_(2 * room) {}

  void add(const Patch& patch, std::size_t i) { patches_[cubeOf(patch)].push_back(i); }
  void remove(const Patch& patch, std::size_t i) { std::erase(patches_[cubeOf(patch)], i); }

  template <class Visit>
  void forEachNear(const Patch& patch, const Visit& visit) const
  {
    const Cube middle = cubeOf(patch);
    for (std::int64_t k = 0; k < 27; ++k) {
      const auto found = patches_.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
      if (found == patches_.end()) continue;
      for (const std::size_t i : found->second) visit(i);
    }
  }

private:
  Cube cubeOf(const Patch& patch) const
  {
    Cube cube;
    for (std::size_t k = 0; k < 3; ++k)
      cube[k] = static_cast<std::int64_t>(std::floor(patch.center[static_cast<Eigen::Index>(k)] / edge_));
    return cube;
  }

  double edge_;
  std::unordered_map<Cube, std::vector<std::size_t>, boost::hash<Cube>> patches_;
};

/// Of many corners those that reach farthest in some directions: a ball that cannot hold these cannot hold all.
std::vector<Vector3d> outermost(const std::vector<Vector3d>& corners, const Patch& patch)
{
  static const std::vector<Vector3d> directions = [] {
    std::vector<Vector3d> found;
    for (int k = 1; k < 27; ++k)
      if (k != 13) found.push_back(Vector3d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized());
    return found;
  }();
  std::vector<Vector3d> all;
  for (const Piece& piece : patch.pieces)
    all.insert(all.end(), corners.begin() + static_cast<std::ptrdiff_t>(piece.first),
               corners.begin() + static_cast<std::ptrdiff_t>(piece.first + piece.count));
  if (all.size() <= directions.size()) return all;
  std::vector<Vector3d> outer;
  for (const Vector3d& direction : directions) {
    outer.push_back(*std::max_element(all.begin(), all.end(), [&](const Vector3d& p, const Vector3d& q) {
      return direction.dot(p) < direction.dot(q);
    }));
  }
  return outer;
}

class Union {
public:
  Union(const Mesh& mesh, const std::vector<Vector3d>& corners, std::vector<Patch>& patches)
  : room_(mesh.room),
    corners_(corners),
    patches_(patches),
    grid_(mesh.room)
  {
    outer_.reserve(patches.size());
    for (const Patch& patch : patches) outer_.push_back(outermost(corners, patch));
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

  /// The nearest patches, by their centres' distance.
  std::vector<Partner> partnersOf(std::size_t i, const Vector3d& place) const
  {
    std::vector<Partner> near;
    grid_.forEachNear(patches_[i], [&](std::size_t j) {
      const double apart = (patches_[j].center - place).norm();
      if (j != i && apart <= 2 * room_) near.push_back({apart, j});
    });
    const auto tried = static_cast<std::ptrdiff_t>(std::min(kPartners, near.size()));
    std::partial_sort(near.begin(), near.begin() + tried, near.end());
    near.resize(static_cast<std::size_t>(tried));
    return near;
  }

  /// Of the least ball that holds both, wherever its centre lies; at least that, where corners were left out.
  double leastRadius(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) const
  {
    std::vector<Vector3d> both = a;
    both.insert(both.end(), b.begin(), b.end());
    const Vector3d middle = middleOf(both);
    double most = 0.0;
    for (const Vector3d& p : both) most = std::max(most, (p - middle).squaredNorm());
    return std::sqrt(most);
  }

  /// Takes in the partner that leaves the least room; the partner is then empty.
  bool joinBestOf(std::size_t i)
  {
    std::vector<Partner> partners = partnersOf(i, patches_[i].center);
    for (Partner& partner : partners) partner.measure = -leastRadius(outer_[i], outer_[partner.patch]);
    std::sort(partners.begin(), partners.end());
    for (const Partner& partner : partners) {
      if (-partner.measure > room_) continue;
      Patch& other = patches_[partner.patch];
      Patch both = patches_[i];
      both.pieces.insert(both.pieces.end(), other.pieces.begin(), other.pieces.end());
      fitBall(corners_, both);
      if (both.radius > room_) continue;
      grid_.remove(other, partner.patch);
      other.pieces.clear();
      replace(i, std::move(both));
      return true;
    }
    return false;
  }

  void replace(std::size_t i, Patch patch)
  {
    grid_.remove(patches_[i], i);
    patches_[i] = std::move(patch);
    outer_[i] = outermost(corners_, patches_[i]);
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
      for (const Partner& partner : partnersOf(i, alone.center)) {
        const auto known =
            std::find_if(grown.begin(), grown.end(), [&](const auto& entry) { return entry.first == partner.patch; });
        Patch both = known != grown.end() ? known->second : patches_[partner.patch];
        both.pieces.push_back(piece);
        fitBall(corners_, both);
        if (both.radius > room_) continue;
        if (known != grown.end())
          known->second = std::move(both);
        else
          grown.push_back({partner.patch, std::move(both)});
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
  std::vector<std::vector<Vector3d>> outer_; ///< corners of each patch
  Grid grid_;
};

} // namespace

void unite(const Mesh& mesh, const std::vector<Vector3d>& corners, std::vector<Patch>& patches)
{
  Union(mesh, corners, patches)();
}

} // namespace pcl_bsh::surface
