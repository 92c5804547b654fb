// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/trajectory/trajectory.h>
#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk_filters/vtkBSHCollisionFilter.h>
#include <pcl_bsh/vtk_filters/vtkBSHDistanceFilter.h>
#include <pcl_bsh/vtk_filters/vtkBSHSphereSource.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkDummyCommunicator.h>
#include <vtkDummyController.h>
#include <vtkExecutive.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkSphereSource.h>
#include <vtkStringArray.h>
#include <vtkStripper.h>
#include <vtkTable.h>
#include <vtkTransform.h>
#include <vtkTrivialProducer.h>

#include <sys/resource.h>
#include <unistd.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_bsh::vtk {
namespace {

using test::makePoints;
using test::Random;
using test::Shape;
using testing::HasSubstr;

vtkSmartPointer<vtkPolyData> dataOf(const std::vector<Point3>& points, int type)
{
  vtkNew<vtkPoints> made;
  made->SetDataType(type);
  for (const Point3& p : points) made->InsertNextPoint(p.data());
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(made);
  return data;
}

PointsView viewOfData(vtkPolyData& data)
{
  vtkDataArray* const array = data.GetPoints()->GetData();
  const auto count = static_cast<std::size_t>(array->GetNumberOfTuples());
  if (auto* const floats = vtkFloatArray::SafeDownCast(array)) return pcl_bsh::viewOf(floats->GetPointer(0), count);
  return pcl_bsh::viewOf(vtkDoubleArray::SafeDownCast(array)->GetPointer(0), count);
}

vtkSmartPointer<vtkTable> tableOf(const std::vector<Eigen::Isometry3d>& poses)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  for (int k = 0; k < 12; ++k) {
    vtkNew<vtkDoubleArray> column;
    column->SetName(("Field " + std::to_string(k)).c_str());
    for (const Eigen::Isometry3d& pose : poses) column->InsertNextValue(pose.matrix()(k / 4, k % 4));
    table->AddColumn(column);
  }
  return table;
}

std::vector<double> values(vtkPolyData& data, const char* name)
{
  vtkDataArray* const array = data.GetPointData()->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  std::vector<double> found;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i) found.push_back(array->GetTuple1(i));
  return found;
}

/// As doubles, with NaN equal to NaN.
template <class Values>
void expectSame(const std::vector<double>& found, const Values& wanted)
{
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto value = static_cast<double>(wanted[i]);
    ASSERT_TRUE(found[i] == value || (std::isnan(found[i]) && std::isnan(value))) << i << ": " << found[i];
  }
}

/// Texts that an algorithm and its executive report by vtkErrorMacro or vtkWarningMacro.
class Told {
public:
  explicit Told(vtkAlgorithm& algorithm, unsigned long event = vtkCommand::ErrorEvent)
  {
    command_->SetClientData(&texts);
    command_->SetCallback([](vtkObject*, unsigned long, void* heard, void* text) {
      static_cast<std::vector<std::string>*>(heard)->push_back(static_cast<const char*>(text));
    });
    algorithm.AddObserver(event, command_);
    if (event == vtkCommand::ErrorEvent) algorithm.GetExecutive()->AddObserver(event, command_);
  }
  std::vector<std::string> texts;

private:
  vtkNew<vtkCallbackCommand> command_;
};

/// The filter fails with one line of its own that holds the text, and its output has nothing.
void expectFailure(vtkBSHFilter& filter, const std::string& text)
{
  SCOPED_TRACE(text);
  Told told(filter);
  filter.Update();
  ASSERT_FALSE(told.texts.empty());
  EXPECT_THAT(told.texts.front(), HasSubstr(text));
  EXPECT_EQ(filter.GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter.GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
  filter.RemoveObservers(vtkCommand::ErrorEvent);
  filter.GetExecutive()->RemoveObservers(vtkCommand::ErrorEvent);
}

class Filters : public testing::TestWithParam<int> {
protected:
  Random random{17};
  vtkSmartPointer<vtkPolyData> cloud = dataOf(makePoints(Shape::uniform, 900, 1.0, random), GetParam());
  vtkSmartPointer<vtkPolyData> obstacle = dataOf(makePoints(Shape::clusters, 300, 1.0, random), GetParam());
  Eigen::Isometry3d pose = [] {
    Eigen::Isometry3d made(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()));
    made.translation() << 0.1, -0.2, 0.05;
    return made;
  }();
  std::vector<Eigen::Isometry3d> path = [] {
    std::vector<Eigen::Isometry3d> poses;
    for (int k = 0; k < 7; ++k) {
      Eigen::Isometry3d made(Eigen::AngleAxisd(0.1 * k, Eigen::Vector3d::UnitZ()));
      made.translation() << 0.3 * k - 1.0, 0.1, 0.0;
      poses.push_back(made);
    }
    return poses;
  }();

  static vtkSmartPointer<vtkTransform> transformOf(const Eigen::Isometry3d& pose)
  {
    double elements[16];
    for (int k = 0; k < 16; ++k) elements[k] = pose.matrix()(k / 4, k % 4);
    auto made = vtkSmartPointer<vtkTransform>::New();
    made->SetMatrix(elements);
    return made;
  }
};

INSTANTIATE_TEST_SUITE_P(Scalars, Filters, testing::Values(VTK_FLOAT, VTK_DOUBLE),
                         [](const auto& scalar) { return scalar.param == VTK_FLOAT ? "Float" : "Double"; });

