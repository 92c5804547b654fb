// SPDX-License-Identifier: BSD-3-Clause
#include "render_view.h"

#include <pcl_bsh/tools/viewer/actors/camera.h>
#include <pcl_bsh/tools/viewer/actors/coloring.h>
#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/scene/dragged_object.h>

#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkCellPicker.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointPicker.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace pcl_bsh::viewer {

RenderView::RenderView(const ViewContent& content, vtkRenderer& renderer)
: content_(content),
  renderer_(renderer),
  extra_props_(renderer),
  closest_props_(renderer),
  path_props_(renderer),
  contact_props_(renderer),
  caption_(renderer, content.options().width, content.options().height),
  bar_(renderer, content.options().width),
  histogram_(renderer, content.options().width, content.options().height)
{
  const Options& options = content.options();
  const std::array<double, 3> c = fractions(ground);
  renderer.SetBackground(c[0], c[1], c[2]);
  for (const ViewedCloud& viewed : content.viewedClouds())
    clouds_.push_back(
        makeCloudActor(viewed, renderer, plainColor(viewed),
                       viewed.role == ViewedCloud::Role::scan ? colliding_color : obstacle_colliding_color));
  if (options.cut) clouds_[0]->cut(*options.cut);
  extras_ = {options.level, options.voxels, options.cells, options.trace, options.open_edges, options.beams > 0};
  collisions_ = content.collisions(options.step);
  coloring_ = coloringOf(content, collisions_);
  step_ = options.step;
  paint(clouds_, bar_, content, coloring_);
  show(options.step);
  look(options.camera);
  if (!content.site()) return;
  tiles_.emplace(*content.site(), renderer, *clouds_[0], bar_, histogram_, coloring_);
  writeTexts();
}

bool RenderView::loadTile()
{
  if (!tiles_ || !tiles_->step()) return false;
  writeTexts();
  return true;
}

void RenderView::show(std::size_t step)
{
  if (step != step_) collisions_ = content_.collisions(step);
  step_ = step;
  drawClouds();
  path_props_.clear();
  addPaths(path_props_, content_.paths(step_));
  closest_props_.clear();
  const std::string& unit = content_.options().unit;
  if (collisions_.closest)
    addClosestPair(closest_props_, *collisions_.closest, lengthOf(collisions_.closest->distance, unit));
  for (const NamedCollisions& one : collisions_.named)
    if (one.colliding > 0 && one.closest)
      addClosestPair(closest_props_, *one.closest, one.name + ": " + lengthOf(one.closest->distance, unit));
  drawContacts(content_.contacts(step_));
  drawExtras();
  writeTexts();
}

void RenderView::follow(const DragStep& now, const std::string& note)
{
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    clouds_[i]->place(content_.poseOf(i, step_));
    if (collisions_.known) clouds_[i]->mark({});
  }
  collisions_.known = false;
  extra_props_.clear();
  closest_props_.clear();
  if (now.nearest)
    addClosestPair(closest_props_, {now.nearest->place, now.nearest->other, now.nearest->distance},
                   lengthOf(now.nearest->distance, content_.options().unit));
  drawContacts(now.contacts);
  writeTexts();
  setNote(note);
}

void RenderView::refresh()
{
  collisions_ = content_.collisions(step_);
  show(step_);
}

/// Arrows are a quarter as long as the smallest cloud that moves or, where none does, as the smallest cloud.
void RenderView::drawContacts(const std::vector<Contact>& contacts)
{
  contact_props_.clear();
  if (contacts.empty()) return;
  for (const bool of_moving : {true, false})
    for (std::size_t i = 0; i < clouds_.size() && (arrow_length_ == 0.0 || of_moving); ++i) {
      if (of_moving && !content_.moves(i)) continue;
      const double length = 0.25 * boundsOf(i).GetDiagonalLength();
      if (length > 0.0 && (arrow_length_ == 0.0 || length < arrow_length_)) arrow_length_ = length;
    }
  addContacts(contact_props_, contacts, arrow_length_);
}

