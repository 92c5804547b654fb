// SPDX-License-Identifier: BSD-3-Clause
// The depth of a triangle is the greatest value of s on it: the distance to the surface, less than 0 outside. From
// place to place, s changes by no more than the way between them. On a piece of the triangle
//
//   s <= s(corner) + the way from there,
//   s <= the distance to any one triangle of the solid, which is convex: at most linear between its values at corners.
//
// At each place the smaller of two such linear bounds counts. Over a piece, it is greatest at a corner, or where the
// two are equal on an edge. There pieces are cut, so that ridges of s, halfway between two walls, and seams between
// faces that lie in one plane become edges of pieces. A piece that crosses the surface is cut where it does; then
// pieces outside are apart from the surface, which is how they are known.
#include <pcl_bsh/depths/triangle_depths.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/depths/pieces.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/geometry/triangle/nearest_point.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/solid/labels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr unsigned kMostCuts = 60;                                            ///< of a piece, one after the other
constexpr std::size_t kMostPlaces = std::size_t{1} << 18;                     ///< of all records of a query together
constexpr std::size_t kFewestPlaces = 64, kManyPlaces = std::size_t{1} << 14; ///< of one record
constexpr double kLonger = 1.0 + 4e-6; ///< more than a pose may lengthen a way by

/// Error of places that are computed, relative to the largest coordinate: each cut rounds by 2^-51 of it, 2^-45
/// after kMostCuts.
constexpr double kPlaceError = 0x1p-44;

/// The search in one record.
struct Search {
  std::uint32_t record;
  double error;                   ///< how far its pieces may be from it
  double lower = 0.0, told = 0.0; ///< of its depth
  double beyond = 0.0;            ///< of pieces that are done: none is deeper
  std::optional<std::uint32_t> nearest = std::nullopt;
  std::size_t places = 3;
  std::vector<Piece> open;
};

class Searches {
public:
  Searches(const DeepSolid& solid, const QueriedRecords& queried, const Eigen::Isometry3d& pose, unsigned threads,
           bool deepest, Work& work)
  : solid_(solid),
    triangles_(*queried.thing().view().triangles),
    pose_(pose),
    threads_(threads),
    deepest_(deepest),
    work_(work)
  {
  }

  std::vector<Depth> find(const std::vector<std::uint32_t>& records)
  {
    most_places_ = std::clamp(kMostPlaces / std::max<std::size_t>(records.size(), 1), kFewestPlaces, kManyPlaces);
    begin(records);
    while (true) {
      bound();
      std::vector<Point3> cuts;
      for (Search& search : searches_) chooseCuts(search, cuts);
      if (cuts.empty()) break;
      look(cuts);
      cutThrough();
    }
    std::vector<Depth> depths;
    for (const Search& search : searches_) {
      double upper = std::max(search.lower, search.beyond);
      depths.push_back({search.record, {search.lower, upper}, search.told, search.nearest.value_or(0)});
    }
    return depths;
  }

private:
  /// A cut of a piece from its corner `k` to a place on the edge across.
  struct Cut {
    std::size_t search;
    Piece piece;
    unsigned k;
    std::uint32_t sample;
  };

  void begin(const std::vector<std::uint32_t>& records)
  {
    std::unordered_map<std::uint32_t, std::uint32_t> samples;
    std::vector<Point3> places;
    for (const std::uint32_t record : records) {
      const Triangle vertices = triangles_.cornersOf(record);
      Piece piece;
      double largest = 0.0;
      for (unsigned k = 0; k < 3; ++k) {
        const auto [at, is_new] = samples.try_emplace(vertices[k], static_cast<std::uint32_t>(places.size()));
        if (is_new) places.push_back(triangles_.vertices.point(vertices[k]));
        piece.corners[k] = at->second;
        for (const double x : places[at->second]) largest = std::max(largest, std::abs(x));
      }
      Search search;
      search.record = record;
      search.error = kPlaceError * largest;
      search.open.push_back(piece);
      searches_.push_back(std::move(search));
    }
    look(places);
    for (Search& search : searches_)
      for (const std::uint32_t corner : search.open.front().corners) take(search, samples_[corner], 0.0);
  }

