// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/open_edges.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/exact/line_order.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/solid/cancel_along_line.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_bsh {
namespace {

using Id = std::uint32_t;
constexpr Id kNone = ~Id{0};
constexpr std::size_t kMostIds = std::size_t{1} << 31; ///< 2 id + 1 is an Id, too

std::size_t hashOf(const Point3& p)
{
  std::uint64_t hash = 0;
  for (const double x : p) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u; // 0 for -0
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash ^ (hash >> 32));
}

/// Numbers places in the order in which they first come: equal places have one number. Open addressing: slots hold
/// numbers, and a number only its place.
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
  /// @param corners_of called twice with each triangle: the numbers of its corners. An edge between equal corners does
  /// not count
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

  std::vector<Id> edges_; ///< by their lower ends: twice the higher end, and 1 more where the edge begins there
  std::vector<Id> ends_;  ///< end of the edges of each lower end
  std::vector<Id> taken_; ///< how many of equal edges are taken, at the first of them
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

/// Edges of triangles that no edge between the same places cancels. Edge 3 i + k goes from corner k of triangle i to
/// the next.
class LoneEdges {
public:
  explicit LoneEdges(const TrianglesView& triangles) : triangles_(triangles), numbers_(triangles.count)
  {
    Joined joined;
    for (std::size_t i = 0; i < triangles.count; ++i) {
      const Triangle3 places = triangles.triangle(static_cast<Id>(i));
      if (isFinite(places)) std::transform(places.begin(), places.end(), numbers_[i].begin(), std::ref(joined));
    }
    if (joined.size() >= kMostIds) refuse(triangles, "2^31 places");
    places_ = std::exchange(joined, Joined()).size();
    EdgesLeft left(triangles.count, places_, [&](std::size_t i) { return numbers_[i]; });
    edges_.reserve(left.count());
    for (std::size_t i = 0; edges_.size() < left.count(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (left.take(numbers_[i][k], numbers_[i][(k + 1) % 3])) edges_.push_back(static_cast<Id>(3 * i + k));
  }

  /// Whether they cancel along their lines. On a line they do if and only if at each place as many begin as end. For
  /// passes one way less passes the other way change at a place by begins less ends, and far out they are 0.
  bool cancel() const
  {
    if (edges_.empty()) return true;
    std::vector<std::size_t> ends(places_, 0); // of the edges that begin or end at each place
    for (const Id edge : edges_) ++ends[number(edge, 0)], ++ends[number(edge, 1)];
    std::size_t sum = 0;
    for (std::size_t& n : ends) sum += std::exchange(n, sum);
    std::vector<Id> at(sum);
    for (const Id edge : edges_)
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) at[ends[number(edge, end)]++] = edge;
    std::vector<Leaving> leaving;
    for (std::size_t place = 0; place < places_; ++place) {
      leaving.clear();
      for (std::size_t i = place == 0 ? 0 : ends[place - 1]; i < ends[place]; ++i)
        leaving.push_back({spanOf(at[i]), number(at[i], 0) == place ? 1 : -1});
      if (!cancel(leaving)) return false;
    }
    return true;
  }

  /// Visits the open parts of these edges, in the order of the edges. @param visit called with triangle, from, to
  template <class Visit>
  void forEachOpen(const Visit& visit) const
  {
    struct Line {
      RoughSlope slope;
      Id edge;
    };
    struct Part {
      Id edge;
      Point3 low, high;
    };
    std::vector<Line> lines;
    lines.reserve(edges_.size());
    for (const Id edge : edges_) lines.push_back({RoughSlope(spanOf(edge)), edge});
    const auto compare = [&](const Line& l, const Line& r) {
      const int rough = l.slope.compare(r.slope);
      return rough != 0 ? rough : compareLines(spanOf(l.edge), spanOf(r.edge));
    };
    std::sort(lines.begin(), lines.end(), [&](const Line& l, const Line& r) { return compare(l, r) < 0; });
    std::vector<Part> parts;
    std::vector<EdgeOnLine> on_line;
    for (auto line = lines.begin(); line != lines.end();) {
      const auto first = line;
      on_line.clear();
      do {
        const LineSpan span = spanOf(line->edge);
        on_line.push_back({span.low, span.high, rises(line->edge), line->edge});
      } while (++line != lines.end() && compare(*first, *line) == 0);
      cancelAlongLine(on_line, [&](std::size_t i, const Point3& low, const Point3& high) {
        parts.push_back({first[static_cast<std::ptrdiff_t>(i)].edge, low, high});
      });
    }
    std::sort(parts.begin(), parts.end(), [&](const Part& l, const Part& r) {
      return l.edge != r.edge ? l.edge < r.edge : rises(l.edge) ? l.low < r.low : r.low < l.low;
    });
    for (const Part& part : parts)
      visit(part.edge / 3, rises(part.edge) ? part.low : part.high, rises(part.edge) ? part.high : part.low);
  }

private:
  /// An edge seen from one of its ends.
  struct Leaving {
    LineSpan span;
    int begins; ///< 1 where it begins there, -1 where it ends
  };

  static bool cancel(std::vector<Leaving>& leaving)
  {
    int sum = 0;
    for (const Leaving& edge : leaving) sum += edge.begins;
    if (sum != 0) return false;
    std::sort(leaving.begin(), leaving.end(),
              [](const Leaving& l, const Leaving& r) { return compareDirections(l.span, r.span) < 0; });
    for (std::size_t i = 0; i < leaving.size(); ++i) {
      sum += leaving[i].begins;
      if (sum != 0 && (i + 1 == leaving.size() || compareDirections(leaving[i].span, leaving[i + 1].span) != 0))
        return false;
    }
    return true;
  }

  Id number(Id edge, std::size_t end) const { return numbers_[edge / 3][(edge + end) % 3]; }
  Point3 place(Id edge, std::size_t end) const
  {
    return triangles_.vertices.point(triangles_.cornersOf(edge / 3)[(edge % 3 + end) % 3]);
  }
  bool rises(Id edge) const { return place(edge, 0) < place(edge, 1); }
  LineSpan spanOf(Id edge) const
  {
    const Point3 from = place(edge, 0), to = place(edge, 1);
    return from < to ? LineSpan{from, to} : LineSpan{to, from};
  }

  const TrianglesView& triangles_;
  std::vector<std::array<Id, 3>> numbers_; ///< of the places of each triangle's corners
  std::size_t places_ = 0;
  std::vector<Id> edges_; ///< ascending
};

void checkCount(const TrianglesView& triangles)
{
  if (3 * triangles.count >= kNone) refuse(triangles, "2^32 edges");
}

} // namespace

bool closes(const TrianglesView& triangles)
{
  checkCount(triangles);
  const DefaultFloatEnvironment environment;
  return closeByNumber(triangles) || LoneEdges(triangles).cancel();
}

OpenEdges openEdgesOf(const TrianglesView& triangles, std::vector<OpenEdge>* all)
{
  if (all) all->clear();
  checkCount(triangles);
  const DefaultFloatEnvironment environment;
  OpenEdges open;
  if (closeByNumber(triangles)) return open;
  const LoneEdges lone(triangles);
  if (lone.cancel()) return open;
  lone.forEachOpen([&](std::size_t triangle, const Point3& from, const Point3& to) {
    if (open.count++ == 0) open.triangle = triangle, open.from = from, open.to = to;
    if (all) all->push_back({triangle, from, to});
  });
  return open;
}

} // namespace pcl_bsh