TEST_P(Filters, CollisionsAreThoseOfBruteForce)
{
  cloud->GetPoints()->SetPoint(5, std::numeric_limits<double>::quiet_NaN(), 0, 0);
  obstacle->GetPoints()->SetPoint(7, 0, std::numeric_limits<double>::infinity(), 0);
  vtkNew<vtkIntArray> other;
  other->SetName("other");
  other->SetNumberOfTuples(cloud->GetNumberOfPoints());
  cloud->GetPointData()->AddArray(other);
  const SphereHierarchy a(viewOfData(*cloud)), b(viewOfData(*obstacle));
  FlagsRequest request;
  request.clearance = 0.3;
  const FlagsResult wanted = brute_force::collisionFlags({a}, {b, pose}, request);
  ASSERT_GT(wanted.colliding_a, 20u);

  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetTransform(transformOf(pose));
  filter->SetClearance(0.3);
  for (const int threads : {1, 2}) {
    filter->SetNumberOfThreads(threads);
    filter->Update();
    expectSame(values(*filter->GetOutput(), "collision"), wanted.a);
    EXPECT_EQ(filter->GetNumberOfCollidingPoints(), static_cast<vtkIdType>(wanted.colliding_a));
  }
  EXPECT_NE(filter->GetOutput()->GetPointData()->GetArray("other"), nullptr);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("first_pose"), nullptr);
  EXPECT_EQ(cloud->GetPointData()->GetArray("collision"), nullptr); // the input stays as it was
}

TEST_P(Filters, PathsAreThoseOfBruteForce)
{
  const SphereHierarchy a(viewOfData(*cloud)), b(viewOfData(*obstacle));
  std::vector<Eigen::Isometry3d> placed = path;
  for (Eigen::Isometry3d& each : placed) each.matrix() = pose.matrix() * each.matrix();
  TrajectoryRequest request;
  request.clearance = 0.15;
  request.distances = request.first_poses = request.closest_poses = true;
  const TrajectoryResult wanted = brute_force::collideAlong({a}, b, placed, request);
  ASSERT_GT(wanted.colliding, 20u);

  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetPosesData(tableOf(path));
  filter->SetTransform(transformOf(pose));
  filter->SetClearance(0.15);
  filter->Update();
  vtkPolyData& output = *filter->GetOutput();
  expectSame(values(output, "collision"), wanted.flags);
  expectSame(values(output, "distance"), wanted.distance);
  expectSame(values(output, "first_pose"), wanted.first_pose);
  expectSame(values(output, "closest_pose"), wanted.closest_pose);

  request.swept = 0.01;
  const TrajectoryResult swept = collideAlong({a}, b, placed, request);
  ASSERT_GT(swept.colliding, wanted.colliding);
  filter->SetSwept(0.01);
  filter->Update();
  expectSame(values(*filter->GetOutput(), "collision"), swept.flags);

  filter->SetPosesData(nullptr);
  expectFailure(*filter, "swept: is given, but nothing moves");
  filter->SetSwept(0.0);
  filter->Update(); // and without a path no array of one
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("first_pose"), nullptr);

  vtkNew<vtkBSHDistanceFilter> distances;
  distances->SetInputData(cloud);
  distances->SetObstacleData(obstacle);
  distances->SetPosesData(tableOf(path));
  distances->SetTransform(transformOf(pose));
  expectFailure(*distances, "give a finite one");
  distances->SetMaximumDistance(0.15);
  distances->Update();
  expectSame(values(*distances->GetOutput(), "distance"), wanted.distance);
  expectSame(values(*distances->GetOutput(), "closest_pose"), wanted.closest_pose);
}

TEST_P(Filters, DistancesAreThoseOfTheCore)
{
  cloud->GetPoints()->SetPoint(5, std::numeric_limits<double>::quiet_NaN(), 0, 0);
  const SphereHierarchy a(viewOfData(*cloud)), b(viewOfData(*obstacle));
  vtkNew<vtkBSHDistanceFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetTransform(transformOf(pose));
  for (const double limit : {VTK_DOUBLE_MAX, std::numeric_limits<double>::infinity(), 0.2}) {
    PointDistancesRequest request;
    if (limit < 1.0) request.max_distance = limit;
    const PointDistances wanted = pointDistances({a}, {b, pose}, request);
    filter->SetMaximumDistance(limit);
    filter->Update();
    expectSame(values(*filter->GetOutput(), "distance"), wanted.distance);
    const std::vector<double> nearest = values(*filter->GetOutput(), "closest_point");
    for (std::size_t i = 0; i < nearest.size(); ++i)
      EXPECT_EQ(nearest[i], wanted.closest_point[i] == kNothing ? -1.0 : wanted.closest_point[i]);
  }
}

TEST_P(Filters, BuildOnlyWhatHasChanged)
{
  const auto transform = transformOf(pose);
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetTransform(transform);
  filter->SetClearance(0.1);
  filter->Update();
  EXPECT_EQ(filter->GetHierarchiesBuilt(), 2);
  const auto expectFresh = [&](vtkIdType built) {
    vtkNew<vtkBSHCollisionFilter> fresh;
    fresh->SetInputData(cloud);
    fresh->SetObstacleData(obstacle);
    fresh->SetTransform(transform);
    fresh->SetClearance(filter->GetClearance());
    fresh->Update();
    filter->Update();
    EXPECT_EQ(values(*filter->GetOutput(), "collision"), values(*fresh->GetOutput(), "collision"));
    EXPECT_EQ(filter->GetHierarchiesBuilt(), built);
  };

  const vtkMTimeType executed = filter->GetOutput()->GetMTime();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetMTime(), executed); // nothing has changed
  transform->Translate(0.05, 0, 0);
  expectFresh(2);
  EXPECT_GT(filter->GetOutput()->GetMTime(), executed);
  filter->SetClearance(0.12);
  expectFresh(2);
  vtkNew<vtkIntArray> other; // an array more, at the same points
  other->SetName("other");
  other->SetNumberOfTuples(cloud->GetNumberOfPoints());
  cloud->GetPointData()->AddArray(other);
  expectFresh(2);

  cloud->GetPoints()->SetPoint(0, 0.1, 0.2, 0.3); // in place
  cloud->GetPoints()->Modified();
  expectFresh(3);
  cloud->GetPoints()->SetPoint(0, 0.3, 0.2, 0.1);
  cloud->Modified(); // the points say nothing
  expectFresh(4);
  obstacle->GetPoints()->SetPoint(3, 0.1, 0.2, 0.3); // nobody says anything until the pose changes
  transform->Translate(0.01, 0, 0);
  expectFresh(5);
  vtkNew<vtkPolyData> copy; // the same numbers, elsewhere
  copy->DeepCopy(cloud);
  filter->SetInputData(copy);
  filter->Update();
  EXPECT_EQ(filter->GetHierarchiesBuilt(), 6);
  copy->GetPoints()->SetPoint(1, 0, 0, 0);
  cloud->GetPoints()->SetPoint(1, 0, 0, 0);
  copy->Modified();
  expectFresh(7);
}

