// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_report.h"

#include "picture.h"
#include <pcl_bsh/tools/cli/json_output.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace pcl_bsh::accuracy {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values)
{
  std::array<char, 256> text;
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string milliseconds(double seconds)
{
  return format("%.4g", 1e3 * seconds);
}

void writeCsv(std::ostream& out, const Study& study)
{
  out << "query,knob,setting,poses,time_median_s,time_quartile_1_s,time_quartile_3_s,once_median_s,once_quartile_1_s,"
         "once_quartile_3_s,node_pairs,updates,leaf_pairs,exact_decisions,certified,certified_error,actual_error,"
         "wrong\n";
  for (const Measurement& m : study.measurements) {
    out << m.query << ',' << m.knob << ',' << m.setting << ',' << m.poses << ','
        << format("%.6e,%.6e,%.6e", m.seconds.median, m.seconds.low, m.seconds.high) << ','
        << format("%.6e,%.6e,%.6e", m.once.median, m.once.low, m.once.high) << ',' << m.work.node_pairs << ','
        << m.work.updates() << ',' << m.work.leaf_pairs << ',' << m.work.exact_decisions << ',' << (m.certified ? 1 : 0)
        << ',' << format("%.9g,%.9g", m.certified_error, m.actual_error) << ',' << m.wrong << '\n';
  }
}

/// All that the other reports have.
nlohmann::ordered_json toJson(const std::string& heading, const Subject& subject, const Study& study)
{
  using Json = nlohmann::ordered_json;
  const auto spread = [](const Spread& s) -> Json { return {{"low", s.low}, {"median", s.median}, {"high", s.high}}; };
  Json report = {{"compared", heading},          {"clearance", subject.clearance}, {"poses", subject.poses.size()},
                 {"diameter", subject.diameter}, {"unit", subject.unit},           {"measurements", Json::array()},
                 {"fits", Json::array()}};
  for (const Measurement& m : study.measurements)
    report["measurements"].push_back({{"query", m.query},
                                      {"knob", m.knob},
                                      {"setting", m.setting},
                                      {"peer", m.peer},
                                      {"seconds", spread(m.seconds)},
                                      {"once", spread(m.once)},
                                      {"work",
                                       {{"node_pairs", m.work.node_pairs},
                                        {"updates", m.work.updates()},
                                        {"leaf_pairs", m.work.leaf_pairs},
                                        {"exact_decisions", m.work.exact_decisions}}},
                                      {"certified", m.certified},
                                      {"certified_error", m.certified_error},
                                      {"actual_error", m.actual_error},
                                      {"wrong", m.wrong}});
  for (const FitMeasurement& m : study.fits)
    report["fits"].push_back({{"fit", m.fit},
                              {"build", spread(m.build)},
                              {"mean_leaf_radius", m.mean_leaf_radius},
                              {"flags", spread(m.flags)},
                              {"distance", spread(m.distance)}});
  return report;
}

void writeTable(std::ostream& out, const Study& study, const std::string& query)
{
  const bool distance = query == "distance";
  out << "| knob | setting | time [ms], median | quartiles | asked once [ms] | "
      << (distance ? "error at most [unit]" : "undecided [%]") << " | "
      << (distance ? "off exact [unit], largest" : "wrong [answers]") << " | sphere tests a query |\n"
      << "|---|---|---:|---:|---:|---:|---:|---:|\n";
  for (const Measurement& m : study.measurements) {
    if (m.query != query) continue;
    const std::string error = !m.certified ? "no proof"
                              : distance   ? format("%.3g", m.certified_error)
                                           : format("%.3g", 100 * m.certified_error);
    out << "| " << m.knob << " | `" << m.setting << "` | " << milliseconds(m.seconds.median) << " | "
        << milliseconds(m.seconds.low) << " .. " << milliseconds(m.seconds.high) << " | " << milliseconds(m.once.median)
        << " | " << error << " | " << (distance ? format("%.3g", m.actual_error) : std::to_string(m.wrong)) << " | "
        << (m.peer ? std::string("-") : std::to_string(m.work.node_pairs / std::max<std::size_t>(m.poses, 1)))
        << " |\n";
  }
}

/// The setting where the frontier bends: farthest below the straight line between its ends, both axes logarithmic.
const Measurement* knee(std::vector<const Measurement*> best, double floor)
{
  while (!best.empty() && best.back()->certified_error <= floor) best.pop_back(); // 0 has no logarithm
  if (best.size() < 3) return nullptr;
  const auto x = [](const Measurement* m) { return std::log(m->seconds.median); };
  const auto y = [](const Measurement* m) { return std::log(m->certified_error); };
  const double x0 = x(best.front()), x1 = x(best.back()), y0 = y(best.front()), y1 = y(best.back());
  const Measurement* turn = nullptr;
  double deepest = 0.0;
  for (const Measurement* m : best) {
    const double below = y0 + (y1 - y0) * (x(m) - x0) / (x1 - x0) - y(m);
    if (below > deepest) {
      deepest = below;
      turn = m;
    }
  }
  return turn;
}

const Measurement* bestWithin(const Study& study, const std::string& query, double seconds)
{
  const Measurement* best = nullptr;
  for (const Measurement& m : study.measurements) {
    if (m.query != query || !m.certified || m.seconds.median > seconds) continue;
    if (m.knob == "tolerance" && query != "distance") continue; // leaves nothing undecided, but asks another question
    if (!best || m.certified_error < best->certified_error ||
        (m.certified_error == best->certified_error && m.seconds.median < best->seconds.median))
      best = &m;
  }
  return best;
}

const Measurement* exactOf(const Study& study, const std::string& query)
{
  for (const Measurement& m : study.measurements)
    if (m.query == query && m.knob == "exact") return &m;
  return nullptr;
}

void writeMarkdown(std::ostream& out, const std::string& heading, const Subject& subject, const Study& study)
{
  out << "# What accuracy costs in time\n\n"
      << heading << "\n\n"
      << format("Clearance %g, ", subject.clearance) << counted(subject.poses.size(), "pose")
      << format(", diameter of the first cloud %.4g (the clouds' unit). ", subject.diameter)
      << "Times are of one query, on one thread its processor time: median and quartiles over the poses (of a single "
         "pose, over the repetitions), trees built before; *asked once*: with all that is built for the question.\n\n"
      << advice(subject, study)
      << "\n![error against time](accuracy.png)\n\n"
         "The line joins the settings that no other setting beats in both time and error. Its errors are guaranteed.";
  out << "\n\n## Smallest distance\n\n"
         "The answer is an interval that holds the exact distance. Its width, the largest over the poses, is the "
         "error.\n\n";
  writeTable(out, study, "distance");
  out << "\n## Flags per point\n\nAn undecided point is called neither free nor colliding. The "
         "wrong answers of a tolerance are those that it allows.\n\n";
  writeTable(out, study, "flags");
  out << "\n## Any collision\n\nThe share of poses that stay undecided.\n\n";
  writeTable(out, study, "any");
  out << "\n## Fits of spheres\n\n| fit | build, both clouds [ms] | mean leaf radius [unit] | exact flags [ms] | exact "
         "distance [ms] |\n|---|---:|---:|---:|---:|\n";
  for (const FitMeasurement& m : study.fits) {
    out << "| " << m.fit << " | " << milliseconds(m.build.median) << " | " << format("%.4g", m.mean_leaf_radius)
        << " | " << milliseconds(m.flags.median) << " | " << milliseconds(m.distance.median) << " |\n";
  }
}

} // namespace

