// SPDX-License-Identifier: BSD-3-Clause
#include "certify_report.h"

#include <cstddef>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace pcl_bsh::cli {
namespace {

nlohmann::ordered_json toJson(const RadiusRatios& ratios)
{
  nlohmann::ordered_json json = {{"measured", ratios.measured}, {"one_place", ratios.one_place}};
  json["mean"] = nullptr;
  json["worst"] = nullptr;
  if (ratios.measured > 0) {
    json["mean"] = ratios.mean();
    json["worst"] = ratios.worst;
  }
  json["histogram"] = {{"below", RadiusRatios::edges}, {"spheres", ratios.histogram}}; // the last: all others
  return json;
}

nlohmann::ordered_json toJson(const LevelCertificate& level, const std::string& name)
{
  return {{"level", name},          {"spheres", level.spheres},
          {"checks", level.checks}, {"exact_checks", level.exact_checks},
          {"leaks", level.leaks},   {"radius_ratio", toJson(level.ratio)}};
}

void printRow(std::ostream& out, const std::string& fit, const std::string& name, const LevelCertificate& level)
{
  std::ostringstream row;
  row << std::fixed << std::setprecision(4) << std::left << std::setw(9) << fit << std::setw(9) << name << std::right
      << std::setw(9) << level.spheres << std::setw(11) << level.checks << std::setw(7) << level.leaks << std::setw(9)
      << level.ratio.measured;
  if (level.ratio.measured > 0)
    row << std::setw(9) << level.ratio.mean() << std::setw(9) << level.ratio.worst;
  else
    row << std::setw(9) << '-' << std::setw(9) << '-';
  for (const std::size_t count : level.ratio.histogram) row << std::setw(8) << count;
  out << row.str() << '\n';
}

} // namespace

std::string nameOf(const SphereLevel& level)
{
  switch (level.kind) {
  case SphereLevel::above_voxels:
    return "cloud " + std::to_string(level.depth);
  case SphereLevel::voxel:
    return "voxel";
  case SphereLevel::in_voxel:
    break;
  }
  return "node " + std::to_string(level.depth);
}

nlohmann::ordered_json toJson(const Certificate& certificate)
{
  nlohmann::ordered_json json;
  json["holds"] = certificate.holds();
  json["missing_points"] = certificate.missing;
  json["total"] = toJson(certificate.total, "all");
  json["levels"] = nlohmann::ordered_json::array();
  for (const LevelCertificate& level : certificate.levels) json["levels"].push_back(toJson(level, nameOf(level.level)));
  json["leaks"] = nlohmann::ordered_json::array(); // the first hundred
  for (const Leak& leak : certificate.leaks) {
    json["leaks"].push_back({{"level", nameOf(leak.level)},
                             {"voxel", leak.voxel},
                             {"node", leak.node},
                             {"child", leak.child},
                             {"point", leak.record},
                             {"excess", leak.excess}});
  }
  return json;
}

void printTableHead(std::ostream& out)
{
  std::ostringstream head;
  head << "Ratio: stored radius / smallest radius. Checks: points looked at, all exact. Other columns: spheres.\n";
  head << std::left << std::setw(9) << "fit" << std::setw(9) << "level" << std::right << std::setw(9) << "spheres"
       << std::setw(11) << "checks" << std::setw(7) << "leaks" << std::setw(9) << "measured" << std::setw(9) << "mean"
       << std::setw(9) << "worst";
  for (const double edge : RadiusRatios::edges) {
    std::ostringstream below;
    below << '<' << edge;
    head << std::setw(8) << below.str();
  }
  head << std::setw(8) << "more" << '\n';
  out << head.str();
}

void printRows(std::ostream& out, const std::string& fit, const Certificate& certificate)
{
  for (const LevelCertificate& level : certificate.levels) printRow(out, fit, nameOf(level.level), level);
  printRow(out, fit, "all", certificate.total);
}

} // namespace pcl_bsh::cli
