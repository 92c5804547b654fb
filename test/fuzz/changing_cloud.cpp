// SPDX-License-Identifier: BSD-3-Clause
#include "changing_cloud.h"

#include <pcl_bsh/hierarchy/update.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl_bsh::fuzz {
namespace {

using test::Random;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
Point3 plus(const Point3& p, const Point3& d)
{
  return {p[0] + d[0], p[1] + d[1], p[2] + d[2]};
}

float narrow(double value)
{
  if (std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
  if (std::abs(value) <= std::numeric_limits<float>::max()) return static_cast<float>(value);
  return std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(value > 0 ? 1 : -1));
}

/// One of the 24 turns of a cube onto itself, exactly.
Eigen::Matrix3d cubeTurn(Random& random)
{
  std::array<int, 3> axes = {0, 1, 2};
  for (int i = 2; i > 0; --i)
    std::swap(axes[static_cast<std::size_t>(i)], axes[static_cast<std::size_t>(random.integer(0, i))]);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) turn(row, axes[static_cast<std::size_t>(row)]) = random.chance(0.5) ? 1.0 : -1.0;
  if (turn.determinant() < 0) turn.row(0) *= -1.0;
  return turn;
}

} // namespace

World::World(Bytes& bytes, bool with_surfaces)
: kind(static_cast<Kind>(bytes.below(static_cast<unsigned>(Kind::kinds)))),
  surfaces(with_surfaces)
{
  constexpr double units[] = {1, 1, 1, 0x1p-10, 0x1p10, 0x1p100, 0x1p-100, 0x1p-130, 0x1p125, 0x1p1000, 0x1p-1000};
  unit = units[bytes.below(std::size(units))];
  if (surfaces && unit > 0x1p64) unit = 1; // triangles that a float32 radius does not tell are refused
}

std::string World::text() const
{
  return "world of kind " + std::to_string(static_cast<int>(kind)) + ", unit 2^" + std::to_string(std::ilogb(unit));
}

Point3 World::place(Random& random) const
{
  const auto onGrid = [&] { return unit / 8 * random.integer(-12, 12); };
  switch (kind) {
  case Kind::uniform:
    return random.point([&] { return unit * random.uniform(0, 2); });
  case Kind::line: {
    const double x = onGrid();
    return {x, 0.5 * x, -0.25 * x};
  }
  case Kind::few: {
    const double x = unit / 4 * random.integer(0, 2);
    return {x, unit - x, x};
  }
  case Kind::outlier:
    if (random.chance(0.02)) return {4096 * unit, 0, random.chance(0.5) ? 0 : -unit};
    return random.point([&] { return 1e-3 * unit * random.uniform(-1, 1); });
  case Kind::crowded:
    return random.point([&] { return unit + 1e-10 * unit * random.integer(0, 9); });
  case Kind::far:
    return random.point([&] { return unit * (500000.003 + 0.01 * random.integer(0, 99)); });
  default:
    return random.point(onGrid);
  }
}

double World::edge(Random& random) const
{
  constexpr double shares[] = {0, 0x1p-2, 0x1p-1, 1, 2, 0x1p-12};
  return unit * random.pick(shares);
}

Eigen::Isometry3d World::pose(Random& random) const
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const int turned = random.integer(0, 5);
  if (turned == 0) return pose;
  if (turned == 1) pose.linear() = cubeTurn(random);
  if (turned == 2) pose.linear() = random.rotation().toRotationMatrix();
  if (turned == 3) pose.linear() = random.rotation().toRotationMatrix().cast<float>().cast<double>();
  for (Eigen::Index k = 0; k < 3; ++k)
    pose.translation()[k] = random.chance(0.5) ? unit / 4 * random.integer(-6, 6) : unit * random.uniform(-1, 1);
  // Far clouds stay where they meet.
  const double middle = kind == Kind::far ? 500000.5 * unit : 0.0;
  const Eigen::Vector3d about = Eigen::Vector3d::Constant(middle);
  pose.translation() += about - pose.linear() * about;
  return pose;
}

