// SPDX-License-Identifier: BSD-3-Clause
// The picture: clouds, marks, spheres and boxes of a ViewContent as actors of one renderer.
#pragma once

#include <pcl_bsh/tools/viewer/actors/actors.h>
#include <pcl_bsh/tools/viewer/actors/caption.h>
#include <pcl_bsh/tools/viewer/actors/cloud_actor.h>
#include <pcl_bsh/tools/viewer/actors/extras.h>
#include <pcl_bsh/tools/viewer/actors/tile_actors.h>
#include <pcl_bsh/tools/viewer/actors/value_bar.h>
#include <pcl_bsh/tools/viewer/actors/value_histogram.h>
#include <pcl_bsh/tools/viewer/actors/visibility.h>
#include <pcl_bsh/tools/viewer/content/view_content.h>

#include <vtkBoundingBox.h>
#include <vtkRenderer.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::viewer {

class RenderView {
public:
  RenderView(const ViewContent& content, vtkRenderer& renderer);

  /// Places all clouds as at this step, and draws what collides there, the paths and the texts anew.
  void show(std::size_t step);
  std::size_t step() const { return step_; }

  /// Draws all clouds where they are now, the contacts and the smallest distance, while an object is led by hand.
  /// Nothing is marked as colliding until refresh().
  void follow(const DragStep& now, const std::string& note);
  void refresh(); ///< draws the step anew, with what collides there

  void setExtras(const Extras& extras);
  const Extras& extras() const { return extras_; }

  void look(const Camera& camera);
  void setMoving(bool moving);
  void setNote(const std::string& text) { caption_.setNote(text); } ///< as for a picked point; empty: none

  /// Draws the tiles of a site that the camera sees nearest, one more with each call.
  /// @throws files::FileError for a tile that cannot be read: it is left out from then on
  bool loadTile();
  std::string tilesText() const { return tiles_ ? tiles_->text() : std::string(); }

  /// Describes the point or triangle that is seen at a pixel; empty where it sees none.
  std::string pick(int x, int y) const;

  /// The cloud that is seen at a pixel, and where; nothing where none is.
  std::optional<std::pair<std::size_t, Eigen::Vector3d>> cloudAt(int x, int y) const;

  /// Describes a picked prop and the id of a point, or of a triangle's cell; empty when it belongs to no cloud.
  std::string describe(const vtkProp* prop, vtkIdType id) const;

  /// Writes clouds with their arrays, spheres of a level, boxes and paths. @throws std::runtime_error naming the file
  void exportTo(const std::filesystem::path& path) const;

  const StepCollisions& collisions() const { return collisions_; }

private:
  struct Picked {
    const vtkProp* prop;
    vtkIdType id;
    Eigen::Vector3d place;
  };
  std::optional<Picked> pickAt(int x, int y) const;
  std::string describePart(const ViewContent& content, std::size_t cloud, const StepCollisions& collisions,
                           std::uint32_t part) const;
  void drawClouds();
  void drawContacts(const std::vector<Contact>& contacts);
  void drawExtras();
  void writeTexts();
  std::vector<LegendEntry> legend() const;
  vtkBoundingBox boundsOf(std::size_t cloud) const;
  vtkBoundingBox collidingBounds() const;
  std::vector<Drawn> drawnAbout(const vtkBoundingBox& seen) const;

  const ViewContent& content_;
  vtkRenderer& renderer_;
  std::vector<std::unique_ptr<CloudActor>> clouds_;
  PropGroup extra_props_, closest_props_, path_props_, contact_props_;
  Caption caption_;
  ValueBar bar_;
  ValueHistogram histogram_;
  bool all_measured_ = false; ///< all points of the first cloud are coloured by their distance
  Coloring coloring_;
  std::optional<TileActors> tiles_; ///< of a site
  Extras extras_;
  std::optional<std::size_t> open_edges_; ///< counted once they are drawn
  double arrow_length_ = 0.0;             ///< of contacts; 0: not measured yet
  StepCollisions collisions_;
  std::size_t step_ = 0;
};

} // namespace pcl_bsh::viewer
