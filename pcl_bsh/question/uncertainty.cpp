// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/uncertainty.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/question/record_numbers.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

namespace pcl_bsh {
namespace {

InvalidInput refusal(const std::string& cloud, const std::string& wrong, const std::string& remedy)
{
  return InvalidInput(Input::uncertainty, cloud, wrong, remedy);
}

/// Returns a float no less than the product; infinity where no finite float is.
float productUpward(double x, double y)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double product = x * y;
  return roundUp(std::fma(x, y, -product) > 0.0 ? std::nextafter(product, infinity) : product);
}

/// No less than the sum.
double movedBy(double x, double y)
{
  return y == 0.0 ? x : std::nextafter(x + y, std::numeric_limits<double>::infinity());
}

/// The memory that a view of uncertain points keeps alive.
struct Owned {
  std::vector<float> lengths;
  std::shared_ptr<const void> points;
};

} // namespace

void checkUncertainty(const std::string& cloud, const Uncertainty& uncertainty)
{
  const auto require = [&](const char* what, double value) {
    if (std::isfinite(value) && value >= 0.0) return;
    throw refusal(cloud, plainText(what, value), "give a finite number >= 0").withValue(value);
  };
  require("uncertainty ", uncertainty.length);
  require("number of sigmas ", uncertainty.sigmas);
  require("length of the pose's uncertainty ", uncertainty.pose.length);
  require("angle of the pose's uncertainty ", uncertainty.pose.angle);
}

PointsView withUncertainty(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                           const Uncertainty& uncertainty)
{
  checkUncertainty(cloud, uncertainty);
  PointsView uncertain = view;
  const bool by_field = !uncertainty.field.empty();
  const double of_all = movedBy(by_field ? 0.0 : uncertainty.length, uncertainty.pose.length);
  uncertain.uncertainty = movedBy(of_all, view.uncertainty);
  if (!by_field && uncertainty.pose.angle == 0.0) return uncertain;
  std::optional<RecordNumbers> sigmas;
  if (by_field) {
    sigmas.emplace(
        view, fields, uncertainty.field, cloud,
        RecordNumbers::Purpose{Input::uncertainty, "of its points' sigmas", "give a length, or one of its fields"});
  }
  auto owned = std::make_shared<Owned>();
  owned->points = view.owner;
  owned->lengths.resize(view.count);
  for (std::size_t i = 0; i < view.count; ++i) {
    const auto record = static_cast<std::uint32_t>(i);
    if (!isFinite(view.point(record))) continue; // it takes part in nothing
    const double sigma = sigmas ? (*sigmas)[i] : 0.0;
    const float own = productUpward(sigma, uncertainty.sigmas);
    const double asked = movedBy(own, uncertainty.pose.turned(view.point(record), view.radius(record)));
    const float length = roundUp(movedBy(asked, view.ownUncertainty(record)));
    if (sigma >= 0.0 && std::isfinite(length)) {
      owned->lengths[i] = length;
      continue;
    }
    const std::string remedy =
        plainText("give finite lengths >= 0, no more than ", std::numeric_limits<float>::max(), " in all");
    if (!sigmas) throw refusal(cloud, plainText("point ", i, " may move by ", length), remedy).withIndex(i);
    throw refusal(cloud, plainText("field '", uncertainty.field, "' of point ", i, " is ", sigma), remedy)
        .withValue(sigma)
        .withIndex(i);
  }
  uncertain.uncertainties = owned->lengths.data();
  uncertain.owner = std::move(owned);
  return uncertain;
}

std::uint64_t checksumOf(const PointsView& view, const std::vector<RecordField>& fields, const std::string& name)
{
  std::uint64_t sum = 0;
  for (const RecordField& field : fields) {
    if (name.empty() || field.name != name) continue;
    const std::size_t bytes = bytesOf(field);
    if (field.offset + bytes > view.stride) continue; // it is refused where it is read
    const auto* record = static_cast<const unsigned char*>(view.data) + field.offset;
    for (std::size_t i = 0; i < view.count; ++i, record += view.stride) {
      std::uint64_t word = 0;
      std::memcpy(&word, record, bytes);
      sum = mixed(sum, word);
    }
  }
  return sum;
}

} // namespace pcl_bsh