void RenderView::setExtras(const Extras& extras)
{
  extras_ = extras;
  drawExtras();
  writeTexts();
}

void RenderView::drawClouds()
{
  bool deformed = false;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    clouds_[i]->place(content_.poseOf(i, step_));
    if (!content_.deforms(i)) continue;
    clouds_[i]->setPoints(content_.viewedClouds()[i].points());
    deformed = true;
  }
  if (deformed) paint(clouds_, bar_, content_, coloring_);
  all_measured_ = paintDistances(clouds_, bar_, histogram_, content_, coloring_, step_);
  if (!all_measured_) mark(clouds_, bar_, content_, collisions_, coloring_, step_);
}

void RenderView::drawExtras()
{
  extra_props_.clear();
  addExtras(extra_props_, content_, extras_, step_);
}

void RenderView::writeTexts()
{
  std::string title = content_.heading(collisions_, step_);
  if (collisions_.closest)
    title += "\nsmallest distance " + lengthOf(collisions_.closest->distance, content_.options().unit);
  if (extras_.open_edges) {
    if (!open_edges_) {
      open_edges_ = 0;
      for (const ViewedCloud& viewed : content_.viewedClouds()) *open_edges_ += openEdgesOf(viewed);
    }
    title += "\n" + groupedCount(*open_edges_, "edge is open", "edges are open");
  }
  if (tiles_) title += "\n" + tiles_->text();
  if (extras_.level) title += "\nspheres of level " + std::to_string(*extras_.level);
  vtkIdType left_out = 0;
  for (const auto& cloud : clouds_) left_out += cloud->leftOut();
  if (left_out > 0) title += "\nfar off and not drawn: " + counted(static_cast<std::uint64_t>(left_out), "point");
  const std::string& given = content_.options().title;
  caption_.setTitle(given.empty() ? title : given + "\n" + title);
  caption_.setLegend(legend());
}

std::vector<LegendEntry> RenderView::legend() const
{
  std::vector<LegendEntry> entries;
  const auto add = [&](const std::string& text, const Color& color) {
    const auto same = [&](const LegendEntry& entry) { return entry.text == text; };
    if (std::none_of(entries.begin(), entries.end(), same)) entries.push_back({text, color});
  };
  for (std::size_t i = 0; i < content_.viewedClouds().size(); ++i) {
    const ViewedCloud& viewed = content_.viewedClouds()[i];
    if (viewed.role == ViewedCloud::Role::obstacle) {
      if (viewed.number < most_named) add(viewed.legend, all_measured_ ? compared_color : plainColor(viewed));
      continue;
    }
    const bool by_value = coloring_ == Coloring::distance || coloring_ == Coloring::first_pose;
    if (all_measured_) continue; // the bar says it all
    if (by_value || coloring_ == Coloring::collision)
      add(viewed.legend + (collisions_.known ? ", free" : ""), scan_color);
    if (by_value && !content_.options().range) continue;
    if (collisions_.known) add(viewed.legend + ", colliding", colliding_color);
    if (collisions_.undecided > 0) add(viewed.legend + ", undecided", undecided_color);
    if (collisions_.sparse > 0) add(viewed.legend + ", not scanned densely enough", sparse_color);
    if (collisions_.unseen > 0) add(viewed.legend + ", unseen", unseen_color);
  }
  for (std::size_t i = 0; i < content_.viewedClouds().size(); ++i) {
    const ViewedCloud& viewed = content_.viewedClouds()[i];
    if (viewed.role != ViewedCloud::Role::obstacle || collisions_.flags[i].empty()) continue;
    const std::string marked = collisions_.named.empty() ? viewed.legend : "obstacle";
    add(marked + ", colliding", obstacle_colliding_color);
    if (countOf(collisions_.flags[i], Verdict::unseen) > 0) add(marked + ", unseen", unseen_color);
  }
  if (const MotionPaths paths = content_.paths(step_); !paths.poses.empty()) add(paths.name, path_color);
  const auto collides = [](const NamedCollisions& one) { return one.colliding > 0 && one.closest; };
  if (std::any_of(collisions_.named.begin(), collisions_.named.end(), collides)) add("nearest places", segment_color);
  if (collisions_.closest) add("closest pair", segment_color);
  if (!content_.contacts(step_).empty()) add("contacts", contact_color);
  if (extras_.level) add("spheres", sphere_color);
  if (extras_.voxels) add("voxels", voxel_color);
  if (extras_.open_edges) add("open edges", open_edge_color);
  if (extras_.cells) add("octree cells", cell_color);
  if (extras_.beams) add("beams", path_color);
  if (extras_.trace) {
    add("query: pruned", fate_colors[0]);
    add("query: near, not needed", fate_colors[1]);
    add("query: points compared", fate_colors[3]);
  }
  return entries;
}

