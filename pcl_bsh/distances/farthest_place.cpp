// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/farthest_place.h>

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/nearest_point.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kBoundless = std::numeric_limits<double>::infinity();
constexpr std::size_t kTogether = 4096;   ///< pieces that are divided before their places are measured
constexpr std::size_t kOfTask = 64;       ///< pieces
constexpr double kOfSide = 0.5773502692;  ///< the nearest corner of a place is within this share of the longest side
constexpr double kOfPlace = 16 * 0x1p-53; ///< share of the largest coordinate that bounds five roundings of a place
constexpr double kNearEnd = 0x1p-10;      ///< shares of a side nearer to an end are no cut

/// Returns an upper bound of x + y.
double sumAbove(double x, double y)
{
  return std::nextafter(x + y, kBoundless);
}

template <class Visit>
void eachPlace(const PointsView& view, const Visit& visit)
{
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    if (!view.triangles) {
      const Point3 p = view.point(record);
      if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) visit(p);
    }
    else if (const std::array<Point3, 3> triangle = view.triangles->triangle(record); isFinite(triangle)) {
      for (const Point3& corner : triangle) visit(corner);
    }
  }
}

} // namespace

double diagonalOf(const PointsView& view)
{
  Point3 low{kBoundless, kBoundless, kBoundless}, high{-kBoundless, -kBoundless, -kBoundless};
  eachPlace(view, [&](const Point3& p) {
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  });
  return low[0] > high[0] ? 0.0 : std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

bool FarthestPlace::precedes(const Piece& one, const Piece& other)
{
  if (one.upper != other.upper) return one.upper < other.upper;
  if (one.record != other.record) return one.record > other.record;
  return one.corners > other.corners;
}

FarthestPlace::FarthestPlace(const Placed& a, const Placed& b, double tolerance, unsigned threads, Work& work)
: a_(a),
  b_(b),
  tolerance_(tolerance),
  threads_(threads),
  work_(work),
  in_b_(b.pose.inverse() * a.pose),
  settled_(-kBoundless),
  lower_(-kBoundless),
  farthest_distance_(-kBoundless)
{
  a.hierarchy().view().triangles ? addTriangles() : measureRecords();
}

/// Measures all points of a; nothing else is to be done for points.
void FarthestPlace::measureRecords()
{
  PointDistancesRequest request;
  request.threads = threads_;
  const PointDistances found = pointDistances(a_, b_, request);
  work_ += found.work;
  if (!found.greatest_pair) return;
  note(found.greatest, 0.0, *found.greatest_pair);
  settled_ = std::nextafter(found.greatest, kBoundless);
}

void FarthestPlace::addTriangles()
{
  const PointsView& view = a_.hierarchy().view();
  const TrianglesView& triangles = *view.triangles;
  std::vector<std::uint32_t> place_of(triangles.vertices.count, kNothing);
  std::vector<Piece> pieces;
  pieces.reserve(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    if (!isFinite(triangles.triangle(record))) continue;
    Piece piece{0.0, record, 0, triangles.cornersOf(record)};
    for (std::uint32_t& corner : piece.corners) {
      std::uint32_t& place = place_of[corner];
      if (place == kNothing) {
        place = static_cast<std::uint32_t>(places_.size());
        places_.push_back(triangles.vertices.point(corner));
        error_.push_back(0.0);
        record_.push_back(record);
        for (const double x : places_.back()) largest_ = std::max(largest_, std::abs(x));
      }
      corner = place;
    }
    pieces.push_back(piece);
  }
  measure(0);
  keep(pieces, lower_);
}

PointsView FarthestPlace::viewOfPlaces(std::size_t from) const
{
  return viewOf(places_[from].data(), places_.size() - from, sizeof(Point3));
}

/// Measures all places from number `from` on.
void FarthestPlace::measure(std::size_t from)
{
  if (from == places_.size()) return;
  PointDistancesRequest request;
  request.threads = threads_;
  const SphereHierarchy cloud(viewOfPlaces(from));
  const PointDistances found = pointDistances({cloud, a_.pose}, b_, request);
  work_ += found.work;
  distance_.insert(distance_.end(), found.distance.begin(), found.distance.end());
  nearest_.insert(nearest_.end(), found.closest_point.begin(), found.closest_point.end());
  for (std::size_t i = from; i < places_.size(); ++i) note(distance_[i], error_[i], {record_[i], nearest_[i]});
}

void FarthestPlace::note(double distance, double error, PointPair pair)
{
  double least = std::nextafter(distance - error, -kBoundless);
  if (error > 0.0) least = std::nextafter(least, -kBoundless);
  if (!b_.hierarchy().view().areBalls() && !a_.hierarchy().view().areBalls()) least = std::max(least, 0.0);
  lower_ = std::max(lower_, least);
  if (!(distance > farthest_distance_) && farthest_distance_ > -kBoundless) return;
  farthest_distance_ = distance;
  farthest_ = pair;
}

/// The greatest distance that a place may have from b.
double FarthestPlace::mostOf(std::uint32_t place) const
{
  return sumAbove(std::nextafter(distance_[place], kBoundless), error_[place]);
}

/// Returns an upper bound of the length between the places that two places stand for.
double FarthestPlace::lengthBetween(std::uint32_t place, std::uint32_t other) const
{
  const Point3 &p = places_[place], &q = places_[other];
  const double length = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  return length * (1.0 + 2 * kPoseStretch) + error_[place] + error_[other] + std::numeric_limits<double>::min();
}

double FarthestPlace::boundOf(const Piece& piece, const RecordDistance& of_places) const
{
  double farthest = -kBoundless, longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    farthest = std::max(farthest, mostOf(piece.corners[k]));
    longest = std::max(longest, lengthBetween(piece.corners[k], piece.corners[(k + 1) % 3]));
  }
  double least = sumAbove(farthest, kOfSide * longest);
  const auto fromRecord = [&](std::uint32_t place, std::uint32_t record) {
    if (nearest_[place] == record) return mostOf(place);
    const RecordDistance::Pair pair = of_places.pair({place, record});
    const double radii = pair.radius_p + pair.radius_q;
    const RecordDistance::Enclosure apart = of_places.enclose(pair);
    if (apart.low - radii > least) return kBoundless;
    double most = apart.high - radii + kFewDoubleRoundings * (apart.high + radii);
    if (!(apart.high - apart.low < 0.125 * tolerance_)) most = std::nextafter(of_places.gap(pair), kBoundless);
    return sumAbove(most, error_[place]);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t record = nearest_[piece.corners[k]];
    double most = -kBoundless;
    for (std::size_t i = 0; i < 3 && most < least; ++i) most = std::max(most, fromRecord(piece.corners[i], record));
    least = std::min(least, most);
  }
  return least;
}

