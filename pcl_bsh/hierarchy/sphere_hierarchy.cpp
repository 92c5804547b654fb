// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/geometry/coordinate_spacing.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/view_check.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

void check(const PointsView& view, const HierarchyOptions& options)
{
  checkView("SphereHierarchy", view);
  checkLengths("SphereHierarchy", view);
  if (!(options.voxel_edge >= 0.0 && options.voxel_edge <= std::numeric_limits<double>::max()))
    throw InvalidInput(Input::voxel_edge, "SphereHierarchy",
                       "voxel edge " + std::to_string(options.voxel_edge) + " is not finite and >= 0")
        .withValue(options.voxel_edge);
}

} // namespace

SphereHierarchy::SphereHierarchy(const PointsView& points, const HierarchyOptions& options)
{
  check(points, options);
  const DefaultFloatEnvironment environment;
  storage_ = std::make_unique<Storage>(points, options);
}

SphereHierarchy::~SphereHierarchy() = default;
SphereHierarchy::SphereHierarchy(SphereHierarchy&&) noexcept = default;
SphereHierarchy& SphereHierarchy::operator=(SphereHierarchy&&) noexcept = default;

const PointsView& SphereHierarchy::view() const noexcept
{
  return storage_->view;
}
const HierarchyOptions& SphereHierarchy::options() const noexcept
{
  return storage_->options;
}
std::size_t SphereHierarchy::size() const noexcept
{
  return storage_->size;
}

double SphereHierarchy::coordinateSpacing() const noexcept
{
  if (empty() || view().scalar == Scalar::float64) return 0.0;
  const DefaultFloatEnvironment environment;
  const LocalFrame& frame = storage_->frame;
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) // less what the reach was rounded outward by
    largest = std::max(largest, std::abs(frame.origin[k]) + frame.reach[k] * (1.0 - 2 * kReachGrowth) * frame.unit);
  return float32Spacing(largest);
}

void SphereHierarchy::buildAll(unsigned threads) const
{
  const DefaultFloatEnvironment environment;
  parallelFor(storage_->voxel_count, threadCount(threads), [&](std::size_t v) {
    BuildWork unasked;
    storage_->built(v, unasked);
  });
}

} // namespace pcl_bsh