ChangingCloud::Memory::~Memory()
{
  std::fill(bytes.begin(), bytes.end(), 0xff); // NaN
  std::fill(radii.begin(), radii.end(), std::numeric_limits<float>::quiet_NaN());
  std::fill(indices.begin(), indices.end(), -1);
  std::fill(triangles.begin(), triangles.end(), Triangle{~0u, ~0u, ~0u});
}

ChangingCloud::ChangingCloud(const World& world, Random& random)
: pose(world.pose(random)),
  world_(world),
  doubles_(world.unit > 0x1p126 || world.unit < 0x1p-140 || random.chance(0.5)),
  with_radii_(random.chance(0.3)),
  with_subset_(random.chance(0.2)),
  head_(random.chance(0.5) ? 0 : static_cast<std::size_t>(random.integer(0, 8))),
  tail_(random.chance(0.5) ? 0 : static_cast<std::size_t>(random.integer(0, 8)))
{
  constexpr int counts[] = {0, 1, 2, 7, 16, 17, 20, 33, 33, 50};
  int count = random.chance(0.03) ? 80 : random.pick(counts);
  for (int i = 0; i < count; ++i) append(placeOrNone(random), random);
  if (world.surfaces && random.chance(0.75)) {
    kind_ = random.chance(0.5) ? Kind::triangles : Kind::tetrahedra;
    with_radii_ = false;
    count = random.pick(counts);
    while (static_cast<int>(triangles_.size()) < count) appendTriangles(random);
    count = static_cast<int>(triangles_.size());
  }
  for (int i = 0; with_subset_ && i < count; ++i)
    if (random.chance(0.6)) indices_.push_back(random.chance(0.02) ? random.integer(0, count - 1) : count - 1 - i);
  store();
  hierarchy_ = std::make_shared<SphereHierarchy>(view(), options(random));
}

Point3 ChangingCloud::placeOrNone(Random& random) const
{
  Point3 p = world_.place(random);
  constexpr double bad[] = {nan, infinity, -infinity};
  if (random.chance(0.03)) p[static_cast<std::size_t>(random.integer(0, 2))] = random.pick(bad);
  return p;
}

void ChangingCloud::append(const Point3& point, Random& random)
{
  points_.push_back(point);
  radii_.push_back(narrow(random.chance(0.3) ? 0.0 : std::min(world_.unit / 16 * random.integer(0, 2), 0x1p127)));
}

/// A triangle of any corners, sometimes once more in either sense; or the four of a tetrahedron. Vertices exist
/// already, or are new.
void ChangingCloud::appendTriangles(Random& random)
{
  std::array<std::uint32_t, 4> corners;
  const bool of_new = points_.empty() || random.chance(0.2);
  for (std::uint32_t& corner : corners) {
    if (of_new) append(placeOrNone(random), random);
    corner = static_cast<std::uint32_t>(
        of_new ? points_.size() - 1
               : static_cast<std::size_t>(random.integer(0, static_cast<int>(points_.size()) - 1)));
  }
  const auto [a, b, c, d] = corners;
  if (kind_ == Kind::tetrahedra) {
    triangles_.insert(triangles_.end(), {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}});
    return;
  }
  triangles_.push_back({a, b, c});
  if (random.chance(0.1)) triangles_.push_back({a, b, c});
  if (random.chance(0.1)) triangles_.push_back({c, b, a});
  if (random.chance(0.05)) triangles_.insert(triangles_.end(), 20, {a, b, c});
}

ChangingCloud::Old ChangingCloud::store()
{
  auto memory = std::make_unique<Memory>();
  const std::size_t width = doubles_ ? sizeof(double) : sizeof(float);
  PointsView& view = memory->view;
  view.count = points_.size();
  view.stride = head_ + 3 * width + tail_;
  view.offset = {head_, head_ + width, head_ + 2 * width};
  view.scalar = doubles_ ? Scalar::float64 : Scalar::float32;
  memory->bytes.assign(std::max<std::size_t>(view.stride * view.count, 1), 0xee);
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      unsigned char* const to = memory->bytes.data() + i * view.stride + view.offset[k];
      const float single = narrow(points_[i][k]);
      if (doubles_)
        std::memcpy(to, &points_[i][k], sizeof(double));
      else
        std::memcpy(to, &single, sizeof single);
    }
  view.data = memory->bytes.data();
  memory->radii = radii_;
  memory->radii.push_back(0.0f);
  if (with_radii_) view.radii = memory->radii.data();
  memory->triangles = triangles_;
  memory->triangles.push_back({});
  if (isSurface()) view = viewOf(TrianglesView{view, memory->triangles.front().data(), triangles_.size()});
  memory->indices = indices_;
  memory->indices.push_back(0);
  if (with_subset_) view.indices = memory->indices.data();
  view.index_count = indices_.size();
  now_.swap(memory);
  return memory;
}

