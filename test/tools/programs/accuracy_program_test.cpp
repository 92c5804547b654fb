// SPDX-License-Identifier: BSD-3-Clause
#include "program_run.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <random>
#include <sstream>

namespace pcl_bsh {

using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

/// Two bumpy sheets, one above the other.
class AccuracyProgram : public testing::Test {
protected:
  static std::string sheet(double height, unsigned seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::ostringstream text;
    for (int i = 0; i < 4000; ++i) {
      const double x = unit(random), y = unit(random);
      text << x << ' ' << y << ' ' << height + 0.05 * std::sin(9 * x) * std::cos(7 * y) << '\n';
    }
    return text.str();
  }

  using Row = std::map<std::string, std::string>;

  static std::vector<std::string> cells(const std::string& line)
  {
    std::istringstream text(line);
    std::vector<std::string> all;
    for (std::string cell; std::getline(text, cell, ',');) all.push_back(cell);
    return all;
  }

  std::vector<Row> rows() const
  {
    std::istringstream csv(io::contentOf(folder / "study" / "accuracy.csv"));
    std::string line;
    std::getline(csv, line);
    const std::vector<std::string> names = cells(line);
    std::vector<Row> all;
    while (std::getline(csv, line)) {
      const std::vector<std::string> values = cells(line);
      EXPECT_EQ(values.size(), names.size()) << line;
      Row row;
      for (std::size_t i = 0; i < values.size(); ++i) row[names[i]] = values[i];
      all.push_back(row);
    }
    return all;
  }

