// SPDX-License-Identifier: BSD-3-Clause
#include <examples/tunnel/tunnel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

namespace pcl_bsh::tunnel {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using std::numbers::pi;

constexpr double track_step = 0.1; // of the track's samples: a bend strays from its chord by 7 um there
constexpr double rise = 3.0;       // the track's highest place above its mean

/// A stretch of track whose curvature runs evenly from one value to another: a straight, a bend, or a clothoid.
struct Stretch {
  double length, from, to;
};

constexpr double tight = 1.0 / 175, medium = -1.0 / 210, wide = 1.0 / 450;
constexpr std::array<Stretch, 13> stretches = {{{120, 0, 0},
                                                {40, 0, tight},
                                                {120, tight, tight},
                                                {40, tight, 0},
                                                {160, 0, 0},
                                                {40, 0, medium},
                                                {160, medium, medium},
                                                {40, medium, 0},
                                                {120, 0, 0},
                                                {40, 0, wide},
                                                {120, wide, wide},
                                                {40, wide, 0},
                                                {104, 0, 0}}};

constexpr std::array<Stretch, 5> long_bend = {
    {{120, 0, 0}, {150, 0, 1.0 / 180}, {600, 1.0 / 180, 1.0 / 180}, {150, 1.0 / 180, 0}, {124, 0, 0}}};

/// The tunnel's cross-section: a flat floor, upright walls, an arch; and how rough and noisy the scan of it is.
struct Section {
  double half_width;
  double spring_level; ///< where the arch begins
  double arch_height;
  double rough; ///< share of roughness()
  bool lamps;

  double wallHeight() const { return spring_level - floor_level; }
  double archLength() const // half an ellipse, by Ramanujan
  {
    return pi / 2 *
           (3 * (half_width + arch_height) -
            std::sqrt((3 * half_width + arch_height) * (half_width + 3 * arch_height)));
  }
  double length() const { return 2 * half_width + 2 * wallHeight() + archLength(); }

  static constexpr double floor_level = -0.3;
};

constexpr Section winding_section = {1.76, 2.9, 1.9, 1.0, true};
constexpr Section tight_section = {1.923, 2.0, 2.626, 0.25, false}; // in the bend, 3 to 7 cm beside the upper edges
constexpr double tight_noise = 0.004;                               // standard deviation

// Lamps stand out from the walls, left and right in turn; every fifth reaches in too far.
constexpr double lamp_distance = 24.0;
constexpr double lamp_length = 1.2;
constexpr double lamp_low = 2.3, lamp_high = 2.5;
constexpr double lamp_reach = 0.12, bad_lamp_reach = 0.285;

/// The wagon's outline, left half, from the floor's edge to the middle of the roof; convex.
constexpr std::array<std::array<double, 2>, 5> outline = {
    {{1.2, 0.35}, {1.45, 0.9}, {1.45, 3.1}, {1.1, 3.8}, {0.0, 4.05}}};

/// The standard fixes this generator's numbers, not those of its distributions.
class Random {
public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }

private:
  std::mt19937_64 bits_;
};

double lampReach(double station, double side, double z)
{
  const double lamp = std::round(station / lamp_distance);
  const bool here = std::abs(station - lamp * lamp_distance) <= lamp_length / 2 && z >= lamp_low && z <= lamp_high;
  const auto number = static_cast<long>(lamp);
  if (!here || (number % 2 == 0) != (side > 0)) return 0;
  return number % 5 == 0 ? bad_lamp_reach : lamp_reach;
}

/// The roughness of sprayed concrete: up to 2 cm in or out.
double roughness(double station, double along)
{
  return 0.012 * std::sin(2 * pi * station / 7.3 + 1.3 * along) + 0.008 * std::sin(2 * pi * along / 1.1 + station);
}

/// A place on the tunnel's inside, by the way round its section, 0 .. section_length.
Vector2d onSection(const Section& section, double station, double along)
{
  const double bump = section.rough * roughness(station, along);
  if (along < 2 * section.half_width) return {along - section.half_width, Section::floor_level};
  along -= 2 * section.half_width;
  for (const double side : {1.0, -1.0}) {
    if (along < section.wallHeight()) {
      const double z = Section::floor_level + along;
      const double lamp = section.lamps ? lampReach(station, side, z) : 0.0;
      return {side * (section.half_width - bump - lamp), z};
    }
    along -= section.wallHeight();
  }
  const double angle = pi * along / section.archLength();
  return {(section.half_width - bump) * std::cos(angle),
          section.spring_level + (section.arch_height - bump) * std::sin(angle)};
}

