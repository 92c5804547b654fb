// SPDX-License-Identifier: BSD-3-Clause
// Takes faces away from a mesh: keeps the vertices and values that the other faces use.
#pragma once

#include <pcl/types.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace pcl_bsh {

/// Renumbers the corners of faces of one mesh, for several lists of faces in turn. The cost of a list depends on its
/// own size, not on that of the mesh.
class UsedVertices {
public:
  /** For a mesh of so many vertices. */ explicit UsedVertices(std::size_t vertices) : number_(vertices, unused) {}

  /// Renumbers corners so that only vertices which a face has are left, in their order.
  /// @param faces of corners from 0, each below the number of vertices
  /// @param cornersOf called with a face, returns a range of its corners, which are replaced
  /// @return the vertices that are left, by their former numbers
  template <typename Faces, typename CornersOf>
  pcl::Indices keep(Faces& faces, const CornersOf& cornersOf)
  {
    pcl::Indices used;
    for (auto& face : faces) {
      for (const auto corner : cornersOf(face)) {
        std::uint32_t& number = number_[static_cast<std::size_t>(corner)];
        if (number == unused) used.push_back(static_cast<pcl::index_t>(corner));
        number = 0;
      }
    }
    order(used);
    for (std::size_t i = 0; i < used.size(); ++i)
      number_[static_cast<std::size_t>(used[i])] = static_cast<std::uint32_t>(i);
    for (auto& face : faces) {
      for (auto& corner : cornersOf(face))
        corner = static_cast<std::remove_reference_t<decltype(corner)>>(number_[static_cast<std::size_t>(corner)]);
    }
    for (const pcl::index_t vertex : used) number_[static_cast<std::size_t>(vertex)] = unused;
    return used;
  }

private:
  static constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

  /// Looks through the range of numbers where that is quicker than sorting.
  void order(pcl::Indices& used) const
  {
    constexpr std::size_t scattered = 16; // numbers in the range for each used one
    if (used.empty()) return;
    const auto [least, greatest] = std::minmax_element(used.begin(), used.end());
    const auto first = static_cast<std::size_t>(*least), last = static_cast<std::size_t>(*greatest);
    if (last - first > scattered * used.size()) {
      std::sort(used.begin(), used.end());
      return;
    }
    used.clear();
    for (std::size_t i = first; i <= last; ++i)
      if (number_[i] != unused) used.push_back(static_cast<pcl::index_t>(i));
  }

  std::vector<std::uint32_t> number_; ///< of each vertex
};

/// As UsedVertices::keep(), for one list: the faces of a mesh that are left.
template <typename Faces, typename CornersOf>
pcl::Indices keepUsedVertices(std::size_t vertices, Faces& faces, const CornersOf& cornersOf)
{
  return UsedVertices(vertices).keep(faces, cornersOf);
}

/// Keeps the vertices of faces that are ranges of their corners.
template <typename Faces>
pcl::Indices keepUsedVertices(std::size_t vertices, Faces& faces)
{
  return keepUsedVertices(
      vertices, faces, [](auto& face) -> auto& { return face; });
}

/// Returns the values whose flag in `kept` is not 0, in their order. @pre no more values than flags
template <typename Value>
std::vector<Value> keptValues(const std::vector<Value>& values, const std::vector<std::uint8_t>& kept)
{
  std::vector<Value> left;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (kept[i] != 0) left.push_back(values[i]);
  return left;
}

} // namespace pcl_bsh
