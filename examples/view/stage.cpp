// SPDX-License-Identifier: BSD-3-Clause
#include "stage.h"

#include "cli/program.h"
#include "cli/step.h"

#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/path_data.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkBillboardTextActor3D.h>
#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkGlyph3DMapper.h>
#include <vtkIntArray.h>
#include <vtkLineSource.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

namespace pcl_bsh::view {
namespace {

constexpr vtkIdType points_while_moving = 300'000;
constexpr int text_size = 17;

vtkSmartPointer<vtkMatrix4x4> matrixOf(const Eigen::Isometry3d& pose)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix->SetElement(row, column, pose.matrix()(row, column));
  return matrix;
}

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

void setColor(vtkActor& actor, const Color& color)
{
  const std::array<double, 3> c = fractions(color);
  actor.GetProperty()->SetColor(c[0], c[1], c[2]);
}

Color bytes(const double* color)
{
  return {static_cast<unsigned char>(std::lround(255 * color[0])),
          static_cast<unsigned char>(std::lround(255 * color[1])),
          static_cast<unsigned char>(std::lround(255 * color[2]))};
}

void setData(vtkActor& actor, vtkPolyData* data)
{
  vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(data);
}

/// By record where the data has record numbers.
void setColors(vtkPolyData& data, const std::vector<Color>& colors)
{
  auto* const index = vtkIntArray::SafeDownCast(data.GetPointData()->GetArray("index"));
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName("colors");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(data.GetNumberOfPoints());
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i)
    array->SetTypedTuple(i, colors[static_cast<std::size_t>(index ? index->GetValue(i) : i)].data());
  data.GetPointData()->SetScalars(array);
}

/// The colour, darker for lower points: a cloud of one colour would look flat.
std::vector<Color> shaded(vtkPolyData& data, std::size_t records, const Color& color)
{
  std::vector<Color> colors(records, color);
  auto* const index = vtkIntArray::SafeDownCast(data.GetPointData()->GetArray("index"));
  if (data.GetNumberOfPoints() == 0) return colors;
  const double* const bounds = data.GetBounds();
  const double low = bounds[4], height = std::max(bounds[5] - bounds[4], std::numeric_limits<double>::min());
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) {
    const double share = 0.55 + 0.45 * (data.GetPoint(i)[2] - low) / height;
    Color& shade = colors[static_cast<std::size_t>(index->GetValue(i))];
    for (unsigned char& channel : shade) channel = static_cast<unsigned char>(channel * share);
  }
  return colors;
}

