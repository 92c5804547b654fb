// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/hexagons.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/surface/piece_ball.h>

#include <boost/container/static_vector.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::surface {

namespace {

const double kRoot3 = std::sqrt(3.0);
/// A triangle thinner than this, against its longest edge, gives no place in its plane by its normal: rounding would
/// be multiplied. Its hexagons are cut along its edges, which is stable.
constexpr double kThin = 1.0 / 16;
/// Balls' centres are found in floats: their radii may exceed a hexagon's by that.
constexpr double kCenterMargin = 0x1p-18;
/// What is cut a little too large covers what rounding has on the wrong side: 64 roundings of a coordinate.
constexpr double kOverlap = 64 * kDoubleUnit;

/// A corner of a piece: where it lies in the chart's plane and in space. Both are carried along edges by one
/// parameter, so that they stay together.
struct Corner {
  Vector2d at;
  Vector3d place;
};

/// A convex polygon that is cut by half-planes. A triangle has at most eleven corners after a row's two cuts and a
/// hexagon's six.
class Polygon {
public:
  Polygon(const Plane& plane, const Corners& corners)
  {
    for (const Vector3d& p : corners) corners_.push_back({plane.at(p), p});
  }

  bool empty() const { return corners_.empty(); }
  std::size_t size() const { return corners_.size(); }
  const Corner& operator[](std::size_t i) const { return corners_[i]; }

  /// Keeps what has normal . at <= bound.
  void cut(const Vector2d& normal, double bound)
  {
    const auto beyond = [&](const Corner& corner) { return normal.dot(corner.at) - bound; };
    if (std::none_of(corners_.begin(), corners_.end(), [&](const Corner& corner) { return beyond(corner) > 0; }))
      return;
    CornerList kept;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Corner &p = corners_[i], &q = corners_[i + 1 < corners_.size() ? i + 1 : 0];
      const double here = beyond(p), there = beyond(q);
      if (here <= 0) kept.push_back(p);
      if ((here > 0) != (there > 0)) {
        const double share = here / (here - there);
        kept.push_back({p.at + share * (q.at - p.at), p.place + share * (q.place - p.place)});
      }
    }
    corners_ = kept;
  }

private:
  using CornerList = boost::container::static_vector<Corner, 16>;
  CornerList corners_;
};

/// Places of hexagons of one circumradius, two of their sides along y: rows of them, each other row half a step on.
class Lattice {
public:
  Lattice(double radius, const Vector2d& origin) : radius_(radius), origin_(origin) {}

  double radius() const { return radius_; }
  double inradius() const { return 0.5 * kRoot3 * radius_; }
  Vector2d center(std::int64_t row, std::int64_t column) const
  {
    const double half = (row & 1) ? 0.5 : 0.0;
    return origin_ +
           Vector2d(kRoot3 * radius_ * (static_cast<double>(column) + half), 1.5 * radius_ * static_cast<double>(row));
  }
  /// The rows, as real numbers, whose hexagons' centres have this y; and columns of a row.
  double rowAt(double y) const { return (y - origin_.y()) / (1.5 * radius_); }
  double columnAt(std::int64_t row, double x) const
  {
    return (x - origin_.x()) / (kRoot3 * radius_) - ((row & 1) ? 0.5 : 0.0);
  }

  /// The normals of the six sides.
  static const std::array<Vector2d, 6>& sides()
  {
    static const std::array<Vector2d, 6> normals = {
        Vector2d(1, 0),  Vector2d(0.5, 0.5 * kRoot3),   Vector2d(-0.5, 0.5 * kRoot3),
        Vector2d(-1, 0), Vector2d(-0.5, -0.5 * kRoot3), Vector2d(0.5, -0.5 * kRoot3)};
    return normals;
  }

private:
  double radius_;
  Vector2d origin_;
};

