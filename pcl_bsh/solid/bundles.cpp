// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/bundles.h>

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr std::uint32_t kSmallest = 8; ///< a bundle of at most so many triangles has none below it
constexpr std::uint32_t kFewest = 16;  ///< each part has at least 1 / kFewest of a bundle's triangles

/// How often the ray upward from the origin crosses a triangle whose corners are within `error` per axis of these; 0
/// where it passes. Unknown where that differs among such triangles.
constexpr int kUnknown = 2;
int crossingsOf(const Triangle3& t, double error, bool above)
{
  constexpr double rounded = 16 * kDoubleUnit, more = 1.0 + 64 * kDoubleUnit;
  double sides[3];
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &u = t[i], &v = t[(i + 1) % 3];
    const double sum = std::abs(u[0]) + std::abs(u[1]) + std::abs(v[0]) + std::abs(v[1]);
    const double doubt = (error * (sum + 2.0 * error) + rounded * sum * sum) * more + 0x1p-1000;
    sides[i] = u[0] * v[1] - u[1] * v[0];
    left += sides[i] > doubt, right += sides[i] < -doubt;
  }
  if (left > 0 && right > 0) return 0;
  if (left < 3 && right < 3) return kUnknown;
  const int turns = left == 3 ? 1 : -1;
  if (above) return turns;
  double volume = 0.0, cofactors = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &p = t[i], &u = t[(i + 1) % 3], &v = t[(i + 2) % 3];
    volume += p[2] * sides[(i + 1) % 3];
    cofactors +=
        std::abs(u[0] * v[1] - u[1] * v[0]) + std::abs(u[1] * v[2] - u[2] * v[1]) + std::abs(u[2] * v[0] - u[0] * v[2]);
    sum += std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
  }
  const double doubt =
      (error * (cofactors + rounded * sum * sum + 2.0 * error * (sum + 3.0 * error)) + rounded * sum * sum * sum) *
          more +
      0x1p-1000;
  if (volume > doubt) return turns > 0 ? 1 : 0;
  if (volume < -doubt) return turns < 0 ? -1 : 0;
  return kUnknown;
}

} // namespace

/// The corners of a triangle, in turn, beginning with its lowest: so corners correspond in triangles that lie alike.
struct Bundles::Alike {
  float corners[9];
  std::uint32_t triangle;
};

Bundles::Bundles(std::uint32_t* first, std::uint32_t* last, const std::function<Triangle3(std::uint32_t)>& seen,
                 const FloatBox* boxes)
{
  std::vector<Alike> all;
  all.reserve(static_cast<std::size_t>(last - first));
  for (const std::uint32_t* i = first; i != last; ++i) {
    const Triangle3 t = seen(*i);
    const auto height = [&](std::size_t corner) { return t[corner][2] + 0.77 * t[corner][1] + 0.59 * t[corner][0]; };
    std::size_t lowest = 0;
    for (const std::size_t corner : {std::size_t{1}, std::size_t{2}})
      if (height(corner) < height(lowest)) lowest = corner;
    Alike& alike = all.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) alike.corners[k] = roundToFloat(t[(lowest + k / 3) % 3][k % 3]);
    alike.triangle = *i;
  }
  bundles_.reserve(all.size() / 2 + 1);
  bundle(all.data(), all.data() + all.size(), 0, boxes);
  bundles_.shrink_to_fit();
  for (std::size_t i = 0; i < all.size(); ++i) first[i] = all[i].triangle;
}

/// Makes the bundle of a range, and below it those of its parts along the coordinate in which they differ most.
void Bundles::bundle(Alike* first, Alike* last, std::uint32_t begin, const FloatBox* boxes)
{
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  float low[9], high[9];
  std::fill(low, low + 9, kEndless), std::fill(high, high + 9, -kEndless);
  FloatBox box;
  std::fill(box.low, box.low + 3, kEndless), std::fill(box.high, box.high + 3, -kEndless);
  for (const Alike* alike = first; alike != last; ++alike) {
    for (std::size_t k = 0; k < 9; ++k)
      low[k] = std::min(low[k], alike->corners[k]), high[k] = std::max(high[k], alike->corners[k]);
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], boxes[alike->triangle].low[k]);
      box.high[k] = std::max(box.high[k], boxes[alike->triangle].high[k]);
    }
  }
  Bundle own{box, {}, 0.0f, begin, static_cast<std::uint32_t>(last - first), 0};
  std::size_t widest = 0;
  double reach = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    if (high[k] - low[k] > high[widest] - low[widest]) widest = k;
    const double least = static_cast<double>(low[k]), most = static_cast<double>(high[k]);
    const float middle = roundToFloat(0.5 * least + 0.5 * most);
    own.corners[k / 3][k % 3] = middle;
    // A corner was rounded to a float by at most this.
    const double off = 0x1p-23 * std::max(std::abs(least), std::abs(most)) + 0x1p-140;
    reach = std::max(reach, std::max(most - static_cast<double>(middle), static_cast<double>(middle) - least) + off);
  }
  own.reach = reach < 0x1p60 ? roundUp(reach) : kEndless; // with an endless reach nothing is known
  const std::size_t index = bundles_.size();
  bundles_.push_back(own);
  if (own.count > kSmallest) {
    // Halves of equal numbers would mix different kinds again and again.
    const float between = own.corners[widest / 3][widest % 3];
    Alike* middle = std::partition(first, last, [&](const Alike& l) { return l.corners[widest] < between; });
    const auto below = static_cast<std::uint32_t>(middle - first);
    if (std::min(below, own.count - below) * kFewest < own.count) {
      middle = first + own.count / 2;
      std::nth_element(first, middle, last, [&](const Alike& l, const Alike& r) {
        return l.corners[widest] != r.corners[widest] ? l.corners[widest] < r.corners[widest] : l.triangle < r.triangle;
      });
    }
    bundle(first, middle, begin, boxes);
    bundle(middle, last, begin + static_cast<std::uint32_t>(middle - first), boxes);
  }
  bundles_[index].next = static_cast<std::uint32_t>(bundles_.size());
}

int Bundles::collect(const std::uint32_t* first, const Point3& at, double error, std::vector<std::uint32_t>& found,
                     std::uint64_t& looked_at) const
{
  const UpwardRay ray(at, error);
  int turns = 0;
  for (std::uint32_t i = 0; i < bundles_.size();) {
    const Bundle& bundle = bundles_[i];
    ++looked_at;
    if (ray.misses(bundle.box)) {
      i = bundle.next;
      continue;
    }
    Triangle3 t;
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) t[j][k] = static_cast<double>(bundle.corners[j][k]) - at[k];
    const double reach = (static_cast<double>(bundle.reach) + error) * (1.0 + 4 * kDoubleUnit);
    const int crossings = crossingsOf(t, reach, ray.beginsBelow(bundle.box));
    if (crossings != kUnknown) {
      turns += crossings * static_cast<int>(bundle.count);
      i = bundle.next;
    }
    else if (bundle.count > kSmallest) {
      ++i;
    }
    else {
      found.insert(found.end(), first + bundle.begin, first + bundle.begin + bundle.count);
      i = bundle.next;
    }
  }
  return turns;
}

} // namespace pcl_bsh