/// Three great circles of radius 1: they outline a sphere from every side.
vtkSmartPointer<vtkPolyData> circles()
{
  constexpr int corners = 96;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  for (int axis = 0; axis < 3; ++axis) {
    lines->InsertNextCell(corners + 1);
    for (int i = 0; i <= corners; ++i) {
      double p[3] = {0, 0, 0};
      p[axis] = std::cos(2 * std::numbers::pi * i / corners);
      p[(axis + 1) % 3] = std::sin(2 * std::numbers::pi * i / corners);
      lines->InsertCellPoint(points->InsertNextPoint(p));
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

vtkSmartPointer<vtkTextActor> textAt(double x, double y, bool from_top)
{
  auto text = vtkSmartPointer<vtkTextActor>::New();
  text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  text->SetPosition(x, y);
  vtkTextProperty* const look = text->GetTextProperty();
  look->SetFontSize(text_size);
  look->SetFontFamilyToArial();
  look->SetLineSpacing(1.25);
  const std::array<double, 3> c = fractions(text_color);
  look->SetColor(c[0], c[1], c[2]);
  if (from_top)
    look->SetVerticalJustificationToTop();
  else
    look->SetVerticalJustificationToBottom();
  return text;
}

Coloring coloringOf(const World& world, const Findings& findings)
{
  if (world.options().color) return *world.options().color;
  if (findings.known) return Coloring::collision;
  return world.scan().colors() ? Coloring::rgb : Coloring::height;
}

std::string grouped(std::size_t number)
{
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, " ");
  return text;
}

std::string shortest(double value)
{
  std::ostringstream text;
  text << std::setprecision(6) << value;
  return text.str();
}

Extras extrasOf(const Options& options)
{
  return {options.level, options.voxels, options.cells, options.trace};
}

vtkSmartPointer<vtkPolyData> posed(vtkPolyData* data, const Eigen::Isometry3d& pose)
{
  if (data->GetNumberOfPoints() == 0 || pose.isApprox(Eigen::Isometry3d::Identity(), 0.0)) return data;
  vtkNew<vtkTransform> transform;
  transform->SetMatrix(matrixOf(pose));
  vtkNew<vtkTransformPolyDataFilter> filter;
  filter->SetTransform(transform);
  filter->SetInputData(data);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  return filter->GetOutput();
}

} // namespace

CloudActor::CloudActor(const Thing& thing, vtkRenderer& renderer, const Color& marked)
: data_(vtk::cloudData(thing.points())),
  marked_(vtkSmartPointer<vtkPolyData>::New()),
  points_(actorOf(data_)),
  marks_(actorOf(marked_))
{
  // Sparse clouds need larger points to be seen as surfaces.
  const vtkIdType count = data_->GetNumberOfPoints();
  points_->GetProperty()->SetPointSize(count > 300'000 ? 1.5f : count > 30'000 ? 2.0f : 3.0f);
  marks_->GetProperty()->SetPointSize(6.0f);
  setColor(*marks_, marked);
  marks_->GetMapper()->SetRelativeCoincidentTopologyPointOffsetParameter(-8.0); // before the same points, dimmed
  renderer.AddActor(points_);
  renderer.AddActor(marks_);
}

void CloudActor::paint(const std::vector<Color>& colors)
{
  setColors(*data_, colors);
  few_ = nullptr;
}

void CloudActor::mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors)
{
  marked_ = flags.empty() ? vtkSmartPointer<vtkPolyData>::New() : vtk::subset(*data_, flags);
  if (flags.empty()) marked_->SetPoints(vtkNew<vtkPoints>());
  marked_->GetPointData()->SetActiveScalars(nullptr);
  marked_->GetPointData()->RemoveArray("colors");
  if (!colors.empty() && !flags.empty()) setColors(*marked_, colors);
  setData(*marks_, marked_);

  // The same points among all others: what is marked must not shine through its mark in another colour.
  if (flags.empty()) return;
  const Color mark = bytes(marks_->GetProperty()->GetColor());
  auto* const index = vtkIntArray::SafeDownCast(data_->GetPointData()->GetArray("index"));
  auto* const shown = vtkUnsignedCharArray::SafeDownCast(data_->GetPointData()->GetScalars());
  for (vtkIdType i = 0; i < data_->GetNumberOfPoints(); ++i) {
    const auto record = static_cast<std::size_t>(index->GetValue(i));
    if (flags[record] != 0) shown->SetTypedTuple(i, colors.empty() ? mark.data() : colors[record].data());
  }
  shown->Modified();
}

void CloudActor::place(const Eigen::Isometry3d& pose)
{
  const auto matrix = matrixOf(pose);
  points_->SetUserMatrix(matrix);
  marks_->SetUserMatrix(matrix);
}

void CloudActor::setMoving(bool moving)
{
  if (moving && !few_) {
    few_ = vtk::thinned(*data_, points_while_moving);
    few_->GetPointData()->SetActiveScalars("colors");
  }
  setData(*points_, moving ? few_ : data_);
}

