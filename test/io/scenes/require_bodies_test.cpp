// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/cli/scene_bodies.h>

#include "support/refusal.h"

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

/// This file is compiled as programs are where Bullet is not found.
TEST(RequireBodies, NamesThePackage)
{
  io::SceneFile file;
  file.path = "fall.json";
  EXPECT_EQ(test::refusalOf([&] { cli::requireBodies(file); }), "");
  file.bodies.emplace();
  EXPECT_EQ(test::refusalOf([&] { cli::requireBodies(file); }),
            "fall.json: effects.bodies: this program was built without Bullet: install libbullet-dev and build it "
            "again, or leave 'bodies' out");
}

} // namespace
} // namespace pcl_bsh
