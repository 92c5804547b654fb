// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/seen_outline.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl_bsh {
namespace {

constexpr std::size_t beams_of_block = 4096;
constexpr double most_cells = 0x1p33; ///< a gigabyte, at a bit each
constexpr std::size_t most_trials = 200;

double crossOf(const SectionPoint& a, const SectionPoint& b)
{
  return a.offset * b.height - a.height * b.offset;
}

SectionPoint wayFrom(const SectionPoint& a, const SectionPoint& b)
{
  return {b.offset - a.offset, b.height - a.height};
}

/// Shares of a straight way in section at which it crosses an outline, in order.
void crossingsOf(const SectionPoint& from, const SectionPoint& to, const std::vector<SectionPoint>& outline,
                 std::vector<double>& shares)
{
  shares.clear();
  const SectionPoint way = wayFrom(from, to);
  for (std::size_t i = 0, last = outline.size() - 1; i < outline.size(); last = i++) {
    const SectionPoint edge = wayFrom(outline[last], outline[i]), before = wayFrom(outline[last], from);
    const double begin = crossOf(edge, before), end = begin + crossOf(edge, way);
    if ((begin > 0.0) == (end > 0.0)) continue;
    const double share = begin / (begin - end);
    const double along =
        (before.offset + share * way.offset) * edge.offset + (before.height + share * way.height) * edge.height;
    const double square = edge.offset * edge.offset + edge.height * edge.height;
    if (along >= 0.0 && along <= square) shares.push_back(share);
  }
  std::sort(shares.begin(), shares.end());
}

} // namespace

/// Finds the cells that beams cross. Between two places of a beam, one inside of the outline and one outside, there is
/// a crossing, however the axis bends and the profile widens. The search begins where the beam would cross if it were
/// straight in section. A crossing that it overlooks counts as not seen.
class SeenOutline::Beams {
public:
  Beams(const SeenOutline& seen, const AxisReach& reach) : seen_(seen), axis_(seen.axis_), reach_(reach) {}

  /// Appends the cells that the way from an origin to a return crosses.
  void addCells(const Point3& origin, const Point3& end, std::vector<std::size_t>& cells)
  {
    for (std::size_t k = 0; k < 3; ++k) way_[k] = end[k] - origin[k];
    origin_ = origin;
    const double length = std::hypot(way_[0], way_[1], way_[2]);
    if (!(length > 0.0 && std::isfinite(length))) return;
    least_ = seen_.tolerance_ / length;
    const std::optional<AxisPlace> first = placeAt(0.0);
    if (!first) return;
    double until = 1.0;
    std::optional<AxisPlace> last = placeAt(until);
    if (!last) until = withinReach(*first);
    for (int halvings = 0; !last && halvings < 6; ++halvings, until /= 2) {
      last = placeAt(until);
      if (last) break;
    }
    if (!last) return;
    for (std::size_t e = 0; e < seen_.envelopes_.size(); ++e) addCells(e, *first, *last, until, cells);
  }

private:
  /// A place of the beam, and how far it is outside of the outline there.
  struct Trial {
    double share; ///< of the beam
    AxisPlace at;
    double outside;
    OutlinePlace nearest;
    bool isInside() const { return outside <= 0.0; }
  };

  std::optional<AxisPlace> placeAt(double share) const
  {
    Point3 place;
    for (std::size_t k = 0; k < 3; ++k) place[k] = origin_[k] + share * way_[k];
    const AxisPlaces places = axis_.nearest(place, reach_);
    return hasPlace(places.state) ? std::optional(places.best) : std::nullopt;
  }

  std::optional<Trial> trialAt(const Envelope& envelope, double share)
  {
    const std::optional<AxisPlace> at = placeAt(share);
    return at ? std::optional(trialOf(envelope, share, *at)) : std::nullopt;
  }

  Trial trialOf(const Envelope& envelope, double share, const AxisPlace& at)
  {
    Trial trial{share, at, 0.0, {}};
    const std::vector<SectionPoint>& outline = envelope.outlineAt(axis_, at.distance, room_);
    trial.outside = signedDistance(outline, {at.offset, at.height}, &trial.nearest);
    return trial;
  }

