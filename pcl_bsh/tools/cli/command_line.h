// SPDX-License-Identifier: BSD-3-Clause
// How every program reads its command line: CLI11 with checks that say what is wrong and what to give instead.
#pragma once

#include "program.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh::cli {

/// Parses all of main()'s arguments; false when they ask for help or the version, which is
/// printed then. Throws UsageError.
bool understood(CLI::App& app, const std::string& program, int argc, const char* const* argv);

/// Parses arguments of which some were taken out. @param arguments from last to first, as CLI11 wants them
bool understood(CLI::App& app, const std::string& program, std::vector<std::string> arguments,
                const std::function<void()>& check);

/// For transform(): refuses a value that is no Number (double, int, unsigned or std::uint64_t), or not an accepted one,
/// and writes whole numbers without leading zeros, which CLI11 would take for octal ones.
/// @param remedy what to give instead
template <typename Number>
CLI::Validator number(std::string remedy, std::function<bool(Number)> accepted = {});

extern template CLI::Validator number(std::string, std::function<bool(double)>);
extern template CLI::Validator number(std::string, std::function<bool(int)>);
extern template CLI::Validator number(std::string, std::function<bool(unsigned)>);
extern template CLI::Validator number(std::string, std::function<bool(std::uint64_t)>);

/// For transform(): a whole number, with K, M or G behind it or not, each `unit` times the one before; refuses less
/// than `least`.
CLI::Validator amount(std::uint64_t unit, std::uint64_t least, std::string remedy);

inline constexpr auto give_length = "give a length in the clouds' unit";

/// Adds --threads, 0 for all of the machine's.
CLI::Option* addThreads(CLI::App& app, unsigned& threads, const std::string& help);

/// For transform(): replaces a name by its number, from which CLI11 makes an enumerator; refuses other names.
CLI::Validator numberOfName(std::vector<std::pair<std::string, int>> names);

/// For transform(), of an option whose variable is an enumeration.
template <typename Enum>
CLI::Validator choice(const std::vector<std::pair<std::string, Enum>>& names)
{
  std::vector<std::pair<std::string, int>> numbers;
  for (const auto& [name, value] : names) numbers.emplace_back(name, static_cast<int>(value));
  return numberOfName(std::move(numbers));
}

} // namespace pcl_bsh::cli
