// SPDX-License-Identifier: BSD-3-Clause
// Squared distances of triangles as fractions, from their nearest features: corners, edges, faces. Computed in
// RoughNumber and LongNumber, which may be unsure, or in Dyadic, which never is.
#pragma once

#include <pcl_bsh/geometry/exact/dyadic.h>
#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/exact/rough_number.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

#include <cstdint>

namespace pcl_bsh {

inline int signOf(const LongNumber& x, bool& sure)
{
  return x.sign(sure);
}
inline int signOf(const RoughNumber& x, bool& sure)
{
  return x.sign(sure);
}
inline int signOf(const Dyadic& x, bool&)
{
  return x.sign();
}

/// numerator / denominator, of which the latter is positive.
template <class Number>
struct Fraction {
  Number numerator = Number(0.0), denominator = Number(1.0);
};

/// Sign of x - y.
template <class Number>
int compareFractions(const Fraction<Number>& x, const Fraction<Number>& y, bool& sure)
{
  return signOf(x.numerator * y.denominator - y.numerator * x.denominator, sure);
}

/// Which pairs of features are to be compared: all that may be the nearest.
struct FeaturePairs {
  std::uint16_t edges =
      0x1ff;                 ///< bit 3 i + j: edge i of the first triangle, edge j of the second; each from its corner
  std::uint8_t faces = 0x3f; ///< bit i: corner i of the first, the second's face; bit 3 + j: corner j of the second
};

/// A feature of each triangle, with the nearest places inside both. Edge k goes from corner k to the next.
struct Features {
  enum Kind : std::uint8_t { meeting, corners, corner_edge, edge_corner, edges, corner_face, face_corner };
  Kind kind = meeting;
  std::uint8_t i = 0, j = 0; ///< of the first triangle and of the second; 0 for a face
};

/// The squared distance of the points, lines and planes that features lie in.
/// @param a, b the corners of both triangles: called with their number
template <class Number, class CornerA, class CornerB>
Fraction<Number> squaredDistance(const Features& features, const CornerA& a, const CornerB& b)
{
  using Vector = Vector3<Number>;
  const std::size_t i = features.i, j = features.j, next_i = (i + 1) % 3, next_j = (j + 1) % 3;
  const auto to_line = [](const Vector& point, const Vector& start, const Vector& end) -> Fraction<Number> {
    const Vector edge = end - start, moment = cross(point - start, edge);
    return {dot(moment, moment), dot(edge, edge)};
  };
  const auto to_plane = [](const Vector& point, const Vector& start, const Vector& u,
                           const Vector& v) -> Fraction<Number> {
    const Vector normal = cross(u, v);
    const Number height = dot(normal, point - start);
    return {height * height, dot(normal, normal)};
  };
  switch (features.kind) {
  case Features::corners: {
    const Vector between = a(i) - b(j);
    return {dot(between, between), Number(1.0)};
  }
  case Features::corner_edge:
    return to_line(a(i), b(j), b(next_j));
  case Features::edge_corner:
    return to_line(b(j), a(i), a(next_i));
  case Features::edges: {
    const Vector start_a = a(i), start_b = b(j);
    return to_plane(start_a, start_b, a(next_i) - start_a, b(next_j) - start_b);
  }
  case Features::corner_face: {
    const Vector start = b(0);
    return to_plane(a(i), start, b(1) - start, b(2) - start);
  }
  case Features::face_corner: {
    const Vector start = a(0);
    return to_plane(b(j), start, a(1) - start, a(2) - start);
  }
  case Features::meeting:
    break;
  }
  return {Number(0.0), Number(1.0)};
}

/// The smallest squared distance of two closed triangles, or of a point, which is corner 0 of the first, and a
/// triangle.
///
/// The nearest places of two triangles that do not meet are a corner and a place inside a face, or places of two edges.
/// On two edges they are inside both, or a corner and a place. Each pair of two corners, of corner and edge and so on
/// is offered once at most, so that equal distances are not compared where one feature is shared. Where a sign is
/// unknown, `sure` is false and the result worth nothing.
template <class Number>
class NearestFeatures {
public:
  using Vector = Vector3<Number>;
  using Corners = std::array<Vector, 3>;

