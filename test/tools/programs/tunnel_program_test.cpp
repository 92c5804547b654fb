// SPDX-License-Identifier: BSD-3-Clause
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/poses/pose_file.h>

#include <gmock/gmock.h>

namespace pcl_bsh {

using testing::HasSubstr;

TEST(TunnelProgram, WritesWhatCollideReads)
{
  const io::TemporaryFolder folder;
  const std::string tunnel = (folder / "new/tunnel").string();
  const Outcome made = run("pcl_bsh_tunnel", tunnel + " --scale 0.002");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(io::readCloud(tunnel + "/scan.ply").width, 37840u);
  EXPECT_EQ(io::readCloud(tunnel + "/wagon.ply").width, 5000u);
  EXPECT_EQ(io::readPoses(tunnel + "/poses.txt").size(), 38u);

  const Outcome done = run("pcl_bsh_collide", tunnel + "/scan.ply " + tunnel + "/wagon.ply " + tunnel +
                                                  "/marked.ply --clearance 0.2 --trajectory " + tunnel + "/poses.txt");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr(" of 37840 points collide; smallest distance "));
  EXPECT_THAT(done.err, HasSubstr("warning: points lie ")) << "so sparse a scan hides collisions";
}

TEST(TunnelProgram, MakesATightTunnel)
{
  const io::TemporaryFolder folder;
  const Outcome made = run("pcl_bsh_tunnel", (folder / "t").string() + " --scale 0.001 --tight");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(io::readCloud(folder / "t/scan.ply").width, 18920u);
}

TEST(TunnelProgram, Refuses)
{
  const io::TemporaryFolder folder;
  const Outcome scale = run("pcl_bsh_tunnel", (folder / "t").string() + " --scale 0");
  EXPECT_EQ(scale.exit_code, 1);
  EXPECT_THAT(scale.err, HasSubstr("pcl_bsh_tunnel: scale: 0"));
  EXPECT_EQ(run("pcl_bsh_tunnel", "").exit_code, 2);
  const std::string file = folder.write("file", "x").string();
  EXPECT_EQ(run("pcl_bsh_tunnel", file + " --scale 0.001").exit_code, 1);
  EXPECT_EQ(folder.files(), 1u);
  const Outcome help = run("pcl_bsh_tunnel", "--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("pcl_bsh_collide tunnel/scan.ply"));
}

} // namespace pcl_bsh