/// Rows of hexagons over a chart that is only a few rows high are laid symmetrically about its middle: a strip no
/// higher than a side takes one row.
Lattice latticeOver(const Mesh& mesh, const Chart& chart)
{
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const std::uint32_t t : chart.triangles) {
    for (const Vector3d& p : mesh.corners(t)) {
      low = low.cwiseMin(chart.plane.at(p));
      high = high.cwiseMax(chart.plane.at(p));
    }
  }
  const double radius = (mesh.room - 2 * kOverlap * mesh.extent) * chart.least_cosine * (1 - kCenterMargin);
  const double rows = std::ceil(((high - low).y() + 0.5 * radius) / (1.5 * radius)); // together they hold so much
  const double first_row = 0.5 * (low + high).y() - 0.75 * radius * (rows - 1);
  return {radius, {0.5 * (low + high).x(), first_row}};
}

/// One hexagon's part of a triangle.
struct Part {
  std::int64_t row, column;
  Piece piece;

  bool inOneHexagon(const Part& other) const { return row == other.row && column == other.column; }
  friend bool operator<(const Part& a, const Part& b)
  {
    return std::tie(a.row, a.column, a.piece.first) < std::tie(b.row, b.column, b.piece.first);
  }
};

class ChartDivision {
public:
  ChartDivision(const Mesh& mesh, const Chart& chart, std::vector<Vector3d>& corners)
  : mesh_(mesh),
    chart_(chart),
    lattice_(latticeOver(mesh, chart)),
    overlap_(kOverlap * mesh.extent),
    corners_(corners)
  {
  }

  Division operator()()
  {
    for (const std::uint32_t t : chart_.triangles) divideTriangle(t);
    std::sort(parts_.begin(), parts_.end());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i == 0 || !parts_[i].inOneHexagon(parts_[i - 1])) division_.patches.emplace_back();
      division_.patches.back().pieces.push_back(parts_[i].piece);
    }
    return std::move(division_);
  }

private:
  void divideTriangle(std::uint32_t t)
  {
    const Corners corners = mesh_.corners(t);
    const Polygon triangle(chart_.plane, corners);
    setInside(corners, triangle);
    double low = triangle[0].at.y(), high = low;
    for (std::size_t i = 1; i < 3; ++i) {
      low = std::min(low, triangle[i].at.y());
      high = std::max(high, triangle[i].at.y());
    }
    // A hexagon reaches two thirds of a row above and below its centre.
    const auto first = static_cast<std::int64_t>(std::ceil(lattice_.rowAt(low) - 0.667));
    const auto last = static_cast<std::int64_t>(std::floor(lattice_.rowAt(high) + 0.667));
    for (std::int64_t row = first; row <= last; ++row) divideRow(t, triangle, row);
  }

  void divideRow(std::uint32_t t, Polygon strip, std::int64_t row)
  {
    const double y = lattice_.center(row, 0).y(), half = lattice_.radius() + overlap_;
    strip.cut({0, 1}, y + half);
    strip.cut({0, -1}, half - y);
    if (strip.empty()) return;
    double low = strip[0].at.x(), high = low;
    for (std::size_t i = 1; i < strip.size(); ++i) {
      low = std::min(low, strip[i].at.x());
      high = std::max(high, strip[i].at.x());
    }
    const auto first = static_cast<std::int64_t>(std::ceil(lattice_.columnAt(row, low) - 0.501));
    const auto last = static_cast<std::int64_t>(std::floor(lattice_.columnAt(row, high) + 0.501));
    for (std::int64_t column = first; column <= last; ++column) {
      const Vector2d center = lattice_.center(row, column);
      if (isInside(center)) {
        division_.whole.push_back({lifted(center), radius_, t});
      }
      else {
        addPart(t, strip, row, column);
      }
    }
  }

  void addPart(std::uint32_t t, Polygon part, std::int64_t row, std::int64_t column)
  {
    const Vector2d center = lattice_.center(row, column);
    for (const Vector2d& side : Lattice::sides()) {
      part.cut(side, side.dot(center) + lattice_.inradius() + overlap_);
      if (part.empty()) return;
    }
    parts_.push_back({row, column, {t, static_cast<std::uint32_t>(part.size()), corners_.size()}});
    for (std::size_t i = 0; i < part.size(); ++i) corners_.push_back(part[i].place);
  }

  /// Which centres have a hexagon that lies in the triangle, and how to find their places on it.
  void setInside(const Corners& corners, const Polygon& triangle)
  {
    const Vector2d p = triangle[0].at, q = triangle[1].at, r = triangle[2].at;
    const double twice = (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
    const double turn = twice < 0 ? -1.0 : 1.0;
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector2d from = triangle[i].at, edge = triangle[(i + 1) % 3].at - from;
      const double length = edge.norm();
      longest = std::max(longest, length);
      if (length > 0) inward_[i] = turn * Vector2d(-edge.y(), edge.x()) / length;
      least_[i] = inward_[i].dot(from) + lattice_.radius() + overlap_;
    }
    const bool large = longest > 0 && twice * turn > longest * std::max(kThin * longest, lattice_.radius());
    has_inside_ = large;
    if (!large) return;
    origin_ = corners[0];
    origin_at_ = p;
    const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const Plane& plane = chart_.plane;
    slope_ = Vector2d(-normal.dot(plane.x), -normal.dot(plane.y)) / normal.dot(plane.normal);
    radius_ = lattice_.radius() / cosineTo(plane, corners);
  }

  bool isInside(const Vector2d& center) const
  {
    if (!has_inside_) return false;
    for (std::size_t i = 0; i < 3; ++i)
      if (!(inward_[i].dot(center) >= least_[i])) return false;
    return true;
  }

  Vector3d lifted(const Vector2d& center) const
  {
    const Vector2d d = center - origin_at_;
    return origin_ + d.x() * chart_.plane.x + d.y() * chart_.plane.y + slope_.dot(d) * chart_.plane.normal;
  }

  const Mesh& mesh_;
  const Chart& chart_;
  const Lattice lattice_;
  const double overlap_;
  std::vector<Vector3d>& corners_;
  std::vector<Part> parts_;
  Division division_;

  // Of the triangle that is being divided.
  bool has_inside_ = false;
  std::array<Vector2d, 3> inward_ = {Vector2d::Zero(), Vector2d::Zero(), Vector2d::Zero()}; ///< normals of its edges
  std::array<double, 3> least_ = {}; ///< along them, for a hexagon that lies inside
  Vector3d origin_ = Vector3d::Zero();
  Vector2d origin_at_ = Vector2d::Zero();
  Vector2d slope_ = Vector2d::Zero();
  double radius_ = 0.0;
};

} // namespace