Stage::Stage(const World& world, vtkRenderer& renderer) : world_(world), renderer_(renderer)
{
  const std::array<double, 3> c = fractions(ground);
  renderer.SetBackground(c[0], c[1], c[2]);
  for (std::size_t i = 0; i < world.things().size(); ++i)
    clouds_.emplace_back(world.things()[i], renderer, i == 0 ? colliding_color : obstacle_colliding_color);

  title_ = textAt(0.012, 0.985, true);
  note_ = textAt(0.5, 0.02, false);
  note_->GetTextProperty()->SetJustificationToCentered();
  bar_ = vtkSmartPointer<vtkScalarBarActor>::New();
  bar_->UnconstrainedFontSizeOn();
  bar_->SetPosition(0.885, 0.3);
  bar_->SetWidth(0.085);
  bar_->SetHeight(0.45);
  bar_->SetNumberOfLabels(5);
  bar_->SetVerticalTitleSeparation(10);
  for (vtkTextProperty* look : {bar_->GetTitleTextProperty(), bar_->GetLabelTextProperty()}) {
    look->ShallowCopy(title_->GetTextProperty());
    look->SetFontSize(text_size - 2);
  }
  bar_->VisibilityOff();
  legend_ = vtkSmartPointer<vtkLegendBoxActor>::New();
  legend_->BorderOff();
  legend_->SetPadding(4);
  legend_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  legend_->GetPosition2Coordinate()->SetCoordinateSystemToNormalizedViewport();
  for (vtkProp* prop : {static_cast<vtkProp*>(title_), static_cast<vtkProp*>(note_), static_cast<vtkProp*>(bar_),
                        static_cast<vtkProp*>(legend_)})
    renderer.AddActor2D(static_cast<vtkActor2D*>(prop));
  if (world.steps() > 1) {
    vtkSmartPointer<vtkPolyData> path = vtk::pathData(world.poses());
    path->GetPointData()->SetActiveScalars(nullptr);
    const auto line = actorOf(path);
    setColor(*line, path_color);
    line->GetProperty()->SetLineWidth(2.0f);
    renderer.AddActor(line);
  }

  extras_ = extrasOf(world.options());
  findings_ = world.findings(world.options().step);
  coloring_ = coloringOf(world, findings_);
  show(world.options().step);
  look(world.options().camera);
}

void Stage::show(std::size_t step)
{
  if (step != step_) findings_ = world_.findings(step);
  step_ = step;
  for (std::size_t i = 0; i < clouds_.size(); ++i) clouds_[i].place(world_.poseOf(i, step));
  paint();
  drawClosest();
  drawExtras();
  writeTexts();
}

void Stage::setExtras(const Extras& extras)
{
  extras_ = extras;
  drawExtras();
  writeTexts();
}

std::string Stage::lengthTitle(const std::string& name) const
{
  return name + "\n[" + (world_.options().unit.empty() ? "cloud's unit" : world_.options().unit) + "]";
}

void Stage::paint()
{
  const Thing& scan = world_.scan();
  const std::vector<Color> plain = shaded(clouds_[0].data(), scan.points().count, scan_color);
  bar_->VisibilityOff();
  const auto require = [&](const char* option, const auto& values, const char* fields) {
    if (!values)
      throw cli::UsageError(std::string("--color: ") + scan.file.string() + " has no " + fields +
                            ": give another than " + option);
  };
  const auto requireFindings = [&](const char* option) {
    if (!findings_.known)
      throw cli::UsageError(
          std::string("--color: it is not known what collides: give an obstacle and --clearance, or a " +
                      std::string("cloud with the field 'collision', for ") + option));
  };
  switch (coloring_) {
  case Coloring::collision:
    requireFindings("collision");
    clouds_[0].paint(plain);
    clouds_[0].mark(findings_.scan, {});
    break;
  case Coloring::distance:
    requireFindings("distance");
    paintByValue(world_.distances(step_), lengthTitle("distance"), true, true);
    break;
  case Coloring::first_pose: {
    requireFindings("first_pose");
    std::vector<float> values;
    for (const std::int32_t pose : world_.firstPoses())
      values.push_back(pose < 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(pose));
    paintByValue(values, "first pose\n[number]", false, true);
    break;
  }
  case Coloring::height: {
    std::vector<float> values;
    for (std::uint32_t i = 0; i < scan.points().count; ++i)
      values.push_back(static_cast<float>(scan.points().point(i)[2]));
    paintByValue(values, lengthTitle("height z"), false, false);
    clouds_[0].mark(findings_.scan, {});
    break;
  }
  case Coloring::intensity: {
    const auto values = scan.field("intensity");
    require("intensity", values, "field 'intensity'");
    paintByValue(*values, "intensity\n[as given]", false, false);
    clouds_[0].mark(findings_.scan, {});
    break;
  }
  case Coloring::rgb: {
    const auto colors = scan.colors();
    require("rgb", colors, "colours (fields rgb, rgba or red, green, blue)");
    clouds_[0].paint(*colors);
    clouds_[0].mark(findings_.scan, {});
    break;
  }
  }
  for (std::size_t i = 1; i < clouds_.size(); ++i) {
    clouds_[i].paint(shaded(clouds_[i].data(), world_.things()[i].points().count, obstacle_color));
    if (findings_.known) clouds_[i].mark(findings_.other[i - 1], {});
  }
}

