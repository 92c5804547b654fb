// SPDX-License-Identifier: BSD-3-Clause
// Searches for the worst case of an error bound, one number at a time: random near-ties do not find it.
#pragma once

#include "random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_bsh::test {

/// A number near `x`, or like it: some bits of its mantissa changed, its sign, its power of two, or all.
inline double mutated(double x, Random& random)
{
  const double unit = std::ldexp(1.0, x == 0.0 ? 0 : std::ilogb(x));
  switch (random.integer(0, 9)) {
  case 0:
    return -x;
  case 1:
    return std::ldexp(x, random.integer(-2, 2));
  case 2:
    return std::copysign(unit * (1.0 + std::ldexp(random.uniform(0, 1), -random.integer(0, 30))), x);
  case 3:
    return 0.0;
  case 4:
    return std::ldexp(random.uniform(-1, 1), -random.integer(0, 28));
  default:
    return x + unit * std::ldexp(random.uniform(-1, 1), -random.integer(1, 52));
  }
}

/// From `start`, keeps what does not lower fitness(numbers), for so many steps. @return the fitness reached
template <class Fitness>
double climb(std::vector<double>& numbers, const Fitness& fitness, int steps, Random& random)
{
  double best = fitness(numbers);
  for (int step = 0; step < steps; ++step) {
    const std::vector<double> before = numbers;
    const int changes = random.chance(0.7) ? 1 : 2;
    for (int k = 0; k < changes; ++k) {
      double& number = numbers[static_cast<std::size_t>(random.integer(0, static_cast<int>(numbers.size()) - 1))];
      number = mutated(number, random);
    }
    const double found = fitness(numbers);
    if (found >= best)
      best = found;
    else
      numbers = before;
  }
  return best;
}

/// The best of climbs from many starts, the best of these continued. @param start makes numbers
template <class Start, class Fitness>
double climbFromMany(const Start& start, const Fitness& fitness, int starts, int steps, Random& random,
                     std::vector<double>* where = nullptr)
{
  double best = -1.0;
  std::vector<double> champion;
  for (int k = 0; k < starts; ++k) {
    std::vector<double> numbers = start();
    const double reached = climb(numbers, fitness, steps, random);
    if (reached > best) best = reached, champion = numbers;
  }
  best = climb(champion, fitness, starts * steps, random);
  if (where) *where = champion;
  return best;
}

} // namespace pcl_bsh::test
