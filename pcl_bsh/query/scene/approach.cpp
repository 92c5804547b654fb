// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/scene/approach.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

std::optional<double> meeting(const Eigen::Vector3d& apart, const Eigen::Vector3d& shift, const ContactZone& zone)
{
  const double along = apart.dot(shift), length2 = shift.squaredNorm();
  if (!(along < 0.0) || length2 == 0.0) return std::nullopt; // no nearer than now
  const double nearest = std::min(1.0, -along / length2);
  const double inner = zone.inner(), outer = zone.outer();
  if ((apart + nearest * shift).squaredNorm() >= inner * inner) return std::nullopt;
  const double now2 = apart.squaredNorm();
  if (now2 <= inner * inner) return 0.0;
  const double halt = now2 > outer * outer ? outer : inner;
  // The smaller root of |apart + s shift| = halt, in the form that does not cancel.
  const double gap = now2 - halt * halt;
  const double root = std::sqrt(std::max(0.0, along * along - length2 * gap));
  return std::clamp(gap / (root - along), 0.0, 1.0);
}

std::optional<double> meeting(const Path& path_a, const Eigen::Vector3d& p, const Path& path_b,
                              const Eigen::Vector3d& q, const ContactZone& zone, double begin, double end)
{
  if (!path_a.turns() && !path_b.turns()) {
    const Eigen::Vector3d apart = path_a.at(begin) * p - path_b.at(begin) * q;
    const auto s = meeting(apart, (end - begin) * (path_a.shift() - path_b.shift()), zone);
    if (!s) return std::nullopt;
    return begin + *s * (end - begin);
  }
  const double speed = path_a.speedOf(p) + path_b.speedOf(q);
  if (!(speed > 0.0)) return std::nullopt;
  const double shortest = zone.tolerance / 16; // a step that is not worth taking any more
  bool inside = false;                         // the outer distance has been passed before the way began
  for (double s = begin;;) {
    const double distance = (path_a.at(s) * p - path_b.at(s) * q).norm();
    if (s == begin) inside = distance <= zone.outer();
    if (distance > zone.outer()) inside = false;
    if (!inside && distance <= zone.outer()) return s;
    const double left = distance - zone.inner();
    if (left < shortest && inside) {
      // Let pass who does not come nearer from here.
      const double ahead = std::min(end, s + shortest / speed);
      if ((path_a.at(ahead) * p - path_b.at(ahead) * q).norm() < distance) return s;
      if (ahead >= end) return std::nullopt;
      s = ahead;
      continue;
    }
    s += std::max(left, shortest) / speed;
    if (s >= end) return std::nullopt;
  }
}

} // namespace pcl_bsh
