// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "palette.h"
#include <pcl_bsh/tools/viewer/content/view_content.h>
#include <pcl_bsh/tools/viewer/content/viewed_cloud.h>
#include <pcl_bsh/tools/viewer/view_options.h>

#include <pcl_bsh/hierarchy/points_view.h>

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkPicker.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pcl_bsh::viewer {

/// A cloud as it is drawn. Its parts are points or triangles, which have colours and marks.
class CloudActor {
public:
  virtual ~CloudActor() = default;
  CloudActor(const CloudActor&) = delete;
  CloudActor& operator=(const CloudActor&) = delete;

  /// Takes points that have moved in the cloud's own frame; they are to be painted and marked anew. Surfaces ignore it:
  /// they do not deform.
  virtual void setPoints(const PointsView& /*points*/) {}

  /// @param colors one per part
  virtual void paint(const std::vector<Color>& colors) = 0;

  /// Paints all in one colour. Lower points are darker, because a cloud all of one colour would look flat.
  /// @param heights of the lowest and the highest; null: the cloud's own
  virtual void paint(const Color& color, const ColorRange* heights = nullptr) = 0;

  /// Makes parts with flags[part] != 0 stand out: in the mark's colour, or in `colors` where that is not empty.
  /// @param flags empty: none
  virtual void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors = {}) = 0;

  virtual void setMoving(bool /*moving*/) {} ///< large clouds are thinned while the picture moves
  virtual void setVisible(bool visible) = 0; ///< while the picture does not move
  void place(const Eigen::Isometry3d& pose);
  void remove();              ///< for good
  void cut(const Cut& plane); ///< in the world frame; nothing is drawn on the side of its normal

  vtkPolyData& data() const { return *data_; }     ///< what is drawn
  vtkPolyData& all() const { return *all_; }       ///< also points that are not drawn, as they lie far off
  vtkPolyData& marked() const { return *marked_; } ///< the marked parts
  vtkIdType leftOut() const { return all().GetNumberOfPoints() - data().GetNumberOfPoints(); }

  /// Lets the pickers find the parts.
  virtual void offerTo(vtkPicker& points, vtkPicker& triangles) const = 0;

  /// The part that was picked, by its prop and the id of a point or of a triangle's cell; none when the prop is not of
  /// this cloud.
  virtual std::optional<std::uint32_t> partOf(const vtkProp* prop, vtkIdType id) const = 0;

protected:
  explicit CloudActor(vtkRenderer& renderer) : renderer_(renderer) {}
  void draw(vtkActor& actor); ///< adds it to the picture

  vtkSmartPointer<vtkPolyData> data_, all_, marked_;

private:
  vtkRenderer& renderer_;
  std::vector<vtkSmartPointer<vtkActor>> actors_;
};

/// Clouds of a picture, in the order of its content's.
using CloudActors = std::span<const std::unique_ptr<CloudActor>>;

/// A cloud as points; marks are drawn once more, larger.
std::unique_ptr<CloudActor> makePointsActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color,
                                            const Color& marked);

/// A surface whose triangles have colours of their own. Marked triangles are outlined, too: small ones are seen from
/// afar. @pre viewed.hasTriangles()
std::unique_ptr<CloudActor> makeTrianglesActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color,
                                               const Color& marked);

/// Returns the actor that fits the cloud, added to the renderer.
/// @param marked the colour of marks
inline std::unique_ptr<CloudActor> makeCloudActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color,
                                                  const Color& marked)
{
  return (viewed.hasTriangles() ? makeTrianglesActor : makePointsActor)(viewed, renderer, color, marked);
}

} // namespace pcl_bsh::viewer