TEST_P(Filters, OtherArraysOfPointsAreCopiedAndBuiltOnce)
{
  vtkNew<vtkSOADataArrayTemplate<double>> apart;
  apart->SetNumberOfComponents(3);
  apart->SetNumberOfTuples(cloud->GetNumberOfPoints());
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i) apart->SetTuple(i, cloud->GetPoint(i));
  vtkNew<vtkPoints> points;
  points->SetData(apart);
  vtkNew<vtkPolyData> same;
  same->SetPoints(points);
  vtkNew<vtkBSHCollisionFilter> filter, other;
  for (vtkBSHCollisionFilter* each : {filter.Get(), other.Get()}) {
    each->SetObstacleData(obstacle);
    each->SetClearance(0.1);
  }
  filter->SetInputData(same);
  other->SetInputData(cloud);
  filter->Update();
  other->Update();
  EXPECT_EQ(values(*filter->GetOutput(), "collision"), values(*other->GetOutput(), "collision"));
  filter->SetClearance(0.11);
  filter->Update();
  EXPECT_EQ(filter->GetHierarchiesBuilt(), 2);
}

TEST_P(Filters, ObstaclesWithCellsAreSurfaces)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.6);
  ball->Update();
  vtkPolyData& mesh = *ball->GetOutput(); // triangles
  std::vector<Triangle> triangles;
  for (vtkIdType t = 0; t < mesh.GetNumberOfPolys(); ++t) {
    vtkNew<vtkIdList> corners;
    mesh.GetCellPoints(t, corners);
    triangles.push_back({static_cast<std::uint32_t>(corners->GetId(0)), static_cast<std::uint32_t>(corners->GetId(1)),
                         static_cast<std::uint32_t>(corners->GetId(2))});
  }
  const TrianglesView view{viewOfData(mesh), triangles[0].data(), triangles.size()};
  const SphereHierarchy a(viewOfData(*cloud)), b(viewOf(view));
  FlagsRequest request;
  request.clearance = 0.1;

  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleConnection(ball->GetOutputPort());
  filter->SetClearance(0.1);
  filter->Update();
  expectSame(values(*filter->GetOutput(), "collision"), collisionFlags({a}, {b}, request).a);
  EXPECT_EQ(filter->GetHierarchiesBuilt(), 2);
  filter->SetTransform(transformOf(pose));
  filter->SetClearance(0.2);
  filter->Update();
  EXPECT_EQ(filter->GetHierarchiesBuilt(), 2);

  vtkNew<vtkBSHDistanceFilter> distances;
  distances->SetInputData(cloud);
  distances->SetObstacleConnection(ball->GetOutputPort());
  distances->Update();
  const PointDistances wanted = pointDistances({a}, {b});
  expectSame(values(*distances->GetOutput(), "distance"), wanted.distance);
  expectSame(values(*distances->GetOutput(), "closest_point"), wanted.closest_point);

  PointDistancesRequest near;
  near.max_distance = 0.2;
  const PointDistances some = pointDistances({a}, {b}, near);
  distances->SetMaximumDistance(near.max_distance);
  distances->Update();
  const std::vector<double> cells = values(*distances->GetOutput(), "closest_point");
  std::size_t none = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    none += some.closest_point[i] == kNothing;
    EXPECT_EQ(cells[i], some.closest_point[i] == kNothing ? -1.0 : some.closest_point[i]);
  }
  EXPECT_GT(none, 100u);

  ball->SetPhiResolution(9); // other triangles
  filter->Update();
  EXPECT_EQ(filter->GetHierarchiesBuilt(), 3);
}

TEST_P(Filters, OptionsHaveTheirNamesInTheTable)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.6);
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleConnection(ball->GetOutputPort());
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfCollidingPoints(), 0) << "hollow";
  filter->SetOption("solid", "true");
  filter->Update();
  EXPECT_GT(filter->GetNumberOfCollidingPoints(), 60) << "enclosed: of 900 in a cube, some 80";
  filter->SetOption("vertices_only", "true");
  expectFailure(*filter, "solid");
  filter->SetOption("solid", "");
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfCollidingPoints(), 0);
  filter->SetOption("vertices_only", "");
  filter->SetOption("solid", "true");
  filter->Update();
  EXPECT_GT(filter->GetNumberOfCollidingPoints(), 60);
  filter->ClearOptions();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfCollidingPoints(), 0);
  filter->SetOption("clearances", "1");
  expectFailure(*filter, "clearances");
  filter->ClearOptions();
  filter->SetOption("threads", "few");
  expectFailure(*filter, "threads: 'few': give a number from 0 to 1024");
}