  /// Compares a point and a triangle.
  NearestFeatures(const Vector& point, const Corners& triangle) : a_{point, point, point}, b_(triangle)
  {
    const Vector normal = normalOf(b_);
    const bool flat = isZero(normal);
    if (!flat && isOver(point, b_, normal)) {
      offer(Features::corner_face, 0, 0);
      return;
    }
    for (std::size_t j = 0; j < 3 && sure_; ++j) // the nearest edge is one that has the point on its outer side
      if (flat || outer_[j]) offerEdge(0, j, true);
  }

  /// Compares two triangles.
  NearestFeatures(const Corners& a, const Corners& b, FeaturePairs pairs) : a_(a), b_(b)
  {
    const Vector normals[2] = {normalOf(a), normalOf(b)};
    if (takeSeparated(normals, pairs)) return;
    if (pierces(a, b, normals[1]) || (sure_ && pierces(b, a, normals[0]))) {
      if (sure_) best_ = {Number(0.0), Number(1.0)}, found_ = true;
      return;
    }
    for (std::size_t k = 0; k < 9 && sure_; ++k)
      if ((pairs.edges >> k & 1) != 0) offerEdges(k / 3, k % 3);
    for (std::size_t k = 0; k < 6 && sure_; ++k) {
      if ((pairs.faces >> k & 1) == 0) continue;
      const Corners& face = k < 3 ? b : a;
      const Vector& point = k < 3 ? a[k] : b[k - 3];
      const Vector& normal = normals[k < 3 ? 1 : 0];
      if (!isZero(normal) && isOver(point, face, normal))
        k < 3 ? offer(Features::corner_face, k, 0) : offer(Features::face_corner, 0, k - 3);
    }
  }

  bool sure() const { return sure_ && found_; }
  const Fraction<Number>& squared() const { return best_; }
  const Features& features() const { return nearest_; }

private:
  static Vector normalOf(const Corners& t) { return cross(t[1] - t[0], t[2] - t[0]); }

  bool isZero(const Vector& v)
  {
    // An unknown sign of a component does not matter beside one that is known.
    bool sure = true, zero = true;
    for (const Number& x : v) zero = signOf(x, sure) == 0 && zero;
    sure_ = sure_ && (sure || !zero);
    return zero;
  }

  /// Whether a point is over the closed triangle, seen along its normal; notes the edges that it is outside of.
  bool isOver(const Vector& point, const Corners& t, const Vector& normal)
  {
    bool over = true;
    for (std::size_t j = 0; j < 3; ++j) {
      outer_[j] = signOf(dot(normal, cross(t[(j + 1) % 3] - t[j], point - t[j])), sure_) < 0;
      over = over && !outer_[j];
    }
    return over && sure_;
  }

  /// Whether an edge passes through the triangle from one side of its plane to the other.
  bool pierces(const Corners& edges, const Corners& t, const Vector& normal)
  {
    int sides[3];
    for (std::size_t i = 0; i < 3; ++i) sides[i] = signOf(dot(normal, edges[i] - t[0]), sure_);
    for (std::size_t i = 0; i < 3 && sure_; ++i) {
      if (sides[i] * sides[(i + 1) % 3] >= 0) continue;
      const Vector from[3] = {t[0] - edges[i], t[1] - edges[i], t[2] - edges[i]};
      const Vector way = edges[(i + 1) % 3] - edges[i];
      bool some_left = false, some_right = false;
      for (std::size_t j = 0; j < 3; ++j) {
        const int side = signOf(dot(way, cross(from[j], from[(j + 1) % 3])), sure_);
        some_left = some_left || side > 0, some_right = some_right || side < 0;
      }
      if (sure_ && !(some_left && some_right)) return true;
    }
    return false;
  }

