// SPDX-License-Identifier: BSD-3-Clause
// The effect clashes of a run: the places where other objects come too near to the scan, as pcl_bsh_collide lists them
// of several obstacles.
//
//   SceneClashList list(file, world, options);
//   for (...) list.addStep(); // as the objects stand now
//   list.finish();
#pragma once

#include <pcl_bsh/tools/cli/clash_options.h>

#include <pcl_bsh/io/reports/compared_obstacles.h>
#include <pcl_bsh/io/scenes/scene_file.h>

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

class SceneClashList {
public:
  /// Reads the earlier list. Borrows its arguments. @pre the file lists the effect
  /// @throws std::invalid_argument where the scan is no cloud of points; as io::ClashListing::readEarlier() does
  SceneClashList(const io::SceneFile& file, io::SceneWorld& world, const ClashOptions& options);

  /// Keeps the poses that the objects have now.
  void addStep();

  /// Asks about all steps together, and writes the lists. @throws std::invalid_argument naming the effect
  void finish();

  const std::vector<std::string>& warnings() const { return warnings_; } ///< a line each
  std::string summary() const; ///< after finish(): lines about objects and about pairs, and the count of clashes
  nlohmann::ordered_json json() const; ///< after finish(): the summary for programs

private:
  const io::CloudSource& sourceOf(const std::string& cloud) const;
  Shape shapeOf(const io::CloudSource& source);
  void addObject(ObjectId object);
  void setPaths();
  void compareOthers();

  const io::SceneFile& file_;
  io::SceneWorld& world_;
  const ClashOptions& options_;
  const io::CloudSource& scan_;
  Question question_;
  std::map<std::string, Shape> shapes_; ///< by the name of their cloud
  std::vector<PlacedShape> placed_;
  std::vector<std::pair<ObjectId, std::uint32_t>> parts_; ///< the object and the part of each of placed_
  std::vector<io::ComparedObstacle> obstacles_;
  io::ClashListing listing_;
  std::size_t present_ = 0, perhaps_ = 0;
  std::string counts_;
  std::vector<std::string> warnings_;
};

} // namespace pcl_bsh::cli
