// SPDX-License-Identifier: BSD-3-Clause
// Verdicts as tests write and print them.
#pragma once

#include <pcl_bsh/query/result.h>

#include <array>
#include <cstddef>
#include <initializer_list>
#include <ostream>
#include <vector>

namespace pcl_bsh {

/// As GoogleTest prints it.
inline void PrintTo(Verdict verdict, std::ostream* out)
{
  constexpr std::array<const char*, 5> names = {"free", "colliding", "undecided", "sparse", "unseen"};
  const auto number = static_cast<std::size_t>(verdict);
  if (number < names.size())
    *out << names[number];
  else
    *out << "no verdict: " << number;
}

namespace test {

/// From numbers: 0 free, 1 colliding, 2 undecided, 3 sparse, 4 unseen.
inline std::vector<Verdict> verdictsOf(std::initializer_list<int> numbers)
{
  std::vector<Verdict> verdicts;
  for (const int number : numbers) verdicts.push_back(static_cast<Verdict>(number));
  return verdicts;
}

inline Verdict verdictIf(bool collides)
{
  return collides ? Verdict::colliding : Verdict::free;
}

/// To count verdicts by kind.
inline std::size_t numberOf(Verdict verdict)
{
  return static_cast<std::size_t>(verdict);
}

} // namespace test
} // namespace pcl_bsh
