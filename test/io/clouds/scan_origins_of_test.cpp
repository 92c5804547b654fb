// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/scan_origins_of.h>

#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace pcl_bsh::io {
namespace {

std::string originsIn(const std::filesystem::path& file)
{
  CloudFacts facts;
  const pcl::PCLPointCloud2 cloud = readCloud(file, &facts);
  return originsOf(cloud, facts).text();
}

TEST(ScanOriginsOf, AreWhatTheFileSays)
{
  const TemporaryFolder folder;
  const std::string axes = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  const std::string one = "1\n1\n" + axes + "4 5 6.5 1\n1 2 3 0.5\n", other = "1\n1\n" + axes + "7 8 9 1\n1 2 3 0.5\n";
  EXPECT_EQ(originsIn(folder.write("one.ptx", one)), "4,5,6.5");
  const std::string at_zero = "1\n1\n" + axes + "0 0 0 1\n1 2 3 0.5\n";
  EXPECT_EQ(originsIn(folder.write("zero.ptx", at_zero)), "0,0,0") << "which a .ptx always says";
  CloudFacts facts;
  const pcl::PCLPointCloud2 second = readCloud(folder.write("second.ptx", one + at_zero), &facts, {{}, false, 1});
  EXPECT_EQ(originsOf(second, facts).text(), "0,0,0");
  EXPECT_EQ(originsIn(folder.write("camera.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                                 "property float y\nproperty float z\nelement camera 1\n"
                                                 "property float view_px\nproperty float view_py\n"
                                                 "property float view_pz\nproperty float x_axisx\n"
                                                 "property float x_axisy\nproperty float x_axisz\n"
                                                 "property float y_axisx\nproperty float y_axisy\n"
                                                 "property float y_axisz\nproperty float z_axisx\n"
                                                 "property float z_axisy\nproperty float z_axisz\nend_header\n"
                                                 "1 1 1\n1 2 3.5 1 0 0 0 1 0 0 0 1\n")),
            "1,2,3.5");
  EXPECT_EQ(originsIn(folder.write("two.ptx", one + other)), "scan:0=4,5,6.5;1=7,8,9");
  const std::string header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nVIEWPOINT ",
                    rest = " 1 0 0 0\nPOINTS 1\nDATA ascii\n";
  EXPECT_EQ(originsIn(folder.write("place.pcd", header + "1 2 3" + rest + "1 1 1\n")), "1,2,3");
  EXPECT_EQ(originsIn(folder.write("none.pcd", header + "0 0 0" + rest + "1 1 1\n")), "")
      << "as files have it without one";
  EXPECT_EQ(originsIn(folder.write("none.xyz", "1 2 3\n")), "");
}

/// Which a viewpoint does not say.
TEST(ScanOriginsOf, AreNotKnownOfSeveralScansInACloud)
{
  const TemporaryFolder folder;
  const std::string header =
      "FIELDS x y z scan\nSIZE 4 4 4 2\nTYPE F F F U\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 1\nDATA ascii\n";
  EXPECT_EQ(originsIn(folder.write("merged.pcd", header + "1 1 1 0\n")), "");
}

} // namespace
} // namespace pcl_bsh::io