/// Bounds of a rotated cloud: those of its rotated box, which may be larger.
vtkBoundingBox RenderView::boundsOf(std::size_t cloud) const
{
  vtkBoundingBox bounds;
  vtkPolyData& data = clouds_[cloud]->data();
  if (data.GetNumberOfPoints() == 0) return bounds;
  double drawn[6];
  data.GetCellsBounds(drawn); // a mesh may have vertices of no triangle
  const vtkBoundingBox own(drawn);
  const Eigen::Isometry3d pose = content_.poseOf(cloud, step_);
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at;
    own.GetCorner(corner, at.data());
    at = pose * at;
    bounds.AddPoint(at.data());
  }
  return bounds;
}

/// The bounds of all parts that collide, and of all clouds that move.
vtkBoundingBox RenderView::collidingBounds() const
{
  vtkBoundingBox bounds;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    if (content_.moves(i)) bounds.AddBox(boundsOf(i));
    const auto marked = posed(&clouds_[i]->marked(), content_.poseOf(i, step_));
    if (collisions_.known && marked->GetNumberOfPoints() > 0) bounds.AddBounds(marked->GetBounds());
  }
  return bounds;
}

/// All that is drawn. Marks are what collides of the scan or, where nothing of it does, of all clouds.
std::vector<Drawn> RenderView::drawnAbout(const vtkBoundingBox& seen) const
{
  constexpr double steps = 200.0;
  const double step = std::max(seen.GetDiagonalLength() / steps, std::numeric_limits<double>::min());
  const std::optional<Cut>& cut = content_.options().cut;
  const auto isCut = [&](const Eigen::Vector3d& place) {
    return (place - Eigen::Vector3d(cut->point.data())).dot(Eigen::Vector3d(cut->normal.data())) > 0.0;
  };
  std::vector<Drawn> things;
  bool of_scan = false;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    const Eigen::Isometry3d pose = content_.poseOf(i, step_);
    const std::function<bool(const Eigen::Vector3d&)> left_out = i == 0 && cut ? isCut : decltype(left_out)();
    things.push_back({placesOf(clouds_[i]->data(), pose, step, left_out), {}});
    if (collisions_.known) things[i].marks = placesOf(clouds_[i]->marked(), pose, step, left_out);
    of_scan |= content_.viewedClouds()[i].role == ViewedCloud::Role::scan && !things[i].marks.empty();
  }
  for (std::size_t i = 0; i < clouds_.size() && of_scan; ++i)
    if (content_.viewedClouds()[i].role != ViewedCloud::Role::scan) things[i].marks.clear();
  return things;
}

