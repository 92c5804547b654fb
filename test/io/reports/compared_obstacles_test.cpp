// SPDX-License-Identifier: BSD-3-Clause
// Memory that the answers about many obstacles keep.
#include "support/random_clouds.h"

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/io/reports/compared_obstacles.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace pcl_bsh::io {
namespace {

/// Bytes of the heap in use; 0 where nobody tells.
std::size_t usedBytes()
{
#ifdef __GLIBC__
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

/// A scan and obstacles of a point each, which are points of the scan.
class ComparedObstacles : public testing::Test {
protected:
  ObstaclesAnswer ask(std::size_t obstacles)
  {
    shapes.clear();
    compared.clear();
    for (std::size_t i = 0; i < obstacles; ++i) {
      shapes.push_back({Shape("one", viewOf(scan[i].data(), 1))});
      compared.push_back({"obstacle " + std::to_string(i), "one.ply"});
    }
    Question question;
    question.clearance = 0.001;
    question.wanted.flags = question.wanted.contacts = question.wanted.closest = true;
    return askAbout(question, input, shapes, compared);
  }

  test::Random random{61};
  const std::vector<Point3> scan = test::makePoints(test::Shape::uniform, 100000, 10.0, random);
  Shape input{"scan", viewOf(scan[0].data(), scan.size())};
  std::vector<PlacedShape> shapes;
  std::vector<ComparedObstacle> compared;
};

TEST_F(ComparedObstacles, KeepNoEntryForEachRecordOfTheInput)
{
  ask(2); // builds what all share
  const std::size_t before = usedBytes();
  const ObstaclesAnswer found = ask(40);
  const std::size_t kept = usedBytes() - before;
  for (std::size_t i = 0; i < compared.size(); ++i) {
    EXPECT_EQ(compared[i].found.verdict, Verdict::colliding);
    ASSERT_EQ(compared[i].colliding.records.size(), 1U);
    EXPECT_EQ(compared[i].colliding.records[0], static_cast<std::int32_t>(i));
    EXPECT_EQ(compared[i].colliding.found.distance[0], 0.0F);
  }
  EXPECT_EQ(found.all.collisions.colliding, 40U);
  constexpr std::size_t of_each = 21; // bytes: a flag, a distance, two poses, a record, an obstacle
  EXPECT_LT(kept, 3 * of_each * scan.size()) << "the answer about all together, and little more";
}

} // namespace
} // namespace pcl_bsh::io
