// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/text/number_text.h>

#include <cmath>

namespace pcl_bsh::io {

std::string clashCsv(const ClashLists& lists)
{
  const ClashReport& first = lists.obstacles.front();
  std::string csv = "id,status,points,distance,first_pose,closest_pose,min_x,min_y,min_z,max_x,max_y,max_z,"
                    "input_" +
                    std::string(first.source_of ? "source,input_record" : "point") +
                    ",input_x,input_y,input_z,obstacle_" +
                    (lists.haveNames()       ? "name,obstacle_part,obstacle_record"
                     : first.model_source_of ? "source,obstacle_record"
                                             : first.partName()) +
                    ",obstacle_x,obstacle_y,obstacle_z,"
                    "certainty,certain_points,clearance,input_uncertainty,obstacle_uncertainty,sigmas,accuracy,unit,"
                    "coordinate_system,pose_uncertainty,distance_lower,distance_upper\n";
  const auto cell = [&](const std::string& text) { csv += (csv.back() == '\n' ? "" : ",") + text; };
  for (const auto& [of, one] : lists.bySeverity()) {
    const ClashReport& report = *of;
    const Clash& clash = *one;
    const ClashQuestion& question = report.question;
    cell(csvText(report.idOf(clash)));
    cell(nameOf(clash.status));
    cell(std::to_string(clash.points));
    cell(clash.wasNoClash() ? "" : numberText(clash.distance));
    cell(std::to_string(clash.first_pose));
    cell(std::to_string(clash.closest_pose));
    for (const Point3& corner : {clash.low, clash.high})
      for (const double coordinate : corner) cell(numberText(coordinate));
    const auto cell_of = [&](const auto& source_of, std::uint32_t number, std::uint32_t part) {
      if (!source_of) return cell(std::to_string(part));
      const SourcePoint point = source_of(number);
      cell(csvText(point.file));
      cell(std::to_string(point.record));
    };
    const auto cells_of_name = [&] {
      if (!lists.haveNames()) return;
      cell(csvText(report.name));
      cell(report.partName());
    };
    if (isPresent(clash.status)) {
      cell_of(report.source_of, clash.scan_point, clash.scan_point);
      for (const double coordinate : report.scanPoint(clash)) cell(numberText(coordinate));
      cells_of_name();
      cell_of(report.model_source_of, clash.model_point, clash.model_point);
      for (const double coordinate : report.modelPoint(clash)) cell(numberText(coordinate));
    }
    else {
      csv += std::string(report.source_of ? 5 : 4, ',');
      cells_of_name();
      csv += std::string(report.model_source_of ? 5 : 4, ',');
    }
    cell(certaintyOf(clash));
    cell(std::to_string(clash.certain_points));
    cell(numberText(*question.clearance));
    std::string sigmas;
    for (const Uncertainty& uncertainty : {question.uncertaintyOfInput(), question.uncertaintyOfObstacle()}) {
      cell(uncertainty.field.empty() ? numberText(uncertainty.length) : csvText(uncertainty.field));
      if (!uncertainty.field.empty()) sigmas = numberText(uncertainty.sigmas);
    }
    cell(sigmas);
    cell(question.accuracy.text());
    cell(csvText(report.unit));
    cell(csvText(report.coordinate_system));
    cell(csvText(question.pose_uncertainty.text()));
    for (const double end : {clash.interval.lower, clash.interval.upper}) cell(std::isnan(end) ? "" : numberText(end));
    csv += '\n';
  }
  return csv;
}

} // namespace pcl_bsh::io
