// SPDX-License-Identifier: BSD-3-Clause
#include "stage.h"

#include "closest_actor.h"
#include "export.h"
#include "eye.h"
#include "painting.h"
#include "text.h"

#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk/path_data.h>

#include <vtkBoundingBox.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include <algorithm>

namespace pcl_bsh::view {

Stage::Stage(const World& world, vtkRenderer& renderer)
: world_(world),
  renderer_(renderer),
  extra_props_(renderer),
  closest_props_(renderer),
  way_props_(renderer),
  caption_(renderer, world.options().width, world.options().height),
  bar_(renderer, world.options().width)
{
  const Options& options = world.options();
  const std::array<double, 3> c = fractions(ground);
  renderer.SetBackground(c[0], c[1], c[2]);
  for (const Thing& thing : world.things())
    clouds_.emplace_back(thing.points(), renderer,
                         thing.role == Thing::Role::scan ? colliding_color : obstacle_colliding_color);
  if (options.cut) clouds_[0].cut(*options.cut);
  extras_ = {options.level, options.voxels, options.cells, options.trace};
  findings_ = world.findings(options.step);
  coloring_ = coloringOf(world, findings_);
  step_ = options.step;
  paint(clouds_, bar_, world, coloring_);
  show(options.step);
  look(options.camera);
}

void Stage::show(std::size_t step)
{
  if (step != step_) findings_ = world_.findings(step);
  step_ = step;
  drawClouds();
  drawWays();
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

void Stage::drawClouds()
{
  bool deformed = false;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    clouds_[i].place(world_.poseOf(i, step_));
    if (!world_.deforms(i)) continue;
    clouds_[i].setPoints(world_.things()[i].points());
    deformed = true;
  }
  if (deformed) paint(clouds_, bar_, world_, coloring_);
  mark(clouds_, bar_, world_, findings_, coloring_, step_);
}

void Stage::drawExtras()
{
  extra_props_.clear();
  addExtras(extra_props_, world_, extras_, step_);
}

void Stage::drawClosest()
{
  closest_props_.clear();
  if (findings_.closest) addClosest(closest_props_, *findings_.closest, world_.options().unit);
}

void Stage::drawWays()
{
  way_props_.clear();
  for (const std::vector<Eigen::Isometry3d>& way : world_.ways(step_).poses) {
    const auto path = vtk::pathData(way);
    path->GetPointData()->SetActiveScalars(nullptr);
    const auto line = actorOf(path);
    setColor(*line, path_color);
    line->GetProperty()->SetLineWidth(2.0f);
    way_props_.add(line);
  }
}

void Stage::writeTexts()
{
  std::string title = world_.heading(findings_, step_);
  if (findings_.closest) title += "\nsmallest distance " + lengthOf(findings_.closest->distance, world_.options().unit);
  if (extras_.level) title += "\nspheres of level " + std::to_string(*extras_.level);
  vtkIdType left_out = 0;
  for (const CloudActor& cloud : clouds_) left_out += cloud.leftOut();
  if (left_out > 0)
    title += "\nfar off and not drawn: " + std::to_string(left_out) + (left_out == 1 ? " point" : " points");
  caption_.setTitle(title);
  caption_.setLegend(legend());
}

std::vector<LegendEntry> Stage::legend() const
{
  std::vector<LegendEntry> entries;
  const auto add = [&](const std::string& text, const Color& color) {
    const auto same = [&](const LegendEntry& entry) { return entry.text == text; };
    if (std::none_of(entries.begin(), entries.end(), same)) entries.push_back({text, color});
  };
  for (std::size_t i = 0; i < world_.things().size(); ++i) {
    const Thing& thing = world_.things()[i];
    if (thing.role == Thing::Role::obstacle) {
      add(thing.legend, obstacle_color);
      if (!findings_.flags[i].empty()) add(thing.legend + ", colliding", obstacle_colliding_color);
      continue;
    }
    const bool by_value = coloring_ == Coloring::distance || coloring_ == Coloring::first_pose;
    if (by_value || coloring_ == Coloring::collision) add(thing.legend + (findings_.known ? ", free" : ""), scan_color);
    if (findings_.known && (!by_value || world_.options().range)) add(thing.legend + ", colliding", colliding_color);
  }
  if (const Ways ways = world_.ways(step_); !ways.poses.empty()) add(ways.name, path_color);
  if (findings_.closest) add("closest pair", segment_color);
  if (extras_.level) add("spheres", sphere_color);
  if (extras_.voxels) add("voxels", voxel_color);
  if (extras_.cells) add("octree cells", cell_color);
  if (extras_.trace) {
    add("query: pruned", fate_colors[0]);
    add("query: near, not needed", fate_colors[1]);
    add("query: points compared", fate_colors[3]);
  }
  return entries;
}

/// Of a rotated cloud the bounds of its rotated box, which may be larger.
vtkBoundingBox Stage::boundsOf(std::size_t thing) const
{
  vtkBoundingBox bounds;
  vtkPolyData& data = clouds_[thing].data();
  if (data.GetNumberOfPoints() == 0) return bounds;
  const vtkBoundingBox own(data.GetBounds());
  const Eigen::Isometry3d pose = world_.poseOf(thing, step_);
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at;
    own.GetCorner(corner, at.data());
    at = pose * at;
    bounds.AddPoint(at.data());
  }
  return bounds;
}

/// Around all points that collide, and what moves.
vtkBoundingBox Stage::collidingBounds() const
{
  vtkBoundingBox bounds;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    if (world_.moves(i)) bounds.AddBox(boundsOf(i));
    const auto marked = posed(&clouds_[i].marked(), world_.poseOf(i, step_));
    if (findings_.known && marked->GetNumberOfPoints() > 0) bounds.AddBounds(marked->GetBounds());
  }
  return bounds;
}

void Stage::look(const Camera& camera)
{
  vtkBoundingBox seen;
  for (std::size_t i = 0; i < clouds_.size(); ++i) seen.AddBox(boundsOf(i));
  if (camera.kind == Camera::Kind::colliding) {
    vtkBoundingBox near = collidingBounds();
    if (near.IsValid()) {
      near.Inflate(std::max(0.01 * seen.GetDiagonalLength(), 0.25 * near.GetDiagonalLength()));
      seen = near;
    }
  }
  const Options& options = world_.options();
  view::look(renderer_, camera, seen, static_cast<double>(options.width) / options.height, bar_.freeWidth());
}

void Stage::setMoving(bool moving)
{
  for (CloudActor& cloud : clouds_) cloud.setMoving(moving);
}

std::string Stage::describe(const vtkProp* prop, vtkIdType id) const
{
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    const std::optional<std::uint32_t> record = clouds_[i].recordOf(prop, id);
    if (!record) continue;
    const Thing& thing = world_.things()[i];
    const Point3 p = thing.points().point(*record);
    std::ostringstream text;
    text << "point " << *record << " of " << thing.name << std::setprecision(9) << ": " << p[0] << ", " << p[1] << ", "
         << p[2];
    const std::vector<std::uint8_t>& flags = findings_.flags[i];
    if (findings_.known) text << (!flags.empty() && flags[*record] != 0 ? "; collides" : "; free");
    return text.str() + world_.details(i, *record, step_);
  }
  return {};
}

void Stage::exportTo(const std::filesystem::path& path)
{
  view::exportTo(path, world_, clouds_, findings_, step_, extras_.level.value_or(0));
}

} // namespace pcl_bsh::view
