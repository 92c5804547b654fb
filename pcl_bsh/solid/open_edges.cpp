// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/open_edges.h>

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_bsh {
namespace {

using Id = std::uint32_t;
constexpr Id kNone = ~Id{0};
constexpr std::size_t kMostIds = std::size_t{1} << 31; ///< twice one, and 1 more, is an Id

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

/// The directed edges between numbers that are left over where opposite ones have cancelled.
class EdgesLeft {
public:
  /// @param corners_of called twice with each triangle: the numbers of its corners. An edge between equal ones is none
  template <class CornersOf>
  EdgesLeft(std::size_t triangles, std::size_t numbers, const CornersOf& corners_of) : ends_(numbers)
  {
    const auto each_edge = [&](const auto& take) {
      for (std::size_t i = 0; i < triangles; ++i) {
        const std::array<Id, 3> corners = corners_of(i);
        for (std::size_t k = 0; k < 3; ++k)
          if (const Id from = corners[k], to = corners[(k + 1) % 3]; from != to) take(from, to);
      }
    };
    each_edge([&](Id from, Id to) { ++ends_[std::min(from, to)]; });
    Id sum = 0;
    for (Id& n : ends_) sum += std::exchange(n, sum);
    edges_.resize(sum);
    each_edge([&](Id from, Id to) { edges_[ends_[std::min(from, to)]++] = keyOf(from, to); });
    for (std::size_t low = 0; low < numbers; ++low) cancel(low);
  }

  std::uint64_t count() const { return count_; }

  /// Whether such an edge is left; it is taken away.
  bool take(Id from, Id to)
  {
    taken_.resize(edges_.size());
    const std::size_t low = std::min(from, to);
    const auto [first, last] =
        std::equal_range(edges_.begin() + begin(low), edges_.begin() + ends_[low], keyOf(from, to));
    if (first == last) return false;
    Id& taken = taken_[static_cast<std::size_t>(first - edges_.begin())];
    return taken < static_cast<std::size_t>(last - first) && ++taken != 0;
  }

private:
  static Id keyOf(Id from, Id to) { return from < to ? 2 * to : 2 * from + 1; }
  Id begin(std::size_t low) const { return low == 0 ? 0 : ends_[low - 1]; }

  void cancel(std::size_t low)
  {
    const auto end = edges_.begin() + ends_[low];
    auto edge = edges_.begin() + begin(low), left = edge;
    std::sort(edge, end);
    while (edge != end) {
      const Id up = *edge & ~Id{1};
      std::int64_t net = 0;
      for (; edge != end && (*edge & ~Id{1}) == up; ++edge) net += *edge == up ? 1 : -1;
      left = std::fill_n(left, net < 0 ? -net : net, net < 0 ? up + 1 : up);
      count_ += static_cast<std::uint64_t>(net < 0 ? -net : net);
    }
    std::fill(left, end, kNone);
  }

  std::vector<Id> edges_; ///< by their lower numbers: twice the higher one, and 1 more where the edge comes from there
  std::vector<Id> ends_;  ///< of those of each lower number
  std::vector<Id> taken_; ///< of the edges that are alike, at the first one
  std::uint64_t count_ = 0;
};

bool haveFiniteVertices(const TrianglesView& triangles)
{
  for (std::size_t i = 0; i < triangles.vertices.count; ++i)
    if (!isFinite(triangles.vertices.point(static_cast<Id>(i)))) return false;
  return true;
}

/// Whether the edges between numbers of vertices cancel. Then those between places do, too, whichever numbers stand for
/// one place.
bool closeByNumber(const TrianglesView& triangles)
{
  const std::size_t vertices = triangles.vertices.count;
  if (vertices >= kMostIds || vertices > 3 * triangles.count || !haveFiniteVertices(triangles)) return false;
  const auto corners_of = [&](std::size_t i) { return triangles.cornersOf(static_cast<Id>(i)); };
  return EdgesLeft(triangles.count, vertices, corners_of).count() == 0;
}

[[noreturn]] void refuse(const TrianglesView& triangles, const char* most)
{
  throw std::invalid_argument("triangles: " + std::to_string(triangles.count) + ": edges are compared of less than " +
                              most);
}

} // namespace

OpenEdges openEdgesOf(const TrianglesView& triangles, std::vector<OpenEdge>* all)
{
  if (all) all->clear();
  if (3 * triangles.count >= kNone) refuse(triangles, "2^32 edges");
  if (closeByNumber(triangles)) return {};

  std::vector<std::array<Id, 3>> corners(triangles.count);
  Joined joined;
  for (std::size_t i = 0; i < triangles.count; ++i) {
    const Triangle3 places = triangles.triangle(static_cast<Id>(i));
    if (isFinite(places)) std::transform(places.begin(), places.end(), corners[i].begin(), std::ref(joined));
  }
  if (joined.size() >= kMostIds) refuse(triangles, "2^31 places");
  const std::size_t numbers = std::exchange(joined, Joined()).size();
  EdgesLeft left(triangles.count, numbers, [&](std::size_t i) { return corners[i]; });

  OpenEdges open{left.count()};
  std::optional<OpenEdge> first;
  for (std::size_t i = 0; open.count != 0 && i < triangles.count && (all || !first); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      if (!left.take(corners[i][k], corners[i][(k + 1) % 3])) continue;
      const Triangle3 places = triangles.triangle(static_cast<Id>(i));
      const OpenEdge edge{i, places[k], places[(k + 1) % 3]};
      if (!first) first = edge;
      if (all) all->push_back(edge);
    }
  if (first) open.triangle = first->triangle, open.from = first->from, open.to = first->to;
  return open;
}

} // namespace pcl_bsh
