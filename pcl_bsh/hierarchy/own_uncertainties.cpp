// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/own_uncertainties.h>

#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>

namespace pcl_bsh {

const OwnUncertainties* LazyUncertainties::make(const Voxel& voxel, const PointsView& view)
{
  auto made = std::make_unique<OwnUncertainties>();
  made->points = std::make_unique<float[]>(std::size_t{voxel.count} + kMaxLeafPoints);
  for (std::uint32_t i = 0; i < voxel.count; ++i) made->points[i] = view.uncertainties[voxel.records()[i]];
  made->nodes.resize(voxel.nodes.size());
  for (std::size_t n = voxel.nodes.size(); n-- > 0;) { // children follow their parents
    const Node& node = voxel.nodes[n];
    UncertaintyLanes& lanes = made->nodes[n];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const auto of = [&](const auto* begin_of_least, const auto* begin_of_most, std::size_t count) {
        lanes.least[i] = *std::min_element(begin_of_least, begin_of_least + count);
        lanes.most[i] = *std::max_element(begin_of_most, begin_of_most + count);
      };
      if (node.isLeaf(i)) {
        of(&made->points[node.begin[i]], &made->points[node.begin[i]], node.points(i));
      }
      else {
        const UncertaintyLanes& below = made->nodes[node.child[i]];
        of(below.least, below.most, voxel.nodes[node.child[i]].count);
      }
    }
  }
  const UncertaintyLanes& root = made->nodes[0];
  made->most = *std::max_element(root.most, root.most + voxel.nodes[0].count);
  bool kept = false;
  return made_.keep(std::move(made), kept);
}

} // namespace pcl_bsh