HierarchyOptions ChangingCloud::options(Random& random) const
{
  HierarchyOptions options;
  options.voxel_edge = world_.edge(random);
  options.fit = static_cast<SphereFit>(random.integer(0, 2));
  options.threads = static_cast<unsigned>(random.integer(1, 3));
  return options;
}

std::string ChangingCloud::text() const
{
  return std::to_string(view().count) +
         (kind_ == Kind::points      ? " points"
          : kind_ == Kind::triangles ? " triangles"
                                     : " triangles of tetrahedra") +
         (doubles_ ? ", doubles" : ", floats") + (with_radii_ ? ", radii" : "") + (with_subset_ ? ", subset" : "");
}

std::string ChangingCloud::buildAnew(Random& random)
{
  const Old before = store();
  *hierarchy_ = SphereHierarchy(view(), options(random));
  return "built anew, voxel edge " + std::to_string(hierarchy_->options().voxel_edge / world_.unit) + " units";
}

std::string ChangingCloud::buildSome(Random& random)
{
  hierarchy_->buildAll(static_cast<unsigned>(random.integer(1, 3)));
  return "all voxels built";
}

std::string ChangingCloud::moveObject(Random&)
{
  SphereHierarchy elsewhere(std::move(*hierarchy_));
  SphereHierarchy other(PointsView{});
  other = std::move(elsewhere);
  *hierarchy_ = std::move(other);
  return "hierarchy moved and moved back";
}

double ChangingCloud::growth(Random& random)
{
  constexpr double growths[] = {1.0, 1.5, 10.0, 1e300};
  return random.pick(growths);
}

