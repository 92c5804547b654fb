// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/reports/clash_list.h>
#include <pcl_bsh/io/reports/clash_values.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/question/options.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

namespace pcl_bsh::io {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

std::optional<Extent> boxOrNone(const JsonReader& box)
{
  return box.json().is_null() ? std::nullopt : std::optional(boxFrom(box));
}

/// The point of the closest pair. Lists of earlier versions give it for clashes that were there; for others it is the
/// box's middle.
Point3 placeFrom(const JsonReader& entry, const Clash& clash)
{
  if (entry.has("place")) return pointFrom(entry.at("place"));
  if (entry.has("closest_pair")) return pointFrom(entry.at("closest_pair").at("input").at("at"));
  Point3 middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = 0.5 * clash.low[k] + 0.5 * clash.high[k];
  return middle;
}

/// A clash as clashJson() writes it. Corners and distances may be any finite numbers; all else is within its range.
Clash clashFrom(const JsonReader& entry)
{
  constexpr std::uint64_t last_pose = std::numeric_limits<std::int32_t>::max();
  Clash clash;
  clash.id = entry.at("id").text();
  clash.status = statusFrom(entry.at("status"));
  clash.points = static_cast<std::size_t>(entry.at("points").whole(1, max_points));
  clash.certain_points = clash.points;
  if (entry.has("certain_points"))
    clash.certain_points = static_cast<std::size_t>(entry.at("certain_points").whole(0, clash.points));
  const Extent box = boxFrom(entry.at("box"));
  clash.low = box.low;
  clash.high = box.high;
  clash.place = placeFrom(entry, clash);
  const JsonReader distance = entry.at("distance");
  clash.distance = clash.status == ClashStatus::unseen && distance.json().is_null()
                       ? std::numeric_limits<double>::quiet_NaN()
                       : distance.number(-largest, largest);
  if (entry.has("distance_interval") && !entry.at("distance_interval").json().is_null()) {
    const std::vector<double> ends = entry.at("distance_interval").numbers(2);
    clash.interval = {ends[0], ends[1]};
  }
  clash.first_pose = static_cast<std::int32_t>(entry.at("first_pose").whole(0, last_pose));
  clash.closest_pose = static_cast<std::int32_t>(entry.at("closest_pose").whole(0, last_pose));
  return clash;
}

/// A name, which may be empty.
std::string nameFrom(const JsonReader& name)
{
  return name.json().is_string() ? name.json().get<std::string>() : name.text();
}

/// @param about what is stated of the obstacle: the whole document, or one of its obstacles
ClashQuestion questionFrom(const JsonReader& reader, const JsonReader& about, const char* obstacle)
{
  ClashQuestion question;
  question.input = nameFrom(reader.at("input"));
  question.obstacle = nameFrom(about.at(obstacle));
  question.clearance = about.at("clearance").number(0, largest);
  if (!reader.at("swept").json().is_null()) question.swept = reader.at("swept").number(0, largest);
  if (!about.has("options")) return question;
  for (const auto& [name, value] : about.at("options").members()) {
    try {
      setOption(question, name, value.text());
    }
    catch (const InvalidInput& error) {
      value.fail(error.wrong(), error.remedy());
    }
  }
  return question;
}

std::optional<Survey> surveyFrom(const JsonReader& reader, const JsonReader& about)
{
  if (!about.has("path") || !reader.has("scan")) return std::nullopt;
  const JsonReader path = about.at("path");
  Survey survey;
  survey.poses = static_cast<std::size_t>(path.at("poses").whole(0, std::numeric_limits<std::int32_t>::max()));
  survey.path_checksum = path.at("checksum").text();
  survey.path = boxOrNone(path.at("box"));
  survey.scan = boxOrNone(reader.at("scan").at("box"));
  return survey;
}

std::string boxText(const std::optional<Extent>& box)
{
  if (!box) return "nowhere";
  std::string text;
  for (const Point3& corner : {box->low, box->high}) {
    text += text.empty() ? "from (" : " to (";
    for (std::size_t k = 0; k < 3; ++k)
      text += (k > 0 ? ", " : "") + numberText(corner[k], std::chars_format::general, 8);
    text += ')';
  }
  return text;
}

bool isSame(const std::optional<Extent>& a, const std::optional<Extent>& b, double nearness)
{
  if (!a || !b) return !a && !b;
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(a->low[k] - b->low[k]) > nearness || std::abs(a->high[k] - b->high[k]) > nearness) return false;
  return true;
}

