// SPDX-License-Identifier: BSD-3-Clause
#include "io/clouds/samples.h"
#include "one_list.h"
#include "support/verdicts.h"

#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/parse_number.h>
#include <pcl_bsh/version.h>

#include <gmock/gmock.h>

#include <charconv>
#include <cstdlib>
#include <locale>

namespace pcl_bsh::io {

using testing::HasSubstr;
using testing::Not;

namespace {

/// Tags that do not close, or are not named in the order they were opened; text outside of tags that has a '<' or '>'.
std::string faultOfMarkup(const std::string& page)
{
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) return "a tag without an end at byte " + std::to_string(at);
    const std::string tag = page.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos) return "a tag within <" + tag;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "a quotation mark too many in <" + tag;
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    if (name == "!DOCTYPE" || name == "meta" || tag.ends_with('/')) continue;
    if (name.starts_with('/')) {
      if (open.empty() || open.back() != name.substr(1)) return "<" + name + "> closes nothing";
      open.pop_back();
    }
    else {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

std::size_t occurrences(const std::string& text, const std::string& part)
{
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

/// Rows of cells; no cell of these lists has a comma in quotes but where the test says.
std::vector<std::vector<std::string>> cellsOf(const std::string& csv)
{
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line + ',');
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

bool has(const std::string& page, const std::string& part)
{
  return page.find(part) != std::string::npos;
}

double numberIn(const std::string& text)
{
  return parseNumber<double>(text);
}

/// 1.234.567,5 as some languages write it.
struct CommaAndGroups : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class ForeignLocale {
public:
  ForeignLocale() : before_(std::locale::global(std::locale(std::locale::classic(), new CommaAndGroups))) {}
  ~ForeignLocale() { std::locale::global(before_); }

private:
  std::locale before_;
};

/// A probe that comes near to a row of points at some of its poses.
class ClashReports : public testing::Test {
protected:
  /// @param gap between neighbours of the row
  /// @param stops where along the row the probe is at each pose, and how far off
  void follow(std::size_t count, double gap, const std::vector<std::array<double, 2>>& stops)
  {
    for (std::size_t i = 0; i < count; ++i) {
      for (const double coordinate : {gap * static_cast<double>(i), 0.0, 1234567.25}) row.push_back(coordinate);
    }
    for (const auto& [x, y] : stops) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(x, y, 1234567.25);
      poses.push_back(pose);
    }
    TrajectoryRequest request;
    request.clearance = 0.3;
    request.distances = request.first_poses = request.closest_poses = request.pose_summaries = true;
    found = collideAlong({SphereHierarchy(scan())}, SphereHierarchy(model()), poses, request);
  }

  PointsView scan() const { return viewOf(row.data(), row.size() / 3); }
  PointsView model() const { return viewOf(probe.data(), 1); }

  ClashReport report(const std::string& input = "hall.ply", const std::string& obstacle = "wagon.ply") const
  {
    ClashQuestion question;
    question.input = input;
    question.obstacle = obstacle;
    question.clearance = 0.3;
    return {.question = question,
            .cluster_distance = 0.5,
            .clashes = findClashes(scan(), found, 0.5),
            .scan = scan_,
            .model = model_,
            .poses = poses,
            .found = found,
            .survey = {poses, extentOf(scan())}};
  }

  ClashReport twoClashes()
  {
    follow(41, 0.25, {{2, 0.2}, {4, 5}, {6, 5}, {8, 0.1}});
    scan_ = scan();
    model_ = model();
    return report();
  }

  std::string refusal(const std::string& list) const
  {
    try {
      parseClashes(list, "old.json");
    }
    catch (const JsonError& error) {
      return error.what();
    }
    ADD_FAILURE() << list << " was read";
    return {};
  }

  std::vector<double> row;
  std::array<double, 3> probe = {0, 0, 0};
  PointsView scan_, model_;
  std::vector<Eigen::Isometry3d> poses;
  TrajectoryResult found;
};

const std::string entry = R"({"id": "A", "status": "new", "points": 1, "box": {"min": [0, 0, 0], "max": [1, 1, 1]},
    "distance": 0.5, "first_pose": 0, "closest_pose": 0})";

std::string listOf(const std::string& entries)
{
  return R"({"input": "a", "obstacle": "b", "clearance": 1, "swept": null, "clashes": [)" + entries + "]}";
}

/// The list of one entry, with a change.
std::string listWith(const std::string& what, const std::string& instead)
{
  std::string changed = entry;
  const std::size_t at = changed.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return listOf(changed.replace(at, what.size(), instead));
}

} // namespace

