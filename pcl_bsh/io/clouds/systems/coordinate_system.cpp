// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>
#include <pcl_bsh/io/clouds/systems/proj_objects.h>
#include <pcl_bsh/io/text/format_error.h>

#include <array>

namespace pcl_bsh::io {
namespace {

/// EPSG's code of a system, also where its WKT names none; empty where EPSG has no such system.
std::string codeOf(const ProjContext& proj, const PJ* system)
{
  constexpr int same_but_names = 70; // of PROJ's degrees of confidence
  int* confidence = nullptr;
  const ProjList found(proj_identify(proj.get(), system, "EPSG", nullptr, &confidence));
  const bool is_found = found && proj_list_get_count(found.get()) > 0 && confidence[0] >= same_but_names;
  proj_int_list_destroy(confidence);
  if (!is_found) return {};
  const ProjObject first(proj_list_get(proj.get(), found.get(), 0));
  const char* const code = proj_get_id_code(first.get(), 0);
  return code ? code : "";
}

bool areSame(const ProjContext& proj, const PJ* a, const PJ* b)
{
  const ProjObject plain_a = proj.plain(a), plain_b = proj.plain(b);
  if (proj_is_equivalent_to_with_ctx(proj.get(), plain_a.get(), plain_b.get(),
                                     PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS))
    return true;
  const std::string code = codeOf(proj, plain_a.get());
  return !code.empty() && code == codeOf(proj, plain_b.get());
}

} // namespace

bool hasProj()
{
  return true;
}

CoordinateSystem coordinateSystemNamed(const std::string& text)
{
  const ProjContext proj;
  const ProjObject system = proj.system(text);
  if (!system) {
    throw FormatError("'" + text.substr(0, 200) + "' is no coordinate system that PROJ knows" +
                          (proj.said().empty() ? "" : " (" + proj.said() + ")"),
                      "give a code, such as EPSG:25832, or WKT");
  }
  std::string name = proj_get_name(system.get());
  const char *const authority = proj_get_id_auth_name(system.get(), 0), *const code = proj_get_id_code(system.get(), 0);
  if (authority && code) name += std::string(" (") + authority + ':' + code + ')';
  return {name, text};
}

std::string wkt1Of(const CoordinateSystem& system)
{
  const ProjContext proj;
  const ProjObject known = proj.system(system.definition);
  const std::array<const char*, 2> options = {"MULTILINE=NO", nullptr};
  const char* const wkt = known ? proj_as_wkt(proj.get(), known.get(), PJ_WKT1_GDAL, options.data()) : nullptr;
  return wkt ? wkt : "";
}

std::optional<bool> areOneSystem(const CoordinateSystem& a, const CoordinateSystem& b)
{
  if (a.definition.empty() || b.definition.empty()) return std::nullopt;
  if (a.definition == b.definition) return true;
  const ProjContext proj;
  const ProjObject system_a = proj.system(a.definition), system_b = proj.system(b.definition);
  if (!system_a || !system_b) return std::nullopt;
  const ProjObject heights_a = proj.heights(system_a.get()), heights_b = proj.heights(system_b.get());
  if (heights_a && heights_b && !areSame(proj, heights_a.get(), heights_b.get())) return false;
  return areSame(proj, proj.places(system_a.get()).get(), proj.places(system_b.get()).get());
}

} // namespace pcl_bsh::io