void RenderView::look(const Camera& camera)
{
  std::vector<Drawn> things;
  vtkBoundingBox seen;
  for (std::size_t i = 0; i < clouds_.size(); ++i) seen.AddBox(boundsOf(i));
  if (camera.kind == Camera::Kind::colliding) {
    vtkBoundingBox near = collidingBounds();
    if (near.IsValid()) {
      near.Inflate(std::max(0.01 * seen.GetDiagonalLength(), 0.25 * near.GetDiagonalLength()));
      seen = near;
    }
    things = drawnAbout(seen);
  }
  const Options& options = content_.options();
  viewer::look(renderer_, camera, seen, static_cast<double>(options.width) / options.height, bar_.freeWidth(), things);
}

void RenderView::setMoving(bool moving)
{
  for (const auto& cloud : clouds_) cloud->setMoving(moving);
  if (tiles_) tiles_->setMoving(moving);
}

std::optional<RenderView::Picked> RenderView::pickAt(int x, int y) const
{
  vtkNew<vtkPointPicker> points;
  vtkNew<vtkCellPicker> triangles;
  points->SetTolerance(0.005);
  triangles->SetTolerance(0.0);
  points->PickFromListOn();
  triangles->PickFromListOn();
  for (const auto& cloud : clouds_) cloud->offerTo(*points, *triangles);
  if (tiles_) tiles_->offerTo(*points, *triangles);
  const auto distance = [&](vtkPicker& picker) {
    if (picker.Pick(x, y, 0.0, &renderer_) == 0) return std::numeric_limits<double>::infinity();
    return std::sqrt(
        vtkMath::Distance2BetweenPoints(picker.GetPickPosition(), renderer_.GetActiveCamera()->GetPosition()));
  };
  const double to_point = distance(*points), to_triangle = distance(*triangles);
  if (to_triangle < to_point)
    return Picked{triangles->GetViewProp(), triangles->GetCellId(), Eigen::Vector3d(triangles->GetPickPosition())};
  if (!std::isfinite(to_point)) return std::nullopt;
  return Picked{points->GetViewProp(), points->GetPointId(), Eigen::Vector3d(points->GetPickPosition())};
}

std::string RenderView::pick(int x, int y) const
{
  const auto picked = pickAt(x, y);
  return picked ? describe(picked->prop, picked->id) : std::string();
}

std::optional<std::pair<std::size_t, Eigen::Vector3d>> RenderView::cloudAt(int x, int y) const
{
  const auto picked = pickAt(x, y);
  for (std::size_t i = 0; picked && i < clouds_.size(); ++i)
    if (clouds_[i]->partOf(picked->prop, picked->id)) return std::pair(i, picked->place);
  return std::nullopt;
}

std::string RenderView::describe(const vtkProp* prop, vtkIdType id) const
{
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    if (const auto part = clouds_[i]->partOf(prop, id)) return describePart(content_, i, collisions_, *part);
  }
  const auto part = tiles_ ? tiles_->partOf(prop, id) : std::nullopt;
  return part ? describePart(*part->content, 0, part->content->collisions(0), part->record) : std::string();
}

std::string RenderView::describePart(const ViewContent& content, std::size_t cloud, const StepCollisions& collisions,
                                     std::uint32_t part) const
{
  const ViewedCloud& viewed = content.viewedClouds()[cloud];
  const Point3 p = viewed.placeOf(part);
  std::ostringstream text;
  text << viewed.partName() << ' ' << part << " of " << viewed.name << std::setprecision(9) << ": " << p[0] << ", "
       << p[1] << ", " << p[2];
  const std::vector<Verdict>& flags = collisions.flags[cloud];
  const Verdict flag = flags.empty() ? Verdict::free : flags[part];
  if (collisions.known)
    text << (flag == Verdict::free        ? "; free"
             : flag == Verdict::undecided ? "; undecided"
             : flag == Verdict::sparse    ? "; not scanned densely enough"
             : flag == Verdict::unseen    ? "; unseen"
                                          : "; collides");
  return text.str() + content.details(cloud, part, step_);
}

} // namespace pcl_bsh::viewer