TEST_F(ClashReports, AListIsReadAsItWasWritten)
{
  ClashReport written = twoClashes();
  ASSERT_EQ(written.clashes.size(), 2U);
  written.question.swept = 0.125;
  EXPECT_EQ(parseClashes(clashJson(written), "list.json").question.swept, 0.125);
  written.question.swept = 0.0;
  const ClashList list = parseClashes("\xef\xbb\xbf" + clashJson(written), "list.json");
  EXPECT_EQ(list.question.input, "hall.ply");
  EXPECT_EQ(list.question.obstacle, "wagon.ply");
  EXPECT_EQ(list.question.clearance, 0.3);
  EXPECT_EQ(list.question.swept, 0.0);
  ASSERT_EQ(list.clashes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Clash &before = written.clashes[i], &after = list.clashes[i];
    EXPECT_EQ(after.id, before.id);
    EXPECT_EQ(after.points, before.points);
    EXPECT_EQ(after.certain_points, before.points);
    EXPECT_EQ(after.place, before.place);
    EXPECT_EQ(after.low, before.low);
    EXPECT_EQ(after.high, before.high);
    EXPECT_EQ(after.distance, before.distance);
    EXPECT_EQ(after.first_pose, before.first_pose);
    EXPECT_EQ(after.closest_pose, before.closest_pose);
  }
}

TEST_F(ClashReports, TheTableListsEveryClashWithItsNumbers)
{
  ClashReport list = twoClashes();
  Clash gone;
  gone.id = "C9_0_0";
  gone.status = ClashStatus::resolved;
  gone.points = gone.certain_points = 7;
  gone.distance = 0.25;
  gone.closest_pose = 2;
  list.clashes.push_back(gone);
  list.previous = "monday.json";
  const std::string page = clashPage(list);
  EXPECT_EQ(faultOfMarkup(page), "");
  EXPECT_TRUE(has(page, "<h1>2 clashes</h1>"));
  EXPECT_EQ(occurrences(page, "<tr>"), 4U);
  const auto badge = [](const std::string& status) {
    return "<span class=\"badge " + status + "\">" + status + "</span>";
  };
  EXPECT_TRUE(has(page, "<tr><td><a href=\"#C4_0_617283\">C4_0_617283</a></td><td>" + badge("new") +
                            "</td><td>0.1</td><td>3</td><td>3</td><td>3</td><td>0.5</td></tr>"));
  EXPECT_TRUE(has(page, "<tr><td><a href=\"#C1_0_617283\">C1_0_617283</a></td><td>" + badge("new") +
                            "</td><td>0.2</td><td>1</td><td>0</td><td>0</td><td>0</td></tr>"));
  EXPECT_TRUE(has(page, "<tr><td>C9_0_0</td><td>" + badge("resolved") +
                            "</td><td>0.25</td><td>7</td><td>0</td><td>2</td><td>0</td></tr>"));
  EXPECT_EQ(occurrences(page, "<section class=\"card\""), 2U) << "a resolved one has no pictures";
  EXPECT_EQ(occurrences(page, "<svg viewBox"), 5U) << "of the path, and two of each clash";
  EXPECT_TRUE(has(page, "between point 32 of the input at (8.000, 0.000, 1234567.250) and point 0 of the obstacle; "
                        "<b>3</b> points; first at pose <b>3</b>"));
  EXPECT_TRUE(has(page, "<b>1</b> point; first at pose <b>0</b>"));
  EXPECT_FALSE(has(page, "Perhaps")) << "no point is uncertain";
  for (const char* tile : {"<b>0.3</b><span>clearance", "<b>4</b><span>colliding points", "<b>0.1</b><span>smallest",
                           "<b>2</b><span>new", "<b>0</b><span>persisting", "<b>1</b><span>resolved"})
    EXPECT_TRUE(has(page, tile));
  // Every link leads somewhere.
  for (const Clash& clash : list.clashes)
    EXPECT_EQ(occurrences(page, "#" + clash.id + "\""), occurrences(page, "id=\"" + clash.id + "\"")) << clash.id;
}

