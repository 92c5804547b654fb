// SPDX-License-Identifier: BSD-3-Clause
// Vectors of any kind of number: doubles, LongNumber, Dyadic.
#pragma once

#include <array>
#include <cstddef>

namespace pcl_bsh {

template <class Number>
using Vector3 = std::array<Number, 3>;

template <class Number>
Vector3<Number> operator-(const Vector3<Number>& a, const Vector3<Number>& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Number>
Vector3<Number> operator-(const Vector3<Number>& a)
{
  return {-a[0], -a[1], -a[2]};
}

template <class Number>
Vector3<Number> operator+(const Vector3<Number>& a, const Vector3<Number>& b)
{
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class Number>
Vector3<Number> operator*(const Number& s, const Vector3<Number>& a)
{
  return {s * a[0], s * a[1], s * a[2]};
}

template <class Number>
Number dot(const Vector3<Number>& a, const Vector3<Number>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
Vector3<Number> cross(const Vector3<Number>& a, const Vector3<Number>& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A pose's product with a point, its twelve numbers as they are. @param pose called with row and column
template <class Number, class Pose>
Vector3<Number> placedBy(const Pose& pose, const Vector3<double>& p)
{
  Vector3<Number> at;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = Number(pose(k, 3));
    for (std::size_t j = 0; j < 3; ++j) // upright poses are half zeros
      if (const double r = pose(k, j); r != 0.0) at[k] += Number(r) * Number(p[j]);
  }
  return at;
}

} // namespace pcl_bsh