void Stage::paintByValue(const std::vector<float>& values, const std::string& title, bool reversed, bool only_marked)
{
  std::vector<float> finite;
  for (const float value : values)
    if (std::isfinite(value)) finite.push_back(value);
  double low = 0.0, high = 1.0;
  if (!finite.empty()) {
    // A few outliers should not take all colours for themselves.
    const auto at = [&](double share) {
      const auto nth = finite.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(finite.size() - 1));
      std::nth_element(finite.begin(), nth, finite.end());
      return static_cast<double>(*nth);
    };
    low = at(only_marked ? 0.0 : 0.005);
    high = at(only_marked ? 1.0 : 0.995);
  }
  if (coloring_ == Coloring::distance) {
    low = 0.0;
    high = world_.options().clearance.value_or(high);
  }
  const auto table = colorTable(low, high, reversed);
  std::vector<Color> colors(values.size(), scan_color);
  std::vector<std::uint8_t> known(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const unsigned char* const c = table->MapValue(values[i]);
    colors[i] = {c[0], c[1], c[2]};
    known[i] = 1;
  }
  if (only_marked) {
    clouds_[0].paint(shaded(clouds_[0].data(), values.size(), scan_color));
    clouds_[0].mark(known, colors);
  }
  else {
    clouds_[0].paint(colors);
  }
  bar_->SetLookupTable(table);
  bar_->SetTitle(title.c_str());
  const bool counts = coloring_ == Coloring::first_pose;
  bar_->SetLabelFormat(counts ? "%.0f" : "%-.3g");
  bar_->SetNumberOfLabels(counts ? static_cast<int>(std::clamp(high - low + 1.0, 2.0, 5.0)) : 5);
  bar_->SetVisibility(!finite.empty());
}

