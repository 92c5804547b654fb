// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/beam_spacing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Returns the greater of two chords: to the nearest beam above or below, and to the nearest one left or right, both no
/// farther than `reach`. Infinity where there is no such pair.
double stepAt(const BeamTree& beams, const Beam& beam, double reach)
{
  const Eigen::Vector3d at = beam.direction();
  const Eigen::Vector3d beside =
      (std::abs(at.z()) < 0.999 ? at.cross(Eigen::Vector3d::UnitZ()) : Eigen::Vector3d(Eigen::Vector3d::UnitX()))
          .normalized();
  const Eigen::Vector3d above = at.cross(beside);
  double vertical = kNone, horizontal = kNone;
  beams.any([&](const BeamNode& node) { return !areDisjoint(at, reach, node); },
            [&](const Beam& other) {
              const Eigen::Vector3d way = other.direction() - at;
              const double length = way.norm();
              if (length <= 4.0 * kDirectionError || length > reach) return false; // the same direction
              if (std::abs(way.dot(above)) >= 0.5 * length) vertical = std::min(vertical, length);
              if (std::abs(way.dot(beside)) >= 0.5 * length) horizontal = std::min(horizontal, length);
              return false;
            });
  return std::max(vertical, horizontal);
}

} // namespace

double beamSpacing(const BeamTree& tree)
{
  constexpr std::size_t samples = 1000;
  const std::vector<Beam>& beams = tree.beams();
  std::vector<double> steps;
  const std::size_t count = std::min(samples, beams.size());
  const double even =
      std::sqrt(4.0 * static_cast<double>(EIGEN_PI) / static_cast<double>(std::max<std::size_t>(beams.size(), 1)));
  for (std::size_t i = 0; i < count; ++i) {
    const Beam& beam = beams[i * beams.size() / count];
    double step = kNone;
    for (double reach = even; step == kNone && reach < 4.0; reach *= 2.0) step = stepAt(tree, beam, reach);
    if (step != kNone) steps.push_back(step);
  }
  if (steps.empty()) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

} // namespace pcl_bsh