/// Bounds pieces; those that may be farther than what is known wait.
void FarthestPlace::keep(std::vector<Piece>& pieces, double known)
{
  const PointsView places = viewOfPlaces(0);
  const RecordDistance of_places(places, a_.pose, b_.hierarchy().view(), b_.pose);
  parallelFor((pieces.size() + kOfTask - 1) / kOfTask, threadCount(threads_), [&](std::size_t task) {
    Pulse pulse;
    for (std::size_t i = task * kOfTask; i < std::min(pieces.size(), (task + 1) * kOfTask); ++i) {
      pulse.count(64);
      pieces[i].upper = boundOf(pieces[i], of_places);
    }
  });
  const double enough = std::max(known, lower_) + tolerance_;
  work_.exact_decisions += pieces.size();
  for (const Piece& piece : pieces) {
    if (!(piece.upper > enough)) {
      settled_ = std::max(settled_, piece.upper);
      continue;
    }
    waiting_.push_back(piece);
    std::push_heap(waiting_.begin(), waiting_.end(), precedes);
  }
}

Interval FarthestPlace::interval() const
{
  const double waiting = waiting_.empty() ? -kBoundless : waiting_.front().upper;
  return {lower_, std::max({lower_, settled_, waiting})};
}

/// Returns the distance of a place of a, given in b's frame, from a record of b, up to rounding.
double FarthestPlace::roughDistance(const Eigen::Vector3d& at, std::uint32_t record) const
{
  const PointsView& view = b_.hierarchy().view();
  const Point3 p{at[0], at[1], at[2]};
  const Point3 q = view.triangles ? nearestPoint(p, view.triangles->triangle(record)) : view.point(record);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) - view.ownRadius(record);
}

