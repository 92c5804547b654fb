// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/strips.h>

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

/// Error of a product of a normal and a place, relative to its terms: three roundings of doubles, and as many at the
/// corners.
constexpr double kAcrossError = 16 * kDoubleUnit;

double acrossError(const float (&normal)[2], double x, double y)
{
  return kAcrossError * (std::abs(static_cast<double>(normal[0]) * x) + std::abs(static_cast<double>(normal[1]) * y));
}

double across(const float (&normal)[2], double x, double y)
{
  return static_cast<double>(normal[0]) * x + static_cast<double>(normal[1]) * y;
}

/// A direction in the plane of shadows.
struct Direction {
  double x = 1.0, y = 0.0;
};

/// Sums up the directions of lines; opposite directions are alike.
struct Lines {
  double xx = 0.0, xy = 0.0, yy = 0.0;

  void add(double x, double y) { xx += x * x, xy += x * y, yy += y * y; }

  /// Returns their mean direction: half the angle of the doubled angles' mean.
  Direction mean() const
  {
    const double turn = 0.5 * std::atan2(2.0 * xy, xx - yy);
    return std::isfinite(turn) ? Direction{std::cos(turn), std::sin(turn)} : Direction{};
  }
};

constexpr std::uint32_t kBelow = 16; ///< strips below a strip, or triangles

constexpr double kEndless = std::numeric_limits<double>::infinity();

constexpr std::size_t kSamples = 64; ///< needles that tell how all of them lie

/// The keys that the order is sorted by.
struct Needles {
  struct Needle {       // in a unit in which squares are floats
    float x, y;         ///< its middle
    float way_x, way_y; ///< along its longest side
  };
  struct Keyed {
    float key;
    std::uint32_t needle;
  };

  std::vector<Needle> needles;
  std::vector<Keyed> order;

  /// Splits [begin, end) into halves of whole blocks, and these again, down to kBelow needles. The key is a needle's
  /// place across their mean direction, or its turn from it, whichever widens their strip by more.
  void sort(std::size_t begin, std::size_t end, std::size_t block)
  {
    if (end - begin <= kBelow) return;
    while (block >= end - begin) block /= kBelow;
    const std::size_t step = std::max<std::size_t>(1, (end - begin) / kSamples);
    Lines lines;
    for (std::size_t i = begin; i < end; i += step) {
      const Needle& n = needles[order[i].needle];
      lines.add(static_cast<double>(n.way_x), static_cast<double>(n.way_y));
    }
    const Direction along = lines.mean();
    const auto placed = [&](const Needle& n) {
      return static_cast<double>(n.y) * along.x - static_cast<double>(n.x) * along.y;
    };
    const auto turned = [&](const Needle& n) { // how far it gets aside on its way
      const double on = static_cast<double>(n.way_x) * along.x + static_cast<double>(n.way_y) * along.y;
      const double aside = static_cast<double>(n.way_y) * along.x - static_cast<double>(n.way_x) * along.y;
      return on < 0.0 ? -aside : aside;
    };
    double places[2] = {0, 0}, turns[2] = {0, 0}, count = 0.0;
    for (std::size_t i = begin; i < end; i += step) {
      const Needle& n = needles[order[i].needle];
      const double place = placed(n), turn = turned(n);
      places[0] += place, places[1] += place * place, turns[0] += turn, turns[1] += turn * turn, count += 1.0;
    }
    const auto spread = [&](const double(&sums)[2]) { return sums[1] - sums[0] * sums[0] / count; };
    const bool by_turn = spread(turns) > spread(places);
    for (std::size_t i = begin; i < end; ++i) {
      const Needle& n = needles[order[i].needle];
      const float key = roundToFloat(by_turn ? turned(n) : placed(n));
      order[i].key = std::isfinite(key) ? key : 0.0f;
    }
    const std::size_t blocks = (end - begin + block - 1) / block;
    const std::size_t middle = begin + blocks / 2 * block;
    std::nth_element(
        order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(middle),
        order.begin() + static_cast<std::ptrdiff_t>(end),
        [](const Keyed& l, const Keyed& r) { return l.key != r.key ? l.key < r.key : l.needle < r.needle; });
    sort(begin, middle, block);
    sort(middle, end, block);
  }
};

} // namespace

