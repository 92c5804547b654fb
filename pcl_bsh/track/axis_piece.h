// SPDX-License-Identifier: BSD-3-Clause
// A short piece of a line whose curvature grows evenly, as a power series about its middle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pcl_bsh {

/// A place and a direction in plan.
struct PlanFrame {
  double x = 0.0, y = 0.0, cosine = 1.0, sine = 0.0;

  /// How far a place is ahead of this one, and to its left.
  double ahead(double px, double py) const { return (px - x) * cosine + (py - y) * sine; }
  double aside(double px, double py) const { return (py - y) * cosine - (px - x) * sine; }
};

/// The curve t -> (X(t), Y(t)), |t| <= half, of the heading k t + c t^2 / 2, in the frame of its middle.
///
/// cos and sin of the heading have the coefficients C_n, S_n with (n + 1) C_{n+1} = -(k S_n + c S_{n-1}) and
/// (n + 1) S_{n+1} = k C_n + c C_{n-1}; X and Y are their integrals. Coefficients e_n of exp(|k| t + |c| t^2 / 2) obey
/// the same recurrence without signs, so they bound |C_n| and |S_n|. Let q = (|k| h + |c| h^2) / (N + 1), and m the
/// larger of e_N h^N and e_{N-1} h^{N-1}. Beyond degree N each term is at most q times the larger of the two before it.
/// All of them together are at most 2 q m / (1 - q). remainder() is h times this bound.
struct AxisPiece {
  static constexpr std::size_t kDegree = 9;
  static constexpr double kMostTurn = 0.125;      ///< of a piece, in radians
  static constexpr double kMostRemainder = 1e-14; ///< of positions

  double begin = 0.0, half = 0.0;       ///< distance of its begin, half its length
  double curvature = 0.0, change = 0.0; ///< at its middle, to the left; per length
  PlanFrame middle;
  std::array<double, kDegree + 1> cosine = {}, sine = {}; ///< C_n, S_n

  AxisPiece(double begin_at, double length, double k, double c)
  : begin(begin_at),
    half(0.5 * length),
    curvature(k),
    change(c)
  {
    cosine[0] = 1.0;
    for (std::size_t n = 0; n < kDegree; ++n) {
      const double s = n > 0 ? sine[n - 1] : 0.0, co = n > 0 ? cosine[n - 1] : 0.0;
      const double next = static_cast<double>(n) + 1.0;
      cosine[n + 1] = -(k * sine[n] + c * s) / next;
      sine[n + 1] = (k * cosine[n] + c * co) / next;
    }
  }

  /// An upper bound of the errors of X and Y within the piece.
  static double remainder(double half, double k, double c)
  {
    const double a = std::abs(k) * half, b = std::abs(c) * half * half;
    double last = 0.0, now = 1.0; // e_{n-1}, e_n
    for (std::size_t n = 0; n < kDegree; ++n) {
      const double next = (a * now + b * last) / (static_cast<double>(n) + 1.0);
      last = now;
      now = next;
    }
    const double q = (a + b) / (static_cast<double>(kDegree) + 1.0);
    return q < 0.5 ? half * 2.0 * q * std::max(last, now) / (1.0 - q) : half;
  }

  /// Place and direction at t, in the frame of the middle.
  PlanFrame at(double t) const
  {
    double x = 0.0, y = 0.0, c = 0.0, s = 0.0;
    for (std::size_t n = kDegree + 1; n-- > 0;) {
      constexpr auto reciprocals = [] {
        std::array<double, kDegree + 1> values = {};
        for (std::size_t i = 0; i <= kDegree; ++i) values[i] = 1.0 / (static_cast<double>(i) + 1.0);
        return values;
      }();
      c = c * t + cosine[n];
      s = s * t + sine[n];
      x = x * t + cosine[n] * reciprocals[n];
      y = y * t + sine[n] * reciprocals[n];
    }
    return {x * t, y * t, c, s};
  }

  /// Place and direction at t, in the axis' own frame.
  PlanFrame placed(double t) const
  {
    const PlanFrame p = at(t);
    return {middle.x + (middle.cosine * p.x - middle.sine * p.y), middle.y + (middle.sine * p.x + middle.cosine * p.y),
            middle.cosine * p.cosine - middle.sine * p.sine, middle.sine * p.cosine + middle.cosine * p.sine};
  }

  /// Where the curve is nearest to a place. @return t, and how far the place is to the left there
  struct Foot {
    double t, left;
  };

  /// F(t) = (q - P(t)) . P'(t) falls in the whole piece, because the reach is below the radius. So its one zero is
  /// bracketed. Newton's steps find it; from the ninth on, a step that leaves the bracket becomes halving.
  /// @pre F(-half) >= 0 >= F(half)
  Foot foot(double px, double py) const
  {
    const double a = middle.ahead(px, py), b = middle.aside(px, py);
    double low = -half, high = half, t = std::clamp(a, low, high), left = b;
    for (int step = 0; step < 60; ++step) {
      const PlanFrame p = at(t);
      const double value = (a - p.x) * p.cosine + (b - p.y) * p.sine;
      left = (b - p.y) * p.cosine - (a - p.x) * p.sine;
      (value > 0.0 ? low : high) = t;
      const double slope = 1.0 - (curvature + change * t) * left;
      double next = std::clamp(t + value / slope, -half, half);
      if (step >= 8 && !(next > low && next < high)) next = 0.5 * (low + high);
      const double moved = std::abs(next - t);
      t = next;
      if (moved <= 1e-8) { // the next step of Newton's would be its square
        const PlanFrame q = at(t);
        return {t, (b - q.y) * q.cosine - (a - q.x) * q.sine};
      }
    }
    return {t, left};
  }
};

} // namespace pcl_bsh