  /// Takes two features if the planes through their nearest places, across the way between these, separate both
  /// triangles: the triangles are as far apart as the planes. Signs alone prove it, also where other features are
  /// hardly farther apart. @return false where no two features are sure
  bool takeSeparated(const Vector (&normals)[2], FeaturePairs pairs)
  {
    for (std::size_t k = 0; k < 6; ++k) {
      if ((pairs.faces >> k & 1) == 0) continue;
      const std::size_t i = k % 3;
      if (k < 3 ? isLowestOver(a_, i, b_, normals[1]) : isLowestOver(b_, i, a_, normals[0]))
        return k < 3 ? take(Features::corner_face, i, 0) : take(Features::face_corner, 0, i);
    }
    for (std::size_t k = 0; k < 9; ++k)
      if ((pairs.edges >> k & 1) != 0 && areEdgesBetween(k / 3, k % 3)) return take(Features::edges, k / 3, k % 3);
    for (std::size_t k = 0; k < 9; ++k) {
      if ((pairs.edges >> k & 1) == 0) continue;
      const std::size_t i = k / 3, j = k % 3;
      for (const std::size_t corner : {i, (i + 1) % 3})
        if (isEdgeBefore(a_, corner, b_, j)) return take(Features::corner_edge, corner, j);
      for (const std::size_t corner : {j, (j + 1) % 3})
        if (isEdgeBefore(b_, corner, a_, i)) return take(Features::edge_corner, i, corner);
    }
    for (std::size_t k = 0; k < 9; ++k)
      if (areCornersBetween(k / 3, k % 3)) return take(Features::corners, k / 3, k % 3);
    return false;
  }

  bool take(Features::Kind kind, std::size_t i, std::size_t j)
  {
    found_ = false;
    offer(kind, i, j);
    return true;
  }

  /// Whether the other corners of a triangle are surely no farther along a direction than corner i.
  static bool areBehind(const Vector& direction, const Corners& t, std::size_t i, bool& sure)
  {
    for (const std::size_t k : {(i + 1) % 3, (i + 2) % 3})
      if (signOf(dot(direction, t[k] - t[i]), sure) > 0 || !sure) return false;
    return true;
  }

  /// Whether a corner is surely over a face, and no other corner of its triangle is nearer to the face's plane.
  static bool isLowestOver(const Corners& t, std::size_t i, const Corners& face, const Vector& normal)
  {
    bool sure = true;
    const int side = signOf(dot(normal, t[i] - face[0]), sure);
    if (side == 0 || !areBehind(side > 0 ? -normal : normal, t, i, sure)) return false;
    for (std::size_t j = 0; j < 3; ++j)
      if (signOf(dot(normal, cross(face[(j + 1) % 3] - face[j], t[i] - face[j])), sure) < 0 || !sure) return false;
    return true;
  }

  /// Whether the nearest places of two edges' lines are surely inside both, and the third corners not between the
  /// planes through these edges.
  bool areEdgesBetween(std::size_t i, std::size_t j) const
  {
    const Vector &from_a = a_[i], &from_b = b_[j];
    const Vector u = a_[(i + 1) % 3] - from_a, v = b_[(j + 1) % 3] - from_b, w = from_a - from_b;
    const Vector normal = cross(u, v);
    bool sure = true;
    const int side = signOf(dot(normal, w), sure);
    if (side == 0 || side * signOf(dot(normal, a_[(i + 2) % 3] - from_a), sure) < 0 || !sure ||
        side * signOf(dot(normal, b_[(j + 2) % 3] - from_b), sure) > 0 || !sure)
      return false;
    return isInside(normal, cross(v, w), sure) && isInside(normal, cross(u, w), sure);
  }

