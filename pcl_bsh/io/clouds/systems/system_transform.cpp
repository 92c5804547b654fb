// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/systems/proj_objects.h>
#include <pcl_bsh/io/clouds/systems/system_transform.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/number_text.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {
namespace {

std::string digits(double number, int most)
{
  return numberText(number, std::chars_format::general, most);
}

bool isAngular(PJ_TYPE type)
{
  return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
}

/// x east, y north, whatever the order of the systems' axes.
ProjObject eastFirst(const ProjContext& proj, const ProjObject& operation)
{
  return ProjObject(proj_normalize_for_visualization(proj.get(), operation.get()));
}

/// A place of one system in another, for orientation alone; not finite where PROJ cannot tell.
Eigen::Vector2d placeIn(const ProjContext& proj, const PJ* from, const PJ* to, const Eigen::Vector2d& place)
{
  const ProjObject way(proj_create_crs_to_crs_from_pj(proj.get(), from, to, nullptr, nullptr));
  const PJ_COORD at = proj_coord(place.x(), place.y(), 0, 0);
  const PJ_COORD found =
      way ? proj_trans(eastFirst(proj, way).get(), PJ_FWD, at) : proj_coord(HUGE_VAL, HUGE_VAL, 0, 0);
  return {found.xy.x, found.xy.y};
}

/// Longitude and latitude in degrees.
Eigen::Vector2d degreesOf(const ProjContext& proj, const PJ* system, const Eigen::Vector2d& place)
{
  return placeIn(proj, system, proj.system("OGC:CRS84").get(), place);
}

/// An operation, and a better one that lacks a grid.
struct Way {
  ProjObject operation;
  std::string missing = {}; ///< the first grid that is not there; empty: no operation is better
  double better = -1.0;     ///< the accuracy with that grid, in metres; negative: not known
};

std::string missingGridOf(const ProjContext& proj, const PJ* operation)
{
  for (int i = 0; i < proj_coordoperation_get_grid_used_count(proj.get(), operation); ++i) {
    const char* name = nullptr;
    int is_there = 0;
    proj_coordoperation_get_grid_used(proj.get(), operation, i, &name, nullptr, nullptr, nullptr, nullptr, nullptr,
                                      &is_there);
    if (!is_there && name) return name;
  }
  return "a grid";
}

Way wayBetween(const ProjContext& proj, const PJ* from, const PJ* to, const Eigen::Vector2d& degrees)
{
  const std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, FreeProj> factory(
      proj_create_operation_factory_context(proj.get(), nullptr));
  proj_operation_factory_context_set_allow_ballpark_transformations(proj.get(), factory.get(), 0);
  proj_operation_factory_context_set_spatial_criterion(proj.get(), factory.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(proj.get(), factory.get(),
                                                           PROJ_GRID_AVAILABILITY_IGNORED); // the best first
  if (degrees.allFinite()) {
    constexpr double around = 1e-6;
    proj_operation_factory_context_set_area_of_interest(proj.get(), factory.get(), degrees.x() - around,
                                                        degrees.y() - around, degrees.x() + around,
                                                        degrees.y() + around);
  }
  Way way;
  const ProjList all(proj_create_operations(proj.get(), from, to, factory.get()));
  for (int i = 0; all && i < proj_list_get_count(all.get()); ++i) {
    ProjObject one(proj_list_get(proj.get(), all.get(), i));
    if (proj_coordoperation_has_ballpark_transformation(proj.get(), one.get())) continue;
    if (proj_coordoperation_is_instantiable(proj.get(), one.get())) {
      way.operation = std::move(one);
      break;
    }
    if (!way.missing.empty()) continue;
    way.missing = missingGridOf(proj, one.get());
    way.better = proj_coordoperation_get_accuracy(proj.get(), one.get());
  }
  return way;
}

std::string accuracyText(double metres)
{
  return metres > 0 ? "accurate to " + digits(metres, 3) + " m" : metres == 0 ? "exact" : "of unknown accuracy";
}

/// How much longer lengths to the north and to the east are in the projection than on the ellipsoid, in millionths;
/// none where PROJ cannot tell. By differences: proj_factors() is wrong for axes that are not metres to the east and
/// north.
std::optional<std::pair<double, double>> gridScaleOf(const ProjContext& proj, const PJ* projected,
                                                     const Eigen::Vector2d& place)
{
  const ProjObject plain = proj.plain(projected), base(proj_crs_get_geodetic_crs(proj.get(), plain.get())),
                   ellipsoid(proj_get_ellipsoid(proj.get(), plain.get()));
  double a = 0.0, b = 0.0;
  if (!base || !ellipsoid || !proj_ellipsoid_get_parameters(proj.get(), ellipsoid.get(), &a, &b, nullptr, nullptr))
    return std::nullopt;
  constexpr double step = 1e-6; // radians, some metres
  const double degree = proj.unitOf(base.get()), e2 = 1 - (b / a) * (b / a);
  const Eigen::Vector2d at = placeIn(proj, plain.get(), base.get(), place);
  const auto scale = [&](const Eigen::Vector2d& way, double radius) {
    const Eigen::Vector2d from = placeIn(proj, base.get(), plain.get(), at - way * (step / degree)),
                          to = placeIn(proj, base.get(), plain.get(), at + way * (step / degree));
    return 1e6 * (proj.unitOf(plain.get()) * (to - from).norm() / (2 * step * radius) - 1);
  };
  const double sine = std::sin(at.y() * degree), w = std::sqrt(1 - e2 * sine * sine);
  const std::pair found(scale(Eigen::Vector2d::UnitY(), a * (1 - e2) / (w * w * w)),
                        scale(Eigen::Vector2d::UnitX(), a / w * std::cos(at.y() * degree)));
  return std::isfinite(found.first) && std::isfinite(found.second) ? std::optional(found) : std::nullopt;
}

std::string gridScaleText(const std::pair<double, double>& scale)
{
  constexpr double printed = 0.05;
  const auto ppm = [](double value) {
    return numberText(std::abs(value) < printed ? 0.0 : value, std::chars_format::fixed, 1);
  };
  const bool is_conformal = std::abs(scale.first - scale.second) < printed;
  return "the grid scale of its middle is " + ppm(scale.first) +
         (is_conformal ? "" : " (to the north) and " + ppm(scale.second) + " (to the east)") +
         " ppm: lengths differ by so much from those on the ellipsoid";
}

/// Whether a place is in the area that a system is made for, as far as is known.
bool isInArea(const ProjContext& proj, const PJ* system, const Eigen::Vector2d& degrees)
{
  double west = 0, south = 0, east = 0, north = 0;
  if (!degrees.allFinite() || !proj_get_area_of_use(proj.get(), system, &west, &south, &east, &north, nullptr) ||
      std::min({west, south, east, north}) < -360) // PROJ's sign for an area that it does not know
    return true;
  const bool is_east = degrees.x() >= west, is_west = degrees.x() <= east;
  const bool is_across = west > east; // the date line
  return (is_across ? is_east || is_west : is_east && is_west) && degrees.y() >= south && degrees.y() <= north;
}

} // namespace

struct SystemTransform::Proj {
  ProjContext context;
  ProjObject operation; ///< x east, y north
};

SystemTransform::~SystemTransform() = default;

SystemTransform::SystemTransform(const CoordinateSystem& given, const std::string& wanted,
                                 const Eigen::AlignedBox3d& box, std::optional<LengthUnit> told)
: target_(coordinateSystemNamed(wanted))
{
  auto made = std::make_unique<Proj>();
  const ProjContext& proj = made->context;
  ProjObject from = proj.system(given.definition), to = proj.system(wanted);
  if (!from)
    throw FormatError("has the coordinate system '" + given.name + "', which PROJ does not know",
                      "name its system by a code, such as EPSG:25832");
  const ProjObject places_from = proj.places(from.get()), places_to = proj.places(to.get());
  const PJ_TYPE type = proj_get_type(proj.plain(places_from.get()).get());
  if (type != PJ_TYPE_PROJECTED_CRS && !isAngular(type))
    throw FormatError("is in '" + given.name + "', which is neither projected nor of longitudes and latitudes",
                      "export it in a projected system");
  const auto unit = lengthUnitOfMetres(proj.unitOf(places_to.get()));
  if (proj_get_type(proj.plain(places_to.get()).get()) != PJ_TYPE_PROJECTED_CRS || !unit)
    throw FormatError("is wanted in '" + target_.name + "', which has no plane with lengths in " + length_units,
                      "name a projected system, such as EPSG:25832");
  unit_ = *unit;
  const double unit_from = isAngular(type) ? 1.0 : proj.unitOf(places_from.get());
  if (told && lengthUnitOfMetres(unit_from) != told)
    throw FormatError(std::string("has lengths in ") + nameOf(*told) + ", which is not the unit of '" + given.name +
                          "'",
                      "name the system that it is in");
  if (areOneSystem(given, target_).value_or(false)) return;

  const ProjObject heights_from = proj.heights(from.get()), heights_to = proj.heights(to.get());
  const bool has_heights = heights_from && heights_to;
  const double height_unit = heights_from ? proj.unitOf(heights_from.get()) : unit_from,
               wanted_unit = proj.unitOf(places_to.get());
  if (has_heights && lengthUnitOfMetres(proj.unitOf(heights_to.get())) != unit)
    throw FormatError("is wanted in '" + target_.name + "', whose heights have another unit than its places",
                      "name a system with one unit");
  if (!has_heights) {
    from = proj.places(from.get());
    to = proj.places(to.get());
    if (lengthUnitOfMetres(height_unit) != unit) height_scale_ = height_unit / wanted_unit;
  }

  const bool has_points = !box.isEmpty();
  const Eigen::Vector3d middle = has_points ? Eigen::Vector3d(box.center()) : Eigen::Vector3d::Zero();
  Eigen::Vector2d degrees(NAN, NAN);
  if (has_points) degrees = degreesOf(proj, places_from.get(), middle.head<2>());
  Way way = wayBetween(proj, from.get(), to.get(), degrees);
  const std::string both = "is in '" + given.name + "', and is wanted in '" + target_.name + "'";
  if (!way.operation && way.missing.empty())
    throw FormatError(both + ": PROJ knows no way there, or none but a rough one (a ballpark transformation)",
                      "name the systems by codes of their datums and heights");
  if (!way.operation)
    throw FormatError(both + ": the way there needs the grid " + way.missing + ", which is not there",
                      "put it into a folder of PROJ's (projsync fetches it)");
  const double accuracy = proj_get_type(way.operation.get()) == PJ_TYPE_CONVERSION
                              ? 0.0
                              : proj_coordoperation_get_accuracy(proj.get(), way.operation.get());
  remarks_.push_back("its coordinates are transformed from '" + given.name + "' to '" + target_.name + "' by '" +
                     proj_get_name(way.operation.get()) + "', " + accuracyText(accuracy));
  if (!way.missing.empty())
    remarks_.push_back("its transformation would be " + accuracyText(way.better) + " with the grid " + way.missing +
                       ", which is not there");
  if (!has_heights && (heights_from || heights_to))
    remarks_.push_back("its heights stay what they are: '" + (heights_from ? target_.name : given.name) +
                       "' has no system of heights");
  if (isAngular(type) && !has_heights) remarks_.push_back("its heights are taken for metres");
  if (height_scale_ != 1.0) remarks_.push_back("its heights are multiplied by " + digits(height_scale_, 10));

  made->operation = eastFirst(proj, way.operation);
  proj_ = std::move(made);
  if (!has_points) return;
  const PJ_COORD there =
      proj_trans(proj_->operation.get(), PJ_FWD, proj_coord(middle.x(), middle.y(), middle.z(), HUGE_VAL));
  if (const auto scale = gridScaleOf(proj_->context, places_to.get(), {there.xy.x, there.xy.y}))
    remarks_.push_back(gridScaleText(*scale));
  if (!isInArea(proj_->context, places_to.get(), degrees))
    remarks_.push_back("its middle, at longitude " + digits(degrees.x(), 6) + " and latitude " +
                       digits(degrees.y(), 6) + ", is outside of the area that '" + target_.name + "' is made for");
}

void SystemTransform::operator()(std::span<Point3> places, std::uint64_t first) const
{
  if (!proj_) return;
  std::vector<Point3> found;
  std::vector<std::size_t> records;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!isFinite(places[i])) continue;
    found.push_back(places[i]);
    records.push_back(i);
  }
  if (found.empty()) return;
  constexpr std::size_t step = sizeof(Point3);
  const std::size_t count = found.size();
  proj_trans_generic(proj_->operation.get(), PJ_FWD, found[0].data(), step, count, found[0].data() + 1, step, count,
                     found[0].data() + 2, step, count, nullptr, 0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Point3& from = places[records[i]];
    if (!isFinite(found[i]))
      throw FormatError("has record " + std::to_string(first + records[i]) + " at (" + digits(from[0], 12) + ", " +
                            digits(from[1], 12) + ", " + digits(from[2], 12) + "), which PROJ cannot transform to '" +
                            target_.name + "'",
                        "check its coordinate system, and leave out records that are elsewhere");
    found[i][2] *= height_scale_;
  }
  for (std::size_t i = 0; i < count; ++i) places[records[i]] = found[i];
}

} // namespace pcl_bsh::io
