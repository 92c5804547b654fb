// SPDX-License-Identifier: BSD-3-Clause
#include "actors.h"
#include "cloud_actor.h"

#include <pcl_bsh/vtk/cloud_data.h>

#include <vtkIntArray.h>
#include <vtkMapper.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pcl_bsh::viewer {
namespace {

constexpr double tail = 0.005; // of the points, at each end of an axis
constexpr double farthest = 1000.0;

struct Bulk {
  std::array<double, 3> low, high;
  double size = 0.0;
};

Bulk bulkOf(vtkPolyData& cloud)
{
  Bulk bulk;
  const auto count = static_cast<std::size_t>(cloud.GetNumberOfPoints());
  std::vector<double> along(count);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < count; ++i) along[i] = cloud.GetPoint(static_cast<vtkIdType>(i))[k];
    const auto at = [&](double share) {
      const auto nth = along.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1));
      std::nth_element(along.begin(), nth, along.end());
      return *nth;
    };
    bulk.low[k] = at(tail);
    bulk.high[k] = at(1.0 - tail);
    bulk.size = std::max(bulk.size, bulk.high[k] - bulk.low[k]);
  }
  return bulk;
}

/// The cloud without points far from its bulk, which are 99 of 100 points along each axis. Far is more than a thousand
/// times the bulk's size. Returns the cloud itself where it has no such points, or the bulk is one place. A picture
/// with them, a sensor's "no return" written as a number, would show nothing of the others.
vtkSmartPointer<vtkPolyData> withoutFarPoints(vtkPolyData& cloud)
{
  const vtkIdType count = cloud.GetNumberOfPoints();
  if (count == 0) return &cloud;
  const double* const bounds = cloud.GetBounds();
  const double size = std::max({bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]});
  const Bulk bulk = bulkOf(cloud);
  if (!(bulk.size > 0.0) || size <= farthest * bulk.size) return &cloud;
  vtkDataArray& index = *cloud.GetPointData()->GetArray("index");
  std::vector<std::uint8_t> near;
  for (vtkIdType i = 0; i < count; ++i) {
    const double* const p = cloud.GetPoint(i);
    const auto record = static_cast<std::size_t>(index.GetTuple1(i));
    near.resize(std::max(near.size(), record + 1));
    near[record] = 1;
    for (std::size_t k = 0; k < 3; ++k)
      if (bulk.low[k] - p[k] > farthest * bulk.size || p[k] - bulk.high[k] > farthest * bulk.size) near[record] = 0;
  }
  return vtk::subset(cloud, near);
}

/// Sparse clouds need larger points to be seen as surfaces.
float sizeFor(std::size_t count)
{
  return count > 300'000 ? 1.5f : count > 30'000 ? 2.0f : 3.0f;
}

/// Points of one size. While the picture moves, only a few are drawn. All and few have an actor each, of which one is
/// visible, so that the graphics card keeps the data of all.
class PointLayer {
public:
  /// @param in_front drawn in front of other points of the same place
  PointLayer(float size, bool in_front)
  : data_(vtkSmartPointer<vtkPolyData>::New()),
    all_(actorOf(data_)),
    few_(actorOf(data_))
  {
    // VTK shifts all points by -8 once any are to be shifted at all. The 8 undoes that for points not in front.
    vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
    few_->SetProperty(all_->GetProperty());
    all_->GetProperty()->SetPointSize(size);
    for (vtkActor* actor : {all_.Get(), few_.Get()})
      actor->GetMapper()->SetRelativeCoincidentTopologyPointOffsetParameter(in_front ? -8.0 : 8.0);
    setMoving(false);
  }

  /// @param data of vtk::cloudData(), with an array `colors` or in the layer's colour
  void show(vtkPolyData& data)
  {
    data_ = &data;
    setData(*all_, data);
    few_is_old_ = true;
    if (few_->GetVisibility() != 0) setMoving(true);
  }

  vtkActor& all() const { return *all_; } ///< is picked, as nothing moves then
  vtkActor& few() const { return *few_; }

