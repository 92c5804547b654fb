// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces.h"

#include "statue.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcl_bsh::bench {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Eigen::Vector3d vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// Rings of `columns` vertices, each joined to the next one; closed at both ends by fans about two places.
template <class Place>
TestMesh ringsMesh(std::uint32_t columns, std::uint32_t rings, const Point3& first_end, const Point3& last_end,
                   const Place& place)
{
  TestMesh mesh;
  for (std::uint32_t j = 0; j < rings; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) mesh.vertices.push_back(place(i, j));
  mesh.vertices.push_back(first_end);
  mesh.vertices.push_back(last_end);
  for (std::uint32_t i = 0; i < columns; ++i) {
    const std::uint32_t next = (i + 1) % columns;
    for (std::uint32_t j = 0; j + 1 < rings; ++j) {
      const std::uint32_t a = j * columns + i, b = j * columns + next, c = a + columns, d = b + columns;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
    mesh.triangles.push_back({next, i, rings * columns});
    mesh.triangles.push_back({(rings - 1) * columns + i, (rings - 1) * columns + next, rings * columns + 1});
  }
  return mesh;
}

void append(TestMesh& mesh, const TestMesh& other)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// About an axis along `way` from `from`: its vertex at this turn and height.
struct Axis {
  Axis(const Eigen::Vector3d& begin, const Eigen::Vector3d& way) : from(begin), along(way)
  {
    u = along.unitOrthogonal();
    v = along.normalized().cross(u);
  }
  Point3 at(double turn, double height, double radius) const
  {
    const Eigen::Vector3d p = from + height * along + radius * (std::cos(turn) * u + std::sin(turn) * v);
    return {p.x(), p.y(), p.z()};
  }
  Eigen::Vector3d from, along, u, v;
};

} // namespace

TestMesh machinedPart()
{
  constexpr std::uint32_t kColumns = 300, kRings = 110;
  return ringsMesh(kColumns, kRings, {0, 0, 0}, {0, 0, 1}, [](std::uint32_t i, std::uint32_t j) -> Point3 {
    const double turn = kTurn * i / kColumns, height = j / (kRings - 1.0);
    const double radius = 0.1 + 0.02 * std::sin(4 * turn + 4 * height);
    return {radius * std::cos(turn), radius * std::sin(turn), height};
  });
}

TestMesh bumpySurface()
{
  constexpr std::uint32_t kColumns = 1000, kRings = 500;
  return ringsMesh(kColumns, kRings, {0, 0, -0.5}, {0, 0, 0.5}, [](std::uint32_t i, std::uint32_t j) -> Point3 {
    const double turn = kTurn * i / kColumns, tilt = std::numbers::pi * ((j + 1.0) / (kRings + 1.0) - 0.5);
    const double bump = 0.04 * std::sin(7 * turn) * std::cos(5 * tilt) +
                        0.01 * std::sin(41 * turn + 3) * std::sin(37 * tilt) +
                        0.002 * std::sin(173 * turn) * std::cos(151 * tilt);
    const double radius = 0.5 + bump * std::cos(tilt);
    return {radius * std::cos(tilt) * std::cos(turn), radius * std::cos(tilt) * std::sin(turn),
            radius * std::sin(tilt)};
  });
}

TestMesh thinTubes()
{
  constexpr std::uint32_t kSides = 10, kTubes = 1250; // of 40 triangles
  test::Random random(11);
  TestMesh mesh;
  for (std::uint32_t k = 0; k < kTubes; ++k) {
    Eigen::Vector3d way;
    do way = vectorOf(random.point([&] { return random.uniform(-1, 1); }));
    while (way.norm() > 1.0 || way.norm() < 0.1);
    const Axis axis(vectorOf(random.point([&] { return random.uniform(-0.5, 0.5); })) - 0.5 * way.normalized(),
                    way.normalized());
    const auto end = [&](double height) { return axis.at(0.0, height, 0.0); };
    append(mesh, ringsMesh(kSides, 2, end(0.0), end(1.0),
                           [&](std::uint32_t i, std::uint32_t j) { return axis.at(kTurn * i / kSides, j, 2e-4); }));
  }
  return mesh;
}

TestMesh statueMesh()
{
  constexpr std::uint32_t kColumns = 500, kRings = 250;
  const auto place = [](const Point3& direction) {
    const auto at = onStatue(direction, 3);
    return Point3{0.5 * at[0], 0.5 * at[1], 0.5 * at[2]};
  };
  return ringsMesh(kColumns, kRings, place({0, 0, -1}), place({0, 0, 1}), [&](std::uint32_t i, std::uint32_t j) {
    const double turn = kTurn * i / kColumns, tilt = std::numbers::pi * ((j + 1.0) / (kRings + 1.0) - 0.5);
    return place({std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn), std::sin(tilt)});
  });
}

