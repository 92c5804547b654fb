// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace pcl_bsh::fuzz {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Hands out values from the front of an input; zeros once it is used up, so that every input means something.
class Bytes {
public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  template <class T>
  T take()
  {
    T value{};
    const std::size_t taken = std::min(sizeof(T), left_);
    if (taken > 0) std::memcpy(&value, data_, taken);
    data_ += taken;
    left_ -= taken;
    return value;
  }

  /// A number below `limit`, from one byte.
  unsigned below(unsigned limit) { return take<std::uint8_t>() % limit; }

  bool empty() const { return left_ == 0; }

private:
  const std::uint8_t* data_;
  std::size_t left_;
};

} // namespace pcl_bsh::fuzz
