// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/kept_obstacles.h>

#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/clash_values.h>
#include <pcl_bsh/question/options.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh::io {
namespace {

constexpr auto ask_about_it = "ask about it, too", ask_about_all = "ask about all obstacles";

std::uint32_t recordFrom(const JsonReader& record)
{
  return static_cast<std::uint32_t>(record.whole(0, max_points));
}

std::size_t countFrom(const JsonReader& count)
{
  return static_cast<std::size_t>(count.whole(0, max_points));
}

std::string textOrNone(const JsonReader& text)
{
  return text.json().is_null() ? std::string() : text.text();
}

/// A point of the input: its record or, if it has a source, its index in `sources`, to which it is added.
std::uint32_t inputFrom(const JsonReader& point, std::vector<SourcePoint>& sources)
{
  if (!point.json().is_object()) return recordFrom(point);
  if (!point.has("source")) return recordFrom(point.at("point"));
  sources.push_back({point.at("source").text(), recordFrom(point.at("record"))});
  return static_cast<std::uint32_t>(sources.size() - 1);
}

Verdict verdictFrom(const JsonReader& state)
{
  constexpr Verdict verdicts[] = {Verdict::free, Verdict::colliding, Verdict::undecided, Verdict::sparse,
                                  Verdict::unseen};
  std::vector<std::string> names = {"ignored"};
  for (const Verdict verdict : verdicts) names.emplace_back(nameOfState(verdict));
  const std::string name = state.oneOf(names);
  for (const Verdict verdict : verdicts)
    if (name == nameOfState(verdict)) return verdict;
  return Verdict::free;
}

/// Reads an answer that obstacleJson() wrote.
ObstacleAnswer answerFrom(const JsonReader& about, std::vector<SourcePoint>& sources)
{
  ObstacleAnswer answer;
  answer.verdict = verdictFrom(about.at("state"));
  answer.asked = about.at("state").text() != "ignored";
  answer.colliding = countFrom(about.at("colliding"));
  answer.undecided = countFrom(about.at("undecided"));
  answer.sparse = countFrom(about.at("sparse"));
  answer.unseen = countFrom(about.at("unseen"));
  if (const JsonReader pose = about.at("closest_pose"); !pose.json().is_null())
    answer.closest_pose = static_cast<std::int32_t>(pose.whole(0, std::numeric_limits<std::int32_t>::max()));
  const JsonReader pair = about.at("closest_pair");
  if (pair.json().is_null()) return answer;
  const std::vector<JsonReader> both = pair.elements();
  if (both.size() != 2) pair.fail("is no pair", "give a record of the input and one of the obstacle");
  answer.closest.pair = PointPair{inputFrom(both[0], sources), recordFrom(both[1])};
  answer.closest.distance = about.at("distance").number();
  return answer;
}

/// Adds what a clash's entry tells beside the clash.
void addEntry(const JsonReader& entry, Clash& clash, KeptObstacle& kept)
{
  if (clash.wasNoClash()) clash.points_in_shadow = countFrom(entry.at("points_in_shadow"));
  if (!isPresent(clash.status)) return;
  const JsonReader input = entry.at("closest_pair").at("input"), obstacle = entry.at("closest_pair").at("obstacle");
  clash.scan_point = inputFrom(input, kept.sources);
  clash.model_point = recordFrom(obstacle.at(kept.partName()));
  kept.places[clash.id] = pointFrom(obstacle.at("at"));
}

/// Turns the clashes of an earlier list into those of a new run that finds the same.
void takeOver(std::vector<Clash>& clashes)
{
  clashes.erase(std::remove_if(clashes.begin(), clashes.end(),
                               [](const Clash& clash) { return clash.status == ClashStatus::resolved; }),
                clashes.end());
  for (Clash& clash : clashes)
    if (clash.status == ClashStatus::fresh) clash.status = ClashStatus::persisting;
}

std::string fileName(const std::string& path)
{
  return std::filesystem::path(path).filename().string();
}

bool isSame(const std::optional<Extent>& a, const std::optional<Extent>& b)
{
  return a.has_value() == b.has_value() && (!a || (a->low == b->low && a->high == b->high));
}

} // namespace