TEST_P(Filters, SolidObstaclesHoldWhatTheyEnclose)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.6);
  ball->SetThetaResolution(24);
  vtkNew<vtkStripper> strips; // the same triangles
  strips->SetInputConnection(ball->GetOutputPort());
  strips->Update();
  ASSERT_GT(strips->GetOutput()->GetNumberOfStrips(), 0);
  const PointsView points = viewOfData(*cloud);
  for (vtkAlgorithmOutput* const obstacle_port : {ball->GetOutputPort(), strips->GetOutputPort()}) {
    vtkNew<vtkBSHCollisionFilter> filter;
    vtkNew<vtkBSHDistanceFilter> distances;
    for (vtkBSHFilter* const each :
         {static_cast<vtkBSHFilter*>(filter.Get()), static_cast<vtkBSHFilter*>(distances.Get())}) {
      each->SetInputData(cloud);
      each->SetObstacleConnection(obstacle_port);
      each->Update();
    }
    const std::vector<double> hollow = values(*filter->GetOutput(), "collision");
    const std::vector<double> unsigned_distance = values(*distances->GetOutput(), "distance");
    filter->SolidOn();
    distances->SetSolid(true);
    filter->Update();
    distances->Update();
    const std::vector<double> solid = values(*filter->GetOutput(), "collision");
    const std::vector<double> distance = values(*distances->GetOutput(), "distance");
    std::size_t held = 0;
    for (std::uint32_t i = 0; i < points.count; ++i) {
      const Point3 p = points.point(i);
      if (!isFinite(p)) continue;
      const double r = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
      if (r > 0.4 && r < 0.61) continue; // by the facets
      EXPECT_EQ(solid[i], r < 0.4 ? 1.0 : hollow[i]);
      EXPECT_EQ(distance[i], r < 0.4 ? -unsigned_distance[i] : unsigned_distance[i]);
      held += r < 0.4 && hollow[i] == 0.0;
    }
    EXPECT_GT(held, 0u);
  }
  vtkNew<vtkSphereSource> open;
  open->SetEndPhi(120);
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleConnection(open->GetOutputPort());
  filter->SolidOn();
  expectFailure(*filter, "edges are open");
}