std::string ChangingCloud::movePoints(Random& random)
{
  const double unit = world_.unit;
  const Point3 step = random.point([&] { return unit / 4 * random.integer(-4, 4); });
  const auto each = [&](const auto& move) {
    for (Point3& p : points_) move(p);
  };
  if (with_radii_ && random.chance(0.2))
    for (float& radius : radii_) radius = narrow(std::min(unit / 16 * random.integer(0, 2), 0x1p127));
  switch (random.integer(0, 10)) {
  case 0:
    each([&](Point3& p) { p = plus(p, step); });
    return "all points shifted by quarters of a unit";
  case 1:
    each([&](Point3& p) { p = plus(p, random.point([&] { return 1e-6 * unit * random.uniform(-1, 1); })); });
    return "all points moved by a millionth of a unit";
  case 2:
    each([&](Point3& p) { p = plus(p, random.point([&] { return unit / 8 * random.integer(-1, 1); })); });
    return "all points moved on the grid";
  case 3: {
    const double scale = random.chance(0.5) ? 2.0 : 0.5;
    each([&](Point3& p) { p = {scale * p[0], scale * p[1], scale * p[2]}; });
    return "all points scaled";
  }
  case 4:
    for (std::size_t i = points_.size(); i > 1; --i)
      std::swap(points_[i - 1], points_[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
    return "points change places";
  case 5: {
    const Point3 one = world_.place(random);
    each([&](Point3& p) { p = random.chance(0.8) ? one : p; });
    return "most points gather at one place";
  }
  case 6:
    if (!points_.empty()) points_.front() = {4096 * unit, random.chance(0.5) ? 0.0 : nan, 0};
    return "one point goes far away, or nowhere";
  case 7:
    each([&](Point3& p) { p = {-p[0], p[2], p[1]}; });
    return "all points mirrored";
  case 8:
    each([&](Point3& p) {
      if (!isFinite(p) || random.chance(0.1)) p = placeOrNone(random);
    });
    return "some points are replaced";
  case 9:
    each([&](Point3& p) {
      if (p[0] > unit / 2) p = plus(p, step);
    });
    return "a half of the points shifted by quarters of a unit";
  default:
    return "records moved in memory alone";
  }
}

std::string ChangingCloud::refit(Random& random)
{
  return deform(random, [&](const PointsView& now, double growth) { return hierarchy_->refit(now, growth); });
}

std::string ChangingCloud::update(Random& random)
{
  if (with_subset_) return "no update of a subset";
  if (isSurface()) return updateTriangles(random);
  std::vector<std::int32_t> records;
  const double share = random.chance(0.2) ? 1.0 : random.uniform(0, 0.3);
  const double beyond = world_.unit * random.uniform(-1, 2);
  const bool one_side = random.chance(0.5);
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (random.chance(share) && (!one_side || points_[i][0] > beyond)) records.push_back(static_cast<std::int32_t>(i));
  const int more = random.chance(0.5) ? random.integer(0, 20) : 0;
  for (int i = 0; i < more; ++i) records.push_back(static_cast<std::int32_t>(points_.size()) + i);
  std::reverse(records.begin(), records.end());
  HierarchyUpdate update(*hierarchy_, records.data(), records.size());
  const int kind = random.integer(0, 3);
  for (const std::int32_t record : records) {
    const auto i = static_cast<std::size_t>(record);
    if (i >= points_.size()) continue;
    if (kind == 0) points_[i] = {nan, 0, 0};
    if (kind == 1) points_[i] = placeOrNone(random);
    if (kind == 2) points_[i] = plus(points_[i], random.point([&] { return world_.unit / 8 * random.integer(-1, 1); }));
    if (random.chance(0.2)) radii_[i] = 0.0f;
  }
  for (int i = 0; i < more; ++i) append(placeOrNone(random), random);
  const Old before = store();
  const UpdateReport report = update.commit(view());
  return "update of " + std::to_string(records.size()) + " records, kind " + std::to_string(kind) +
         (report.sorted_anew ? ", sorted anew" : "");
}

/// Vertices move, and all triangles that name them change; some are of other corners, some are new.
std::string ChangingCloud::updateTriangles(Random& random)
{
  const std::size_t before = triangles_.size(), in_one = kind_ == Kind::tetrahedra ? 4 : 1;
  const double share = random.chance(0.2) ? 0.5 : random.uniform(0, 0.1);
  std::vector<Point3> moved = points_;
  std::vector<bool> moves(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    moves[i] = random.chance(share);
    if (moves[i]) moved[i] = placeOrNone(random);
  }
  std::vector<Triangle> others = triangles_;
  for (std::size_t i = 0; i < before; i += in_one) { // takes the place of another, or is turned over
    if (!random.chance(share)) continue;
    const auto other = in_one * static_cast<std::size_t>(random.integer(0, static_cast<int>(before / in_one) - 1));
    for (std::size_t k = i; k < std::min(i + in_one, before); ++k) {
      others[k] = triangles_[other + k - i];
      if (other == i) std::swap(others[k][0], others[k][1]);
    }
  }
  std::vector<std::int32_t> records;
  for (std::size_t i = 0; i < before; ++i) {
    const bool at_moved = std::any_of(others[i].begin(), others[i].end(), [&](auto corner) { return moves[corner]; }) ||
                          std::any_of(triangles_[i].begin(), triangles_[i].end(), [&](auto c) { return moves[c]; });
    if (at_moved || others[i] != triangles_[i] || random.chance(0.05)) records.push_back(static_cast<std::int32_t>(i));
  }
  triangles_ = std::move(others);
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (moves[i]) points_[i] = moved[i];
  for (int i = random.chance(0.5) ? random.integer(0, 5) : 0; i > 0; --i) appendTriangles(random);
  for (std::size_t i = before; i < triangles_.size(); ++i) records.push_back(static_cast<std::int32_t>(i));
  HierarchyUpdate update(*hierarchy_, records.data(), records.size()); // the memory is as it was
  const Old memory = store();
  const UpdateReport report = update.commit(view());
  return "update of " + std::to_string(records.size()) + " triangles" + (report.sorted_anew ? ", sorted anew" : "");
}

} // namespace pcl_bsh::fuzz