KeptObstacles keptObstacles(const std::filesystem::path& path, const ListText& text,
                            const std::vector<ClashList>& lists, const std::vector<std::string>& names)
{
  KeptObstacles all;
  all.file = path;
  for (const ClashList& list : lists)
    if (std::find(names.begin(), names.end(), list.name) != names.end()) all.by_name[list.name].list = list;
  for (const std::string& name : names)
    if (all.by_name.count(name) == 0) throw files::FileError(path, "does not tell of '" + name + "'", ask_about_it);

  const std::string beginning = text.name + ": is no list of clashes";
  const Json json = parseJson(text.list, beginning);
  const JsonReader reader(json, beginning);
  all.cluster_distance = reader.at("cluster_distance").number();
  all.unit = textOrNone(reader.at("unit"));
  all.coordinate_system = textOrNone(reader.at("coordinate_system"));
  for (const JsonReader& about : reader.at("obstacles").elements()) {
    const auto found = all.by_name.find(about.at("name").text());
    if (found == all.by_name.end()) continue;
    KeptObstacle& kept = found->second;
    kept.surface = about.at("surface").json();
    kept.answer = answerFrom(about, kept.sources);
    kept.counts.colliding = kept.answer.colliding;
    kept.counts.undecided = kept.answer.undecided;
  }
  std::map<std::string, std::pair<KeptObstacle*, std::size_t>> clashes; // by the ids of the file
  for (auto& [name, kept] : all.by_name)
    for (std::size_t i = 0; i < kept.list.clashes.size(); ++i)
      clashes[name + '/' + kept.list.clashes[i].id] = {&kept, i};
  for (const JsonReader& entry : reader.at("clashes").elements()) {
    const auto found = clashes.find(entry.at("id").text());
    if (found == clashes.end()) continue;
    const auto [kept, number] = found->second;
    addEntry(entry, kept->list.clashes[number], *kept);
  }
  for (auto& [name, kept] : all.by_name) takeOver(kept.list.clashes);
  return all;
}

void KeptObstacles::requireSame(const std::string& name, const ClashQuestion& now, bool ignores_input,
                                const Survey& survey, const std::string& unit_now,
                                const std::string& coordinate_system_now) const
{
  const KeptObstacle& kept = by_name.at(name);
  const auto refuse = [&](const std::string& wrong, const char* remedy) {
    throw files::FileError(file, wrong, remedy);
  };
  const auto requireEqual = [&](const char* what, const std::string& was, const std::string& is, const char* remedy) {
    const auto shown = [](const std::string& text) { return text.empty() ? "not given" : text; };
    if (was != is)
      refuse("tells of '" + name + "' with " + what + ' ' + shown(was) + ", now it is " + shown(is), remedy);
  };
  const ClashQuestion& before = kept.list.question;
  requireEqual("the input", fileName(before.input), fileName(now.input), ask_about_all);
  requireEqual("unit", unit, unit_now, ask_about_all);
  requireEqual("coordinate system", coordinate_system, coordinate_system_now, ask_about_all);
  requireEqual("the file", fileName(before.obstacle), fileName(now.obstacle), ask_about_it);
  for (const QuestionOption& option : questionOptions())
    if (option.effect != OptionEffect::none)
      requireEqual(option.name, textOf(option, before), textOf(option, now), ask_about_it);
  if (!kept.list.states_options || !kept.list.survey)
    refuse("is of an earlier version, which did not tell all options and path", ask_about_all);
  if (!isSame(kept.list.survey->scan, survey.scan)) refuse("is of a scan of another extent", ask_about_all);
  if (kept.list.survey->poses != survey.poses || kept.list.survey->path_checksum != survey.path_checksum)
    refuse("tells of '" + name + "' at other poses", ask_about_it);
  if (kept.answer.asked == ignores_input)
    refuse("tells of '" + name + "' as " + (ignores_input ? "compared with the input" : "ignored"), ask_about_it);
}

} // namespace pcl_bsh::io
