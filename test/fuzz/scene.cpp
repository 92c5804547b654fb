// SPDX-License-Identifier: BSD-3-Clause
#include "scene.h"

#include "target.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/query/record_distance.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace pcl_bsh::fuzz {
namespace {

/// Numbers that have broken programs before.
constexpr double troubles[] = {0.0,        -0.0,
                               1.0,        0x1p-10,
                               0.1,        1000.0,
                               500000.003, 5400000.26,
                               16777216.0, 16777217.0,
                               1e30,       -1e30,
                               3e38,       -3e38,
                               3.5e38,     1e-40,
                               3e-45,      1e-23,
                               1.7e308,    -1.7e308,
                               5e-324,     0x1p-500,
                               0x1p500,    infinity,
                               -infinity,  std::numeric_limits<double>::quiet_NaN()};

/// How a cloud's coordinates are made of bytes.
enum class Kind : std::uint8_t { grid, fine_grid, far_grid, trouble, single, any };

double coordinate(Bytes& bytes, Kind kind)
{
  switch (kind) {
  case Kind::grid:
    return bytes.take<std::int8_t>() / 8.0;
  case Kind::fine_grid:
    return bytes.take<std::int16_t>() * 0.01;
  case Kind::far_grid:
    return 500000.003 + bytes.take<std::int8_t>() * 0.01;
  case Kind::trouble:
    return troubles[bytes.below(std::size(troubles))];
  case Kind::single:
    return bytes.take<float>();
  case Kind::any:
    break;
  }
  return bytes.take<double>();
}

Kind anyKind(Bytes& bytes)
{
  return static_cast<Kind>(bytes.below(6));
}

float narrowed(double value)
{
  if (std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
  if (std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())) return static_cast<float>(value);
  return value > 0 ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity();
}

bool finite(const Point3& p)
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

} // namespace

FuzzedCloud::FuzzedCloud(Bytes& bytes, unsigned most_repeats)
{
  const auto flags = bytes.take<std::uint8_t>();
  const Kind kind = anyKind(bytes);
  const std::size_t distinct = bytes.below(25), repeats = 1 + bytes.below(most_repeats);
  const std::size_t head = bytes.below(9), tail = bytes.below(9);
  const bool doubles = (flags & 1) != 0;
  const std::size_t width = doubles ? sizeof(double) : sizeof(float);
  layout_.scalar = doubles ? Scalar::float64 : Scalar::float32;
  layout_.count = distinct * repeats;
  layout_.stride = head + 3 * width + tail;
  layout_.offset = {head, head + width, head + 2 * width};

  Point3 step = {0, 0, 0};
  if ((flags & 2) != 0)
    for (double& x : step) x = bytes.take<std::int8_t>() / 16.0;
  std::vector<Point3> points(distinct);
  for (Point3& p : points)
    for (double& x : p) x = coordinate(bytes, kind);
  records_.assign(layout_.stride * layout_.count, 0xee);
  for (std::size_t i = 0; i < layout_.count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint8_t* to = records_.data() + i * layout_.stride + layout_.offset[k];
      const double value = points[i % distinct][k] + static_cast<double>(i / distinct) * step[k];
      const float narrow = narrowed(value);
      if (doubles)
        std::memcpy(to, &value, sizeof value);
      else
        std::memcpy(to, &narrow, sizeof narrow);
    }
  }

  subset_ = (flags & 4) != 0;
  if (subset_) {
    indices_.resize(bytes.below(64));
    const bool inside = (flags & 8) == 0 && layout_.count > 0;
    for (std::int32_t& index : indices_)
      index = inside ? static_cast<std::int32_t>(bytes.below(255) % layout_.count) : bytes.take<std::int8_t>();
  }
  if ((flags & 16) != 0) {
    radii_.resize(layout_.count);
    for (float& radius : radii_)
      radius = (flags & 32) != 0 ? bytes.take<float>() : static_cast<float>(bytes.below(9)) / 8;
  }

  options_.fit = static_cast<SphereFit>(bytes.below(3));
  options_.threads = 1 + bytes.below(2);
  constexpr double edges[] = {0.0, 0.0, 0.25, 1.0, 0x1p-20, 1e30};
  const unsigned edge = bytes.below(std::size(edges) + 1);
  options_.voxel_edge = edge < std::size(edges) ? edges[edge] : bytes.take<double>();
}