  /// The share of the beam, from its origin, that would stay within reach if the axis were straight and level.
  double withinReach(const AxisPlace& first) const
  {
    double share = 1.0;
    const auto limit = [&](double room, double advance) {
      if (advance > room) share = std::min(share, std::max(0.0, room / advance));
    };
    limit(reach_.offset - std::abs(first.offset), std::hypot(way_[0], way_[1]));
    limit(reach_.above - first.height, way_[2]);
    limit(reach_.below + first.height, -way_[2]);
    return share * (1.0 - 0x1p-10);
  }

  void addCells(std::size_t e, const AxisPlace& first, const AxisPlace& last, double until,
                std::vector<std::size_t>& cells)
  {
    const Envelope& envelope = seen_.envelopes_[e];
    crossingsOf({first.offset, first.height}, {last.offset, last.height},
                envelope.outlineAt(axis_, 0.5 * (first.distance + last.distance), room_), shares_);
    if (shares_.empty()) return;
    std::optional<Trial> before = trialOf(envelope, 0.0, first);
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      const std::optional<Trial> after = i + 1 < shares_.size()
                                             ? trialAt(envelope, 0.5 * (shares_[i] + shares_[i + 1]) * until)
                                             : trialOf(envelope, until, last);
      if (before && after && before->isInside() != after->isInside())
        if (const auto crossing = crossingBetween(envelope, *before, *after, shares_[i] * until))
          cells.push_back(cellAt(seen_.outlines_[e], *crossing));
      before = after;
    }
  }

  /// Where the beam crosses the outline, up to the tolerance, by secants and halving. None where that is the beam's
  /// return, no place of the axis is within reach, the envelope does not count, or the outline has a step.
  std::optional<Trial> crossingBetween(const Envelope& envelope, Trial from, Trial to, double guess)
  {
    const bool inside = from.isInside();
    double share = guess + 0.25 * least_;
    for (std::size_t i = 0; to.share - from.share > least_ && i < most_trials; ++i) {
      if (!(share > from.share && share < to.share)) share = 0.5 * (from.share + to.share);
      const std::optional<Trial> trial = trialAt(envelope, share);
      if (!trial) return std::nullopt;
      const bool is_before = trial->isInside() == inside;
      (is_before ? from : to) = *trial;
      const double secant = (from.share * to.outside - to.share * from.outside) / (to.outside - from.outside);
      share = i % 3 == 2 ? 0.5 * (from.share + to.share) : secant + (is_before ? 0.25 : -0.25) * least_;
    }
    const double near = 8.0 * seen_.tolerance_; // within reach, a section moves at most 5 times as far as the beam
    if (to.share - from.share > 2.0 * least_ || std::abs(from.outside) > near || std::abs(to.outside) > near)
      return std::nullopt;
    if (to.share > 1.0 - 2.0 * least_ || !envelope.countsAt(axis_.chainage(to.at.distance))) return std::nullopt;
    return to;
  }

  std::size_t cellAt(const Outline& outline, const Trial& crossing) const
  {
    const auto row = static_cast<std::size_t>(std::max(0.0, crossing.at.distance) / seen_.edge_);
    const std::size_t first = outline.first[crossing.nearest.edge];
    const std::size_t count = outline.first[crossing.nearest.edge + 1] - first;
    const auto column = static_cast<std::size_t>(crossing.nearest.share * static_cast<double>(count));
    return cellOf(outline, std::min(row, seen_.rows_ - 1), first + std::min(column, count - 1));
  }

  const SeenOutline& seen_;
  const Axis& axis_;
  const AxisReach& reach_;
  Point3 origin_ = {}, way_ = {};
  double least_ = 0.0; ///< the tolerance as a share of the beam
  std::vector<double> shares_;
  std::vector<SectionPoint> room_;
};

