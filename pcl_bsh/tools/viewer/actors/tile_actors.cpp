// SPDX-License-Identifier: BSD-3-Clause
#include "tile_actors.h"

#include <pcl_bsh/base/counted.h>

#include "coloring.h"
#include "text.h"

#include <vtkCamera.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh::viewer {

TileActors::TileActors(const SiteContent& site, vtkRenderer& renderer, const CloudActor& overview, ValueBar& bar,
                       ValueHistogram& histogram, Coloring coloring)
: site_(site),
  renderer_(renderer),
  bar_(bar),
  histogram_(histogram),
  coloring_(coloring),
  choice_(site.tiles(), site.tilePoints())
{
  const double* const bounds = overview.data().GetBounds();
  alike_.heights = {bounds[4], bounds[5]};
  alike_.values = bar.range();
  alike_.all_distances = coloring == Coloring::distance && !site.allDistances(0).empty();
}

/// The camera sees what lies within its four sides, in front of it, and is not cut away. The plane in front is needed,
/// because a box behind the camera may have a corner on the positive side of each of the four.
Eye TileActors::eye() const
{
  vtkCamera& camera = *renderer_.GetActiveCamera();
  Eye eye;
  camera.GetPosition(eye.place.data());
  double planes[24];
  camera.GetFrustumPlanes(renderer_.GetTiledAspectRatio(), planes);
  for (std::size_t side = 0; side < 4; ++side) {
    std::array<double, 4> plane;
    std::copy_n(planes + 4 * side, 4, plane.begin());
    eye.planes.push_back(plane);
  }
  if (!camera.GetParallelProjection()) {
    const double *const to = camera.GetDirectionOfProjection(), *const from = camera.GetPosition();
    eye.planes.push_back({to[0], to[1], to[2], -(to[0] * from[0] + to[1] * from[1] + to[2] * from[2])});
  }
  if (const std::optional<Cut>& cut = site_.options().cut) {
    const std::array<double, 3>&n = cut->normal, &p = cut->point;
    eye.planes.push_back({-n[0], -n[1], -n[2], n[0] * p[0] + n[1] * p[1] + n[2] * p[2]});
  }
  return eye;
}

bool TileActors::step()
{
  choice_.look(eye());
  const std::vector<std::size_t> superfluous = choice_.superfluous();
  for (const std::size_t tile : superfluous) {
    shown_.at(tile).actor->remove();
    shown_.erase(tile);
    choice_.drop(tile);
  }
  const std::optional<std::size_t> next = choice_.next();
  if (!next) return !superfluous.empty();
  try {
    load(*next);
  }
  catch (...) {
    choice_.giveUp(*next);
    throw;
  }
  choice_.hold(*next);
  return true;
}

void TileActors::load(std::size_t tile)
{
  Shown shown;
  shown.content = site_.readTile(tile, alike_);
  shown.actor = makeCloudActor(shown.content->scan(), renderer_, scan_color, colliding_color);
  const CloudActors clouds(&shown.actor, 1);
  if (site_.options().cut) shown.actor->cut(*site_.options().cut);
  paint(clouds, bar_, *shown.content, coloring_);
  if (!paintDistances(clouds, bar_, histogram_, *shown.content, coloring_, 0))
    mark(clouds, bar_, *shown.content, shown.content->collisions(0), coloring_, 0);
  if (!alike_.values) alike_.values = bar_.range(); // no point of the overview has a value, one of this tile may
  shown_.emplace(tile, std::move(shown));
}

void TileActors::setMoving(bool moving)
{
  for (auto& [tile, shown] : shown_) shown.actor->setVisible(!moving);
}

void TileActors::offerTo(vtkPicker& points, vtkPicker& triangles) const
{
  for (const auto& [tile, shown] : shown_) shown.actor->offerTo(points, triangles);
}

std::optional<TileActors::Part> TileActors::partOf(const vtkProp* prop, vtkIdType id) const
{
  for (const auto& [tile, shown] : shown_)
    if (const auto record = shown.actor->partOf(prop, id)) return Part{shown.content.get(), *record};
  return std::nullopt;
}

std::string TileActors::text() const
{
  if (site_.tilePoints() == 0) return "all points are drawn";
  return "drawn: " + groupedCount(site_.scan().parts(), "point") + " of the overview, " +
         grouped(choice_.heldPoints()) + " of " + counted(choice_.held(), "tile") +
         (choice_.held() < choice_.wanted() ? ", " + std::to_string(choice_.wanted() - choice_.held()) + " to load"
                                            : "");
}

} // namespace pcl_bsh::viewer
