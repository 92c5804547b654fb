// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/cli/scene_robots.h>

#include "io/clouds/samples.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <fstream>

namespace pcl_bsh {
namespace {

/// This file is compiled as programs are where urdfdom is not found.
TEST(ReadScene, NamesThePackageThatRobotsNeed)
{
  const io::TemporaryFolder folder;
  const std::filesystem::path file = folder / "scene.json";
  std::ofstream(folder / "arm.urdf") << "<robot/>";
  std::ofstream(file) << R"({"clouds": {}, "objects": [{"name": "arm", "robot": {"urdf": "arm.urdf"}}]})";
  EXPECT_EQ(test::refusalOf([&] { cli::readScene(file); }),
            file.string() + ": objects[0].robot: this program was built without urdfdom: install liburdfdom-dev, "
                            "libconsole-bridge-dev and libpugixml-dev and build it again, or leave 'robot' out");
}

} // namespace
} // namespace pcl_bsh
