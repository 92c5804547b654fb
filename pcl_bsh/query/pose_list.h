// SPDX-License-Identifier: BSD-3-Clause
// Any list of poses, as queries read it: without a copy.
#pragma once

#include <pcl_bsh/export.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <type_traits>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Refers to a list with size() and operator[], which gives an Eigen::Isometry3d or a type that converts to one. A
/// std::vector, a std::deque and a span are such lists, and a class that makes its poses when asked. The list must
/// outlive the call that it is given to; several threads read it at once, in any order.
class PoseList {
public:
  /// Not explicit: queries take any such list.
  template <class List, class = std::enable_if_t<!std::is_same_v<List, PoseList>>>
  PoseList(const List& list)
  : list_(&list),
    size_(static_cast<std::size_t>(list.size())),
    at_([](const void* any, std::size_t i) -> Eigen::Isometry3d { return (*static_cast<const List*>(any))[i]; })
  {
  }

  std::size_t size() const noexcept { return size_; }                         ///< poses
  Eigen::Isometry3d operator[](std::size_t i) const { return at_(list_, i); } ///< 0 <= i < size()

private:
  const void* list_;
  std::size_t size_;
  Eigen::Isometry3d (*at_)(const void*, std::size_t);
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