PointsView FuzzedCloud::view() const
{
  PointsView view = layout_;
  view.data = records_.data();
  static constexpr std::int32_t none = 0;
  if (subset_) view.indices = indices_.empty() ? &none : indices_.data();
  view.index_count = indices_.size();
  if (!radii_.empty()) view.radii = radii_.data();
  return view;
}

bool FuzzedCloud::sensible() const
{
  const auto inside = [&](std::int32_t index) { return index >= 0 && static_cast<std::size_t>(index) < layout_.count; };
  const auto length = [](double x) { return std::isfinite(x) && x >= 0.0; };
  return std::all_of(indices_.begin(), indices_.end(), inside) && std::all_of(radii_.begin(), radii_.end(), length) &&
         length(options_.voxel_edge);
}

std::optional<SphereHierarchy> FuzzedCloud::hierarchy() const
{
  std::optional<SphereHierarchy> built;
  try {
    built.emplace(view(), options_);
  }
  catch (const std::invalid_argument&) {
    require(!sensible(), "a sensible cloud was refused");
    return std::nullopt;
  }
  require(sensible(), "a cloud that makes no sense was accepted");
  return built;
}

std::optional<SphereHierarchy> FuzzedCloud::hierarchy(const Uncertainty& uncertainty) const
{
  try {
    return SphereHierarchy(withUncertainty(view(), {}, "cloud", uncertainty), options_);
  }
  catch (const std::invalid_argument&) { // what is too large for a float
    return std::nullopt;
  }
}

FuzzedMesh::FuzzedMesh(Bytes& bytes)
{
  const auto flags = bytes.take<std::uint8_t>();
  const Kind kind = anyKind(bytes);
  of_floats_ = (flags & 1) != 0;
  doubles_.resize(3 * bytes.below(17));
  for (double& x : doubles_) x = coordinate(bytes, kind);
  for (const double x : doubles_) floats_.push_back(narrowed(x));
  const auto vertices = static_cast<unsigned>(doubles_.size() / 3);
  const bool closed = (flags & 6) == 2, wrong = (flags & 0xf8) == 0;
  const auto corner = [&]() -> std::uint32_t {
    return wrong ? bytes.take<std::uint8_t>() : bytes.below(std::max(vertices, 1u));
  };
  for (unsigned i = bytes.below(closed ? 7 : 25); i > 0 && vertices > 0; --i) {
    const std::uint32_t a = corner(), b = corner(), c = corner();
    corners_.insert(corners_.end(), {a, b, c});
    if (!closed) continue;
    const std::uint32_t d = corner();
    corners_.insert(corners_.end(), {a, d, b, b, d, c, c, d, a});
  }
  options_.fit = static_cast<SphereFit>(bytes.below(3));
  options_.threads = 1 + bytes.below(2);
}

TrianglesView FuzzedMesh::triangles() const
{
  static constexpr std::uint32_t none = 0;
  return {of_floats_ ? viewOf(floats_.data(), floats_.size() / 3) : viewOf(doubles_.data(), doubles_.size() / 3),
          corners_.empty() ? &none : corners_.data(), corners_.size() / 3};
}

