// SPDX-License-Identifier: BSD-3-Clause
// The picture: a world's clouds, marks, spheres and boxes as actors of one renderer.
#pragma once

#include "palette.h"
#include "world.h"

#include <vtkActor.h>
#include <vtkLegendBoxActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::view {

/// A cloud as points, with those that collide once more, larger; few points only while the picture moves.
class CloudActor {
public:
  CloudActor(const Thing& thing, vtkRenderer& renderer, const Color& marked);

  /// @param colors one per record
  void paint(const std::vector<Color>& colors);

  /// Draws points with flags[record] != 0 larger: in the mark's colour, or in `colors` where that is not empty.
  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors);
  void place(const Eigen::Isometry3d& pose);
  void setMoving(bool moving);

  vtkPolyData& data() { return *data_; }
  vtkPolyData& marked() { return *marked_; }
  bool owns(const vtkProp* prop) const { return prop == points_.Get() || prop == marks_.Get(); }

private:
  vtkSmartPointer<vtkPolyData> data_, few_, marked_;
  vtkSmartPointer<vtkActor> points_, marks_;
};

/// Which extras are on.
struct Extras {
  std::optional<unsigned> level; ///< of the spheres
  bool voxels = false, cells = false, trace = false;
};

class Stage {
public:
  Stage(const World& world, vtkRenderer& renderer);

  /// Takes the model to this pose, and lets flags and everything that hangs on them follow.
  void show(std::size_t step);
  std::size_t step() const { return step_; }

  void setExtras(const Extras& extras);
  const Extras& extras() const { return extras_; }

  void look(const Camera& camera);
  void setMoving(bool moving);
  void setNote(const std::string& text); ///< lines at the bottom, as for a picked point; empty: none

  /// What a picked prop and point id say; empty when that is no point of a cloud.
  std::string describe(const vtkProp* prop, vtkIdType id) const;

  /// Clouds with their arrays, spheres, boxes, path and trace, as files. @throws std::runtime_error naming the file
  void exportTo(const std::filesystem::path& path);

  const Findings& findings() const { return findings_; }

private:
  void paint();
  void paintByValue(const std::vector<float>& values, const std::string& title, bool reversed, bool only_marked);
  void writeTexts();
  void drawExtras();
  void drawClosest();
  void addSpheres(vtkPolyData& spheres, const Eigen::Isometry3d& pose, const std::vector<Color>& colors,
                  double opacity);
  void addWires(vtkPolyData& boxes, const Eigen::Isometry3d& pose, const Color& color);
  void addExtra(const vtkSmartPointer<vtkProp>& prop);
  std::string lengthTitle(const std::string& name) const;

  const World& world_;
  vtkRenderer& renderer_;
  std::vector<CloudActor> clouds_;
  std::vector<vtkSmartPointer<vtkProp>> extra_props_, closest_props_;
  vtkSmartPointer<vtkTextActor> title_, note_;
  vtkSmartPointer<vtkLegendBoxActor> legend_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  Coloring coloring_;
  Extras extras_;
  Findings findings_;
  std::size_t step_ = 0;
};

} // namespace pcl_bsh::view
