// SPDX-License-Identifier: BSD-3-Clause
// Numbers in records, at any place and in the byte order of LAS and E57, which is this machine's.
#pragma once

#include <cstring>

namespace pcl_bsh::io {

template <typename T>
T loaded(const void* at)
{
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <typename T>
void store(void* at, T value)
{
  std::memcpy(at, &value, sizeof value);
}

} // namespace pcl_bsh::io