  /// Measures s at places, which become samples.
  void look(const std::vector<Point3>& places)
  {
    if (places.empty()) return;
    const SphereHierarchy cloud(viewOf(places.front().data(), places.size()));
    PointDistancesRequest request;
    request.threads = threads_;
    const PointDistances found = pointDistances({cloud, pose_}, {solid_.surface, solid_.pose}, request);
    const LabelsResult labels = labelPoints({cloud, pose_}, {solid_.solid, solid_.pose}, threads_);
    work_ += found.work;
    work_ += labels.work;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double distance = found.distance[i];
      Sample at = {std::nextafter(distance, 0.0), std::nextafter(distance, unbounded), distance,
                   found.closest_point[i]};
      if (distance == 0.0) at.low = at.high = 0.0;
      if (labels.labels[i] == labelOf(Label::outside)) at = {-at.high, -at.low, -distance, at.nearest};
      samples_.push_back(at);
      places_.push_back(places[i]);
    }
  }

  /// @param off how far the place may be from the triangle
  void take(Search& search, const Sample& sample, double off)
  {
    const double depth = sample.low - off;
    if (search.nearest && !(depth > search.lower)) return;
    search.lower = std::max(search.lower, depth);
    search.told = off == 0.0 ? std::max(sample.rounded, 0.0) : search.lower;
    search.nearest = sample.nearest;
    deepest_lower_ = std::max(deepest_lower_, search.lower);
  }

  /// Pieces that are no deeper than this are not looked at.
  double enough(const Search& search) const
  {
    return std::max((deepest_ ? deepest_lower_ : search.lower) * (1.0 + kDepthShare), flatness(search));
  }

  static double flatness(const Search& search) { return 32.0 * search.error; } ///< what counts for no depth

  /// Bounds new pieces. Pieces that are known well enough are done.
  void bound()
  {
    const DefaultFloatEnvironment environment;
    if (places_.empty()) return;
    const PointsView view = viewOf(places_.front().data(), places_.size());
    const RecordDistance distance(view, pose_, solid_.surface.view(), solid_.pose);
    for (Search& search : searches_)
      for (Piece& piece : search.open)
        if (piece.upper == unbounded) piece.upper = upperOf(piece, distance) + search.error;
    leaveOutApart();
    for (Search& search : searches_) {
      const double known = enough(search);
      const auto done = std::partition(search.open.begin(), search.open.end(),
                                       [&](const Piece& piece) { return piece.upper > known; });
      for (auto piece = done; piece != search.open.end(); ++piece)
        search.beyond = std::max(search.beyond, piece->upper);
      search.open.erase(done, search.open.end());
    }
  }

  double upperOf(const Piece& piece, const RecordDistance& distance)
  {
    const std::array<const Sample*, 3> corner = {&samples_[piece.corners[0]], &samples_[piece.corners[1]],
                                                 &samples_[piece.corners[2]]};
    double upper = unbounded;
    for (unsigned k = 0; k < 3; ++k) {
      const double way = std::max(edgeOf(piece, (k + 1) % 3), edgeOf(piece, (k + 2) % 3));
      upper = std::min(upper, corner[k]->high + way * kLonger);
    }
    if (upper <= 0.0) return 0.0;
    std::array<std::array<double, 3>, 3> to = {}; // the triangle that is nearest to corner q, from corner k
    for (unsigned q = 0; q < 3; ++q)
      for (unsigned k = 0; k < 3; ++k) {
        ++work_.exact_decisions;
        to[q][k] = corner[q]->nearest == corner[k]->nearest
                       ? std::max(corner[k]->high, -corner[k]->low)
                       : distance.enclose(distance.pair({piece.corners[k], corner[q]->nearest})).high;
      }
    for (unsigned q = 0; q < 3; ++q)
      for (unsigned r = q; r < 3; ++r) upper = std::min(upper, smallerOfTwo(to[q], to[r]));
    return upper;
  }

  /// Pieces with no corner inside that are apart from the surface are outside. Pieces that are apart and outside once
  /// pushed off by hardly more than rounding are no deeper than this push.
  void leaveOutApart()
  {
    std::vector<Point3> vertices;
    std::vector<Piece*> asked;
    std::vector<double> pushed;
    const auto ask = [&](Piece& piece, const Eigen::Vector3d& way, double length) {
      for (const std::uint32_t corner : piece.corners) {
        Point3 at = places_[corner];
        for (std::size_t k = 0; k < 3; ++k) at[k] += way[static_cast<Eigen::Index>(k)] * length;
        vertices.push_back(at);
      }
      asked.push_back(&piece);
      pushed.push_back(std::abs(length));
    };
    double error = 0.0;
    for (Search& search : searches_) {
      for (Piece& piece : search.open) {
        const auto is_within = [&](std::uint32_t corner) { return samples_[corner].low > flatness(search); };
        if (!(piece.upper > enough(search)) || std::any_of(piece.corners.begin(), piece.corners.end(), is_within))
          continue;
        error = std::max(error, search.error);
        ask(piece, Eigen::Vector3d::Zero(), 0.0);
        for (const Eigen::Vector3d& normal : {normalOf(piece), normalAt(piece)})
          for (const double side : {16.0, -16.0}) ask(piece, normal, side * search.error);
      }
    }
    if (asked.empty()) return;
    std::vector<Triangle> corners(asked.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i) corners[i] = {3 * i, 3 * i + 1, 3 * i + 2};
    const TrianglesView pieces{viewOf(vertices.front().data(), vertices.size()), corners.front().data(),
                               corners.size()};
    PointDistancesRequest request;
    request.threads = threads_;
    request.max_distance = 2.0 * error;
    const PointDistances found =
        pointDistances({SphereHierarchy(viewOf(pieces)), pose_}, {solid_.surface, solid_.pose}, request);
    work_ += found.work;
    const LabelsResult labels =
        labelPoints({SphereHierarchy(pieces.vertices), pose_}, {solid_.solid, solid_.pose}, threads_);
    work_ += labels.work;
    for (std::size_t i = 0; i < asked.size(); ++i)
      if (std::isnan(found.distance[i]) && labels.labels[3 * i] == labelOf(Label::outside))
        asked[i]->upper = std::min(asked[i]->upper, pushed[i]);
  }

  static Eigen::Vector3d normalOf(const Triangle3& t)
  {
    const auto vector = [](const Point3& p, const Point3& q) {
      return Eigen::Vector3d(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
    };
    return vector(t[0], t[1]).cross(vector(t[0], t[2])).stableNormalized(); // of length 1, or 0
  }

  Eigen::Vector3d normalOf(const Piece& piece) const
  {
    return normalOf(Triangle3{places_[piece.corners[0]], places_[piece.corners[1]], places_[piece.corners[2]]});
  }

  /// Normal of the solid's triangle that is nearest to the piece, in the queried thing's frame.
  Eigen::Vector3d normalAt(const Piece& piece) const
  {
    const auto highest = *std::max_element(piece.corners.begin(), piece.corners.end(), [&](auto one, auto other) {
      return samples_[one].high < samples_[other].high;
    });
    const Eigen::Vector3d normal = normalOf(solid_.solid.triangles().triangle(samples_[highest].nearest));
    return pose_.linear().transpose() * (solid_.pose.linear() * normal);
  }

  void chooseCuts(Search& search, std::vector<Point3>& places)
  {
    if (search.open.empty()) return;
    std::sort(search.open.begin(), search.open.end(), [](const Piece& l, const Piece& r) {
      return l.upper != r.upper ? l.upper > r.upper : l.corners < r.corners;
    });
    for (const Piece& piece : search.open) {
      if (piece.cuts >= kMostCuts || search.places >= most_places_) {
        search.beyond = std::max(search.beyond, piece.upper);
        continue;
      }
      const auto [k, share] = cutOf(piece, search);
      const Point3 &p = places_[piece.corners[(k + 1) % 3]], &q = places_[piece.corners[(k + 2) % 3]];
      cuts_.push_back({static_cast<std::size_t>(&search - searches_.data()), piece, k,
                       static_cast<std::uint32_t>(samples_.size() + places.size())});
      places.push_back(between(p, q, share));
      ++search.places;
    }
    search.open.clear();
  }

  /// The corner across from the edge that is cut, and where on the edge, from the next corner on.
  std::pair<unsigned, double> cutOf(const Piece& piece, const Search& search) const
  {
    const auto corner = [&](unsigned k) -> const Sample& { return samples_[piece.corners[k % 3]]; };
    const auto length = [&](unsigned k) { return edgeOf(piece, k); };
    unsigned longest = 0;
    for (unsigned k = 1; k < 3; ++k)
      if (length(k) > length(longest)) longest = k;
    if (piece.cuts % 3 == 2) return {longest, 0.5}; // so that pieces become small in any case
    const double flat = flatness(search);
    std::optional<std::pair<unsigned, double>> chosen;
    double most = 0.0;
    for (unsigned k = 0; k < 3; ++k) {
      const Sample &p = corner(k + 1), &q = corner(k + 2);
      if (!((p.low > flat && q.high < -flat) || (p.high < -flat && q.low > flat)) || !(length(k) > most)) continue;
      most = length(k);
      const bool leaves = p.low > 0.0; // through the triangle that is nearest to the place outside
      const double to_p = leaves ? distanceTo(places_[piece.corners[(k + 1) % 3]], q.nearest) : -p.rounded,
                   to_q = leaves ? -q.rounded : distanceTo(places_[piece.corners[(k + 2) % 3]], p.nearest);
      const double share = to_p / (to_p + to_q);
      chosen.emplace(k, std::clamp(share + (leaves ? 0x1p-10 : -0x1p-10), 0x1p-8, 1.0 - 0x1p-8));
    }
    if (chosen) return *chosen;
    for (unsigned k = 0; k < 3; ++k) {
      const auto share = meetingOf(piece, (k + 1) % 3, (k + 2) % 3);
      if (!share || !(length(k) > most)) continue;
      most = length(k);
      chosen.emplace(k, std::clamp(*share, 0x1p-8, 1.0 - 0x1p-8));
    }
    return chosen.value_or(std::pair(longest, 0.5));
  }

  /// How long the edge across from a corner is.
  double edgeOf(const Piece& piece, unsigned k) const
  {
    return wayBetween(places_[piece.corners[(k + 1) % 3]], places_[piece.corners[(k + 2) % 3]]);
  }

  /// Returns the share of an edge at which the triangle nearest to its one end becomes farther than the one nearest to
  /// its other end.
  std::optional<double> meetingOf(const Piece& piece, unsigned k, unsigned l) const
  {
    const Sample &p = samples_[piece.corners[k]], &q = samples_[piece.corners[l]];
    if (p.nearest == q.nearest) return std::nullopt;
    const double a = distanceTo(places_[piece.corners[k]], q.nearest) - std::abs(p.rounded),
                 b = distanceTo(places_[piece.corners[l]], p.nearest) - std::abs(q.rounded);
    if (!(a > 0.0 && b > 0.0)) return std::nullopt;
    return a / (a + b);
  }

  /// Returns the distance roughly: it tells only where to cut.
  double distanceTo(const Point3& place, std::uint32_t triangle) const
  {
    const Eigen::Vector3d seen = solid_.pose.inverse() * (pose_ * Eigen::Vector3d(place[0], place[1], place[2]));
    const Point3 from = {seen.x(), seen.y(), seen.z()};
    return wayBetween(from, nearestPoint(from, solid_.solid.triangles().triangle(triangle)));
  }

  void cutThrough()
  {
    for (const Cut& cut : cuts_) {
      Search& search = searches_[cut.search];
      take(search, samples_[cut.sample], search.error);
      for (const unsigned replaced : {1U, 2U}) {
        Piece half = cut.piece;
        half.corners[(cut.k + replaced) % 3] = cut.sample;
        half.upper = unbounded;
        ++half.cuts;
        search.open.push_back(half);
      }
    }
    cuts_.clear();
  }

  const DeepSolid& solid_;
  const TrianglesView& triangles_;
  const Eigen::Isometry3d& pose_;
  const unsigned threads_;
  const bool deepest_;
  Work& work_;
  std::size_t most_places_ = 0;
  double deepest_lower_ = 0.0;
  std::vector<Point3> places_; ///< of samples
  std::vector<Sample> samples_;
  std::vector<Search> searches_;
  std::vector<Cut> cuts_;
};

} // namespace

std::vector<Depth> depthsOfTriangles(const DeepSolid& solid, const QueriedRecords& queried,
                                     const Eigen::Isometry3d& T_world_queried,
                                     const std::vector<std::uint32_t>& records, unsigned threads, bool deepest,
                                     Work& work)
{
  if (records.empty()) return {};
  return Searches(solid, queried, T_world_queried, threads, deepest, work).find(records);
}

} // namespace pcl_bsh