TEST_F(ClashReports, WhatIsUnseenIsAStateOfItsOwn)
{
  ClashReport list = twoClashes();
  Answer::Unseen unseen;
  unseen.where = {{}, {true}, {}, {}};
  list.unseen = &unseen;
  list.question.seen = true;
  listUnseen(list);
  ASSERT_EQ(list.clashes.size(), 3U);
  EXPECT_EQ(clashCounts(list), "2 clashes, 1 unseen");
  const std::string json = clashJson(list);
  const Json entry = Json::parse(json)["clashes"][2];
  EXPECT_EQ(Json::parse(json)["options"]["seen"], "true");
  EXPECT_EQ(entry["status"], "unseen");
  EXPECT_EQ(entry["certainty"], "unseen");
  EXPECT_EQ(entry["points_in_shadow"], 1);
  EXPECT_TRUE(entry["distance"].is_null());
  EXPECT_FALSE(entry.contains("closest_pair"));
  const ClashList read = parseClashes(json, "list.json");
  EXPECT_TRUE(read.clashes[2].wasNoClash());
  EXPECT_EQ(read.clashes[2].low, (Point3{4, 5, 1234567.25}));
  const auto rows = cellsOf(clashCsv(list));
  EXPECT_EQ(rows[3][1], "unseen");
  EXPECT_EQ(rows[3][3], "");
  ASSERT_EQ(rows[3].size(), rows[0].size());
  const std::string page = clashPage(list);
  EXPECT_EQ(faultOfMarkup(page), "");
  EXPECT_TRUE(has(page, "<h1>2 clashes, 1 unseen</h1>"));
  EXPECT_TRUE(has(page, "<h2>Unseen</h2>"));
  EXPECT_TRUE(has(page, "<span class=\"badge unseen\">unseen</span></td><td></td><td>1</td><td>1</td><td>1</td>"));
  EXPECT_TRUE(has(page, "<th>points in shadow</th>"));
  EXPECT_EQ(occurrences(page, "<section class=\"card\""), 2U);
}

TEST_F(ClashReports, AClashThatIsNotFoundAgainMayBeUnseen)
{
  const ClashReport earlier = twoClashes();
  const ClashList before = parseClashes(clashJson(earlier), "list.json");
  ClashReport now = report();
  now.clashes.clear();
  Answer::Unseen unseen;
  unseen.where = {{true}, {}, {}, {}}; // where the probe was near the first clash
  now.unseen = &unseen;
  compareWithList(now, "list.json", before, [&](FormerPlaces& former) {
    former.visit(SphereHierarchy(model()), poses, TrajectoryRequest());
    former.scan(scan());
  });
  ASSERT_EQ(now.clashes.size(), 2U);
  EXPECT_EQ(now.clashes[0].status, ClashStatus::resolved);
  EXPECT_EQ(now.clashes[1].status, ClashStatus::unseen);
  EXPECT_EQ(clashCounts(now), "0 clashes, 1 unseen, 1 resolved");
  now.clashes[0].status = ClashStatus::not_visited;
  EXPECT_EQ(clashCounts(now), "0 clashes, 1 unseen, 0 resolved, 1 not visited");
  EXPECT_EQ(parseClashes(clashJson(now), "list.json").clashes[1].distance, before.clashes[1].distance);
}

/// Up to what may part two points of one clash, scans are of one place: the clearance, and how far its points may step.
TEST_F(ClashReports, ExtentsOfScansAreComparedByTheListsDistances)
{
  const ClashReport earlier = twoClashes();
  const ClashList before = parseClashes(clashJson(earlier), "list.json");
  for (const double change : {0.79, 0.81}) {
    ClashReport now = report();
    now.survey.scan->high[1] += change;
    EXPECT_EQ(compareWithList(now, "list.json", before, [](FormerPlaces&) {}).size(), change > 0.3 + 0.5 ? 1U : 0U);
    EXPECT_EQ(now.previous, "list.json");
    EXPECT_EQ(now.count(ClashStatus::persisting), 2U);
  }
}

TEST_F(ClashReports, UncertaintiesOfPosesAreComparedToo)
{
  ClashReport list = twoClashes();
  list.question.pose_uncertainty = {0.01, 0.002, {1, 2, 3}};
  const ClashList read = parseClashes(clashJson(list), "list.json");
  EXPECT_EQ(read.question.uncertaintyOfObstacle(), list.question.uncertaintyOfObstacle());
  EXPECT_EQ(Json::parse(clashJson(list))["uncertainty"]["obstacle"].dump(),
            R"({"length":0.0,"pose":{"length":0.01,"angle":0.002,"about":[1.0,2.0,3.0]}})");
  EXPECT_THAT(cellsOf(clashCsv(list))[0], testing::Contains("pose_uncertainty"));
  EXPECT_THAT(clashCsv(list), HasSubstr("\"0.01,0.002,1,2,3\""));
  EXPECT_NO_THROW(requireComparable("list.json", read, list.question));
  ClashQuestion other = list.question;
  other.pose_uncertainty.angle = 0.003;
  EXPECT_THROW(requireComparable("list.json", read, other), files::FileError);
}

