// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/accuracy.h>

#include <pcl_bsh/base/invalid_input.h>

#include <array>
#include <charconv>
#include <cmath>

namespace pcl_bsh {
namespace {

struct ModeName {
  Accuracy::Mode mode;
  const char* name;
  bool counts;
};

constexpr std::array<ModeName, 5> mode_names = {{{Accuracy::Mode::exact, "exact", false},
                                                 {Accuracy::Mode::tolerance, "tolerance", true},
                                                 {Accuracy::Mode::level, "level", true},
                                                 {Accuracy::Mode::node_pairs, "pairs", true},
                                                 {Accuracy::Mode::time, "time", true}}};

[[noreturn]] void refuseText(const std::string& text)
{
  throw InvalidInput(Input::accuracy, "accuracy", "'" + text + "' is none",
                     "give exact, tolerance=LENGTH, level=N, pairs=N or time=SECONDS");
}

bool isWhole(Accuracy::Mode mode)
{
  return mode == Accuracy::Mode::level || mode == Accuracy::Mode::node_pairs;
}

} // namespace

Accuracy Accuracy::parse(const std::string& text)
{
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  for (const ModeName& known : mode_names) {
    if (name != known.name) continue;
    Accuracy accuracy{known.mode, 0.0};
    if (known.counts != (equals != std::string::npos)) refuseText(text);
    if (!known.counts) return accuracy;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, accuracy.value);
    const bool number = error == std::errc() && stop == end && std::isfinite(accuracy.value) && accuracy.value >= 0.0;
    if (!number || (isWhole(known.mode) && accuracy.value != std::floor(accuracy.value))) refuseText(text);
    return accuracy;
  }
  refuseText(text);
}

std::string Accuracy::text() const
{
  for (const ModeName& known : mode_names) {
    if (known.mode != mode) continue;
    if (!known.counts) return known.name;
    std::array<char, 32> digits;
    char *const begin = digits.data(), *const room = begin + digits.size();
    const bool whole = isWhole(mode) && value < 0x1p63; // without an exponent, as people write counts
    // Every number has room.
    char* const end = whole ? std::to_chars(begin, room, static_cast<std::uint64_t>(value)).ptr
                            : std::to_chars(begin, room, value).ptr;
    return std::string(known.name) + "=" + std::string(begin, end);
  }
  return {};
}

} // namespace pcl_bsh