TEST(Panel, HasTheWordsOfTheTableOfOptions)
{
  std::ifstream file(PCL_BSH_PANEL);
  const std::string xml((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::string words;
  for (const char c : xml)
    if (!std::isspace(static_cast<unsigned char>(c)) || (!words.empty() && words.back() != ' '))
      words += std::isspace(static_cast<unsigned char>(c)) ? ' ' : c;
  EXPECT_THAT(words, HasSubstr("command=\"SetSolid\""));
  EXPECT_THAT(words, HasSubstr(std::string(questionOption("solid")->doc).substr(3))); // "An obstacle" begins it there
}

TEST_P(Filters, CellsOfAllKindsCount)
{
  // A square, a segment, a strip and a point: each is near one point of the cloud, far from all corners but the
  // point's.
  const auto things = dataOf({{0, 0, 0},
                              {8, 0, 0},
                              {8, 8, 0},
                              {0, 8, 0},
                              {20, 0, 0},
                              {28, 0, 0},
                              {40, 0, 0},
                              {40, 8, 0},
                              {48, 0, 0},
                              {48, 8, 0},
                              {60, 0, 0},
                              {80, 0, 0}},
                             GetParam());
  vtkNew<vtkCellArray> points, lines, polygons, strips;
  points->InsertNextCell({10});
  lines->InsertNextCell({4, 5});
  polygons->InsertNextCell({0, 1, 2, 3});
  strips->InsertNextCell({6, 7, 8, 9});
  things->SetVerts(points);
  things->SetLines(lines);
  things->SetPolys(polygons);
  things->SetStrips(strips);
  const auto probes = dataOf({{5, 4, 0.1},
                              {3, 4, 0.1},
                              {24, 0.1, 0},
                              {42, 2, 0.1},
                              {46, 6, 0.1},
                              {60, 0.1, 0},
                              {80, 0.1, 0},
                              {5, 4, 0.3}}, // the last but one is near a corner of no cell
                             GetParam());
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(probes);
  filter->SetObstacleData(things);
  filter->SetClearance(0.2);
  filter->Update();
  expectSame(values(*filter->GetOutput(), "collision"), std::vector<int>{1, 1, 1, 1, 1, 1, 0, 0});
  vtkNew<vtkBSHDistanceFilter> distances;
  distances->SetInputData(probes);
  distances->SetObstacleData(things);
  distances->Update();
  // vtkPolyData numbers vertices first, then lines, polygons, strips
  expectSame(values(*distances->GetOutput(), "closest_point"), std::vector<int>{2, 2, 1, 3, 3, 0, 0, 2});

  vtkNew<vtkCellArray> wrong;
  wrong->InsertNextCell({0, 1, 77});
  things->SetPolys(wrong);
  expectFailure(*filter, "cell 2: names point 77 of 12");
}

/// Not what they would enclose.
TEST_P(Filters, LinesOfSeveralPointsAreTheirSegments)
{
  const auto bent = dataOf({{0, 0, 0}, {8, 0, 0}, {8, 8, 0}}, GetParam());
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({0, 1, 2});
  bent->SetLines(lines);
  const auto probes = dataOf({{4, 0.1, 0}, {7.9, 4, 0}, {6, 2, 0.1}}, GetParam());
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(probes);
  filter->SetObstacleData(bent);
  filter->SetClearance(0.2);
  filter->Update();
  expectSame(values(*filter->GetOutput(), "collision"), std::vector<int>{1, 1, 0});
}

TEST_P(Filters, PolygonsOfTwoPointsAreSegmentsAndOfOnePoint)
{
  const auto things = dataOf({{0, 0, 0}, {8, 0, 0}, {20, 0, 0}}, GetParam());
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({0, 1});
  polygons->InsertNextCell({2});
  things->SetPolys(polygons);
  const auto probes = dataOf({{4, 0.1, 0}, {20, 0.1, 0}, {14, 0, 0}}, GetParam());
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(probes);
  filter->SetObstacleData(things);
  filter->SetClearance(0.2);
  filter->Update();
  expectSame(values(*filter->GetOutput(), "collision"), std::vector<int>{1, 1, 0});
}

/// An obstacle that comes in pieces is whole, too, whichever piece of the cloud is asked for.
TEST_P(Filters, ObstaclesAreWholeForEachPiece)
{
  vtkNew<vtkSphereSource> ball; // halves, when asked for two pieces
  ball->SetRadius(0.6);
  ball->SetThetaResolution(24);
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleConnection(ball->GetOutputPort());
  filter->SetClearance(0.1);
  filter->Update();
  const std::vector<double> whole = values(*filter->GetOutput(), "collision");
  filter->UpdatePiece(1, 2, 0);
  EXPECT_EQ(values(*filter->GetOutput(), "collision"), whole);
}

TEST_P(Filters, EmptyInputs)
{
  vtkNew<vtkPolyData> nothing; // not even vtkPoints
  const auto no_points = dataOf({}, GetParam());
  for (vtkPolyData* empty : {nothing.Get(), no_points.Get()}) {
    vtkNew<vtkBSHCollisionFilter> filter;
    filter->SetInputData(cloud);
    filter->SetObstacleData(empty);
    filter->SetClearance(5.0);
    filter->Update();
    expectSame(values(*filter->GetOutput(), "collision"), std::vector<int>(900, 0));
    filter->SetInputData(empty);
    filter->SetObstacleData(obstacle);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_NE(filter->GetOutput()->GetPointData()->GetArray("collision"), nullptr);
  }
}

TEST_P(Filters, FailuresLeaveNothingThatLooksLikeAnAnswer)
{
  vtkNew<vtkBSHCollisionFilter> first, filter;
  first->SetInputData(cloud);
  first->SetObstacleData(obstacle);
  first->SetClearance(0.1);
  filter->SetInputConnection(first->GetOutputPort()); // has an array `collision`
  filter->SetObstacleData(obstacle);
  filter->SetClearance(0.1);
  filter->Update();
  EXPECT_NE(filter->GetOutput()->GetPointData()->GetArray("collision"), nullptr);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetNumberOfArrays(), 0) << "none of what was not asked for";
  filter->SetClearance(-1.0);
  expectFailure(*filter, "clearance");
  EXPECT_EQ(filter->GetNumberOfCollidingPoints(), 0);
  filter->SetClearance(std::numeric_limits<double>::quiet_NaN());
  expectFailure(*filter, "clearance");
  filter->SetClearance(0.1);
  vtkNew<vtkTransform> scale;
  scale->Scale(2, 2, 2);
  filter->SetTransform(scale);
  expectFailure(*filter, "rigid");
  filter->SetTransform(nullptr);
  auto table = tableOf(path);
  table->RemoveColumn(11);
  filter->SetPosesData(table);
  expectFailure(*filter, "poses: ");
  table = tableOf(path);
  vtkNew<vtkStringArray> words;
  words->SetNumberOfValues(static_cast<vtkIdType>(path.size()));
  vtkNew<vtkDoubleArray> pairs;
  pairs->SetNumberOfComponents(2);
  pairs->SetNumberOfTuples(static_cast<vtkIdType>(path.size()));
  for (vtkAbstractArray* column : {static_cast<vtkAbstractArray*>(words), static_cast<vtkAbstractArray*>(pairs)}) {
    column->SetName("Field 11");
    table->RemoveColumn(11);
    table->AddColumn(column);
    filter->SetPosesData(table);
    expectFailure(*filter, "poses: column 11 holds no numbers: give a table of numbers");
  }
  vtkNew<vtkTable> none;
  filter->SetPosesData(none);
  expectFailure(*filter, "poses: holds no pose");
  filter->SetPosesData(nullptr);
  filter->Update();
  EXPECT_EQ(values(*filter->GetOutput(), "collision"), values(*first->GetOutput(), "collision"));

  // A filter behind a failed execution does not execute with an empty obstacle.
  vtkNew<vtkBSHCollisionFilter> after;
  after->SetInputData(cloud);
  after->SetObstacleConnection(filter->GetOutputPort());
  after->SetClearance(0.1);
  after->Update();
  EXPECT_EQ(after->GetNumberOfCollidingPoints(), 900);
  filter->SetClearance(-1.0);
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, vtkNew<vtkCallbackCommand>());
  filter->AddObserver(vtkCommand::ErrorEvent, vtkNew<vtkCallbackCommand>());
  const vtkMTimeType before = after->GetOutput()->GetMTime();
  for (int again = 0; again < 3; ++again) { // the executive takes what failed for up to date
    after->Update();
    EXPECT_EQ(after->GetOutput()->GetMTime(), before);
    EXPECT_EQ(after->GetNumberOfCollidingPoints(), 900);
  }
}

/// A mesh that cannot be used fails as often as it is asked about, whatever came before it.
TEST_P(Filters, FailuresAreNotForgotten)
{
  vtkNew<vtkSphereSource> ball;
  ball->Update();
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(ball->GetOutput());
  filter->SetClearance(0.1);
  filter->Update();
  auto broken = vtkSmartPointer<vtkPolyData>::New();
  broken->DeepCopy(obstacle);
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({0, 1, obstacle->GetNumberOfPoints()});
  broken->SetPolys(polygons);
  filter->SetObstacleData(broken);
  for (int again = 0; again < 2; ++again) {
    filter->Modified();
    expectFailure(*filter, "names point");
  }
}

TEST(CollisionFilter, AnOptionWithoutAValueIsLeftOut)
{
  vtkNew<vtkBSHCollisionFilter> filter;
  const auto isSet = [&] {
    std::ostringstream text;
    filter->Print(text);
    return text.str().find("density=") != std::string::npos;
  };
  for (const char* const nothing : {"", static_cast<const char*>(nullptr)}) {
    filter->SetOption("density", "true");
    EXPECT_TRUE(isSet());
    filter->SetOption("density", nothing);
    EXPECT_FALSE(isSet());
  }
  const vtkMTimeType before = filter->GetMTime();
  for (const char* const nameless : {"", static_cast<const char*>(nullptr)}) filter->SetOption(nameless, "true");
  EXPECT_EQ(filter->GetMTime(), before) << "without a name it is none";
}