TEST_F(ClashReports, ManyClashesAreAllInTheTable)
{
  std::vector<std::array<double, 2>> stops;
  for (int i = 0; i < 250; ++i) stops.push_back({2.0 * i, 0.001 * i});
  follow(250, 2, stops);
  scan_ = scan();
  model_ = model();
  const ClashReport list = report();
  ASSERT_EQ(list.clashes.size(), 250U);
  const std::string page = clashPage(list);
  EXPECT_EQ(faultOfMarkup(page), "");
  EXPECT_EQ(occurrences(page, "<tr>"), 251U);
  EXPECT_EQ(occurrences(page, "<section class=\"card\""), 200U);
  EXPECT_TRUE(has(page, "The 200 most severe have pictures"));
  EXPECT_EQ(occurrences(page, "<a href=\"#C"), 200U) << "of those alone";
  for (const Clash& clash : list.clashes) EXPECT_TRUE(has(page, ">" + clash.id + "<"));
}

TEST_F(ClashReports, NamesDoNoHarm)
{
  twoClashes();
  const std::string odd = "<script>&\"'\x01\xff\xc3(.ply";
  ClashReport list = report(odd, odd);
  list.previous = odd;
  list.clashes[1].id = "a\",b\n<i>";
  const std::string page = clashPage(list);
  EXPECT_EQ(faultOfMarkup(page), "");
  EXPECT_EQ(occurrences(page, "<script"), 0U);
  EXPECT_EQ(occurrences(page, "&lt;script&gt;&amp;&quot;&apos;\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd(.ply"), 4U);
  EXPECT_EQ(validUtf8(page), page);
  const std::string csv = clashCsv(list);
  EXPECT_THAT(csv, HasSubstr("\n\"a\"\",b\n<i>\",new,1,"));
  const std::string json = clashJson(list);
  EXPECT_EQ(validUtf8(json), json);
  EXPECT_EQ(parseClashes(json, "list.json").clashes[1].id, list.clashes[1].id);
  EXPECT_EQ(parseClashes(json, "list.json").question.input, validUtf8(odd));
}

TEST_F(ClashReports, EveryPlaceOfTheTemplateIsFilled)
{
  ClashReport list = twoClashes();
  list.previous = "{{clearance}}";
  list.question.swept = 0.01;
  const std::string page = clashPage(list);
  EXPECT_TRUE(has(page, "compared with {{clearance}}</p>")) << "names are no templates";
  EXPECT_EQ(occurrences(page, "{{"), 1U);
  for (const char* empty :
       {"=\"\"", "<b></b>", "<td></td>", "<text></text>", "\"middle\"></text>", "\"end\"></text>", "()"})
    EXPECT_FALSE(has(page, empty)) << empty;
}

TEST_F(ClashReports, CsvReadsBackToTheSameBits)
{
  ClashReport list = twoClashes();
  list.clashes[1].status = ClashStatus::resolved;
  const auto rows = cellsOf(clashCsv(list));
  ASSERT_EQ(rows.size(), 3U);
  ASSERT_EQ(rows[0].size(), 32U);
  ASSERT_EQ(rows[1].size(), 32U);
  EXPECT_EQ(rows[1][0], "C4_0_617283");
  EXPECT_EQ(numberIn(rows[1][3]), list.clashes[0].distance);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(numberIn(rows[1][6 + k]), list.clashes[0].low[k]);
    EXPECT_EQ(numberIn(rows[1][9 + k]), list.clashes[0].high[k]);
    const auto axis = static_cast<Eigen::Index>(k);
    EXPECT_EQ(numberIn(rows[1][13 + k]), list.scanPoint(list.clashes[0])[axis]);
    EXPECT_EQ(numberIn(rows[1][17 + k]), list.modelPoint(list.clashes[0])[axis]);
  }
  EXPECT_EQ(rows[1][12], "32");
  ASSERT_EQ(rows[2].size(), 32U);
  for (std::size_t k = 12; k < 20; ++k) EXPECT_EQ(rows[2][k], "") << "a resolved one has no pair";
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(rows[i][20], "certain");
    EXPECT_EQ(rows[i][21], rows[i][2]);
    EXPECT_EQ(rows[i][22], "0.3");
    EXPECT_EQ(rows[i][25], "") << "sigmas of no field";
    EXPECT_EQ(rows[i][26], "exact");
  }
}

