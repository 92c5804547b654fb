// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/small_letters.h>

#include <gtest/gtest.h>

namespace pcl_bsh::io {
namespace {

TEST(SmallLetters, ChangesLettersAlone)
{
  EXPECT_EQ(inSmallLetters("Normal_X-9"), "normal_x-9");
  EXPECT_EQ(inSmallLetters("\xc3\x84"), "\xc3\x84"); // bytes beyond ASCII stay
}

TEST(SmallLetters, ExtensionIsOfTheLastNameWithItsDot)
{
  EXPECT_EQ(extensionOf("Scan.PLY"), ".ply");
  EXPECT_EQ(extensionOf("a.tar.Pcd"), ".pcd");
  EXPECT_EQ(extensionOf("folder.d/scan"), "");
  EXPECT_EQ(extensionOf("-"), "");
}

} // namespace
} // namespace pcl_bsh::io
