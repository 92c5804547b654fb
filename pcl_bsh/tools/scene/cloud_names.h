// SPDX-License-Identifier: BSD-3-Clause
// The names of the files of a scene's clouds.
#pragma once

#include <pcl_bsh/io/scenes/scene_file.h>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// OBJECT_000012.pcd or OBJECT_PART_000012.pcd (.ply of a surface), with only such letters as every disk allows. No two
/// parts of a scene share a name, not even where upper and lower case are alike: later ones get a number.
class CloudNames {
public:
  explicit CloudNames(const io::SceneFile& file);

  std::string of(std::size_t object, std::size_t part, std::size_t step) const;

  /// Whether a file has the name of some part at some step, in upper or lower case.
  bool mayBe(const std::string& file) const;

private:
  std::vector<std::vector<std::string>> names_; ///< of each object's parts
  std::set<std::string> taken_;                 ///< in lower case
};

} // namespace pcl_bsh::cli
