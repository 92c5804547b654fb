// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/view_check.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr std::size_t kMostRecords = std::numeric_limits<std::int32_t>::max();

/// Whether some coordinate of one kind shares bytes with one of another kind, of the same record or not. Coordinates of
/// a kind may lie in an array of their own, so that offsets beyond the stride are no error.
bool overlap(const PointsView& view, std::size_t offset_a, std::size_t offset_b, std::size_t width)
{
  const std::size_t apart = offset_a < offset_b ? offset_b - offset_a : offset_a - offset_b;
  if (apart < width) return true;
  if (view.stride == 0) return false;              // one record
  const std::size_t records = apart / view.stride; // whole ones that fit in between
  return (records < view.count && apart - records * view.stride < width) ||
         (records + 1 < view.count && (records + 1) * view.stride - apart < width);
}

void checkLayout(const std::string& name, const PointsView& view)
{
  const auto fail = [&](const std::string& what, const std::string& remedy) {
    throw InvalidInput(Input::points, name, what, remedy);
  };
  const std::size_t width = view.scalar == Scalar::float32 ? sizeof(float) : sizeof(double);
  if (view.count > 1 && view.stride < width)
    fail("the view's stride of " + std::to_string(view.stride) + " bytes puts its " + counted(view.count, "record") +
             " over each other",
         "give the bytes from one record to the next, at least " + std::to_string(width));
  constexpr const char* kAxes[3] = {"x", "y", "z"};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t k = j + 1; k < 3; ++k)
      if (overlap(view, view.offset[j], view.offset[k], width))
        fail(std::string("the view's ") + kAxes[j] + " and " + kAxes[k] + " at bytes " +
                 std::to_string(view.offset[j]) + " and " + std::to_string(view.offset[k]) + " of records that are " +
                 std::to_string(view.stride) + " bytes apart lie over each other",
             "give offset and stride as records are");
}

} // namespace

void checkView(const std::string& name, const PointsView& view)
{
  const auto fail = [&](const std::string& what, Input input = Input::points) {
    throw InvalidInput(input, name, what);
  };
  if (view.count > kMostRecords)
    fail(counted(view.count, "point is", "points are") + " more than an index can name (" +
         std::to_string(kMostRecords) + ")");
  if (view.count > 0) {
    if (!view.data) fail("the view's data is null though it has " + counted(view.count, "point"));
    checkLayout(name, view);
  }
  if (!view.indices) return;
  if (view.index_count > kMostRecords)
    fail(std::to_string(view.index_count) + " indices are more than the limit of 2^31 - 1");
  for (std::size_t i = 0; i < view.index_count; ++i)
    if (view.indices[i] < 0 || static_cast<std::size_t>(view.indices[i]) >= view.count)
      fail("index " + std::to_string(view.indices[i]) + " is outside the cloud of " + counted(view.count, "point"),
           Input::index);
}

void checkLengths(const std::string& name, const PointsView& view)
{
  for (std::size_t i = 0; view.radii && i < view.count; ++i) {
    const float radius = view.radii[i];
    if (radius >= 0.0f && radius <= std::numeric_limits<float>::max()) continue;
    throw InvalidInput(Input::radius, name,
                       "radius " + std::to_string(radius) + " of point " + std::to_string(i) +
                           " is not finite and >= 0")
        .withValue(static_cast<double>(radius))
        .withIndex(i);
  }
  const auto refuse = [&](double value, const std::string& of) {
    return InvalidInput(Input::uncertainty, name, plainText("uncertainty ", value, of, " is not finite and >= 0"))
        .withValue(value);
  };
  if (!(std::isfinite(view.uncertainty) && view.uncertainty >= 0.0)) throw refuse(view.uncertainty, "");
  for (std::size_t i = 0; view.uncertainties && i < view.count; ++i) {
    const double own = view.uncertainties[i];
    if (!(std::isfinite(own) && own >= 0.0)) throw refuse(own, " of point " + std::to_string(i)).withIndex(i);
  }
}

} // namespace pcl_bsh
