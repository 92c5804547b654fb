// SPDX-License-Identifier: BSD-3-Clause
#include "program_run.h"

#include <gmock/gmock.h>

namespace pcl_bsh {

using testing::HasSubstr;

TEST(Demo, NoticesOtherNumbers)
{
  const io::TemporaryFolder folder;
  const std::string building = folder.write("building.xyz", "0 0 0\n1 1 1\n").string();
  const std::string man = folder.write("man.off", "OFF 2 0 0\n0 0 -0.5\n0 0 0.5\n").string();
  const Outcome demo = run("pcl_bsh_demo", building + " " + man + " " + (folder / "out.pcd").string());
  EXPECT_EQ(demo.exit_code, 1);
  EXPECT_THAT(demo.out, HasSubstr("not the reference: 53, 0.004"));
  EXPECT_THAT(demo.out, HasSubstr("0 of 10 rows agree"));
  const std::string alone = folder.write("alone.xyz", "0 0 0\n").string();
  EXPECT_THAT(run("pcl_bsh_demo", building + " " + alone + " " + (folder / "out.pcd").string()).out,
              HasSubstr("A man of 1 point walks through a scanned building of 2 points; "));
}

TEST(Demo, SaysWhatItNeeds)
{
  EXPECT_EQ(run("pcl_bsh_demo", "").exit_code, 2);
  const Outcome missing = run("pcl_bsh_demo", "nowhere.ply man.off out.pcd");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_EQ(missing.err, "pcl_bsh_demo: nowhere.ply: no such file: check the name\n");
}

} // namespace pcl_bsh