/// Where the input is several files, and the obstacle, too: each row has the cells of its header.
TEST_F(ClashReports, CsvTellsTheFilesOfPoints)
{
  ClashReport list = twoClashes();
  list.clashes[1].status = ClashStatus::resolved;
  const auto source = [](const char* file, std::uint32_t less) {
    return [=](std::uint32_t number) { return SourcePoint{file, number + 10 - less}; };
  };
  for (const bool of_input : {false, true})
    for (const bool of_obstacle : {false, true}) {
      list.source_of = nullptr, list.model_source_of = nullptr;
      if (of_input) list.source_of = source("a.ply", 2);
      if (of_obstacle) list.model_source_of = source("b.ply", 3);
      const auto rows = cellsOf(clashCsv(list));
      ASSERT_EQ(rows.size(), 3U);
      const std::size_t width = 32U + (of_input ? 1U : 0U) + (of_obstacle ? 1U : 0U);
      for (const auto& row : rows) EXPECT_EQ(row.size(), width);
      const auto cell = [&](const std::string& name) {
        const auto at = std::find(rows[0].begin(), rows[0].end(), name);
        return at == rows[0].end() ? "none" : rows[1][static_cast<std::size_t>(at - rows[0].begin())];
      };
      EXPECT_EQ(cell("input_source"), of_input ? "a.ply" : "none");
      EXPECT_EQ(cell("input_record"), of_input ? "40" : "none");
      EXPECT_EQ(cell("input_point"), of_input ? "none" : "32");
      EXPECT_EQ(cell("input_x"), "8");
      EXPECT_EQ(cell("obstacle_source"), of_obstacle ? "b.ply" : "none");
      EXPECT_EQ(cell("obstacle_record"), of_obstacle ? "7" : "none");
      EXPECT_EQ(cell("obstacle_point"), of_obstacle ? "none" : "0");
      EXPECT_EQ(cell("certainty"), "certain");
      const Json pair = Json::parse(clashJson(list))["clashes"][0]["closest_pair"];
      for (const auto& [side, named] : {std::pair("input", of_input), {"obstacle", of_obstacle}})
        EXPECT_EQ(has(pair[side].dump(), ".ply"), named) << side;
      const std::string page = clashPage(list);
      EXPECT_EQ(has(page, "between point 40 of a.ply of the input"), of_input);
      EXPECT_EQ(has(page, "and point 7 of b.ply of the obstacle"), of_obstacle);
    }
}

TEST_F(ClashReports, TheHostsLanguageDoesNotMatter)
{
  std::vector<std::array<double, 2>> stops;
  for (int i = 0; i < 1500; ++i) stops.push_back({0.1 * i, 0.1});
  follow(1500, 0.1, stops); // thousands, to be grouped
  scan_ = scan();
  model_ = model();
  const ClashReport list = report();
  const std::string csv = clashCsv(list), json = clashJson(list), page = clashPage(list);
  const ForeignLocale foreign;
  std::ostringstream control;
  control << 1234.5;
  ASSERT_EQ(control.str(), "1.234,5");
  EXPECT_EQ(clashCsv(list), csv);
  EXPECT_EQ(clashJson(list), json);
  EXPECT_EQ(clashPage(list), page);
  EXPECT_EQ(parseClashes(json, "list.json").question.clearance, 0.3);
}

TEST_F(ClashReports, RefusesListsThatNoRunWrites)
{
  EXPECT_EQ(parseClashes(listOf(entry), "old.json").clashes.size(), 1U);
  const std::string begin = "old.json: is no list of clashes: ";
  EXPECT_THAT(refusal("[1"), HasSubstr(begin + "is no JSON: "));
  EXPECT_THAT(refusal("[]"), HasSubstr(begin + "'input' is missing"));
  EXPECT_THAT(refusal(R"({"input": 1, "obstacle": "", "clearance": 1, "swept": null, "clashes": []})"),
              HasSubstr(begin + "input: 1 is no text"));
  EXPECT_THAT(refusal(R"({"input": "", "obstacle": "", "clearance": -1, "swept": null, "clashes": []})"),
              HasSubstr(begin + "clearance: -1 is too small"));
  EXPECT_THAT(refusal(R"({"input": "", "obstacle": "", "clearance": 1, "swept": null, "clashes": {}})"),
              HasSubstr(begin + "clashes: {} is no list"));
  const std::string place = begin + "clashes[0].";
  EXPECT_THAT(refusal(listWith(R"("points": 1)", R"("points": -1)")), HasSubstr(place + "points: -1 is too small"));
  EXPECT_THAT(refusal(listWith(R"("points": 1)", R"("points": 0)")), HasSubstr(place + "points: 0 is too small"));
  EXPECT_THAT(refusal(listWith(R"("points": 1)", R"("points": 1.5)")), HasSubstr(place + "points: 1.5 is no whole"));
  EXPECT_THAT(refusal(listWith(R"("points": 1)", R"("points": 1e300)")),
              HasSubstr(place + "points: 1e+300 is too large"));
  EXPECT_THAT(refusal(listWith(R"("points": 1)", R"("points": "1")")), HasSubstr(place + "points: \"1\" is no number"));
  EXPECT_THAT(refusal(listWith("0.5", "null")), HasSubstr(place + "distance: null is no number"));
  EXPECT_THAT(refusal(listWith("0.5", "1e999")), HasSubstr("is no JSON"));
  EXPECT_THAT(refusal(listWith(R"("first_pose": 0)", R"("first_pose": -1)")),
              HasSubstr(place + "first_pose: -1 is too"));
  EXPECT_THAT(refusal(listWith(R"("closest_pose": 0)", R"("closest_pose": 4294967296)")),
              HasSubstr(place + "closest_pose: 4294967296 is too large"));
  EXPECT_THAT(refusal(listWith("\"A\"", "7")), HasSubstr(place + "id: 7 is no text"));
  EXPECT_THAT(refusal(listWith("\"new\"", "\"newish\"")), HasSubstr(place + "status: 'newish' is unknown"));
  EXPECT_THAT(refusal(listWith("[0, 0, 0]", "[0, 0]")), HasSubstr(place + "box.min: has not three numbers"));
  EXPECT_THAT(refusal(listWith("[0, 0, 0]", "[0, 2, 0]")), HasSubstr(place + "box: has a min above its max"));
  EXPECT_THAT(refusal(listWith("[0, 0, 0]", "[0, 0, \"0\"]")), HasSubstr(place + "box.min[2]: \"0\" is no number"));
  EXPECT_THAT(refusal(listWith("\"box\"", "\"bax\"")), HasSubstr("clashes[0]: 'box' is missing"));
  EXPECT_THAT(refusal(listOf(entry + "," + entry)), HasSubstr("clashes[1].id: is the id of another clash, too"));
}