/// The whole outline, once round: the left half, then its mirror image from the roof down, then the floor.
std::vector<Vector2d> wholeOutline()
{
  std::vector<Vector2d> corners;
  for (const auto& corner : outline) corners.emplace_back(corner[0], corner[1]);
  for (std::size_t i = outline.size() - 1; i-- > 0;) corners.emplace_back(-outline[i][0], outline[i][1]);
  return corners;
}

double lengthOf(const std::vector<Vector2d>& ring)
{
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return sum;
}

double areaOf(const std::vector<Vector2d>& ring)
{
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &p = ring[i], &q = ring[(i + 1) % ring.size()];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return std::abs(twice) / 2;
}

Vector2d alongRing(const std::vector<Vector2d>& ring, double along)
{
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d edge = ring[(i + 1) % ring.size()] - ring[i];
    if (along <= edge.norm()) return ring[i] + edge.normalized() * along;
    along -= edge.norm();
  }
  return ring.front();
}

/// How a scanner that turns as it travels sees a tube: calls take(way along, way round) for `count` places, as far
/// apart one way as the other.
template <typename Take>
void sweepTube(std::size_t count, double length, double round, Random& random, const Take& take)
{
  const double per_turn = std::max(1.0, std::round(std::sqrt(static_cast<double>(count) * round / length)));
  for (std::size_t i = 0; i < count; ++i) {
    const double place = static_cast<double>(i) + random.uniform(0.1, 0.9);
    take(length * place / static_cast<double>(count), round * (place / per_turn - std::floor(place / per_turn)));
  }
}

/// Evenly distributed, or of a standard deviation and no more than three of it.
Vector3d noiseOf(Course course, Random& random)
{
  Vector3d noise = Vector3d::Zero();
  for (double& n : noise) {
    if (course == Course::winding)
      n = random.uniform(-0.003, 0.003);
    else
      for (int i = 0; i < 3; ++i) n += random.uniform(-tight_noise, tight_noise);
  }
  return noise;
}

void shuffle(std::vector<Eigen::Vector3f>& points, Random& random)
{
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
}

/// Calls take(point) for the scan's points as the scanner travels.
template <typename Take>
void sweepTunnel(const Track& track, std::size_t count, Course course, Random& random, const Take& take)
{
  const Section& section = course == Course::winding ? winding_section : tight_section;
  sweepTube(count, track_length, section.length(), random, [&](double station, double along) {
    const Vector2d place = onSection(section, station, along);
    const Vector3d noise = noiseOf(course, random);
    take(Eigen::Vector3f((track.at(station) * Vector3d(0, place.x(), place.y()) + noise).cast<float>()));
  });
}

std::vector<Eigen::Vector3f> scanTunnel(const Track& track, std::size_t count, Course course)
{
  Random random(1);
  std::vector<Eigen::Vector3f> points;
  points.reserve(count);
  sweepTunnel(track, count, course, random, [&](const Eigen::Vector3f& point) { points.push_back(point); });
  if (course == Course::tight) shuffle(points, random);
  return points;
}

std::vector<Eigen::Vector3f> scanWagon(std::size_t count, Course course)
{
  Random random(2);
  const std::vector<Vector2d> ring = wholeOutline();
  const double round = lengthOf(ring), end_area = areaOf(ring);
  const auto share = end_area / (2 * end_area + wagon_length * round);
  const auto at_end = static_cast<std::size_t>(share * static_cast<double>(count));
  std::vector<Eigen::Vector3f> points;
  points.reserve(count);
  sweepTube(count - 2 * at_end, wagon_length, round, random, [&](double along, double way_round) {
    const Vector2d place = alongRing(ring, way_round);
    points.emplace_back(Vector3d(along - wagon_length / 2, place.x(), place.y()).cast<float>());
  });
  while (points.size() < count) {
    const double end = points.size() % 2 == 0 ? wagon_length / 2 : -wagon_length / 2;
    const double y = random.uniform(-1.45, 1.45), z = random.uniform(0.35, 4.05);
    if (distanceToWagonOutline(y, z) == 0) points.emplace_back(Vector3d(end, y, z).cast<float>());
  }
  if (course == Course::winding) return points;
  for (Eigen::Vector3f& p : points) p += noiseOf(course, random).cast<float>();
  shuffle(points, random);
  return points;
}

} // namespace

