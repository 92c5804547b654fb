// SPDX-License-Identifier: BSD-3-Clause
// Parts of the picture beside the clouds.
#pragma once

#include "actors.h"
#include <pcl_bsh/tools/viewer/content/view_content.h>

#include <optional>
#include <string>

namespace pcl_bsh::viewer {

/// Which extras are on.
struct Extras {
  std::optional<unsigned> level; ///< of the spheres
  bool voxels = false, cells = false, trace = false;
  bool open_edges = false; ///< of surfaces
  bool beams = false;      ///< of the scan's scanner
};

/// Adds what shows the algorithm at work: spheres of a level, voxels and octree cells as wire boxes, and what a query
/// tested and pruned.
void addExtras(PropGroup& group, const ViewContent& content, const Extras& extras, std::size_t step);

/// How many edges of a cloud's triangles are open; 0 of points.
std::size_t openEdgesOf(const ViewedCloud& viewed);

/// Adds a closest pair as a segment with a label.
void addClosestPair(PropGroup& group, const ClosestPair& closest, const std::string& text);

/// Adds contacts as arrows along their normals, before all else, red where the gap is below 0.
void addContacts(PropGroup& group, const std::vector<Contact>& contacts, double length);

/// Adds the paths of a step as lines.
void addPaths(PropGroup& group, const MotionPaths& paths);

} // namespace pcl_bsh::viewer