  /// Whether corner i of a triangle and the inside of edge j of another surely separate both so: see takeSeparated().
  static bool isEdgeBefore(const Corners& t, std::size_t i, const Corners& ends, std::size_t j)
  {
    const Vector edge = ends[(j + 1) % 3] - ends[j], from = t[i] - ends[j];
    const Number share = dot(from, edge), whole = dot(edge, edge);
    bool sure = true;
    if (signOf(share, sure) <= 0 || signOf(share - whole, sure) >= 0 || !sure) return false;
    const Vector way = whole * from - share * edge; // from the edge to the corner
    return signOf(dot(way, ends[(j + 2) % 3] - ends[j]), sure) <= 0 && sure && areBehind(-way, t, i, sure);
  }

  /// Whether corner i of the first triangle and corner j of the second surely separate both so.
  bool areCornersBetween(std::size_t i, std::size_t j) const
  {
    const Vector way = a_[i] - b_[j];
    bool sure = true;
    return areBehind(-way, a_, i, sure) && areBehind(way, b_, j, sure);
  }

  /// Whether the nearest place of an edge to another's line is inside the edge.
  static bool isInside(const Vector& normal, const Vector& moment, bool& sure)
  {
    const Number share = dot(normal, moment);
    return signOf(share, sure) > 0 && signOf(share - dot(normal, normal), sure) < 0 && sure;
  }

  void offer(Features::Kind kind, std::size_t i, std::size_t j)
  {
    const Features features{kind, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)};
    const Fraction<Number> offered = squaredDistance<Number>(
        features, [this](std::size_t k) -> const Vector& { return a_[k]; },
        [this](std::size_t k) -> const Vector& { return b_[k]; });
    if (!found_ || compareFractions(offered, best_, sure_) < 0) best_ = offered, nearest_ = features;
    found_ = true;
  }

  void offerCorners(std::size_t i, std::size_t j)
  {
    const std::uint32_t bit = 1u << (3 * i + j);
    if ((corners_ & bit) != 0) return;
    corners_ |= bit;
    offer(Features::corners, i, j);
  }

  /// Offers corner i of one triangle and edge j of the other. `of_first`: the corner is of the first triangle.
  void offerEdge(std::size_t i, std::size_t j, bool of_first)
  {
    const std::uint32_t bit = 1u << (3 * i + j + (of_first ? 0 : 9));
    if ((corner_edges_ & bit) != 0) return;
    corner_edges_ |= bit;
    const Corners& ends = of_first ? b_ : a_;
    const std::size_t next = (j + 1) % 3;
    const Vector edge = ends[next] - ends[j], from = (of_first ? a_ : b_)[i] - ends[j];
    const auto offer_end = [&](std::size_t end) { of_first ? offerCorners(i, end) : offerCorners(end, i); };
    const Number share = dot(from, edge), whole = dot(edge, edge);
    if (signOf(share, sure_) <= 0) return offer_end(j);
    if (signOf(share - whole, sure_) >= 0) return offer_end(next);
    of_first ? offer(Features::corner_edge, i, j) : offer(Features::edge_corner, j, i);
  }

  void offerEdges(std::size_t i, std::size_t j)
  {
    const std::size_t next_i = (i + 1) % 3, next_j = (j + 1) % 3;
    const Vector u = a_[next_i] - a_[i], v = b_[next_j] - b_[j], w = a_[i] - b_[j];
    const Vector normal = cross(u, v);
    if (!isZero(normal)) {
      if (isInside(normal, cross(v, w), sure_) && isInside(normal, cross(u, w), sure_))
        return offer(Features::edges, i, j);
    }
    offerEdge(i, j, true);
    offerEdge(next_i, j, true);
    offerEdge(j, i, false);
    offerEdge(next_j, i, false);
  }

  Corners a_, b_;
  std::array<bool, 3> outer_ = {};
  std::uint32_t corners_ = 0, corner_edges_ = 0;
  Fraction<Number> best_;
  Features nearest_;
  bool found_ = false, sure_ = true;
};

} // namespace pcl_bsh