void Stage::writeTexts()
{
  std::ostringstream text;
  text << world_.scan().file.filename().string() << ": " << grouped(clouds_[0].data().GetNumberOfPoints()) << " points";
  if (findings_.known) {
    text << ", " << grouped(findings_.colliding) << " collide";
    if (world_.options().clearance)
      text << "  (clearance " << shortest(*world_.options().clearance) << ' ' << world_.options().unit << ')';
  }
  if (world_.steps() > 1) text << "\npose " << step_ << " of 0.." << world_.steps() - 1;
  if (findings_.closest)
    text << "\nsmallest distance " << shortest(findings_.closest->distance) << ' ' << world_.options().unit;
  if (extras_.level) text << "\nspheres of level " << *extras_.level;
  title_->SetInput(text.str().c_str());

  struct Entry {
    std::string text;
    Color color;
  };
  std::vector<Entry> entries;
  const std::string scan = world_.scan().file.filename().string();
  if (coloring_ == Coloring::collision || coloring_ == Coloring::distance || coloring_ == Coloring::first_pose)
    entries.push_back({scan + (findings_.known ? ", free" : ""), scan_color});
  if (findings_.known && coloring_ != Coloring::distance && coloring_ != Coloring::first_pose)
    entries.push_back({scan + ", colliding", colliding_color});
  for (std::size_t i = 1; i < world_.things().size(); ++i) {
    const std::string name = world_.things()[i].file.filename().string();
    entries.push_back({name, obstacle_color});
    if (findings_.known && !findings_.other[i - 1].empty())
      entries.push_back({name + ", colliding", obstacle_colliding_color});
  }
  if (world_.steps() > 1) entries.push_back({"path of the model", path_color});
  if (findings_.closest) entries.push_back({"closest pair", segment_color});
  if (extras_.level) entries.push_back({"spheres", sphere_color});
  if (extras_.voxels) entries.push_back({"voxels", voxel_color});
  if (extras_.cells) entries.push_back({"octree cells", cell_color});
  if (extras_.trace) {
    entries.push_back({"query: pruned", fate_colors[0]});
    entries.push_back({"query: near, not needed", fate_colors[1]});
    entries.push_back({"query: points compared", fate_colors[3]});
  }
  vtkNew<vtkPlaneSource> square;
  square->Update();
  std::size_t longest = 8;
  legend_->SetNumberOfEntries(static_cast<int>(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::array<double, 3> c = fractions(entries[i].color);
    legend_->SetEntry(static_cast<int>(i), square->GetOutput(), entries[i].text.c_str(), c.data());
    longest = std::max(longest, entries[i].text.size());
  }
  const double width = world_.options().width, height = world_.options().height;
  legend_->SetPosition(0.01, 0.015);
  legend_->SetPosition2(std::min(0.6, (40.0 + 9.0 * static_cast<double>(longest)) / width),
                        26.0 * static_cast<double>(entries.size()) / height);
  legend_->SetVisibility(!entries.empty());
}

void Stage::addExtra(const vtkSmartPointer<vtkProp>& prop)
{
  prop->PickableOff();
  renderer_.AddViewProp(prop);
  extra_props_.push_back(prop);
}

void Stage::addSpheres(vtkPolyData& spheres, const Eigen::Isometry3d& pose, const std::vector<Color>& colors,
                       double opacity)
{
  if (spheres.GetNumberOfPoints() == 0) return;
  setColors(spheres, colors);
  const auto add = [&](vtkPolyData* shape, double how_opaque) {
    vtkNew<vtkGlyph3DMapper> mapper;
    mapper->SetInputData(&spheres);
    mapper->SetSourceData(shape);
    mapper->SetScaleArray("radius");
    mapper->SetScaleModeToScaleByMagnitude();
    mapper->SetScaleFactor(1.0);
    mapper->ScalarVisibilityOn();
    mapper->SetScalarModeToUsePointFieldData();
    mapper->SelectColorArray("colors");
    mapper->SetColorModeToDirectScalars();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetOpacity(how_opaque);
    actor->SetUserMatrix(matrixOf(pose));
    addExtra(actor.Get());
  };
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1.0);
  const vtkIdType count = spheres.GetNumberOfPoints();
  const int corners = count > 20'000 ? 8 : count > 500 ? 20 : 48;
  ball->SetThetaResolution(corners);
  ball->SetPhiResolution(corners);
  ball->Update();
  // The more there are, the less each may hide.
  const double crowd = std::clamp(40.0 / std::sqrt(static_cast<double>(count)), 0.15, 1.0);
  add(ball->GetOutput(), opacity * crowd);
  if (count <= 20'000) add(circles(), std::min(1.0, 0.15 + 2.5 * opacity * crowd));
}

void Stage::addWires(vtkPolyData& boxes, const Eigen::Isometry3d& pose, const Color& color)
{
  const auto actor = actorOf(&boxes);
  actor->GetMapper()->ScalarVisibilityOff();
  setColor(*actor, color);
  actor->GetProperty()->SetOpacity(0.6);
  actor->SetUserMatrix(matrixOf(pose));
  addExtra(actor);
}

void Stage::drawExtras()
{
  for (const auto& prop : extra_props_) renderer_.RemoveViewProp(prop);
  extra_props_.clear();
  for (std::size_t i = 0; i < world_.things().size(); ++i) {
    const SphereHierarchy& hierarchy = *world_.things()[i].hierarchy;
    const Eigen::Isometry3d pose = world_.poseOf(i, step_);
    if (extras_.level) {
      const auto spheres = vtk::sphereData(hierarchy, *extras_.level);
      const std::vector<Color> colors(static_cast<std::size_t>(spheres->GetNumberOfPoints()), sphere_color);
      addSpheres(*spheres, pose, colors, 0.16);
    }
    if (extras_.voxels) addWires(*vtk::voxelBoxes(hierarchy), pose, voxel_color);
    if (extras_.cells) addWires(*vtk::cellBoxes(hierarchy, extras_.level.value_or(1)), pose, cell_color);
  }
  if (!extras_.trace) return;
  for (std::size_t i = 1; i < world_.things().size(); ++i) {
    const CollisionTrace trace = world_.trace(i, step_);
    // Opened spheres are seen as their children; what is left shows each place once.
    const auto show = [&](const std::vector<TracedSphere>& all, std::size_t thing) {
      for (const SphereFate fate : {SphereFate::pruned, SphereFate::kept, SphereFate::compared}) {
        std::vector<TracedSphere> some;
        std::copy_if(all.begin(), all.end(), std::back_inserter(some),
                     [fate](const TracedSphere& sphere) { return sphere.fate == fate; });
        const auto spheres = vtk::traceData(some);
        addSpheres(*spheres, world_.poseOf(thing, step_),
                   std::vector<Color>(some.size(), fate_colors[static_cast<std::size_t>(fate)]),
                   fate == SphereFate::compared ? 0.6
                   : fate == SphereFate::kept   ? 0.3
                                                : 0.12);
      }
    };
    show(trace.a, 0);
    show(trace.b, i);
  }
}

void Stage::drawClosest()
{
  for (const auto& prop : closest_props_) renderer_.RemoveViewProp(prop);
  closest_props_.clear();
  if (!findings_.closest) return;
  const auto add = [&](const vtkSmartPointer<vtkProp>& prop) {
    prop->PickableOff();
    renderer_.AddViewProp(prop);
    closest_props_.push_back(prop);
  };
  vtkNew<vtkLineSource> line;
  line->SetPoint1(findings_.closest->a.data());
  line->SetPoint2(findings_.closest->b.data());
  line->Update();
  const auto segment = actorOf(line->GetOutput());
  setColor(*segment, segment_color);
  segment->GetProperty()->SetLineWidth(3.0f);
  add(segment);
  vtkNew<vtkBillboardTextActor3D> label;
  const Eigen::Vector3d middle = (findings_.closest->a + findings_.closest->b) / 2;
  label->SetPosition(middle.x(), middle.y(), middle.z());
  label->SetDisplayOffset(8, 8);
  label->SetInput((shortest(findings_.closest->distance) + ' ' + world_.options().unit).c_str());
  const std::array<double, 3> c = fractions(segment_color);
  label->GetTextProperty()->SetColor(c[0], c[1], c[2]);
  label->GetTextProperty()->SetFontSize(text_size);
  add(label.Get());
}

void Stage::look(const Camera& camera)
{
  vtkCamera& eye = *renderer_.GetActiveCamera();
  if (camera.kind == Camera::Kind::given) {
    eye.SetPosition(camera.eye.data());
    eye.SetFocalPoint(camera.focus.data());
    eye.SetViewUp(camera.up.data());
    renderer_.ResetCameraClippingRange();
    return;
  }
  std::array<double, 3> from = {-0.55, -1.0, 0.7}, up = {0, 0, 1};
  if (camera.kind == Camera::Kind::top) {
    from = {0, 0, 1};
    up = {0, 1, 0};
  }
  if (camera.kind == Camera::Kind::front) from = {0, -1, 0};
  if (camera.kind == Camera::Kind::side) from = {1, 0, 0};

  vtkBoundingBox seen;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    const auto at = posed(&clouds_[i].data(), world_.poseOf(i, step_));
    if (at->GetNumberOfPoints() > 0) seen.AddBounds(at->GetBounds());
  }
  if (camera.kind == Camera::Kind::colliding && (findings_.colliding > 0 || world_.model())) {
    const double whole = seen.GetDiagonalLength();
    seen.Reset();
    if (findings_.colliding > 0) seen.AddBounds(vtk::subset(clouds_[0].data(), findings_.scan)->GetBounds());
    if (const auto model = world_.model(); model && clouds_[*model].data().GetNumberOfPoints() > 0)
      seen.AddBounds(posed(&clouds_[*model].data(), world_.poseOf(*model, step_))->GetBounds());
    seen.Inflate(std::max(0.01 * whole, 0.25 * seen.GetDiagonalLength()));
  }
  double focus[3];
  seen.GetCenter(focus);
  const Eigen::Vector3d toward_eye = Eigen::Vector3d(from.data()).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d(up.data()).cross(toward_eye).normalized();
  const double tall = std::tan(eye.GetViewAngle() * std::numbers::pi / 360.0);
  const double free_width = bar_->GetVisibility() != 0 ? 0.78 : 1.0; // the bar should not hide anything
  const double wide = free_width * tall * world_.options().width / world_.options().height;
  double away = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double at[3];
    seen.GetCorner(corner, at);
    const Eigen::Vector3d p = Eigen::Vector3d(at) - Eigen::Vector3d(focus);
    away = std::max({away, std::abs(p.dot(right)) / wide + p.dot(toward_eye),
                     std::abs(p.dot(toward_eye.cross(right))) / tall + p.dot(toward_eye)});
  }
  const Eigen::Vector3d position = Eigen::Vector3d(focus) + 1.1 * std::max(away, 1e-6) * toward_eye;
  eye.SetFocalPoint(focus);
  eye.SetPosition(position.data());
  eye.SetViewUp(up.data());
  renderer_.ResetCameraClippingRange();
}

