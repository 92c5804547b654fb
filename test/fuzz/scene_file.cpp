// SPDX-License-Identifier: BSD-3-Clause
// Any text as a scene: refused with a reason, or objects of clouds that the scene has, at finite poses.
#include "refusal.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/scenes/scene_file.h>

#include <string>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  try {
    const io::SceneFile scene = io::parseScene(std::string(reinterpret_cast<const char*>(data), size), "fuzzed.json");
    for (const io::ObjectEntry& object : scene.objects)
      fuzz::require(object.pose.matrix().allFinite(), "a pose that is not finite");
  }
  catch (const io::JsonError& error) {
    fuzz::requireReason(error);
  }
  catch (const files::FileError& error) {
    fuzz::requireReason(error);
  }
  return 0;
}
