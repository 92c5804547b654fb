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