std::optional<SphereHierarchy> FuzzedMesh::hierarchy() const
{
  const TrianglesView view = triangles();
  const auto named = [&](std::uint32_t corner) { return corner < view.vertices.count; };
  const bool sensible = std::all_of(corners_.begin(), corners_.end(), named);
  const auto large = [](double x) { return std::isfinite(x) && std::abs(x) > 1e37; }; // radii may be no floats
  const bool may_be_large = std::any_of(doubles_.begin(), doubles_.end(), large);
  std::optional<SphereHierarchy> built;
  try {
    built.emplace(viewOf(view), options_);
  }
  catch (const std::invalid_argument&) {
    require(!sensible || may_be_large, "a sensible mesh was refused");
    return std::nullopt;
  }
  require(sensible, "a mesh that makes no sense was accepted");
  return built;
}

Uncertainty anyUncertainty(Bytes& bytes, double clearance)
{
  const auto length = [&] {
    const unsigned kind = bytes.below(8);
    if (kind == 0) return bytes.take<double>();
    return kind < 4 ? 0.0 : clearance * bytes.below(32) / 16;
  };
  Uncertainty uncertainty(length());
  uncertainty.pose.length = length();
  uncertainty.pose.angle = bytes.below(4) == 0 ? bytes.below(64) / 16.0 : 0.0;
  for (double& x : uncertainty.pose.about) x = static_cast<double>(bytes.take<std::int8_t>());
  return uncertainty;
}

Eigen::Isometry3d anyPose(Bytes& bytes)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const unsigned mode = bytes.below(8);
  if (mode == 0) return pose;
  const Kind kind = anyKind(bytes);
  if (mode == 1) { // anything, almost never a pose
    for (Eigen::Index i = 0; i < 16; ++i) pose.matrix()(i / 4, i % 4) = coordinate(bytes, kind);
    return pose;
  }
  for (Eigen::Index k = 0; k < 3; ++k) pose.translation()[k] = coordinate(bytes, kind);
  if (mode == 2) return pose;
  const auto component = [&] { return static_cast<double>(bytes.take<std::int8_t>()); };
  Eigen::Quaterniond turn(component(), component(), component(), component());
  if (turn.norm() > 0) pose.linear() = turn.normalized().toRotationMatrix();
  if (mode == 3) pose.linear() *= 1.0 + 1e-8 * component();                           // rigid within tolerance
  if (mode == 4) pose.linear()(bytes.below(3), bytes.below(3)) += 1e-7 * component(); // or just beyond it
  if (mode == 5) pose.linear() = pose.linear().cast<float>().cast<double>().eval();   // once kept in float
  return pose;
}

double anyClearance(Bytes& bytes, const Placed& a, const Placed& b)
{
  const unsigned mode = bytes.below(8);
  if (mode == 0) return 0.0;
  if (mode == 1) return bytes.take<double>();
  if (mode == 2) return troubles[bytes.below(std::size(troubles))];
  if (mode == 3) return bytes.below(256) / 16.0;
  const PointsView &p = a.hierarchy().view(), &q = b.hierarchy().view();
  const bool usable = p.size() > 0 && q.size() > 0 && a.pose.matrix().allFinite() && b.pose.matrix().allFinite();
  const unsigned i = bytes.take<std::uint8_t>(), j = bytes.take<std::uint8_t>();
  if (!usable) return 1.0;
  const std::uint32_t record_p = p.record(i % p.size()), record_q = q.record(j % q.size());
  if (!finite(p.point(record_p)) || !finite(q.point(record_q))) return 1.0;
  const DefaultFloatEnvironment environment;
  const RecordDistance distance(p, a.pose, q, b.pose);
  const double tie =
      std::max(0.0, distance.ofTriangles() ? distance.gap(PointPair{record_p, record_q})
                                           : ExactDistance(a.pose, b.pose).gap({p.point(record_p), q.point(record_q)}));
  if (!std::isfinite(tie)) return std::numeric_limits<double>::max();
  return mode == 4 ? std::nextafter(tie, 0.0) : mode == 5 ? std::nextafter(tie, infinity) : tie;
}

} // namespace pcl_bsh::fuzz