std::string advice(const Subject& subject, const Study& study)
{
  std::string text;
  const auto describe = [&](const Measurement* m) {
    return "`" + m->setting + "` (" + milliseconds(m->seconds.median) + " ms, error at most " +
           format("%.3g", m->certified_error) +
           format(" = %.2g %% of the diameter)", 100 * m->certified_error / subject.diameter);
  };
  const std::vector<const Measurement*> best = frontier(study, "distance", 1e-9 * subject.diameter);
  if (const Measurement* turn = knee(best, 1e-9 * subject.diameter)) {
    text += "For the smallest distance " + describe(turn) +
            " is where the curve bends: with less time the error grows fast, with more time it shrinks slowly.\n\n";
  }
  text += "| time for one query | smallest distance | flags per point |\n|---|---|---|\n";
  for (const double seconds : {1e-3, 1e-2}) {
    const Measurement *distance = bestWithin(study, "distance", seconds), *flags = bestWithin(study, "flags", seconds);
    text +=
        format("| within %g ms | ", 1e3 * seconds) + (distance ? describe(distance) : "nothing measured is as fast");
    text += " | ";
    text += flags ? "`" + flags->setting + "` (" + milliseconds(flags->seconds.median) + " ms, " +
                        format("%.3g %% undecided)", 100 * flags->certified_error)
                  : "nothing measured is as fast";
    text += " |\n";
  }
  const Measurement *distance = exactOf(study, "distance"), *flags = exactOf(study, "flags");
  if (distance && flags) {
    text += "| exact | `exact` (" + milliseconds(distance->seconds.median) + " ms) | `exact` (" +
            milliseconds(flags->seconds.median) + " ms) |\n";
  }
  return text;
}

void writeReports(const std::filesystem::path& folder, const std::string& heading, const Subject& subject,
                  const Study& study)
{
  files::replaceFile(folder / "accuracy.csv", [&](std::ostream& out) { writeCsv(out, study); });
  cli::writeJson(folder / "accuracy.json", toJson(heading, subject, study));
  files::replaceFile(folder / "accuracy.md", [&](std::ostream& out) { writeMarkdown(out, heading, subject, study); });
  vtk::writeChartsPng(chartsOf(subject, study), 1600, 800, folder / "accuracy.png");
}

} // namespace pcl_bsh::accuracy
