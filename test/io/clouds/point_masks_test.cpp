// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/io/clouds/point_masks.h>
#include <pcl_bsh/io/files/file_error.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PointMasks : public testing::Test {
protected:
  IgnoredPoints ignoring(const std::string& text) const
  {
    const std::string file = folder.write("marks.txt", text).string();
    return IgnoredPoints::parse("box=0,0,0,1,1,1;mask=" + file);
  }

  std::string refusal(const std::string& text) const
  {
    IgnoredPoints ignored = ignoring(text);
    try {
      readMasks(ignored);
    }
    catch (const files::FileError& error) {
      return error.what();
    }
    return "nothing is refused";
  }

  const TemporaryFolder folder;
};

TEST_F(PointMasks, AreALineForEachPoint)
{
  IgnoredPoints ignored = ignoring("# of the floor\n0\r\n1 # here\n\n 1\n0");
  EXPECT_THAT(maskFilesOf(ignored), ElementsAre(folder / "marks.txt"));
  readMasks(ignored);
  ASSERT_TRUE(ignored.terms[1].mask);
  EXPECT_FALSE(ignored.terms[0].mask);
  EXPECT_THAT(*ignored.terms[1].mask, ElementsAre(0, 1, 1, 0));
}

TEST_F(PointMasks, RefuseWhatIsNone)
{
  EXPECT_THAT(refusal("0\n2\n"), HasSubstr("marks.txt: line 2 has '2': give 1 where a point does not count, else 0"));
  EXPECT_THAT(refusal("0 1\n"), HasSubstr("line 1 has more values than it should"));
  EXPECT_THAT(refusal("floor\n0\n"), HasSubstr("line 1 has 'floor'"));
  IgnoredPoints ignored = IgnoredPoints::parse("mask=none.txt");
  EXPECT_THROW(readMasks(ignored), files::FileError);
}

} // namespace
} // namespace pcl_bsh::io