/// ParaView has a check box for it.
TEST(CollisionFilter, SolidIsAnOption)
{
  vtkNew<vtkBSHCollisionFilter> filter;
  EXPECT_FALSE(filter->GetSolid());
  filter->SetSolid(true);
  EXPECT_TRUE(filter->GetSolid());
  const vtkMTimeType before = filter->GetMTime();
  filter->SetSolid(true);
  EXPECT_EQ(filter->GetMTime(), before) << "it was before";
  filter->SetSolid(false);
  EXPECT_GT(filter->GetMTime(), before);
  EXPECT_FALSE(filter->GetSolid());
  filter->SetOption("solid", "true");
  EXPECT_TRUE(filter->GetSolid());
  filter->SetOption("solid", "false");
  EXPECT_FALSE(filter->GetSolid());
}

TEST(CollisionFilter, PrintsWhatIsSet)
{
  const auto printed = [](vtkObject& filter) {
    std::ostringstream text;
    filter.Print(text);
    return text.str();
  };
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetNumberOfThreads(3);
  filter->SetClearance(0.25);
  filter->SetSwept(0.125);
  filter->SetOption("solid", "true");
  for (const char* const line : {"NumberOfThreads: 3\n", "Options: solid=true\n", "HierarchiesBuilt: 0\n",
                                 "Clearance: 0.25\n", "Swept: 0.125\n", "NumberOfCollidingPoints: 0\n"})
    EXPECT_THAT(printed(*filter), HasSubstr(line));
  vtkNew<vtkBSHDistanceFilter> distances;
  distances->SetMaximumDistance(0.5);
  for (const char* const line : {"MaximumDistance: 0.5\n", "Options:\n"})
    EXPECT_THAT(printed(*distances), HasSubstr(line));
}

/// An input that is taken away leaves no answer of before.
TEST_P(Filters, InputsTakenAwayAreErrors)
{
  vtkNew<vtkBSHCollisionFilter> collisions;
  vtkNew<vtkBSHDistanceFilter> distances;
  for (vtkBSHFilter* filter : {static_cast<vtkBSHFilter*>(collisions), static_cast<vtkBSHFilter*>(distances)}) {
    collisions->SetClearance(0.1);
    for (const int port : {0, 1}) {
      filter->SetInputData(0, cloud);
      filter->SetObstacleData(obstacle);
      filter->Update();
      EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 900);
      filter->SetInputDataObject(port, nullptr);
      expectFailure(*filter, "an input is missing: connect a cloud and an obstacle");
    }
    filter->SetInputData(0, cloud);
    filter->SetObstacleData(nullptr);
    expectFailure(*filter, "an input is missing: connect a cloud and an obstacle");
    filter->SetObstacleConnection(nullptr);
    expectFailure(*filter, "an input is missing: connect a cloud and an obstacle");
  }
  EXPECT_EQ(collisions->GetNumberOfCollidingPoints(), 0);
}

/// As all faces tell it.
TEST_P(Filters, TellWhatTheAnswerDoesNot)
{
  vtkNew<vtkBSHCollisionFilter> filter;
  Told told(*filter, vtkCommand::WarningEvent);
  const auto toldOf = [&](vtkPolyData* a, vtkPolyData* b, double clearance) {
    told.texts.clear();
    filter->SetInputData(a);
    filter->SetObstacleData(b);
    filter->SetClearance(clearance);
    filter->Update();
    return told.texts;
  };
  std::vector<Point3> floor;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) floor.push_back({double(i), double(j), 0.0});
  const auto scan = dataOf(floor, GetParam());
  EXPECT_THAT(toldOf(scan, scan, 2.0), testing::IsEmpty());
  EXPECT_THAT(toldOf(scan, scan, 1.0),
              testing::ElementsAre(HasSubstr("points lie 1 apart in the cloud and 1 in the obstacle")));
  EXPECT_THAT(toldOf(scan, dataOf({}, GetParam()), 2.0),
              testing::ElementsAre(HasSubstr("the obstacle: has no finite point: nothing collides with it")));
  floor[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(toldOf(scan, dataOf(floor, GetParam()), 2.0),
              testing::ElementsAre(HasSubstr("the obstacle: 1 of 400 points is not finite")));
  EXPECT_THAT(toldOf(scan, dataOf({{1 << 23, 1, 1}, {1 << 23, 2, 1}}, GetParam()), 2.0),
              testing::Contains(HasSubstr("the boxes of the cloud and of the obstacle, with all of its motion")));

  // The floor as a surface; its last point is loose.
  const auto surface = dataOf({{0, 0, -1}, {19, 0, -1}, {0, 19, -1}, {9, 9, -1}}, GetParam());
  vtkNew<vtkCellArray> faces;
  faces->InsertNextCell({0, 1, 2});
  surface->SetPolys(faces);
  EXPECT_THAT(toldOf(scan, surface, 2.0),
              testing::ElementsAre(HasSubstr("the obstacle: 1 of its vertices belongs to no face: it is no part of the "
                                             "surface that is compared")));
  EXPECT_EQ(filter->GetNumberOfCollidingPoints(), 247) << "at most 21 from the corner, x + y";

  vtkNew<vtkBSHDistanceFilter> distances;
  Told of_distances(*distances, vtkCommand::WarningEvent);
  distances->SetInputData(scan);
  distances->SetObstacleData(surface);
  distances->Update();
  EXPECT_THAT(of_distances.texts,
              testing::ElementsAre(HasSubstr("the obstacle: 1 of its vertices belongs to no face")));
  distances->SetObstacleData(dataOf({}, GetParam()));
  distances->Update();
  ASSERT_EQ(of_distances.texts.size(), 2u);
  EXPECT_THAT(of_distances.texts[1], HasSubstr("nothing has a distance from it"));
}

