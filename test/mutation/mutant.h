// SPDX-License-Identifier: BSD-3-Clause
// The switch that mutated sources are compiled with: see mutants.py.
#pragma once

#include <cstdlib>

/// The mutant that is on, by the environment's PCL_BSH_MUTANT. 0: none. -1: none, and which are reached is kept.
inline const int pcl_bsh_chosen_mutant = [] {
  const char* const chosen = std::getenv("PCL_BSH_MUTANT");
  return chosen ? std::atoi(chosen) : 0;
}();
inline constexpr int kMostMutants = 32768;
inline unsigned char pcl_bsh_reached_mutants[kMostMutants] = {};

/// False wherever the compiler computes.
constexpr bool pcl_bsh_mutant(int number)
{
  if (__builtin_is_constant_evaluated()) return false;
  if (pcl_bsh_chosen_mutant < 0) pcl_bsh_reached_mutants[number] = 1;
  return pcl_bsh_chosen_mutant == number;
}
