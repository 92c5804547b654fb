// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/origin_file.h>

#include <pcl_bsh/io/files/file_error.h>

#include "support/temporary_folder.h"

#include <gmock/gmock.h>

#include <string>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

TEST(OriginFile, ReadsItsColumnsByName)
{
  const files::TemporaryFolder folder;
  folder.write("path.csv", "# a wagon\nN,E,H,speed,gps_time\n2,1,3,0,10\n4,2,3,0,20\n");
  const OriginPath path = readOriginPath(folder / "path.csv");
  EXPECT_EQ(path.from(), 10);
  EXPECT_EQ(path.to(), 20);
  EXPECT_EQ(path.at(15), (Point3{1.5, 3, 3}));
}

TEST(OriginFile, NamesTheLineThatIsWrong)
{
  const files::TemporaryFolder folder;
  const auto refusal = [&](const std::string& lines) -> std::string {
    folder.write("path.csv", "time,x,y,z\n" + lines);
    try {
      readOriginPath(folder / "path.csv");
      return {};
    }
    catch (const files::FileError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(refusal("1,0,0,0\n\n2,1,0,0\n2,2,0,0\n"),
              HasSubstr("path.csv: line 5 is no place of a path: its time 2 does not exceed the one"));
  EXPECT_THAT(refusal("1,0,0,0\n2,inf,0,0\n"),
              HasSubstr("path.csv: line 3 is no place of a path: has a value that is not finite: correct it"));
  EXPECT_THAT(
      refusal("1,0,0,0\n2,a,0,0\n"),
      HasSubstr("path.csv: line 3 is damaged: 'a' is not a number: give a place in each line, in columns time"));
  EXPECT_THAT(refusal("1,0,0,0\n"), HasSubstr("path.csv: has 1 of the two places it needs"));
  EXPECT_THAT(refusal(""), HasSubstr("path.csv: has 0 of the two places it needs"));
}

} // namespace
} // namespace pcl_bsh::io