double Track::curvature(double station, Course course)
{
  const Stretch* stretch = course == Course::winding ? stretches.data() : long_bend.data();
  const Stretch* end = stretch + (course == Course::winding ? stretches.size() : long_bend.size());
  for (; stretch != end; station -= stretch->length, ++stretch)
    if (station < stretch->length) return stretch->from + (stretch->to - stretch->from) * station / stretch->length;
  return 0;
}

Track::Track(Course course)
{
  Sample sample{0, 0, 0};
  const auto steps = static_cast<std::size_t>(std::lround(track_length / track_step));
  for (std::size_t i = 0; i <= steps; ++i) {
    samples_.push_back(sample);
    const double middle = (static_cast<double>(i) + 0.5) * track_step;
    const double turn = curvature(middle, course) * track_step;
    sample.x += track_step * std::cos(sample.heading + turn / 2);
    sample.y += track_step * std::sin(sample.heading + turn / 2);
    sample.heading += turn;
  }
}

Eigen::Isometry3d Track::at(double station) const
{
  const double place = std::clamp(station, 0.0, track_length) / track_step;
  const auto i = std::min(static_cast<std::size_t>(place), samples_.size() - 2);
  const double f = place - static_cast<double>(i);
  const Sample &p = samples_[i], &q = samples_[i + 1];
  const double phase = 2 * pi * station / track_length;
  const double heading = p.heading + f * (q.heading - p.heading);
  const double slope = rise * 2 * pi / track_length * std::cos(phase);
  Eigen::Isometry3d pose(Eigen::AngleAxisd(heading, Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(-std::atan(slope), Vector3d::UnitY()));
  pose.translation() = Vector3d(p.x + f * (q.x - p.x), p.y + f * (q.y - p.y), rise * std::sin(phase));
  return pose;
}

Eigen::Isometry3d Track::wagonAt(double station) const
{
  const Vector3d rear = at(station - pivot_distance / 2).translation();
  const Vector3d front = at(station + pivot_distance / 2).translation();
  const Vector3d x = (front - rear).normalized();
  const Vector3d y = Vector3d::UnitZ().cross(x).normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, y, x.cross(y);
  pose.translation() = (rear + front) / 2;
  return pose;
}

Size Size::atScale(double scale)
{
  if (!(scale > 0 && scale <= 100)) {
    throw std::invalid_argument("scale: " + std::to_string(scale) + ": give a number above 0, 100 at most");
  }
  const auto scaled = [](double count, double by) { return static_cast<std::size_t>(std::max(1.0, count * by)); };
  const double of_wagon = std::min(scale, 1.0);
  return {scaled(18.92e6, scale), scaled(2.5e6, of_wagon), scaled(19392, of_wagon)};
}

void forEachScanPoint(std::size_t count, const std::function<void(const Eigen::Vector3f&)>& take)
{
  Random random(1);
  sweepTunnel(Track(), count, Course::winding, random, take);
}

Passage makePassage(const Size& size, Course course)
{
  const Track track(course);
  Passage run{scanTunnel(track, size.scan, course), scanWagon(size.wagon, course), {}};
  // From the portal, just inside, to the other.
  const double first = wagon_length / 2, last = track_length - wagon_length / 2;
  for (std::size_t i = 0; i < size.poses; ++i) {
    const double f = size.poses > 1 ? static_cast<double>(i) / static_cast<double>(size.poses - 1) : 0.5;
    run.poses.push_back(track.wagonAt(first + f * (last - first)));
  }
  return run;
}

double distanceToWagonOutline(double y, double z)
{
  const std::vector<Vector2d> ring = wholeOutline();
  const Vector2d place(y, z);
  double nearest = 1e300;
  bool inside = true;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d edge = ring[(i + 1) % ring.size()] - ring[i], to_place = place - ring[i];
    inside = inside && edge.x() * to_place.y() - edge.y() * to_place.x() >= 0;
    const double f = std::clamp(to_place.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (to_place - f * edge).norm());
  }
  return inside ? 0 : nearest;
}

} // namespace pcl_bsh::tunnel
