// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/near_boxes.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pcl_bsh {

NearBoxes::NearBoxes(std::vector<Extent> boxes)
: boxes_(std::move(boxes)),
  order_(boxes_.size()),
  is_gone_(boxes_.size(), false)
{
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

void NearBoxes::build(std::uint32_t begin, std::uint32_t end)
{
  const std::size_t number = nodes_.size();
  Node node{boxes_[order_[begin]], begin, end, 0, end - begin};
  const auto middle = [](const Extent& box, std::size_t k) { return 0.5 * box.low[k] + 0.5 * box.high[k]; };
  Point3 least = node.box.low, greatest = node.box.low; // of the middles
  for (std::uint32_t i = begin; i < end; ++i) node.box.add(boxes_[order_[i]]);
  for (std::size_t k = 0; k < 3; ++k) {
    least[k] = greatest[k] = middle(node.box, k);
    for (std::uint32_t i = begin; i < end; ++i) {
      const Extent& box = boxes_[order_[i]];
      least[k] = std::min(least[k], middle(box, k));
      greatest[k] = std::max(greatest[k], middle(box, k));
    }
  }
  nodes_.push_back(node);
  if (end - begin <= leaf_size) return;
  std::size_t axis = 0; // along which the middles are widest apart
  for (std::size_t k = 1; k < 3; ++k)
    if (greatest[k] - least[k] > greatest[axis] - least[axis]) axis = k;
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(middle(boxes_[a], axis), a) < std::pair(middle(boxes_[b], axis), b);
                   });
  build(begin, half);
  nodes_[number].second = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

} // namespace pcl_bsh