  io::TemporaryFolder folder;
  fs::path a = folder.write("a.xyz", sheet(0.0, 1));
  fs::path b = folder.write("b.xyz", sheet(0.02, 2));
};

TEST_F(AccuracyProgram, MeasuresEveryKnobAndIsNeverWrongWhereCertified)
{
  const Outcome done =
      run("pcl_bsh_accuracy", a.string() + " " + b.string() + " --clearance 0.01 --poses 2 --repeat 1 " +
                                  "--unit m --out " + (folder / "study").string());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("| exact | `exact`"));
  std::map<std::string, int> knobs, certified_of; ///< rows that were checked, by query
  for (const Row& row : rows()) {
    ++knobs[row.at("knob")];
    const double certified = std::stod(row.at("certified_error")), actual = std::stod(row.at("actual_error"));
    EXPECT_GT(std::stod(row.at("time_quartile_1_s")), 0.0);
    EXPECT_LE(std::stod(row.at("time_quartile_1_s")), std::stod(row.at("time_median_s")));
    EXPECT_LE(std::stod(row.at("time_median_s")), std::stod(row.at("time_quartile_3_s")));
    EXPECT_GT(std::stod(row.at("once_median_s")), 0.0);
    if (row.at("certified") != "1") continue;
    if (row.at("query") == "distance")
      EXPECT_LE(actual, certified + 1e-12) << row.at("setting");
    else if (row.at("knob") == "tolerance")
      continue; // answers within the tolerance may go either way
    else
      EXPECT_EQ(row.at("wrong"), "0") << row.at("query") << ' ' << row.at("setting");
    ++certified_of[row.at("query")];
  }
  const auto report = nlohmann::json::parse(io::contentOf(folder / "study" / "accuracy.json"));
  ASSERT_EQ(report["measurements"].size(), rows().size());
  for (std::size_t i = 0; i < rows().size(); ++i) {
    const Row row = rows()[i];
    const auto& told = report["measurements"][i];
    for (const char* name : {"query", "knob", "setting"}) EXPECT_EQ(told[name], row.at(name));
    const double seconds = told["seconds"]["median"].get<double>();
    EXPECT_NEAR(seconds, std::stod(row.at("time_median_s")), 1e-6 * seconds); // the CSV has seven digits
    EXPECT_NEAR(told["once"]["median"].get<double>(), std::stod(row.at("once_median_s")),
                1e-6 * std::stod(row.at("once_median_s")));
    EXPECT_EQ(told["work"]["node_pairs"], std::stoull(row.at("node_pairs")));
    EXPECT_EQ(told["wrong"], std::stoull(row.at("wrong")));
  }
  EXPECT_EQ(report["fits"].size(), 3U);
  EXPECT_EQ(report["poses"], 2);
  for (const char* query : {"distance", "flags", "any"}) EXPECT_GE(certified_of[query], 5) << query;
  for (const char* knob : {"exact", "tolerance", "level of detail", "budget of tests"})
    EXPECT_EQ(knobs.count(knob), 1u) << knob;
  const std::string text = io::contentOf(folder / "study" / "accuracy.md");
  for (const char* part :
       {"## Smallest distance", "## Flags per point", "## Any collision", "## Fits of spheres", "minimal"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(io::contentOf(folder / "study" / "accuracy.png"), StartsWith("\x89PNG"));
}

TEST_F(AccuracyProgram, TakesPosesFromAFile)
{
  std::string lines;
  for (int i = 0; i < 50; ++i) lines += "0 " + std::to_string(0.001 * i) + " 0 0 0 0 0 1\n";
  const fs::path poses = folder.write("poses.txt", lines);
  const Outcome done = run("pcl_bsh_accuracy", a.string() + " " + b.string() + " --clearance 0.01 --repeat 1 --out " +
                                                   (folder / "study").string() + " --trajectory " + poses.string());
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(io::contentOf(folder / "study" / "accuracy.md"), HasSubstr(", 20 poses, "));
}

/// The sheet passes through the crate's faces, and none of its corners is near.
TEST_F(AccuracyProgram, MeasuresSurfacesWhereFilesHaveFaces)
{
  const fs::path crate = folder.write(
      "crate.off", "OFF\n8 6 0\n-1 -1 -1\n0.5 -1 -1\n0.5 2 -1\n-1 2 -1\n-1 -1 1\n0.5 -1 1\n0.5 2 1\n-1 2 1\n"
                   "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const auto study = [&](const std::string& more) {
    fs::remove_all(folder / "study");
    const Outcome done =
        run("pcl_bsh_accuracy", a.string() + " " + crate.string() + " --clearance 0.05 --repeat 1 --out " +
                                    (folder / "study").string() + more);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    for (const Row& row : rows()) {
      if (row.at("certified") == "1" && row.at("query") != "distance" && row.at("knob") != "tolerance") {
        EXPECT_EQ(row.at("wrong"), "0") << row.at("query") << ' ' << row.at("setting");
      }
    }
    return io::contentOf(folder / "study" / "accuracy.md");
  };
  const std::string surface = study(""), corners = study(" --vertices-only");
  EXPECT_THAT(surface, HasSubstr("`a.xyz` (4000 points) against `crate.off` (12 triangles)."));
  EXPECT_THAT(surface, HasSubstr("what it encloses is no part of it"));
  EXPECT_THAT(corners, HasSubstr("against `crate.off` (8 points)."));
}

TEST_F(AccuracyProgram, RefusesWhatItCannotMeasure)
{
  const auto fails = [&](const std::string& arguments, int code, const std::string& message) {
    const Outcome failed = run("pcl_bsh_accuracy", arguments);
    EXPECT_EQ(failed.exit_code, code) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(folder / "study" / "accuracy.csv"));
  };
  const std::string clouds = a.string() + " " + b.string() + " --out " + (folder / "study").string();
  fails(clouds, 2, "--clearance");
  fails(clouds + " --clearance 1 --poses 0", 2, "--poses: 0");
  fails(clouds + " --clearance x", 2, "--clearance");
  const fs::path poses = folder.write("poses.txt", "0 0 0 0 0 0 0 1\n");
  fails(clouds + " --clearance 1 --poses 2 --trajectory " + poses.string(), 2, "--poses: --trajectory is given too");
  fails(clouds + " --clearance 1 --trajectory " + (folder / "none.txt").string(), 1, "none.txt: no such file");
  fails(clouds + " --clearance -1", 2, "--clearance");
  const fs::path nothing = folder.write("nothing.xyz", "nan nan nan\n");
  fails(nothing.string() + " " + b.string() + " --clearance 1 --out " + (folder / "study").string(), 1,
        "no finite point");
}

} // namespace pcl_bsh
