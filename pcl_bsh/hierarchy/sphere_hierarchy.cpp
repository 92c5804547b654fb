// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/parallel.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh {
namespace {

constexpr std::size_t kMostRecords = std::numeric_limits<std::int32_t>::max();

void check(const PointsView& view, const HierarchyOptions& options)
{
  const auto fail = [](const std::string& what) { throw std::invalid_argument("SphereHierarchy: " + what); };
  if (view.count > kMostRecords)
    fail(std::to_string(view.count) + " points are more than an index can name (" + std::to_string(kMostRecords) + ")");
  if (view.count > 0 && !view.data)
    fail("the view's data is null though it has " + std::to_string(view.count) + " points");
  if (view.indices) {
    if (view.index_count > kMostRecords)
      fail(std::to_string(view.index_count) + " indices are more than the limit of 2^31 - 1");
    for (std::size_t i = 0; i < view.index_count; ++i)
      if (view.indices[i] < 0 || static_cast<std::size_t>(view.indices[i]) >= view.count)
        fail("index " + std::to_string(view.indices[i]) + " is outside the cloud of " + std::to_string(view.count) +
             " points");
  }
  if (view.radii)
    for (std::size_t i = 0; i < view.count; ++i)
      if (!(view.radii[i] >= 0.0f && view.radii[i] <= std::numeric_limits<float>::max()))
        fail("radius " + std::to_string(view.radii[i]) + " of point " + std::to_string(i) + " is not finite and >= 0");
  if (!(options.voxel_edge >= 0.0 && options.voxel_edge <= std::numeric_limits<double>::max()))
    fail("voxel edge " + std::to_string(options.voxel_edge) + " is not finite and >= 0");
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
  const LocalFrame& frame = storage_->frame;
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) // the reach is rounded outward by 2^-20
    largest = std::max(largest, std::abs(frame.origin[k]) + frame.reach[k] * (1.0 - 0x1p-19) * frame.unit);
  const float number = roundDown(largest);
  return static_cast<double>(number) - static_cast<double>(std::nextafter(number, 0.0f));
}

void SphereHierarchy::buildAll(unsigned threads) const
{
  const DefaultFloatEnvironment environment;
  parallelFor(storage_->voxel_count, threadCount(threads), [&](std::size_t v) {
    std::uint64_t built_now = 0;
    storage_->built(v, built_now);
  });
}

} // namespace pcl_bsh