/// FNV-1a of the bits of all numbers.
std::string checksumOf(const std::vector<Eigen::Isometry3d>& poses)
{
  std::uint64_t sum = 0xcbf29ce484222325ULL;
  for (const Eigen::Isometry3d& pose : poses) {
    for (Eigen::Index i = 0; i < 12; ++i) {
      const double number = pose.matrix()(i / 4, i % 4) + 0.0; // -0 becomes 0
      std::uint64_t bits = 0;
      std::memcpy(&bits, &number, sizeof bits);
      for (int byte = 0; byte < 8; ++byte, bits >>= 8) sum = (sum ^ (bits & 0xff)) * 0x100000001b3ULL;
    }
  }
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += digits[sum >> shift & 0xf];
  return text;
}

} // namespace

std::string uncertaintyText(const Uncertainty& uncertainty)
{
  std::string text = numberText(uncertainty.length);
  if (!uncertainty.field.empty()) text = numberText(uncertainty.sigmas) + " x field " + uncertainty.field;
  return uncertainty.pose.isZero() ? text : text + " and of poses " + uncertainty.pose.text();
}

Json uncertaintyJson(const Uncertainty& uncertainty)
{
  const PoseUncertainty& pose = uncertainty.pose;
  if (uncertainty.field.empty() && pose.isZero()) return uncertainty.length;
  Json json = {{"length", uncertainty.length}};
  if (!uncertainty.field.empty()) json = {{"field", uncertainty.field}, {"sigmas", uncertainty.sigmas}};
  if (!pose.isZero()) json["pose"] = {{"length", pose.length}, {"angle", pose.angle}, {"about", pose.about}};
  return json;
}

Survey::Survey(const std::vector<Eigen::Isometry3d>& all_poses, const std::optional<Extent>& of_scan)
: poses(all_poses.size()),
  path_checksum(checksumOf(all_poses)),
  scan(of_scan)
{
  for (const Eigen::Isometry3d& pose : all_poses) {
    const Point3 at = {pose.translation().x(), pose.translation().y(), pose.translation().z()};
    if (!path) path = Extent{at, at};
    path->add({at, at});
  }
}

namespace {

/// Adds the clashes to their lists. If obstacles have names, a clash's id begins with its obstacle's name, which is
/// removed.
void addClashes(const JsonReader& reader, std::vector<ClashList>& lists)
{
  std::set<std::string> ids;
  for (const JsonReader& entry : reader.at("clashes").elements()) {
    Clash clash = clashFrom(entry);
    if (!ids.insert(clash.id).second) entry.at("id").fail("is the id of another clash, too", "remove one");
    auto list = lists.begin();
    if (!lists.front().name.empty()) {
      const std::string name = nameFrom(entry.at("obstacle_name"));
      list = std::find_if(lists.begin(), lists.end(), [&](const ClashList& one) { return one.name == name; });
      if (list == lists.end())
        entry.at("obstacle_name").fail("names no obstacle of the list", "give the name of one of them");
      if (clash.id.rfind(name + '/', 0) != 0) entry.at("id").fail("is no id of this obstacle", "begin with its name");
      clash.id.erase(0, name.size() + 1);
    }
    list->clashes.push_back(std::move(clash));
  }
}

} // namespace

ListText readListText(const std::filesystem::path& path)
{
  const FileBytes file(path);
  if (!isBcfExtension(extensionOf(path))) return {std::string(file.view()), path.string()};
  BcfContents contents = naming(path, [&] { return parseBcf(file.view()); });
  return {std::move(contents.list), path.string() + ": " + bcf_list_file, std::move(contents.topics)};
}

std::vector<ClashList> listsOf(const ListText& text)
{
  std::vector<ClashList> lists = parseClashLists(text.list, text.name);
  for (ClashList& list : lists) list.topics = text.topics;
  return lists;
}

std::vector<ClashList> readClashLists(const std::filesystem::path& path)
{
  return listsOf(readListText(path));
}

std::vector<ClashList> parseClashLists(std::string_view text, const std::string& name)
{
  const std::string beginning = name + ": is no list of clashes"; // which JsonReader refers to
  const Json json = parseJson(text, beginning);
  const JsonReader reader(json, beginning);
  std::vector<ClashList> lists;
  const auto add = [&](const JsonReader& about, const char* obstacle) {
    ClashList list;
    list.question = questionFrom(reader, about, obstacle);
    list.states_options = about.has("options");
    list.survey = surveyFrom(reader, about);
    lists.push_back(std::move(list));
  };
  if (!reader.has("obstacles")) {
    add(reader, "obstacle");
  }
  else {
    std::set<std::string> names;
    for (const JsonReader& obstacle : reader.at("obstacles").elements()) {
      add(obstacle, "file");
      lists.back().name = obstacle.at("name").text();
      if (!names.insert(lists.back().name).second)
        obstacle.at("name").fail("is the name of another obstacle, too", "give each its own");
    }
    if (lists.empty()) reader.at("obstacles").fail("is empty", "name one obstacle at least");
  }
  addClashes(reader, lists);
  return lists;
}