SeenOutline::SeenOutline(const Axis& axis, const std::vector<Envelope>& envelopes, const SeenCells& cells)
: axis_(axis),
  envelopes_(envelopes)
{
  const auto refuse = [&](const std::string& wrong) {
    throw InvalidInput(Input::seen, "seen spacing", plainText(cells.spacing, wrong),
                       "give a length above 0, such as 0.1")
        .withValue(cells.spacing);
  };
  if (!(cells.spacing > 0.0 && std::isfinite(cells.spacing))) refuse(" is no length");
  const double of_part = std::max(1.0, std::ceil(cells.step / cells.spacing));
  edge_ = cells.step / of_part;
  tolerance_ = 0x1p-20 * cells.spacing;
  const double rows = std::max(1.0, std::ceil(axis.length() / cells.step)) * of_part;
  double all = 0.0;
  for (const Envelope& envelope : envelopes_) {
    const std::vector<SectionPoint>& corners = envelope.corners();
    Outline outline{{}, {0}, static_cast<std::size_t>(all)};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const SectionPoint &from = corners[i], &to = corners[(i + 1) % corners.size()], way = wayFrom(from, to);
      const double count = std::ceil(std::hypot(way.offset, way.height) / cells.spacing);
      all += rows * count;
      if (!(all <= most_cells)) refuse(plainText(" makes too many cells of an axis ", axis.length(), " long"));
      for (double k = 0.5; k < count; ++k) {
        const double share = k / count;
        const double around = envelope.aroundOf({from.offset + share * way.offset, from.height + share * way.height});
        outline.columns.push_back({i, share, static_cast<Sector>(around)});
      }
      outline.first.push_back(outline.columns.size());
    }
    outlines_.push_back(std::move(outline));
  }
  rows_of_part_ = static_cast<std::size_t>(of_part);
  rows_ = static_cast<std::size_t>(rows);
  crossed_.resize(static_cast<std::size_t>(all));
}

void SeenOutline::add(const PointsView& points, const std::vector<Point3>& origins, const GaugeRequest& request)
{
  axis_.requireReach(request.reach);
  const std::size_t count = points.size(), blocks = (count + beams_of_block - 1) / beams_of_block;
  std::vector<std::vector<std::size_t>> cells(blocks);
  const DefaultFloatEnvironment environment;
  parallelFor(blocks, threadCount(request.threads), [&](std::size_t block) {
    askWatcher();
    Beams beams(*this, request.reach);
    const std::size_t end = std::min(count, (block + 1) * beams_of_block);
    for (std::size_t i = block * beams_of_block; i < end; ++i)
      beams.addCells(origins[i], points.point(points.record(i)), cells[block]);
  });
  for (const std::vector<std::size_t>& of_block : cells)
    for (const std::size_t cell : of_block) crossed_[cell] = true;
}

template <class Counts>
double SeenOutline::shareOf(std::size_t part, std::size_t envelope, const Counts& counts) const
{
  const Outline& outline = outlines_[envelope];
  std::size_t all = 0, crossed = 0;
  for (std::size_t row = part * rows_of_part_; row < (part + 1) * rows_of_part_; ++row) {
    if (edge_ * static_cast<double>(row) >= axis_.length()) break; // the last part may be shorter
    for (std::size_t column = 0; column < outline.columns.size(); ++column) {
      if (!counts(outline.columns[column].sector)) continue;
      ++all;
      crossed += isCrossed(envelope, row, column);
    }
  }
  return all == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(crossed) / static_cast<double>(all);
}

double SeenOutline::share(std::size_t part, std::size_t envelope, Sector sector) const
{
  return shareOf(part, envelope, [&](Sector of_column) { return of_column == sector; });
}

double SeenOutline::share(std::size_t part, std::size_t envelope) const
{
  return shareOf(part, envelope, [](Sector) { return true; });
}

bool SeenOutline::isUnseen(std::size_t part, std::size_t envelope) const
{
  for (const Sector sector : {Sector::left, Sector::above, Sector::right, Sector::below})
    if (share(part, envelope, sector) == 0.0) return true;
  return false;
}

AxisPlace SeenOutline::middleOf(std::size_t envelope, std::size_t row, std::size_t column) const
{
  const Column& of = outlines_[envelope].columns[column];
  AxisPlace middle;
  middle.distance = std::min(axis_.length(), edge_ * (static_cast<double>(row) + 0.5));
  std::vector<SectionPoint> room;
  const std::vector<SectionPoint>& outline = envelopes_[envelope].outlineAt(axis_, middle.distance, room);
  const SectionPoint &from = outline[of.edge], way = wayFrom(from, outline[(of.edge + 1) % outline.size()]);
  middle.offset = from.offset + of.share * way.offset;
  middle.height = from.height + of.share * way.height;
  return middle;
}

} // namespace pcl_bsh
