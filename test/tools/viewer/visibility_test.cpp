// SPDX-License-Identifier: BSD-3-Clause
// From which side what collides is seen, and words before bright points.
#include "pixels.h"

#include <pcl_bsh/tools/viewer/actors/visibility.h>

#include <gmock/gmock.h>

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkPoints.h>

#include <cmath>

namespace pcl_bsh::viewer {
namespace {

using Eigen::Vector3d;

/// A grid of (2 n + 1)^2 points about `middle`, `step` apart along two axes.
std::vector<Vector3d> gridOf(const Vector3d& middle, const Vector3d& u, const Vector3d& v, int n, double step)
{
  std::vector<Vector3d> points;
  for (int i = -n; i <= n; ++i)
    for (int k = -n; k <= n; ++k) points.push_back(middle + step * (i * u + k * v));
  return points;
}

Gaze gazeFrom(const Vector3d& at, const Vector3d& up)
{
  Gaze gaze;
  gaze.at = at;
  gaze.toward = at.normalized(); // it looks at the origin
  gaze.right = up.cross(gaze.toward).normalized();
  gaze.up = gaze.toward.cross(gaze.right);
  return gaze;
}

TEST(Visibility, AThingHidesWhatIsBehindIt)
{
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const std::vector<Vector3d> wall = gridOf({0, 0, 0}, x, z, 100, 0.01);
  const std::vector<Vector3d> plate = gridOf({0, -0.01, 0}, x, z, 100, 0.01); // nearer than a cell is wide
  const std::vector<Vector3d> half = gridOf({1, -0.01, 0}, x, z, 100, 0.01);
  const auto seen = [&](const std::vector<Vector3d>& before, const Vector3d& at, const Vector3d& up) {
    const Drawn things[] = {{wall, gridOf({0, 0, 0}, x, z, 50, 0.01)}, {before, {}}};
    return shareSeen(gazeFrom(at, up), things);
  };
  EXPECT_EQ(seen(plate, -3 * y, z), 0.0);
  EXPECT_EQ(seen(plate, 3 * y, z), 1.0);
  EXPECT_NEAR(seen(half, -3 * y, z), 0.5, 0.02);
  EXPECT_EQ(seen({}, -3 * y, z), 1.0);
  EXPECT_EQ(shareSeen(gazeFrom(3 * y, z), {}), 0.0);
}

TEST(Visibility, PlacesCoverTriangles)
{
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(4, 0, 0);
  points->InsertNextPoint(0, 4, 0);
  vtkNew<vtkCellArray> triangles;
  triangles->InsertNextCell({0, 1, 2});
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 7));
  const std::vector<Vector3d> places = placesOf(*mesh, pose, 0.1);
  for (double u = 0.05; u < 4; u += 0.3) {
    for (double v = 0.05; u + v < 3.9; v += 0.3) {
      double nearest = 1e9;
      for (const Vector3d& place : places) nearest = std::min(nearest, (place - Vector3d(u, v, 7)).norm());
      EXPECT_LT(nearest, 0.12) << u << ' ' << v;
    }
  }
  const auto left = [](const Vector3d& place) { return place.x() > 1.0; };
  for (const Vector3d& place : placesOf(*mesh, pose, 0.1, left)) EXPECT_LE(place.x(), 1.0);
}

class CollidingCamera : public ViewTest {
protected:
  CollidingCamera() { unsetenv("DISPLAY"); }

  std::filesystem::path gridFile(const std::string& name, const std::vector<Vector3d>& points) const
  {
    std::ostringstream text;
    for (const Vector3d& p : points) text << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    return folder.write(name, text.str());
  }

  Options options(const std::filesystem::path& scan, const std::filesystem::path& obstacle, Camera::Kind kind) const
  {
    Options made;
    made.clouds = {scan};
    made.model = obstacle;
    made.question.clearance = 0.03;
    made.width = 480;
    made.height = 360;
    made.camera.kind = kind;
    made.question.threads = 1;
    return made;
  }
};

/// A plate before a wall, floor or ceiling, on each side of it: the wall is seen from the other side.
TEST_F(CollidingCamera, LooksFromWhereWhatCollidesIsSeen)
{
  const Vector3d axes[] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d &u = axes[(axis + 1) % 3], &v = axes[(axis + 2) % 3];
    const auto wall = gridFile("wall.xyz", gridOf({0, 0, 0}, u, v, 60, 0.02));
    for (const double side : {-1.0, 1.0}) {
      const auto plate = gridFile("plate.xyz", gridOf(0.02 * side * axes[axis], u, v, 80, 0.01));
      OffscreenView near(options(wall, plate, Camera::Kind::colliding));
      ASSERT_GT(near.view->collisions().colliding, 1000U);
      EXPECT_LT(side * near.renderer->GetActiveCamera()->GetPosition()[axis], 0.0) << axis << ' ' << side;
      EXPECT_GT(near.draw().count(colliding_color, 40), 3000U) << axis << ' ' << side;
    }
  }
}

/// The usual side stays where nothing is gained.
TEST_F(CollidingCamera, LooksSlantedWhereThatShowsAsMuch)
{
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
  const auto floor = gridFile("floor.xyz", gridOf({0, 0, 0}, x, y, 60, 0.02));
  const auto under = gridFile("under.xyz", gridOf({0, 0, -0.02}, x, y, 40, 0.02));
  OffscreenView view(options(floor, under, Camera::Kind::colliding));
  double at[3], focus[3];
  view.renderer->GetActiveCamera()->GetPosition(at);
  view.renderer->GetActiveCamera()->GetFocalPoint(focus);
  const Vector3d toward = (Vector3d(at) - Vector3d(focus)).normalized();
  EXPECT_LT((toward - Vector3d(-0.55, -1.0, 0.7).normalized()).norm(), 1e-6);
}

/// A wall of bright points fills the picture: behind words, and beside letters, it is dark.
TEST_F(CollidingCamera, WordsHaveABacking)
{
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
  const auto wall = gridFile("wall.xyz", gridOf({0, 0, 0}, x, y, 150, 0.02));
  const auto all = gridFile("all.xyz", gridOf({0, 0, 0.01}, x, y, 150, 0.02));
  Options asked = options(wall, all, Camera::Kind::given);
  asked.camera.eye = {0, 0, 2};
  asked.camera.focus = {0, 0, 0};
  asked.camera.up = {0, 1, 0};
  for (const Coloring color : {Coloring::collision, Coloring::distance}) {
    asked.color = color;
    OffscreenView view(asked);
    const Pixels pixels = view.draw();
    const auto bright = [&](int from_x, int to_x, int from_y, int to_y) {
      std::size_t found = 0;
      for (int v = from_y; v < to_y; ++v)
        for (int u = from_x; u < to_x; ++u) {
          const Color c = pixels.at(u, v);
          found += c[0] + c[1] + c[2] > 300 ? 1U : 0U;
        }
      return static_cast<double>(found) / ((to_x - from_x) * (to_y - from_y));
    };
    EXPECT_GT(bright(200, 300, 150, 250), 0.8) << "the wall itself";
    EXPECT_LT(bright(10, 90, 335, 350), 0.5) << "behind the title's first line";
    EXPECT_GT(bright(10, 90, 335, 350), 0.03) << "its letters";
    EXPECT_LT(bright(30, 100, 10, 26), 0.5) << "behind the legend's words";
  }
}

} // namespace
} // namespace pcl_bsh::viewer