Strips::Strips(std::uint32_t* first, std::uint32_t* last, const std::function<Triangle3(std::uint32_t)>& seen)
: count_(static_cast<std::uint32_t>(last - first))
{
  const std::vector<std::uint32_t> given(first, last);
  std::vector<std::array<Point3, 3>> corners(count_);
  double largest = 0.0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    corners[i] = seen(given[i]);
    for (const Point3& corner : corners[i]) largest = std::max({largest, std::abs(corner[0]), std::abs(corner[1])});
  }
  const double scale = std::min(1.0 / largest, 0x1p1000);
  Needles needles;
  needles.needles.reserve(count_);
  needles.order.reserve(count_);
  for (std::uint32_t i = 0; i < count_; ++i) {
    Triangle3 t = corners[i];
    for (Point3& corner : t)
      for (double& x : corner) x *= scale;
    double longest = -1.0, way[2] = {0, 0};
    for (std::size_t j = 0; j < 3; ++j) {
      const double x = t[(j + 1) % 3][0] - t[j][0], y = t[(j + 1) % 3][1] - t[j][1];
      if (const double square = x * x + y * y; square > longest) longest = square, way[0] = x, way[1] = y;
    }
    const auto middle = [&](std::size_t k) {
      const auto [low, high] = std::minmax({t[0][k], t[1][k], t[2][k]});
      return roundToFloat(0.5 * low + 0.5 * high);
    };
    needles.needles.push_back({middle(0), middle(1), roundToFloat(way[0]), roundToFloat(way[1])});
    needles.order.push_back({0.0f, i});
  }
  std::size_t block = kBelow;
  while (block * kBelow < count_) block *= kBelow;
  needles.sort(0, count_, block);
  for (std::uint32_t i = 0; i < count_; ++i) first[i] = given[needles.order[i].needle];

  for (std::size_t size = kBelow;; size *= kBelow) {
    const auto begin = static_cast<std::uint32_t>(strips_.size());
    for (std::size_t from = 0; from < count_; from += size) {
      const std::size_t to = std::min<std::size_t>(count_, from + size);
      Lines lines;
      for (std::size_t i = from; i < to; ++i) {
        const Needles::Needle& n = needles.needles[needles.order[i].needle];
        lines.add(static_cast<double>(n.way_x), static_cast<double>(n.way_y));
      }
      const Direction along = lines.mean();
      Strip strip{{roundToFloat(-along.y), roundToFloat(along.x)}, 0.0f, 0.0f};
      double low = kEndless, high = -kEndless, most_x = 0.0, most_y = 0.0;
      for (std::size_t i = from; i < to; ++i)
        for (const Point3& corner : corners[needles.order[i].needle]) {
          const double at = across(strip.normal, corner[0], corner[1]);
          low = std::min(low, at), high = std::max(high, at);
          most_x = std::max(most_x, std::abs(corner[0])), most_y = std::max(most_y, std::abs(corner[1]));
        }
      const double off = acrossError(strip.normal, most_x, most_y);
      const bool is_known = most_x + most_y < 0x1p1000; // no product leaves the range of double
      strip.low = roundDown(is_known ? low - off : -kEndless), strip.high = roundUp(is_known ? high + off : kEndless);
      strips_.push_back(strip);
    }
    levels_.push_back({begin, static_cast<std::uint32_t>(strips_.size()) - begin});
    if (levels_.back().count <= kBelow) break;
  }
}

bool Strips::Strip::holds(const Point3& at, double error) const noexcept
{
  const double place = across(normal, at[0], at[1]);
  const double off = acrossError(normal, at[0], at[1]) +
                     error * (std::abs(static_cast<double>(normal[0])) + std::abs(static_cast<double>(normal[1]))) *
                         (1.0 + kAcrossError);
  return !(place + off < static_cast<double>(low)) && !(place - off > static_cast<double>(high));
}

void Strips::collect(const std::uint32_t* first, const Point3& at, double error,
                     std::vector<std::uint32_t>& found) const
{
  struct Open {
    std::size_t level;
    std::uint32_t begin, end;
  };
  Open open[32];
  std::size_t depth = 0;
  open[depth++] = {levels_.size() - 1, 0, levels_.back().count};
  while (depth > 0) {
    Open& top = open[depth - 1];
    if (top.begin == top.end) {
      --depth;
      continue;
    }
    const std::size_t level = top.level;
    const std::uint32_t i = top.begin++;
    if (!strips_[levels_[level].begin + i].holds(at, error)) continue;
    const std::uint32_t begin = i * kBelow;
    const std::uint32_t end = std::min<std::uint32_t>(level == 0 ? count_ : levels_[level - 1].count, begin + kBelow);
    if (level == 0)
      found.insert(found.end(), first + begin, first + end);
    else
      open[depth++] = {level - 1, begin, end};
  }
}

} // namespace pcl_bsh
