// SPDX-License-Identifier: BSD-3-Clause
#include "defect.h"

#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/text_cursor.h>

namespace pcl_bsh::io {

TEST(HeaderCount, MayBeNeitherMoreNorLess)
{
  const HeaderCount two{2};
  EXPECT_NO_THROW(requireNoFewer(two, 2));
  EXPECT_NO_THROW(requireNoFewer(two, 3));
  EXPECT_EQ(defectOf([&] { requireNoFewer(two, 1); }), "is truncated: 1 of 2 points are there");
  EXPECT_EQ(defectOf([&] { requireNoFewer({1, "face"}, 0); }), "is truncated: 0 of 1 face is there");
  EXPECT_NO_THROW(requireNoMore(two, 2));
  EXPECT_NO_THROW(requireNoMore(two, 1));
  EXPECT_EQ(defectOf([&] { requireNoMore(two, 3); }), "has 3 points, and its header counts 2");
  EXPECT_FALSE(remarkOnCount(two, 2));
  EXPECT_EQ(remarkOnCount(two, 3), "its header counts 2 points, and 3 are there: all that are there are read");
  EXPECT_EQ(remarkOnCount({2, "vertex", "vertices"}, 1),
            "its header counts 2 vertices, and 1 is there: all that are there are read");
}

TEST(HeaderCount, NoLineMayFollow)
{
  TextCursor none(" \n\n# a comment\n", '#');
  EXPECT_NO_THROW(requireNoMoreLines({2}, none));
  TextCursor more("\n1 2 3\n\n4 5 6", '#');
  try {
    requireNoMoreLines({2}, more);
    ADD_FAILURE() << "was taken";
  }
  catch (const FormatError& error) {
    EXPECT_STREQ(error.what(), "line 2 is one more point than the header promises");
    EXPECT_EQ(error.remedy(), "mend the count in its header, for there are 4 points, or export the file again");
  }
  TextCursor one("1 2 3");
  try {
    requireNoMoreLines({0}, one);
    ADD_FAILURE() << "was taken";
  }
  catch (const FormatError& error) {
    EXPECT_EQ(error.remedy(), "mend the count in its header, for there is 1 point, or export the file again");
  }
}

TEST(HeaderCount, NoRecordMayFollow)
{
  const HeaderCount two{2};
  for (const std::uint64_t part : {0u, 1u, 11u}) {
    EXPECT_NO_THROW(requireNoMoreBytes(two, part, 12)) << part;
    EXPECT_FALSE(remarkOnMoreBytes(two, part, std::string(part, 'x'), 12)) << part;
  }
  EXPECT_EQ(defectOf([&] { requireNoMoreBytes(two, 12, 12); }), "has 3 points, and its header counts 2");
  EXPECT_EQ(defectOf([&] { requireNoMoreBytes(two, 35, 12); }), "has 4 points, and its header counts 2");
  EXPECT_EQ(defectOf([&] { requireNoMoreBytes(two, 13, 13, false); }),
            "has 13 bytes behind the 2 points that its header counts");
  EXPECT_EQ(remarkOnMoreBytes(two, 12, std::string(12, 'x'), 12),
            "its header counts 2 of the 3 points there is room for: 1 is left out");
  EXPECT_EQ(remarkOnMoreBytes(two, 1'000'000, std::string(11, '\0') + "x", 10),
            "its header counts 2 of the 100002 points there is room for: 100000 are left out");
  EXPECT_FALSE(remarkOnMoreBytes(two, 30, std::string(30, '\0'), 12)) << "padding, as PCL writes it";
}

} // namespace pcl_bsh::io