void Stage::setMoving(bool moving)
{
  for (CloudActor& cloud : clouds_) cloud.setMoving(moving);
}

void Stage::setNote(const std::string& text)
{
  note_->SetInput(text.c_str());
}

std::string Stage::describe(const vtkProp* prop, vtkIdType id) const
{
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    if (!clouds_[i].owns(prop)) continue;
    vtkPolyData* const data = vtkPolyData::SafeDownCast(
        vtkActor::SafeDownCast(const_cast<vtkProp*>(prop))->GetMapper()->GetInputDataObject(0, 0));
    auto* const index = vtkIntArray::SafeDownCast(data->GetPointData()->GetArray("index"));
    if (!index || id < 0 || id >= index->GetNumberOfTuples()) return {};
    const auto record = static_cast<std::uint32_t>(index->GetValue(id));
    const Thing& thing = world_.things()[i];
    const Point3 p = thing.points().point(record);
    std::ostringstream text;
    text << "point " << record << " of " << thing.file.filename().string() << std::setprecision(9) << ": " << p[0]
         << ", " << p[1] << ", " << p[2];
    if (i > 0) return text.str();
    if (const auto distance = world_.distanceOf(record, step_))
      text << "; distance " << shortest(*distance) << ' ' << world_.options().unit;
    if (findings_.known) text << (findings_.scan[record] != 0 ? "; collides" : "; free");
    if (world_.knowsFirstPoses() || world_.steps() > 1) {
      const std::int32_t first = world_.firstPoses()[record];
      text << "; first pose " << (first < 0 ? "none" : std::to_string(first));
    }
    return text.str();
  }
  return {};
}