TestMesh connectingRod()
{
  // An outline of two eyes and the shank between them; fillets lead from its upright side to both flat sides, which are
  // strips from one side of the outline to the other.
  constexpr std::uint32_t kHalf = 179, kColumns = 2 * kHalf, kFillet = 4, kRings = 2 * (kFillet + 1) - 1;
  constexpr double kRadius = 0.02, kThickness = 0.12;
  const auto outline =
      [](std::uint32_t i) -> Eigen::Vector2d { // from the tip of the small eye along one side to that of the large
    const bool back = i > kHalf;
    const double s = static_cast<double>(back ? kColumns - i : i) / kHalf;
    const double x = 0.5 - 0.5 * std::cos(std::numbers::pi * s);
    const double small = 0.07 * 0.07 - (x - 0.07) * (x - 0.07), large = 0.16 * 0.16 - (x - 0.84) * (x - 0.84);
    const double shank = x > 0.07 && x < 0.9 ? 0.045 + 0.03 * x : 0.0;
    const double y = std::max({small > 0.0 ? std::sqrt(small) : 0.0, large > 0.0 ? std::sqrt(large) : 0.0, shank});
    return {x, back ? -y : y};
  };
  TestMesh mesh;
  const Eigen::Vector2d middle(0.5, 0.0);
  for (std::uint32_t j = 0; j < kRings; ++j) {
    const bool upper = j > kFillet;
    const double step = upper ? j - kFillet : kFillet - j; // 0 at half height
    const double tilt = step / kFillet * std::numbers::pi / 2;
    const double height =
        (upper ? 1.0 : -1.0) * (step == 0.0 ? 0.0 : kThickness / 2 - kRadius + kRadius * std::sin(tilt));
    for (std::uint32_t i = 0; i < kColumns; ++i) {
      const Eigen::Vector2d p = outline(i), inward(0.0, p.y() > 0.0 ? -1.0 : 1.0);
      const double in = std::min(kRadius * (1.0 - std::cos(tilt)), 0.9 * std::abs(p.y()));
      const Eigen::Vector2d at = p + in * inward;
      mesh.vertices.push_back({at.x(), at.y(), height});
    }
  }
  for (std::uint32_t i = 0; i < kColumns; ++i) {
    const std::uint32_t next = (i + 1) % kColumns;
    for (std::uint32_t j = 0; j + 1 < kRings; ++j) {
      const std::uint32_t a = j * kColumns + i, b = j * kColumns + next, c = a + kColumns, d = b + kColumns;
      mesh.triangles.push_back({a, d, b});
      mesh.triangles.push_back({a, c, d});
    }
  }
  for (const bool upper : {false, true}) { // 2 kHalf - 2 triangles each
    const std::uint32_t first = upper ? (kRings - 1) * kColumns : 0;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back({first + a, first + (upper ? c : b), first + (upper ? b : c)});
    };
    for (std::uint32_t i = 0; i < kHalf; ++i) {
      const std::uint32_t left = i == 0 ? 0 : kColumns - i, next_left = kColumns - i - 1;
      if (i > 0) add(left, i, i + 1);
      if (i + 1 < kHalf) add(left, i + 1, next_left);
    }
  }
  return mesh;
}

TestMesh knottedTube()
{
  constexpr std::uint32_t kAlong = 1200, kAround = 20;
  const auto place = [](double t) -> Eigen::Vector3d { // a trefoil
    return Eigen::Vector3d(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)) / 6;
  };
  TestMesh mesh;
  for (std::uint32_t i = 0; i < kAlong; ++i) {
    const double t = kTurn * i / kAlong, dt = 1e-4;
    const Eigen::Vector3d way = (place(t + dt) - place(t - dt)).normalized();
    const Eigen::Vector3d out = Eigen::Vector3d(place(t) - way * way.dot(place(t))).normalized(), up = way.cross(out);
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const double turn = kTurn * j / kAround;
      const Eigen::Vector3d p = place(t) + 0.06 * (std::cos(turn) * out + std::sin(turn) * up);
      mesh.vertices.push_back({p.x(), p.y(), p.z()});
    }
  }
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t next_i = (i + 1) % kAlong, next_j = (j + 1) % kAround;
      const std::uint32_t a = i * kAround + j, b = i * kAround + next_j, c = next_i * kAround + j,
                          d = next_i * kAround + next_j;
      mesh.triangles.push_back({a, d, b});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

double sizeOf(const TestMesh& mesh)
{
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                                                 [&](const Point3& p, const Point3& q) { return p[k] < q[k]; });
    longest = std::max(longest, (*high)[k] - (*low)[k]);
  }
  return longest;
}

std::vector<double> scanOf(const TestMesh& mesh, std::size_t count, double noise, std::uint64_t seed)
{
  test::Random random(seed);
  Point3 low = mesh.vertices[0], high = low;
  for (const Point3& p : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  std::vector<double> area(mesh.triangles.size()); // summed up, so that points spread evenly
  double sum = 0.0;
  for (std::size_t i = 0; i < area.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Eigen::Vector3d a = vectorOf(mesh.vertices[t[0]]), b = vectorOf(mesh.vertices[t[1]]);
    area[i] = sum += (b - a).cross(vectorOf(mesh.vertices[t[2]]) - a).norm();
  }
  std::vector<double> scan;
  scan.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto found = std::lower_bound(area.begin(), area.end() - 1, random.uniform(0, sum));
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(found - area.begin())];
    const double u = random.uniform(0, 1), v = random.uniform(0, 1);
    const double of_b = u + v > 1 ? 1 - u : u, of_c = u + v > 1 ? 1 - v : v;
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = mesh.vertices[t[0]][k], b = mesh.vertices[t[1]][k], c = mesh.vertices[t[2]][k];
      const double on = a + of_b * (b - a) + of_c * (c - a) + random.uniform(-noise, noise);
      scan.push_back(i % 2 == 0 ? on : random.uniform(low[k], high[k]));
    }
  }
  return scan;
}

} // namespace pcl_bsh::bench