  void setMoving(bool moving)
  {
    constexpr vtkIdType points_while_moving = 300'000;
    if (moving && few_is_old_) {
      setData(*few_, *vtk::thinned(*data_, points_while_moving));
      few_is_old_ = false;
    }
    all_->SetVisibility(!moving);
    few_->SetVisibility(moving);
  }

  /// For a picture that does not move.
  void setVisible(bool visible) { all_->SetVisibility(visible); }

private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkActor> all_, few_;
  bool few_is_old_ = true;
};

class PointsActor final : public CloudActor {
public:
  PointsActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& marked)
  : CloudActor(renderer),
    points_(sizeFor(viewed.points().size()), false),
    marks_(6.0f, true)
  {
    for (const PointLayer* layer : {&points_, &marks_})
      for (vtkActor* actor : {&layer->all(), &layer->few()}) draw(*actor);
    setColor(marks_.all(), marked);
    setPoints(viewed.points());
    mark({}, {});
  }

  void setPoints(const PointsView& points) override
  {
    all_ = vtk::cloudData(points);
    data_ = withoutFarPoints(*all_);
    points_.show(*data_);
  }

  void paint(const std::vector<Color>& colors) override
  {
    setColorsOfRecords(*data_, colors);
    points_.show(*data_);
  }

  void paint(const Color& color, const ColorRange* heights) override
  {
    const double* const bounds = data_->GetBounds();
    const ColorRange range = heights ? *heights : ColorRange{bounds[4], bounds[5]};
    const double height = std::max(range.high - range.low, std::numeric_limits<double>::min());
    setColors(*data_->GetPointData(), data_->GetNumberOfPoints(), [&](vtkIdType i) {
      const double share = 0.55 + 0.45 * std::clamp((data_->GetPoint(i)[2] - range.low) / height, 0.0, 1.0);
      Color shaded;
      for (std::size_t k = 0; k < 3; ++k) shaded[k] = static_cast<unsigned char>(color[k] * share);
      return shaded;
    });
    points_.show(*data_);
  }

  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors) override
  {
    marked_ = flags.empty() ? vtkSmartPointer<vtkPolyData>::New() : vtk::subset(*data_, flags);
    marked_->GetPointData()->RemoveArray("colors");
    if (!colors.empty()) setColorsOfRecords(*marked_, colors);
    marks_.show(*marked_);
  }

  void setMoving(bool moving) override
  {
    points_.setMoving(moving);
    marks_.setMoving(moving);
  }

  void setVisible(bool visible) override
  {
    points_.setVisible(visible);
    marks_.setVisible(visible);
  }

  void offerTo(vtkPicker& points, vtkPicker& /*triangles*/) const override
  {
    for (const PointLayer* layer : {&points_, &marks_}) points.AddPickList(&layer->all());
  }

  std::optional<std::uint32_t> partOf(const vtkProp* prop, vtkIdType id) const override
  {
    if (prop != &points_.all() && prop != &marks_.all()) return std::nullopt;
    vtkPolyData& picked = prop == &points_.all() ? *data_ : *marked_;
    if (id < 0 || id >= picked.GetNumberOfPoints()) return std::nullopt;
    return static_cast<std::uint32_t>(recordsOf(picked).GetValue(id));
  }

private:
  static vtkIntArray& recordsOf(vtkPolyData& points)
  {
    return *vtkIntArray::SafeDownCast(points.GetPointData()->GetArray("index"));
  }

  static void setColorsOfRecords(vtkPolyData& points, const std::vector<Color>& colors)
  {
    const vtkIntArray& records = recordsOf(points);
    setColors(*points.GetPointData(), points.GetNumberOfPoints(),
              [&](vtkIdType i) { return colors[static_cast<std::size_t>(records.GetValue(i))]; });
  }

  PointLayer points_, marks_;
};

} // namespace

std::unique_ptr<CloudActor> makePointsActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& /*color*/,
                                            const Color& marked)
{
  return std::make_unique<PointsActor>(viewed, renderer, marked);
}

} // namespace pcl_bsh::viewer