/// Two clashes, of which the nearer one collides only perhaps.
TEST_F(ClashReports, CertainAndPerhapsAreToldApart)
{
  twoClashes();
  for (const std::size_t i : {31U, 32U, 33U}) found.flags[i] = Verdict::undecided;
  found.colliding = 1;
  found.undecided = 3;
  ClashReport list = report();
  list.question.uncertainty = Uncertainty("sigma", 1);
  list.question.sigmas = 3;
  list.question.obstacle_uncertainty = 0.04;
  ASSERT_EQ(list.clashes.size(), 2U);
  EXPECT_TRUE(list.clashes[0].isCertain()) << "before those that are nearer, perhaps";
  EXPECT_FALSE(list.clashes[1].isCertain());
  EXPECT_EQ(clashCounts(list), "1 clash, 1 perhaps");

  const std::string page = clashPage(list);
  EXPECT_EQ(faultOfMarkup(page), "");
  for (const char* told :
       {"<h1>1 clash, 1 perhaps</h1>", "<b>1</b><span>colliding points",
        "<b>3</b><span>points of the input collide perhaps", "<b>3 x field sigma</b><span>uncertainty of the input",
        "<b>0.04</b><span>uncertainty of the obstacle", "<b>exact</b><span>accuracy", "<h2>By severity</h2>",
        "<h2>Perhaps</h2>", "<b>0.1</b><span>smallest"})
    EXPECT_TRUE(has(page, told)) << told;
  EXPECT_LT(page.find(">C1_0_617283</a>"), page.find("<h2>Perhaps</h2>"));
  EXPECT_GT(page.find(">C4_0_617283</a>"), page.find("<h2>Perhaps</h2>"));

  const Json json = Json::parse(clashJson(list));
  EXPECT_EQ(json["uncertainty"].dump(), R"({"input":{"field":"sigma","sigmas":3.0},"obstacle":0.04})");
  EXPECT_EQ(json["accuracy"], "exact");
  EXPECT_EQ(json["clashes"][0]["certainty"], "certain");
  EXPECT_EQ(json["clashes"][1]["certainty"], "perhaps");
  EXPECT_EQ(json["clashes"][1]["certain_points"], 0);
  const ClashList read = parseClashes(clashJson(list), "list.json");
  EXPECT_EQ(read.clashes[1].certain_points, 0U);
  EXPECT_EQ(read.question.uncertaintyOfInput(), list.question.uncertaintyOfInput());
  EXPECT_EQ(read.question.uncertaintyOfObstacle(), list.question.uncertaintyOfObstacle());

  const auto rows = cellsOf(clashCsv(list));
  EXPECT_EQ(rows[1][20], "certain");
  EXPECT_EQ(std::vector<std::string>(rows[2].begin() + 20, rows[2].end()),
            (std::vector<std::string>{"perhaps", "0", "0.3", "sigma", "0.04", "3", "exact", "", "", "", "", ""}));
}

