// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/used_vertices.h>

#include <gmock/gmock.h>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(UsedVertices, AreNumberedInTheirOrder)
{
  std::vector<std::vector<int>> faces = {{4, 1, 6}, {}, {1, 4}};
  EXPECT_THAT(keepUsedVertices(8, faces), ElementsAre(1, 4, 6));
  EXPECT_THAT(faces, ElementsAre(ElementsAre(1, 0, 2), IsEmpty(), ElementsAre(0, 1)));
  faces = {{0}, {2}};
  EXPECT_THAT(keepUsedVertices(3, faces), ElementsAre(0, 2)) << "the first and the last";
  faces.clear();
  EXPECT_THAT(keepUsedVertices(3, faces), IsEmpty());
}

TEST(UsedVertices, AreThoseOfEachListInTurn)
{
  UsedVertices used(1000);
  const auto itself = [](auto& face) -> auto&
  {
    return face;
  };
  std::vector<std::vector<int>> scattered = {{999, 3}, {500, 3}}, together = {{5, 3}, {4, 5}}, none;
  EXPECT_THAT(used.keep(scattered, itself), ElementsAre(3, 500, 999));
  EXPECT_THAT(scattered, ElementsAre(ElementsAre(2, 0), ElementsAre(1, 0)));
  EXPECT_THAT(used.keep(none, itself), IsEmpty());
  EXPECT_THAT(used.keep(together, itself), ElementsAre(3, 4, 5)) << "nothing is left of the list before";
  EXPECT_THAT(together, ElementsAre(ElementsAre(2, 0), ElementsAre(1, 2)));
}

TEST(UsedVertices, ValuesAreThoseOfWhatIsKept)
{
  EXPECT_THAT(keptValues(std::vector<float>{1, 2, 3}, {1, 0, 1}), ElementsAre(1.0f, 3.0f));
  EXPECT_THAT(keptValues(std::vector<float>{1}, {1, 1, 1}), ElementsAre(1.0f)) << "of fewer values than flags";
  EXPECT_THAT(keptValues(std::vector<float>{}, {}), IsEmpty());
}

} // namespace
} // namespace pcl_bsh