TEST_P(Filters, WrongPortsAreErrors)
{
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  expectFailure(*filter, "an input is missing: connect a cloud and an obstacle");
  vtkNew<vtkTable> table;
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(table);
  filter->SetObstacleConnection(producer->GetOutputPort());
  expectFailure(*filter, "the obstacle is a vtkTable: give a vtkPolyData");
  filter->SetObstacleData(obstacle);
  vtkNew<vtkTrivialProducer> wrong;
  wrong->SetOutput(cloud);
  filter->SetPosesConnection(wrong->GetOutputPort());
  expectFailure(*filter, "the list of poses is a vtkPolyData: give a vtkTable");
}

TEST_P(Filters, BlocksOfACloudAreAnsweredOfAnObstacleRefused)
{
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetClearance(0.1);
  filter->Update();
  const std::vector<double> whole = values(*filter->GetOutput(), "collision");

  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, obstacle);
  blocks->SetBlock(1, cloud);
  filter->SetInputDataObject(1, blocks);
  expectFailure(*filter, "the obstacle is a vtkMultiBlockDataSet: merge its blocks");
  filter->SetObstacleData(obstacle);
  vtkNew<vtkMultiBlockDataSet> tables;
  tables->SetBlock(0, tableOf(path));
  filter->SetInputDataObject(2, tables);
  expectFailure(*filter, "the list of poses is a vtkMultiBlockDataSet: merge its blocks");
  filter->SetPosesData(nullptr);

  filter->SetInputDataObject(0, blocks);
  filter->Update();
  auto* const answered = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(answered, nullptr);
  ASSERT_EQ(answered->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(values(*vtkPolyData::SafeDownCast(answered->GetBlock(0)), "collision"), std::vector<double>(300, 1.0));
  EXPECT_EQ(values(*vtkPolyData::SafeDownCast(answered->GetBlock(1)), "collision"), whole);
}

TEST_P(Filters, WhoHearsOfAFailureMayAskForTheTime)
{
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetClearance(-1.0);
  expectFailure(*filter, "clearance");
  int heard = 0;
  vtkNew<vtkCallbackCommand> ask;
  ask->SetClientData(&heard);
  ask->SetCallback([](vtkObject* caller, unsigned long, void* count, void*) {
    if (++*static_cast<int*>(count) < 10) caller->GetMTime();
  });
  filter->AddObserver(vtkCommand::ModifiedEvent, ask);
  const vtkMTimeType before = filter->GetMTime();
  EXPECT_GT(filter->GetMTime(), before);
  EXPECT_EQ(heard, 0); // it is not modified by being asked
  filter->SetClearance(0.1);
  EXPECT_EQ(heard, 1);
}

TEST_P(Filters, PrintedMatricesAreTakenWithAWarning)
{
  Eigen::Isometry3d printed = pose;
  for (int k = 0; k < 12; ++k) printed.matrix()(k / 4, k % 4) = std::round(pose.matrix()(k / 4, k % 4) * 1e5) / 1e5;
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  filter->SetTransform(transformOf(printed));
  filter->SetClearance(0.1);
  Told told(*filter, vtkCommand::WarningEvent);
  filter->Update();
  ASSERT_EQ(told.texts.size(), 1u);
  EXPECT_THAT(told.texts[0], HasSubstr("nearest rotation"));
  EXPECT_GT(filter->GetNumberOfCollidingPoints(), 0);
  filter->RemoveObservers(vtkCommand::WarningEvent);
}

TEST_P(Filters, TellProgressAndStop)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.6);
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleConnection(ball->GetOutputPort());
  filter->SetPosesData(tableOf(path));
  filter->SetClearance(0.05);
  std::vector<double> told;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&told);
  listen->SetCallback([](vtkObject*, unsigned long, void* heard, void* fraction) {
    static_cast<std::vector<double>*>(heard)->push_back(*static_cast<double*>(fraction));
  });
  const unsigned long observer = filter->AddObserver(vtkCommand::ProgressEvent, listen);
  filter->Update();
  ASSERT_GE(told.size(), 3u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_NE(filter->GetOutput()->GetPointData()->GetArray("first_pose"), nullptr);
  filter->RemoveObserver(observer);

  vtkNew<vtkCallbackCommand> stop; // at the first report, and later
  for (const double at : {0.0, 0.31}) {
    double limit = at;
    stop->SetClientData(&limit);
    stop->SetCallback([](vtkObject* caller, unsigned long, void* from, void* fraction) {
      if (*static_cast<double*>(fraction) >= *static_cast<double*>(from))
        vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
    });
    const unsigned long stopping = filter->AddObserver(vtkCommand::ProgressEvent, stop);
    filter->Modified();
    Told errors(*filter);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
    filter->RemoveObserver(stopping);
    filter->RemoveObservers(vtkCommand::ErrorEvent);
    filter->GetExecutive()->RemoveObservers(vtkCommand::ErrorEvent);
    filter->SetAbortExecute(0); // VTK 9.3 leaves it set, 9.1 does not
    filter->Update();           // asked again, the whole answer
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 900);
  }
}

/// As if other processes held parts of the data.
class TwoProcesses : public vtkDummyCommunicator {
public:
  static TwoProcesses* New() { return new TwoProcesses; }

protected:
  TwoProcesses() { this->MaximumNumberOfProcesses = this->NumberOfProcesses = 2; }
};