const ClashList* findList(const std::vector<ClashList>& lists, const std::string& name, const ClashQuestion& question)
{
  const auto found = std::find_if(lists.begin(), lists.end(), [&](const ClashList& list) {
    if (!list.name.empty() && !name.empty()) return list.name == name;
    return (list.name.empty() && name.empty()) || std::filesystem::path(list.question.obstacle).filename() ==
                                                      std::filesystem::path(question.obstacle).filename();
  });
  return found == lists.end() ? nullptr : &*found;
}

namespace {

/// Whether a word is a month or a day of the week, or its first three letters.
bool isOfDate(const std::string& word)
{
  constexpr std::array<std::string_view, 19> names = {"january",  "february", "march",    "april",     "may",
                                                      "june",     "july",     "august",   "september", "october",
                                                      "november", "december", "monday",   "tuesday",   "wednesday",
                                                      "thursday", "friday",   "saturday", "sunday"};
  const std::string small = inSmallLetters(word);
  return small == "sept" || std::any_of(names.begin(), names.end(), [&](std::string_view name) {
           return small == name || (small.size() == 3 && name.substr(0, 3) == small);
         });
}

/// The words of a name without numbers, months and days of the week: files of one place share them from week to week.
std::string withoutDates(const std::string& name)
{
  std::string words, word;
  const auto end = [&] {
    if (!word.empty() && !isOfDate(word)) words += word + ' ';
    word.clear();
  };
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte) != 0 || byte >= 0x80)
      word += c;
    else
      end();
  }
  end();
  return words;
}

} // namespace

std::vector<std::string> requireComparable(const std::filesystem::path& path, const ClashList& earlier,
                                           const ClashQuestion& now)
{
  const ClashQuestion& before = earlier.question;
  for (const QuestionOption& option : questionOptions()) {
    const std::string was = textOf(option, before), is = textOf(option, now);
    if (was == is || option.effect != OptionEffect::clashes) continue;
    if (!earlier.states_options && option.name != std::string("clearance")) continue;
    const auto shown = [](const std::string& text) { return text.empty() ? "not given" : text; };
    throw files::FileError(
        path, "lists clashes with " + std::string(option.name) + ' ' + shown(was) + ", now it is " + shown(is),
        "ask with the same " + std::string(option.name) + ", or compare with another list");
  }
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& wrong) { warnings.push_back(path.string() + ": " + wrong); };
  const auto fileName = [](const std::string& name) { return std::filesystem::path(name).filename().string(); };
  const auto compare = [&](const char* what, const std::string& was, const std::string& is, bool of_each_week) {
    if (fileName(was) == fileName(is)) return;
    if (of_each_week && withoutDates(fileName(was)) == withoutDates(fileName(is))) return;
    warn(std::string("lists clashes of the ") + what + " '" + fileName(was) + "', now it is '" + fileName(is) +
         "': unless both show one place, what is called new or resolved means nothing");
  };
  compare("input", before.input, now.input, true); // where it is another place, surveyWarnings() tells
  compare("obstacle", before.obstacle, now.obstacle, false);
  if ((before.swept > 0.0) != (now.swept > 0.0)) {
    warn(std::string("lists clashes ") +
         (before.swept > 0.0 ? "of swept motion, now poses alone are asked"
                             : "at poses alone, now swept motion is asked") +
         ": clashes between poses seem " + (before.swept > 0.0 ? "resolved" : "new"));
  }
  if (!earlier.states_options || !earlier.survey)
    warn("is of an earlier version, which did not tell all options, path and extent of the scan: unless these are "
         "those of now, what is called new or resolved means nothing");
  return warnings;
}

std::vector<std::string> surveyWarnings(const std::filesystem::path& path, const ClashList& earlier, const Survey& now,
                                        double nearness)
{
  std::vector<std::string> warnings;
  if (!earlier.survey) return warnings;
  const Survey& before = *earlier.survey;
  if (before.poses != now.poses || before.path_checksum != now.path_checksum) {
    warnings.push_back(path.string() + ": lists clashes of another path (" + counted(before.poses, "pose") + ' ' +
                       boxText(before.path) + ", now " + std::to_string(now.poses) + ' ' + boxText(now.path) +
                       "): what was where the path does not come any more is called not_visited, and not resolved");
  }
  if (!isSame(before.scan, now.scan, nearness)) {
    warnings.push_back(path.string() + ": lists clashes of a scan " + boxText(before.scan) + ", now it is " +
                       boxText(now.scan) +
                       ": what was where nothing is scanned any more is called not_scanned, and not resolved");
  }
  return warnings;
}

} // namespace pcl_bsh::io