/// Where between two places another record becomes the nearest, up to rounding: there pieces have one nearest record
/// each, and bounds are sharp. @return its share of the way; 0 where that is not known
double FarthestPlace::crossing(std::uint32_t from, std::uint32_t to) const
{
  const Point3 &p = places_[from], &q = places_[to];
  const Eigen::Vector3d start = in_b_ * Eigen::Vector3d(p[0], p[1], p[2]);
  const Eigen::Vector3d way = in_b_ * Eigen::Vector3d(q[0], q[1], q[2]) - start;
  const auto lead = [&](double share) {
    const Eigen::Vector3d at = start + share * way;
    return roughDistance(at, nearest_[from]) - roughDistance(at, nearest_[to]);
  };
  double low = 0.0, high = 1.0, at_low = lead(low), at_high = lead(high);
  if (!(at_low < 0.0 && at_high > 0.0)) return 0.0;
  for (int step = 0, kept = 0; step < 40 && high - low > 0x1p-48; ++step) { // the Illinois rule
    const double share = low + (high - low) * std::clamp(at_low / (at_low - at_high), 0x1p-20, 1.0 - 0x1p-20);
    const double value = lead(share);
    if (value == 0.0) return share;
    if (value < 0.0) {
      low = share, at_low = value;
      if (kept == -1) at_high *= 0.5;
      kept = -1;
    }
    else {
      high = share, at_high = value;
      if (kept == 1) at_low *= 0.5;
      kept = 1;
    }
  }
  return low + 0.5 * (high - low);
}

FarthestPlace::Cut FarthestPlace::cutOf(const Piece& piece) const
{
  std::array<double, 3> length;
  for (std::size_t k = 0; k < 3; ++k) length[k] = lengthBetween(piece.corners[k], piece.corners[(k + 1) % 3]);
  std::array<std::size_t, 3> sides = {0, 1, 2};
  std::stable_sort(sides.begin(), sides.end(), [&](std::size_t x, std::size_t y) { return length[x] > length[y]; });
  if (piece.depth % 4 != 3) { // sides become short in the end
    for (const std::size_t side : sides) {
      const std::uint32_t from = piece.corners[side], to = piece.corners[(side + 1) % 3];
      if (nearest_[from] == nearest_[to]) continue;
      const double share = crossing(from, to);
      if (share > kNearEnd && share < 1.0 - kNearEnd) return {side, share};
    }
  }
  return {sides[0], 0.5};
}

std::size_t FarthestPlace::divide(double known)
{
  const double enough = std::max(known, lower_) + tolerance_;
  std::vector<Piece> parts;
  while (!waiting_.empty() && parts.size() < kTogether && waiting_.front().upper > enough) {
    std::pop_heap(waiting_.begin(), waiting_.end(), precedes);
    parts.push_back(waiting_.back());
    waiting_.pop_back();
  }
  std::vector<Cut> cuts(parts.size());
  parallelFor((parts.size() + kOfTask - 1) / kOfTask, threadCount(threads_), [&](std::size_t task) {
    for (std::size_t i = task * kOfTask; i < std::min(parts.size(), (task + 1) * kOfTask); ++i)
      cuts[i] = cutOf(parts[i]);
  });
  const std::size_t before = places_.size(), count = parts.size();
  std::size_t divided = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Piece piece = parts[i];
    const auto [side, share] = cuts[i];
    const std::uint32_t from = piece.corners[side], to = piece.corners[(side + 1) % 3];
    Point3 at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = share == 0.5 ? 0.5 * places_[from][k] + 0.5 * places_[to][k]
                           : places_[from][k] + share * (places_[to][k] - places_[from][k]);
    const auto& corners = piece.corners;
    const double most = std::max({mostOf(corners[0]), mostOf(corners[1]), mostOf(corners[2])});
    if (at == places_[from] || at == places_[to] || piece.upper <= most) { // as fine as doubles are
      settled_ = std::max(settled_, piece.upper);
      continue;
    }
    const auto place = static_cast<std::uint32_t>(places_.size());
    places_.push_back(at);
    error_.push_back(std::max(error_[from], error_[to]) + kOfPlace * largest_ + std::numeric_limits<double>::min());
    record_.push_back(piece.record);
    Piece one{0.0, piece.record, piece.depth + 1, piece.corners}, other = one;
    one.corners[(side + 1) % 3] = place;
    other.corners[side] = place;
    parts[divided++] = one; // no part is read again
    parts.push_back(other);
  }
  parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(divided), parts.begin() + static_cast<std::ptrdiff_t>(count));
  measure(before);
  if (divided != 0) keep(parts, known);
  return count;
}

} // namespace pcl_bsh