TEST_F(ClashReports, TellWhereTheyAreNotExact)
{
  ClashReport list = twoClashes();
  list.question.accuracy = Accuracy::tolerance(0.01);
  EXPECT_EQ(Json::parse(clashJson(list))["accuracy"], "tolerance=0.01");
  EXPECT_THAT(clashCsv(list), HasSubstr(",tolerance=0.01,,,,,\n"));
  EXPECT_TRUE(has(clashPage(list), "<b>tolerance=0.01</b><span>accuracy"));
}

TEST(ClusterDistance, IsAPowerOfTwoThatSpansTheScansGaps)
{
  Spacing scan;
  scan.median = 0.1;
  EXPECT_EQ(clusterDistanceFor(0.0, scan), 0.5);
  EXPECT_EQ(clusterDistanceFor(0.6, scan), 1.0);
  EXPECT_EQ(clusterDistanceFor(0.0, Spacing()), 1.0);
}

TEST_F(ClashReports, TellUnitDateVersionAndCoordinateSystem)
{
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  ClashReport list = twoClashes();
  list.unit = "m";
  list.coordinate_system = "ETRS89 / UTM 32N";
  const std::string page = clashPage(list);
  for (const char* told : {"Lengths in m.", "Coordinate system: ETRS89 / UTM 32N.", " on 2023-11-14.",
                           "Made by pcl_bsh " PCL_BSH_VERSION_TEXT, "clearance [m]<", "smallest distance [m]<"})
    EXPECT_TRUE(has(page, told)) << told;
  const Json json = Json::parse(clashJson(list));
  EXPECT_EQ(json["date"], "2023-11-14");
  EXPECT_EQ(json["program"], "pcl_bsh " PCL_BSH_VERSION_TEXT);
  EXPECT_EQ(json["unit"], "m");
  EXPECT_EQ(json["coordinate_system"], "ETRS89 / UTM 32N");
  EXPECT_THAT(clashCsv(list), HasSubstr(",exact,m,ETRS89 / UTM 32N,,,\n"));
  setenv("SOURCE_DATE_EPOCH", "0", 1);
  EXPECT_TRUE(has(clashPage(list), " on 1970-01-01.")) << "the first second";
  setenv("SOURCE_DATE_EPOCH", "253402300799", 1);
  EXPECT_TRUE(has(clashPage(list), " on 9999-12-31.")) << "the last second";
  for (const char* wrong : {"yesterday", "", "-1", "1e99", "253402300800", "999999999999"}) {
    setenv("SOURCE_DATE_EPOCH", wrong, 1);
    EXPECT_THROW(clashPage(list), std::runtime_error) << wrong;
  }
  unsetenv("SOURCE_DATE_EPOCH");
}

/// Nothing is divided by a clearance of 0: what touches is as near as can be.
TEST_F(ClashReports, OfAClearanceOfZero)
{
  follow(41, 0.25, {{2, 0}, {4, 5}});
  scan_ = scan();
  model_ = model();
  ClashReport list = report();
  list.question.clearance = 0.0;
  ASSERT_EQ(list.clashes.at(0).distance, 0.0);
  const std::string page = clashPage(list);
  EXPECT_EQ(faultOfMarkup(page), "");
  EXPECT_FALSE(has(page, "nan"));
  EXPECT_TRUE(has(page, "height=\"130.000\"")) << "the whole bar";
  EXPECT_TRUE(has(page, "rgb(150,10,40)")) << "deep red";
  EXPECT_FALSE(has(page, "rgb(245,190,66)"));
}

TEST_F(ClashReports, WithoutAClashHaveNoPictures)
{
  follow(3, 0.25, {{0, 5}});
  scan_ = scan();
  model_ = model();
  const std::string nothing = clashPage(report());
  EXPECT_EQ(faultOfMarkup(nothing), "");
  EXPECT_TRUE(has(nothing, "<h1>0 clashes</h1>"));
  EXPECT_FALSE(has(nothing, "One by one"));
  row.clear(), poses.clear();
  EXPECT_TRUE(has(clashPage(twoClashes()), "One by one"));
  ClashReport gone = report();
  for (Clash& clash : gone.clashes) clash.status = ClashStatus::resolved;
  EXPECT_FALSE(has(clashPage(gone), "One by one")) << "they are there no more";
}

