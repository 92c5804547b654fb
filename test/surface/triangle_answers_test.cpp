// SPDX-License-Identifier: BSD-3-Clause
#include "support/made_meshes.h"
#include "support/verdicts.h"

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/surface/triangle_answers.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;

constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

/// Six balls of four triangles; the third has none.
SurfaceCover sixBalls()
{
  SurfaceCover cover;
  cover.centers.resize(6);
  cover.radii.resize(6);
  cover.triangles = {0, 0, 1, 1, 3, 0};
  cover.triangle_count = 4;
  cover.triangles_apart = true;
  return cover;
}

TEST(TriangleAnswers, TakeTheGravestVerdict)
{
  EXPECT_EQ(triangleVerdicts(sixBalls(), test::verdictsOf({0, 2, 3, 0, 0, 1})), test::verdictsOf({1, 3, 0, 0}));
  EXPECT_EQ(triangleVerdicts(sixBalls(), test::verdictsOf({3, 2, 1, 2, 3, 0})), test::verdictsOf({2, 1, 0, 3}));
}

TEST(TriangleAnswers, TakeTheNearestBallThenTheFirstPoseThenTheFirstBall)
{
  const SurfaceCover cover = sixBalls();
  EXPECT_THAT(nearestBalls(cover, std::vector<double>{0.5, 0.25, 2, kNoDistance, kNoDistance, 0.25}),
              ElementsAre(1u, 2u, kNothing, kNothing));
  EXPECT_THAT(nearestBalls(cover, std::vector<float>{0.5f, 0.25f, 2, -1, 3, 0.25f}, {0, 7, 1, 1, 1, 6}),
              ElementsAre(5u, 3u, kNothing, 4u));
  EXPECT_THAT(ofBalls<int>({5, kNothing, 0}, {10, 11, 12, 13, 14, 15}, -1), ElementsAre(15, -1, 10));
}

TEST(TriangleAnswers, TakeTheFirstPose)
{
  EXPECT_THAT(triangleFirstPoses(sixBalls(), {4, -1, -1, -1, 0, 2}), ElementsAre(2, -1, -1, 0));
}

TEST(TriangleAnswers, RefuseWhatIsNotAboutTriangles)
{
  SurfaceCover cover = sixBalls();
  const auto inputOf = [](const auto& ask) {
    try {
      ask();
    }
    catch (const InvalidInput& error) {
      return error.input();
    }
    return Input::points;
  };
  EXPECT_EQ(inputOf([&] { triangleVerdicts(cover, test::verdictsOf({0, 0, 0})); }), Input::result);
  EXPECT_EQ(inputOf([&] { triangleVerdicts(cover, test::verdictsOf({0, 0, 0, 0, 4, 0})); }), Input::result);
  EXPECT_EQ(inputOf([&] { triangleFirstPoses(cover, {}); }), Input::result);
  EXPECT_EQ(inputOf([&] { nearestBalls(cover, std::vector<float>(6), {0}); }), Input::result);
  cover.triangles_apart = false;
  EXPECT_EQ(inputOf([&] { triangleVerdicts(cover, std::vector<Verdict>(6)); }), Input::surface);
  EXPECT_EQ(inputOf([&] { triangleFirstPoses(cover, std::vector<std::int32_t>(6)); }), Input::surface);
  EXPECT_EQ(inputOf([&] { nearestBalls(cover, std::vector<double>(6)); }), Input::surface);
}

TEST(TriangleAnswers, EveryTriangleHasABall)
{
  const test::TestMesh mesh = test::soup(5, 200, 1.0, 0.5);
  SurfaceRequest request;
  request.tolerance = 0.1;
  request.triangles_apart = true;
  const SurfaceCover cover = coverSurface(mesh.view(), mesh.triangles, request);
  EXPECT_EQ(cover.triangle_count, 200u);
  EXPECT_THAT(nearestBalls(cover, std::vector<double>(cover.centers.size())), testing::Each(testing::Ne(kNothing)));
}

} // namespace
} // namespace pcl_bsh
