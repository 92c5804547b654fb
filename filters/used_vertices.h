// SPDX-License-Identifier: BSD-3-Clause
// Takes faces away from a mesh: keeps the vertices and values that the other faces use.
#pragma once

#include <pcl/types.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace pcl_bsh {

/// Renumbers the corners of faces so that only vertices which a face has are left, in their order.
/// @param faces of corners from 0, each below `vertices`
/// @param cornersOf from a face to a range of its corners, which are replaced
/// @return the vertices that are left, by their former numbers
template <typename Faces, typename CornersOf>
pcl::Indices keepUsedVertices(std::size_t vertices, Faces& faces, const CornersOf& cornersOf)
{
  std::vector<std::uint32_t> number(vertices, 0);
  for (auto& face : faces)
    for (const auto corner : cornersOf(face)) number[static_cast<std::size_t>(corner)] = 1;
  pcl::Indices used;
  for (std::size_t i = 0; i < vertices; ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(used.size());
    used.push_back(static_cast<pcl::index_t>(i));
  }
  for (auto& face : faces) {
    for (auto& corner : cornersOf(face))
      corner = static_cast<std::remove_reference_t<decltype(corner)>>(number[static_cast<std::size_t>(corner)]);
  }
  return used;
}

/// Keeps the vertices of faces that are ranges of their corners.
template <typename Faces>
pcl::Indices keepUsedVertices(std::size_t vertices, Faces& faces)
{
  return keepUsedVertices(
      vertices, faces, [](auto& face) -> auto& { return face; });
}

/// The values of those that are kept. @pre no more values than flags
template <typename Value>
std::vector<Value> keptValues(const std::vector<Value>& values, const std::vector<std::uint8_t>& kept)
{
  std::vector<Value> left;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (kept[i] != 0) left.push_back(values[i]);
  return left;
}

} // namespace pcl_bsh
