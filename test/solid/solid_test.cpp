// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/solid/bodies.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/solid.h>

#include "meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace pcl_bsh {
namespace {

TEST(Solid, RefusesWhatIsOpenAndSaysWhere)
{
  test::ClosedMesh open = test::boxMesh();
  open.corners.erase(open.corners.begin() + 3, open.corners.begin() + 6); // the second triangle of the first side
  try {
    const Solid solid(open.view());
    FAIL();
  }
  catch (const InvalidInput& error) {
    EXPECT_EQ(error.input(), Input::surface);
    EXPECT_EQ(error.index(), 0u);
    EXPECT_EQ(std::string(error.what()),
              "solid: 3 edges are open, the first from (1, 1, 0) to (0, 0, 0) in triangle 0: "
              "close the mesh, or let it count as a surface");
  }
}

/// A cube whose top has a corner in the middle of each side, where the sides have none.
TEST(Solid, TakesCornersWithinEdgesAndSaysWhichPartIsOpen)
{
  test::ClosedMesh cube = test::boxMesh();
  cube.corners.erase(cube.corners.begin() + 6, cube.corners.begin() + 12); // the top
  const std::uint32_t middle = cube.vertex(0.5, 0.5, 1),
                      around[8] = {4, cube.vertex(0.5, 0, 1), 5, cube.vertex(1, 0.5, 1),
                                   7, cube.vertex(0.5, 1, 1), 6, cube.vertex(0, 0.5, 1)};
  for (std::size_t i = 0; i < 8; ++i) cube.triangle(middle, around[i], around[(i + 1) % 8]);
  const Solid solid(cube.view());
  EXPECT_EQ(labelPlace(solid, {0.5, 0.5, 0.5}), Label::inside);
  EXPECT_EQ(labelPlace(solid, {0.5, 0, 1}), Label::surface);
  EXPECT_EQ(SolidBodies(solid).all().size(), 1u);

  test::ClosedMesh beside = cube;
  beside.xyz[3 * around[1] + 1] = -0x1p-1074; // the least step out of the edge
  EXPECT_THAT([&] { Solid(beside.view()); }, testing::ThrowsMessage<InvalidInput>(
                                                 testing::HasSubstr("solid: 3 edges are open, the first from (1, 0, 1) "
                                                                    "to (0, 0, 1) in triangle 3")));
  cube.corners.erase(cube.corners.end() - 6 * 3, cube.corners.end() - 5 * 3); // from (1, 0, 1) to (1, 0.5, 1)
  EXPECT_THAT([&] { Solid(cube.view()); }, testing::ThrowsMessage<InvalidInput>(
                                               testing::HasSubstr("solid: 3 edges are open, the first from (1, 0.5, 1) "
                                                                  "to (1, 0, 1) in triangle 9")));
}

TEST(Solid, RefusesCornersThatAreNotThere)
{
  test::ClosedMesh mesh = test::boxMesh();
  mesh.corners[7] = 8;
  EXPECT_THAT([&] { Solid(mesh.view()); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("names vertex 8 of 8")));
}

TEST(Solid, JoinsCornersOfEqualCoordinates)
{
  const test::ClosedMesh box = test::boxMesh();
  test::ClosedMesh soup;
  for (const std::uint32_t corner : box.corners)
    soup.corners.push_back(soup.vertex(box.xyz[3 * corner], box.xyz[3 * corner + 1], box.xyz[3 * corner + 2]));
  EXPECT_NO_THROW(Solid(soup.view()));
}

TEST(Solid, OfOneBodyIsThatBody)
{
  test::ClosedMesh mesh = test::boxMesh();
  const Solid solid(mesh.view());
  const SolidBodies bodies(solid);
  ASSERT_EQ(bodies.all().size(), 1u);
  EXPECT_EQ(&bodies.solidOf(bodies.all()[0]), &solid);
  mesh.add(test::boxMesh(), 1.0, {5, 0, 0});
  const Solid two(mesh.view());
  const SolidBodies of_two(two);
  ASSERT_EQ(of_two.all().size(), 2u);
  EXPECT_EQ(labelPlace(of_two.solidOf(of_two.all()[1]), {5.5, 0.5, 0.5}), Label::inside);
  EXPECT_EQ(labelPlace(of_two.solidOf(of_two.all()[1]), {0.5, 0.5, 0.5}), Label::outside);
}

TEST(Solid, TakesLittleMemory)
{
  const auto bytesBeyond = [](const test::ClosedMesh& mesh) {
    const std::size_t bytes = Solid(mesh.view()).bytes(), of_each = 70 * mesh.view().count;
    return bytes - std::min(bytes, of_each);
  };
  EXPECT_LT(bytesBeyond(test::bumpyMesh(100, 0.2)), 400000u);
  EXPECT_LT(bytesBeyond(test::latticeMesh(20, 20, 20)), 400000u);
  EXPECT_LT(bytesBeyond(test::fanMesh(30000)), 10'400'000u) << "long and thin";
  EXPECT_LT(bytesBeyond(test::latticeMesh(400, 8, 3)), 10'400'000u) << "likewise";
}

} // namespace
} // namespace pcl_bsh