TEST_P(Filters, DataThatProcessesShareIsRefused)
{
  vtkNew<vtkDummyController> controller;
  vtkNew<TwoProcesses> communicator;
  controller->SetCommunicator(communicator);
  vtkMultiProcessController::SetGlobalController(controller);
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(cloud);
  filter->SetObstacleData(obstacle);
  expectFailure(*filter, "2 processes share the data");
  vtkNew<vtkDummyController> alone;
  vtkMultiProcessController::SetGlobalController(alone);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 900) << "one process";
  vtkMultiProcessController::SetGlobalController(nullptr);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 900);
}

TEST_P(Filters, SpheresOfALevelHoldAllPoints)
{
  vtkNew<vtkBSHSphereSource> source;
  source->SetInputData(cloud);
  source->Update();
  const int deepest = source->GetDeepestLevel();
  ASSERT_GE(deepest, 1);
  for (int level = 0; level <= deepest; ++level) {
    source->SetLevel(level);
    source->Update();
    double points = 0.0;
    for (const double held : values(*source->GetOutput(), "points")) points += held;
    EXPECT_EQ(points, 900.0);
    EXPECT_EQ(source->GetHierarchiesBuilt(), 1);
  }
  std::ostringstream text;
  source->Print(text);
  for (const std::string& line : {"Level: " + std::to_string(deepest), std::string("HierarchiesBuilt: 1")})
    EXPECT_NE(text.str().find(' ' + line + '\n'), std::string::npos) << text.str();
  const vtkIdType spheres = source->GetOutput()->GetNumberOfPoints();
  source->GenerateGlyphsOn();
  source->Update();
  EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), spheres);
  EXPECT_EQ(values(*source->GetOutput(), "radius").size(),
            static_cast<std::size_t>(source->GetOutput()->GetNumberOfPoints()));
  vtkNew<vtkPolyData> empty;
  source->SetInputData(empty);
  source->Update();
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
}

/// While it lives, this process gets no memory but what it has.
class NoMoreMemory {
public:
  NoMoreMemory()
  {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit = before_;
    limit.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (std::size_t{1} << 20);
    setrlimit(RLIMIT_AS, &limit);
    while (void* const block = std::malloc(std::size_t{1} << 18)) taken_ = new (block) Block{taken_};
  }
  ~NoMoreMemory()
  {
    setrlimit(RLIMIT_AS, &before_);
    while (Block* const block = taken_) {
      taken_ = block->next;
      std::free(block);
    }
  }
  NoMoreMemory(const NoMoreMemory&) = delete;
  NoMoreMemory& operator=(const NoMoreMemory&) = delete;

private:
  struct Block {
    Block* next;
  };
  rlimit before_ = {};
  Block* taken_ = nullptr; ///< what earlier tests have left free
};

TEST(SphereSource, RunsAgainAfterAFailure)
{
  Random random{3};
  const auto cloud = dataOf(makePoints(Shape::uniform, 300'000, 1.0, random), VTK_FLOAT);
  vtkNew<vtkBSHSphereSource> source;
  source->SetInputData(cloud);
  Told told(*source);
  {
    const NoMoreMemory little;
    source->Update();
  }
  ASSERT_FALSE(told.texts.empty());
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  told.texts.clear();
  source->Update();
  EXPECT_TRUE(told.texts.empty());
  EXPECT_GT(source->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(CollisionFilter, TellsWhatOfTheObstacleNobodySaw)
{
  std::vector<Point3> wall; // 3 m away, and on all sides of the scanner
  for (double up = -1.55; up <= 1.55; up += 0.03)
    for (double around = 0.0; around < 6.28; around += 0.03)
      wall.push_back({3 * std::cos(up) * std::cos(around), 3 * std::cos(up) * std::sin(around), 3 * std::sin(up) + 1});
  const std::vector<Point3> machine = {{1, 0, 1}, {5, 0, 1}, {2.999, 0, 1}};
  vtkNew<vtkBSHCollisionFilter> filter;
  filter->SetInputData(dataOf(wall, VTK_DOUBLE));
  filter->SetObstacleData(dataOf(machine, VTK_DOUBLE));
  filter->SetClearance(0.1);
  filter->SetOption("seen", "true");
  filter->SetOption("origin", "0,0,1");
  filter->Update();
  vtkDataArray* const found = filter->GetOutput()->GetFieldData()->GetArray("obstacle_collision");
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->GetTuple1(0), 0);
  EXPECT_EQ(found->GetTuple1(1), 4);
  EXPECT_EQ(found->GetTuple1(2), 1);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("unseen_at_poses")->GetTuple1(0), 1);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("in_shadow_at_poses")->GetTuple1(0), 1);
  filter->SetOption("pose_uncertainty", "0.2");
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("obstacle_collision")->GetTuple1(2), 2) << "undecided now";

  // A surface has verdicts of its cells: here a vertex, and two quads of two triangles each.
  const auto surface = dataOf(
      {{1, 0, 1}, {1, 0.1, 1}, {1, 0.1, 1.1}, {1, 0, 1.1}, {5, 0, 1}, {5, 1, 1}, {5, 1, 2}, {5, 0, 2}}, VTK_DOUBLE);
  vtkNew<vtkCellArray> vertices, quads;
  vertices->InsertNextCell({0});
  quads->InsertNextCell({0, 1, 2, 3});
  quads->InsertNextCell({4, 5, 6, 7});
  surface->SetVerts(vertices);
  surface->SetPolys(quads);
  filter->SetObstacleData(surface);
  filter->SetOption("pose_uncertainty", "0");
  filter->Update();
  vtkDataArray* const cells = filter->GetOutput()->GetFieldData()->GetArray("obstacle_collision");
  ASSERT_EQ(cells->GetNumberOfTuples(), 3);
  EXPECT_EQ(cells->GetTuple1(0), 0);
  EXPECT_EQ(cells->GetTuple1(1), 0);
  EXPECT_EQ(cells->GetTuple1(2), 4);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetArray("unseen_at_poses")->GetTuple1(0), 2) << "triangles";
}

} // namespace
} // namespace pcl_bsh::vtk
