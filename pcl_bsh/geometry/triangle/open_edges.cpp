// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/open_edges.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using Id = std::uint32_t;
constexpr Id kNone = ~Id{0};

std::size_t hashOf(const Point3& p)
{
  std::uint64_t hash = 0;
  for (const double x : p) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u; // 0 for -0
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash ^ (hash >> 32));
}

/// Gives equal places one number, in the order in which they come. Open addressing: of a number, only the place it
/// stands for is kept.
class Joined {
public:
  Id operator()(const Point3& p)
  {
    if (2 * (places_.size() + 1) > slots_.size()) grow();
    std::size_t slot = hashOf(p) & (slots_.size() - 1);
    for (; slots_[slot] != kNone; slot = (slot + 1) & (slots_.size() - 1))
      if (places_[slots_[slot]] == p) return slots_[slot];
    slots_[slot] = static_cast<Id>(places_.size());
    places_.push_back(p);
    return slots_[slot];
  }

  std::size_t size() const { return places_.size(); }

private:
  void grow()
  {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), kNone);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      std::size_t slot = hashOf(places_[i]) & (slots_.size() - 1);
      while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<Id>(i);
    }
  }

  std::vector<Point3> places_;
  std::vector<Id> slots_;
};

/// An edge at its corner of the lower number.
struct Edge {
  Id other;
  Id triangle; ///< twice it, and 1 more where the edge comes from `other`
};

} // namespace

OpenEdges findOpenEdges(std::size_t count, const std::function<Triangle3(std::size_t)>& triangle,
                        std::vector<OpenEdge>* all)
{
  if (all) all->clear();
  if (count >= std::size_t{1} << 31)
    throw std::invalid_argument("triangles: " + std::to_string(count) + ": edges are compared of less than 2^31");
  std::vector<std::array<Id, 3>> corners(count, {kNone, kNone, kNone});
  std::vector<Id> first; // of each corner's edges, one behind: counted, then summed
  {
    Joined joined;
    for (std::size_t i = 0; i < count; ++i) {
      const Triangle3 t = triangle(i);
      if (!isFinite(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) corners[i][k] = joined(t[k]);
    }
    first.assign(joined.size() + 1, 0);
  }
  const auto for_each_edge = [&](const auto& take) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Id from = corners[i][k], to = corners[i][(k + 1) % 3];
        if (from != to) take(std::min(from, to), std::max(from, to), static_cast<Id>(2 * i + (from < to ? 0 : 1)));
      }
  };
  if (3 * count >= kNone) throw std::invalid_argument("triangles: " + std::to_string(count) + ": too many edges");
  for_each_edge([&](Id low, Id, Id) { ++first[low]; });
  Id sum = 0;
  for (Id& n : first) sum += std::exchange(n, sum);
  std::vector<Edge> edges(sum);
  for_each_edge([&](Id low, Id high, Id named) { edges[first[low]++] = {high, named}; });
  // Now first[i] is where the edges of i end.

  OpenEdges open;
  Id least = kNone;
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    const auto begin = edges.begin() + (i == 0 ? 0 : first[i - 1]), end = edges.begin() + first[i];
    std::sort(begin, end, [](const Edge& x, const Edge& y) {
      return std::pair(x.other, x.triangle) < std::pair(y.other, y.triangle);
    });
    for (auto group = begin; group != end;) {
      std::int64_t net = 0;
      auto next = group;
      for (; next != end && next->other == group->other; ++next) net += (next->triangle & 1) == 0 ? 1 : -1;
      if (net != 0) {
        open.count += static_cast<std::uint64_t>(net > 0 ? net : -net);
        const auto left =
            std::find_if(group, next, [&](const Edge& e) { return ((e.triangle & 1) == 0) == (net > 0); });
        least = std::min(least, left->triangle / 2);
        // Of several that are alike, the first ones are as good as the others.
        for (auto e = left; all && net != 0 && e != next; ++e) {
          if (((e->triangle & 1) == 0) != (net > 0)) continue;
          net += net > 0 ? -1 : 1;
          const std::size_t name = e->triangle / 2;
          const Id low = static_cast<Id>(i), from = (e->triangle & 1) == 0 ? low : e->other,
                   to = (e->triangle & 1) == 0 ? e->other : low;
          std::size_t k = 0;
          while (corners[name][k] != from || corners[name][(k + 1) % 3] != to) ++k;
          const Triangle3 t = triangle(name);
          all->push_back({name, t[k], t[(k + 1) % 3]});
        }
      }
      group = next;
    }
  }
  if (open.count == 0) return open;
  if (all) {
    std::stable_sort(all->begin(), all->end(),
                     [](const OpenEdge& x, const OpenEdge& y) { return x.triangle < y.triangle; });
  }

  // Which of its edges: the first that is open.
  open.triangle = least;
  const Triangle3 t = triangle(least);
  for (std::size_t k = 3; k-- > 0;) {
    const Id from = corners[least][k], to = corners[least][(k + 1) % 3];
    if (from == to) continue;
    const Id low = std::min(from, to), high = std::max(from, to);
    std::int64_t net = 0;
    for (std::size_t e = low == 0 ? 0 : first[low - 1]; e < first[low]; ++e)
      if (edges[e].other == high) net += (edges[e].triangle & 1) == 0 ? 1 : -1;
    if ((from < to && net > 0) || (from > to && net < 0)) open.from = t[k], open.to = t[(k + 1) % 3];
  }
  return open;
}

} // namespace pcl_bsh