TEST_F(ClashReports, TellWhatASurfaceIs)
{
  const TemporaryFolder folder;
  const Obstacle surface = readObstacle(folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), {});
  ClashReport list = twoClashes();
  EXPECT_FALSE(has(clashPage(list), ">Here the obstacle is a "));
  EXPECT_EQ(Json::parse(clashJson(list))["surface"], Json());
  model_ = surface.view();
  list.surface = &surface;
  EXPECT_TRUE(has(clashPage(list), ">Here the obstacle is a surface of 1 triangle: what it encloses is no part of it "
                                   "without `solid`.<"));
  EXPECT_TRUE(has(clashPage(list), "and triangle 0 of the obstacle"));
  list.question.solid = true;
  EXPECT_TRUE(has(clashPage(list), ">Here the obstacle is a solid of 1 triangle: what it encloses is part of it.<"));
  const Json json = Json::parse(clashJson(list));
  EXPECT_EQ(json["surface"]["triangles"], 1);
  EXPECT_EQ(json["surface"]["promise"], promiseOf(surface, true));
  EXPECT_EQ(json["clashes"][0]["closest_pair"]["obstacle"]["triangle"], 0);
  const Json at =
      json["clashes"][0]["closest_pair"]["obstacle"]["at"]; // the corner that is nearest to the scan's point
  EXPECT_NEAR(at[0].get<double>(), 8, 1e-9);
  EXPECT_NEAR(at[1].get<double>(), 0.1, 1e-9);
  EXPECT_THAT(clashCsv(list), HasSubstr(",obstacle_triangle,"));
}

/// A missing value is null.
TEST_F(ClashReports, TellWhereNothingWas)
{
  ClashReport list = twoClashes();
  list.survey = Survey({}, std::nullopt);
  const std::string text = clashJson(list);
  EXPECT_TRUE(Json::parse(text)["path"]["box"].is_null());
  EXPECT_TRUE(Json::parse(text)["scan"]["box"].is_null());
  EXPECT_FALSE(parseClashes(text, "list.json").survey->scan);

  Answer::Unseen unseen;
  unseen.count = 3;
  unseen.in_shadow = 1;
  unseen.at_poses = {0, 2, 3};
  unseen.shadow_at_poses = {0, 1, 0};
  unseen.angles = {0.25, 0.5};
  EXPECT_EQ(unseenJson(unseen).dump(), R"({"obstacle_points":3,"in_shadow":1,"in_skin":2,"at_poses":[0,2,3],)"
                                       R"("in_shadow_at_poses":[0,1,0],"first_pose":null,)"
                                       R"("angles_of_scans":[0.25,0.5],"inside":null})");
  unseen.first_pose = 1;
  unseen.inside = {0.5};
  EXPECT_EQ(unseenJson(unseen)["first_pose"], 1);
  EXPECT_EQ(unseenJson(unseen)["inside"], Json{0.5});
}

/// HTML has none of them, the last of ASCII included.
TEST_F(ClashReports, PagesHaveNoControlCharacters)
{
  twoClashes();
  const std::string page = clashPage(report("a\x1f \x7f~.ply"));
  EXPECT_TRUE(has(page, "a\xef\xbf\xbd \xef\xbf\xbd~.ply"));
}

/// Clashes that are gone, and unknown values, are no number of the page.
TEST_F(ClashReports, PagesTellWhatIsThere)
{
  ClashReport list = twoClashes();
  Clash gone = list.clashes[1];
  gone.id = "gone";
  gone.status = ClashStatus::resolved;
  gone.distance = 0.01;
  list.clashes.push_back(gone);
  const std::string alone = clashPage(list);
  EXPECT_TRUE(has(alone, "<b>0.1</b><span>smallest"));
  EXPECT_FALSE(has(alone, "uncertainty of the input"));
  EXPECT_FALSE(has(alone, "compared with"));
  EXPECT_FALSE(has(alone, "<span>persisting"));
  list.previous = "monday.json";
  const std::string compared = clashPage(list);
  EXPECT_TRUE(has(compared, "<b>1</b><span>resolved"));
  EXPECT_TRUE(has(compared, "<b>0</b><span>persisting"));
  EXPECT_FALSE(has(compared, "<span>not visited"));
  list.clashes.back().status = ClashStatus::not_visited;
  EXPECT_TRUE(has(clashPage(list), "<b>1</b><span>not visited"));
}

TEST_F(ClashReports, NothingIsLookedForThatIsNotMissed)
{
  ClashReport list = twoClashes();
  const ClashList before = parseClashes(clashJson(list), "list.json");
  listUnseen(list);
  EXPECT_EQ(list.clashes.size(), 2U) << "nobody asked what is unseen";
  compareWithList(list, "list.json", before, [](FormerPlaces&) { ADD_FAILURE() << "all are found again"; });
  ClashReport none = report();
  none.clashes.clear();
  std::size_t looks = 0;
  compareWithList(none, "list.json", before, [&](FormerPlaces& former) {
    ++looks;
    former.visit(SphereHierarchy(model()), poses, TrajectoryRequest());
    former.scan(scan());
  });
  EXPECT_EQ(looks, 1U);
  EXPECT_EQ(none.count(ClashStatus::resolved), 2U);
}

} // namespace pcl_bsh::io