void Stage::exportTo(const std::filesystem::path& path)
{
  cli::Step step("Writing " + path.string());
  vtkNew<vtkPolyData> scan;
  scan->ShallowCopy(&clouds_[0].data());
  if (findings_.known) {
    vtk::addArray(*scan, "collision", findings_.scan);
    vtk::addArray(*scan, "distance", world_.distances(step_));
    vtk::addArray(*scan, "first_pose", world_.firstPoses());
  }
  if (const auto values = world_.scan().field("intensity")) vtk::addArray(*scan, "intensity", *values);
  if (path.extension() == ".vtp") {
    vtk::writeVtp(*scan, path);
    step.done(grouped(static_cast<std::size_t>(scan->GetNumberOfPoints())) + " points");
    return;
  }
  std::vector<vtk::NamedData> blocks = {{world_.scan().file.filename().string(), scan.Get()}};
  for (std::size_t i = 0; i < world_.things().size(); ++i) {
    const Thing& thing = world_.things()[i];
    const Eigen::Isometry3d pose = world_.poseOf(i, step_);
    const std::string name = thing.file.filename().string();
    if (i > 0) {
      vtkNew<vtkPolyData> other;
      other->ShallowCopy(&clouds_[i].data());
      if (findings_.known && !findings_.other[i - 1].empty())
        vtk::addArray(*other, "collision", findings_.other[i - 1]);
      blocks.emplace_back(name, posed(other, pose));
    }
    const unsigned level = extras_.level.value_or(0);
    const auto spheres = vtk::sphereData(*thing.hierarchy, level);
    blocks.emplace_back(name + " spheres", posed(spheres, pose));
    blocks.emplace_back(name + " sphere glyphs", posed(vtk::sphereGlyphs(*spheres), pose));
    blocks.emplace_back(name + " voxels", posed(vtk::voxelBoxes(*thing.hierarchy), pose));
    blocks.emplace_back(name + " cells", posed(vtk::cellBoxes(*thing.hierarchy, level), pose));
  }
  if (world_.steps() > 1) blocks.emplace_back("path", vtk::pathData(world_.poses()));
  vtk::writeVtm(blocks, path);
  step.done(std::to_string(blocks.size()) + " blocks");
}

} // namespace pcl_bsh::view