Division divide(const Mesh& mesh, const Chart& chart, std::vector<Vector3d>& corners)
{
  return ChartDivision(mesh, chart, corners)();
}

void halveUntilHeld(const Mesh& mesh, Piece piece, std::vector<Vector3d>& corners, std::vector<Patch>& patches)
{
  std::vector<Piece> left = {piece};
  while (!left.empty()) {
    const Piece whole = left.back();
    left.pop_back();
    Patch patch;
    patch.pieces = {whole};
    fitBall(corners, patch);
    if (patch.radius <= mesh.room) {
      patches.push_back(std::move(patch));
      continue;
    }
    std::size_t from = whole.first, to = whole.first;
    double longest = -1.0;
    for (std::size_t i = whole.first; i < whole.first + whole.count; ++i) {
      for (std::size_t j = whole.first; j < i; ++j) {
        const double squared = (corners[i] - corners[j]).squaredNorm();
        if (squared > longest) longest = squared, from = i, to = j;
      }
    }
    // Cut across the middle of the diagonal: which side a corner is on decides, so the halves share the cut exactly.
    const Vector3d direction = (corners[to] - corners[from]).normalized();
    const double middle = direction.dot(0.5 * (corners[from] + corners[to]));
    std::vector<Vector3d> near, far;
    for (std::size_t i = whole.first; i < whole.first + whole.count; ++i) {
      const std::size_t next = i + 1 < whole.first + whole.count ? i + 1 : whole.first;
      const double here = direction.dot(corners[i]) - middle, there = direction.dot(corners[next]) - middle;
      (here <= 0 ? near : far).push_back(corners[i]);
      if ((here <= 0) != (there <= 0)) {
        const Vector3d cut = corners[i] + here / (here - there) * (corners[next] - corners[i]);
        near.push_back(cut), far.push_back(cut);
      }
    }
    for (const std::vector<Vector3d>& half : {near, far}) {
      left.push_back({whole.triangle, static_cast<std::uint32_t>(half.size()), corners.size()});
      corners.insert(corners.end(), half.begin(), half.end());
    }
  }
}

} // namespace pcl_bsh::surface
