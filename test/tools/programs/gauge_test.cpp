// SPDX-License-Identifier: BSD-3-Clause
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

/// A straight of 20 to the east with a box about it, and a scan of few points whose clearances are known.
class GaugeProgram : public testing::Test {
protected:
  GaugeProgram()
  {
    folder.write("line.axis", "start 500000 4000000 90\nchainage 100\nstraight 20\nheight 100 30\nequation 110 210\n");
    folder.write("box.csv", "offset,height\n-1.5,0\n1.5,0\n1.5,4\n-1.5,4\n");
    folder.write("tall.csv", "offset,height\n-1,0\n1,0\n1,5\n-1,5\n");
    // right is -y; chainages 105, 105.2, 210 + 2.5, 210 + 8, beyond, too far
    folder.write("scan.xyz", "500005 3999998.6 32 1\n500005.2 3999998.75 32 2\n500012.5 4000000.5 34.5 3\n"
                             "500018 4000002 31 4\n500021 4000000 31 5\n500005 4000050 31 6\n");
  }

  Outcome gauge(std::string arguments) const
  {
    for (std::size_t at; (at = arguments.find('{')) != std::string::npos;) {
      const std::size_t end = arguments.find('}', at);
      arguments.replace(at, end - at + 1, (folder / arguments.substr(at + 1, end - at - 1)).string());
    }
    return run("pcl_bsh_gauge", arguments);
  }

  void expectRefused(const std::string& arguments, int exit_code, const std::string& message) const
  {
    const std::size_t files = folder.files();
    const Outcome failed = gauge(arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments << failed.err;
    EXPECT_THAT(failed.err, testing::StartsWith("pcl_bsh_gauge: ")) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(folder.files(), files) << arguments;
  }

  std::vector<std::string> linesOf(const std::string& name) const
  {
    std::istringstream text(io::contentOf(folder / name));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }

  const io::TemporaryFolder folder;
};

TEST_F(GaugeProgram, TablesByChainage)
{
  const Outcome done =
      gauge("{scan.xyz} --axis {line.axis} --profile {box.csv} --profile {tall.csv} --range tall=212:220 "
            "--table {table.csv} --infringements {list.csv} --report {report.json} --step 5");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out,
            "2 infringements of 3 points, the worst -0.500 at chainage 212.500; 4 points at the axis, 1 beyond its "
            "ends, 1 too far; no data in 1 of 4 parts\n");
  const std::vector<std::string> table = linesOf("table.csv");
  ASSERT_EQ(table.size(), 7u);
  EXPECT_EQ(table[1], "100,105,0,5,box,no data,0,,,,,");
  EXPECT_EQ(table[2], "105,110,5,10,box,infringed,2,-0.25,,,-0.25,");
  EXPECT_THAT(table[3], HasSubstr(",10,15,box,clear,1,0.5,,0.5,,")) << table[3];
  EXPECT_THAT(table[4], HasSubstr(",10,15,tall,infringed,1,-0.5,,-0.5,,")) << table[4];
  EXPECT_THAT(table[5], HasSubstr(",15,20,box,clear,1,0.5,0.5,,,")) << table[5];
  const std::vector<std::string> list = linesOf("list.csv");
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[1], "1,C250006_2000000_17,new,tall,212.5,212.5,212.5,12.5,-0.5,4.5,-0.5,1,2,500012.5,4000000.5,34.5");
  EXPECT_THAT(list[2], testing::StartsWith("2,C250002_1999999_16,new,box,105,105.2")) << list[2];
  const auto report = nlohmann::json::parse(io::contentOf(folder / "report.json"));
  EXPECT_EQ(report["points"]["behind_the_end"], 1);
  EXPECT_EQ(report["infringements"][0]["clearance"], -0.5);
  EXPECT_TRUE(report["table"][0]["smallest"].is_null()) << "no data";
}

TEST_F(GaugeProgram, TellsWhatIsNewAndWhatIsGone)
{
  folder.write("w47.xyz", "500005 3999998.6 32\n500008 4000000 33.8\n500013 4000001.4 32\n500018.5 4000001.4 32\n");
  folder.write("w48.xyz", "500005.1 3999998.7 32\n500008 4000000 35\n500013 4000000 29.5\n500015 3999998.7 32\n"
                          "500018.5 4000002 32\n");
  const std::string rest = " --axis {line.axis} --profile {box.csv} --report {week.json} ";
  ASSERT_EQ(gauge("{w47.xyz}" + rest).exit_code, 0);
  const auto before = nlohmann::json::parse(io::contentOf(folder / "week.json"));
  const std::string more = "--previous {week.json} --range 100:218 --infringements {list.csv} --page {page.html}";
  const Outcome done = gauge("{w48.xyz}" + rest + more);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.told(), "");
  EXPECT_THAT(done.out, testing::StartsWith("2 infringements of 2 points, 1 new, 1 persisting, 1 resolved, 1 not "
                                            "visited, 1 not scanned, the worst -0.200 at"));
  const auto report = nlohmann::json::parse(io::contentOf(folder / "week.json"));
  std::vector<std::string> told;
  for (const auto& one : report["infringements"])
    told.push_back(one["status"].get<std::string>() + ' ' + std::to_string(one["chainage"].get<int>()));
  EXPECT_THAT(told, testing::UnorderedElementsAre("persisting 105", "new 215", "resolved 108", "not_scanned 213",
                                                  "not_visited 218"));
  for (const auto& one : report["infringements"])
    for (const auto& former : before["infringements"])
      if (one["status"] != "new" && std::abs(one["distance"].get<double>() - former["distance"].get<double>()) < 0.2) {
        EXPECT_EQ(one["id"], former["id"]) << "the place keeps its name";
      }
  const std::vector<std::string> list = linesOf("list.csv");
  ASSERT_EQ(list.size(), 6u);
  EXPECT_THAT(list[5], testing::StartsWith(",C")) << "no rank of what is gone";
  EXPECT_THAT(io::contentOf(folder / "page.html"), HasSubstr("<span class=\"badge not_scanned\">not scanned</span>"));

  const Outcome again = gauge("{w48.xyz}" + rest + more);
  EXPECT_THAT(again.out, HasSubstr("0 new, 2 persisting, 0 resolved, 1 not visited, 1 not scanned")) << again.err;
}

TEST_F(GaugeProgram, OutputHasFieldsOfEachPoint)
{
  for (const char* output : {"out.pcd", "out.las", "out.ply"}) {
    const Outcome done =
        gauge("{scan.xyz} {" + std::string(output) + "} --axis {line.axis} --profile {box.csv} --limit 0.5");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("of 4 points"));
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / output);
    ASSERT_EQ(cloud.width * cloud.height, 6u);
    EXPECT_NEAR(io::valueOf(cloud, 2, "chainage"), 212.5, 1e-9);
    EXPECT_NEAR(io::valueOf(cloud, 1, "offset"), 1.25, 1e-6);
    EXPECT_NEAR(io::valueOf(cloud, 1, "height"), 2, 1e-6);
    EXPECT_NEAR(io::valueOf(cloud, 1, "clearance"), -0.25, 1e-6);
    EXPECT_EQ(io::valueOf(cloud, 1, "envelope"), 0);
    EXPECT_EQ(io::valueOf(cloud, 4, "place"), 3);
    EXPECT_EQ(io::valueOf(cloud, 5, "place"), 4);
    EXPECT_TRUE(std::isnan(io::valueOf(cloud, 5, "clearance")));
    EXPECT_EQ(io::valueOf(cloud, 5, "envelope"), -1);
  }
}

TEST_F(GaugeProgram, StreamsWhatItNeedNotHold)
{
  ASSERT_EQ(gauge("{scan.xyz} {scan.las} --axis {line.axis} --profile {box.csv}").exit_code, 0);
  const std::string rest = "--axis {line.axis} --profile {box.csv} --step 7 --table {";
  const Outcome whole = gauge("{scan.xyz} " + rest + "whole.csv}"),
                streamed = gauge("{scan.las} " + rest + "streamed.csv}");
  EXPECT_EQ(streamed.out, whole.out) << streamed.err;
  EXPECT_EQ(linesOf("streamed.csv").size(), linesOf("whole.csv").size());
}

TEST_F(GaugeProgram, BitsDoNotDependOnThreads)
{
  std::string points;
  for (int i = 0; i < 5000; ++i)
    points += std::to_string(500000 + i % 199 * 0.1) + ' ' + std::to_string(3999997 + i % 61 * 0.1) + ' ' +
              std::to_string(29 + i % 83 * 0.1) + '\n';
  folder.write("many.xyz", points);
  for (const std::string threads : {"1", "2"})
    ASSERT_EQ(gauge("{many.xyz} {out" + threads + ".pcd} --axis {line.axis} --profile {box.csv} --table {table" +
                    threads + ".csv} --infringements {list" + threads + ".csv} --threads " + threads)
                  .exit_code,
              0);
  for (const std::string name : {"out", "table", "list"}) {
    const std::string extension = name == "out" ? ".pcd" : ".csv";
    EXPECT_EQ(io::contentOf(folder / (name + "1" + extension)), io::contentOf(folder / (name + "2" + extension)));
  }
}

/// A scanner that goes along the line, 2 above it, 1 each second.
class GaugeProgramOfBeams : public GaugeProgram {
protected:
  GaugeProgramOfBeams()
  {
    folder.write("path.csv", "time,x,y,z\n0,500000,4000000,32\n20,500020,4000000,32\n");
    // through each side at 2.5, the last one to beyond the reach; through the left side alone at 7.5; one behind its
    // time
    folder.write("beams.csv", "x,y,z,gps_time\n500002.5,4000002,32,2.5\n500002.5,3999998,32,2.5\n"
                              "500002.5,4000000,29,2.5\n500002.5,4000000,90,2.5\n500007.5,4000002,32,7.5\n"
                              "500012.5,4000002,32,21\n");
  }

  const std::string rest = " --axis {line.axis} --profile {box.csv} --step 5 --seen-spacing 0.5 ";
};

TEST_F(GaugeProgramOfBeams, TellsWhatTheySaw)
{
  const Outcome done = gauge("{beams.csv} --origin-path {path.csv}" + rest +
                             "--table {table.csv} --report {report.json} --page {page.html}");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("beams.csv: 1 point with a time that the origin path, from 0 to 20, does not "
                                  "have, the first record 5 at 21: no beam of theirs sees anything"));
  EXPECT_THAT(done.out, HasSubstr("; no data in 1 of 4 parts; a side is unseen in 2 of 4 parts; 1 point without an "
                                  "origin\n"));
  const std::vector<std::string> table = linesOf("table.csv");
  ASSERT_EQ(table.size(), 5u);
  EXPECT_THAT(table[0], testing::EndsWith(",below,seen,seen_left,seen_above,seen_right,seen_below"));
  EXPECT_THAT(table[1], HasSubstr(",box,clear,3,")) << table[1];
  EXPECT_THAT(table[1],
              testing::EndsWith(",0.014285714285714285,0.0125,0.016666666666666666,0.0125,0.016666666666666666"))
      << table[1];
  EXPECT_THAT(table[2], HasSubstr(",box,unseen,1,0.5,")) << table[2];
  EXPECT_THAT(table[2], testing::EndsWith(",0,0,0")) << table[2];
  EXPECT_THAT(table[3], HasSubstr(",box,unseen,1,0.5,")) << "it has no origin: " << table[3];
  EXPECT_THAT(table[4], HasSubstr(",box,no data,0,")) << table[4];
  const auto report = nlohmann::json::parse(io::contentOf(folder / "report.json"));
  EXPECT_EQ(report["points"]["outside_origin_path"], 1);
  EXPECT_EQ(report["table"][0]["state"], "clear");
  EXPECT_EQ(report["table"][0]["seen"]["left"], 0.0125);
  const std::string page = io::contentOf(folder / "page.html");
  for (const char* text : {"of 4 parts have an unseen side", "map of what was seen", "No data at chainages 215 to 220",
                           "Unseen on a side at chainages 105 to 215"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, testing::Not(HasSubstr("{{")));
}

TEST_F(GaugeProgramOfBeams, WhatTheyDoNotSeeIsNotResolved)
{
  folder.write("before.xyz",
               "500002.5 4000001.4 32\n500012.5 4000001.4 32\n"); // at the left side, which is seen at one
  ASSERT_EQ(gauge("{before.xyz}" + rest + "--report {week.json}").exit_code, 0);
  const std::string again = "{beams.csv}" + rest + "--previous {week.json} ";
  EXPECT_THAT(gauge(again).out, HasSubstr("0 new, 0 persisting, 2 resolved;"));
  EXPECT_THAT(gauge(again + "--origin-path {path.csv}").out,
              HasSubstr("0 new, 0 persisting, 1 resolved, 1 not scanned;"));
}

TEST_F(GaugeProgramOfBeams, RefusesWhatIsNoPath)
{
  folder.write("back.csv", "time,x,y,z\n3,0,0,0\n2,1,0,0\n");
  folder.write("one.csv", "time,x,y,z\n3,0,0,0\n");
  folder.write("nan.csv", "time,x,y,z\n3,0,0,0\n4,nan,0,0\n");
  folder.write("names.csv", "x,y,z\n3,0,0\n");
  const auto expect = [&](const std::string& path, const std::string& message) {
    expectRefused("{beams.csv}" + rest + "--table {table.csv} --origin-path {" + path + '}', 1, message);
  };
  expect(
      "back.csv",
      "back.csv: line 3 is no place of a path: its time 2 does not exceed the one before, 3: list places in the order");
  expect("one.csv", "one.csv: has 1 of the two places it needs: give the scanner's place before the first point");
  expect("nan.csv",
         "nan.csv: line 3 is no place of a path: has a value that is not finite: correct it, or leave the place out");
  expect("names.csv", "names.csv: line 1 names no column time");
  expect("none.csv", "none.csv");
  expectRefused("{scan.xyz}" + rest + "--origin-path {path.csv}", 1,
                "scan.xyz: the scan has none: --time-field: give the one that has the points' times: its fields are x");
  expectRefused("{beams.csv}" + rest + "--origin-path {path.csv} --time-field when", 1,
                "beams.csv: the scan has no field 'when': --time-field: give the one");
  expectRefused("{beams.csv} --axis {line.axis} --profile {box.csv} --origin-path {path.csv} --seen-spacing 1e-6", 1,
                "1e-06 makes too many cells of an axis 20 long");
  expectRefused("{beams.csv}" + rest + "--time-field t", 2, "--time-field: tells when beams were: give --origin-path");
}

TEST_F(GaugeProgram, DrawsPagesAndSections)
{
  const Outcome done =
      gauge("{scan.xyz} --axis {line.axis} --profile {box.csv} --page {page.html} --sections {drawn} --at 212.5 "
            "--at 102 --unit m");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string page = io::contentOf(folder / "page.html");
  for (const char* text : {"Gauging run", "of 2 points", "No data at chainages 100 to 105", "clearances by chainage",
                           "Infringement 1, chainage 105.200 m"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, testing::Not(HasSubstr("{{")));
  EXPECT_THAT(io::contentOf(folder / "drawn/infringement_1.svg"), HasSubstr("-0.250 m"));
  EXPECT_THAT(io::contentOf(folder / "drawn/section_1.svg"), HasSubstr("1 point within 0.05"));
  EXPECT_THAT(io::contentOf(folder / "drawn/section_2.svg"), HasSubstr("no data: no point within 0.05"));
}

TEST_F(GaugeProgram, DrawsPictures)
{
  const std::string rest = "{scan.xyz} --axis {line.axis} --profile {box.csv} --at 212.5 ";
  expectRefused(rest + "--page {page.html} --png", 2, "--png: draws sections: give --sections FOLDER");
  const Outcome done = gauge(rest + "--sections {drawn} --png");
  if (done.err.find("librsvg2-dev") != std::string::npos) {
    expectRefused(rest + "--sections {drawn} --png", 2,
                  "--png: this program was built without librsvg: build it where");
    GTEST_SKIP() << "the program was built without librsvg: install librsvg2-dev";
  }
  EXPECT_EQ(done.exit_code, 0) << done.err;
  for (const char* name : {"drawn/section_1.png", "drawn/infringement_1.png"}) {
    const std::string png = io::contentOf(folder / name);
    ASSERT_GT(png.size(), 10'000u);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x07\x80\0\0\x06\x90", 8)) << "1920 x 1680";
    EXPECT_TRUE(std::filesystem::exists((folder / name).replace_extension(".svg")));
  }
}

/// Two tracks, 4 apart, and an alignment of the second that counts its chainage from 1000.
class GaugeProgramOfTracks : public GaugeProgram {
protected:
  GaugeProgramOfTracks()
  {
    folder.write("right.axis", "start 500000 3999996 90\nchainage 1000\nstraight 30\nheight 1000 30\n");
    // in both boxes of 5, at both, at right alone (chainage 1025), at none
    folder.write("both.xyz", "500005 3999998.2 32\n500012 4000000 35\n500025 3999996.5 31\n500012 4000050 31\n");
    folder.write("wide.csv", "offset,height\n-2.5,0\n2.5,0\n2.5,4\n-2.5,4\n");
  }

  const std::string both = " --axis left={line.axis} --axis right={right.axis} ";
};

TEST_F(GaugeProgramOfTracks, EachIsTabledAsIfItWereAlone)
{
  const std::string rest = " --profile {wide.csv} --profile {tall.csv} --track tall=right --step 10 --table {";
  const Outcome done = gauge("{both.xyz} {out.pcd}" + both + rest + "both.csv} --infringements {list.csv} --page " +
                             "{page.html} --sections {drawn} --at 1005 --report {report.json}");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "3 infringements of 2 points, the worst -1.000 at chainage 1025.000 of track right; 3 points at "
                      "the axis, 0 beyond its ends, 1 too far\n");
  std::vector<std::string> table = {"track," + linesOf("both.csv")[0].substr(6)};
  for (const std::string track : {"left", "right"}) {
    const std::string file = track == "left" ? "line" : "right";
    const std::string profiles =
        track == "left" ? " --profile {wide.csv}" : " --profile {wide.csv} --profile {tall.csv}";
    ASSERT_EQ(gauge("{both.xyz} --axis {" + file + ".axis}" + profiles + " --step 10 --table {alone.csv}").exit_code,
              0);
    const std::vector<std::string> alone = linesOf("alone.csv");
    for (std::size_t i = 1; i < alone.size(); ++i) table.push_back(track + ',' + alone[i]);
  }
  EXPECT_EQ(linesOf("both.csv"), table);

  const std::vector<std::string> list = linesOf("list.csv");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_THAT(list[0], testing::StartsWith("rank,id,status,track,envelope,"));
  EXPECT_THAT(list[1], testing::StartsWith("1,right:C250012_1999998_15,new,right,wide,1025,1025,1025,25,"));
  EXPECT_THAT(list[2], testing::StartsWith("2,left:C250002_1999999_16,new,left,wide,105,")) << "0.7 deep";
  EXPECT_THAT(list[3], testing::StartsWith("3,right:C250002_1999999_16,new,right,wide,1005,")) << "0.3 deep";

  const auto report = nlohmann::json::parse(io::contentOf(folder / "report.json"));
  EXPECT_FALSE(report.contains("axis"));
  EXPECT_EQ(report["tracks"][1]["name"], "right");
  EXPECT_EQ(report["tracks"][1]["axis"]["chainage_from"], 1000);
  EXPECT_EQ(report["tracks"][1]["envelopes"].size(), 2u);
  EXPECT_EQ(report["infringements"][0]["track"], "right");
  EXPECT_EQ(report["table"][0]["track"], "left");

  const pcl::PCLPointCloud2 cloud = io::readCloud(folder / "out.pcd");
  const std::array<double, 4> tracks = {0, 0, 1, -1};
  for (std::size_t i = 0; i < tracks.size(); ++i) EXPECT_EQ(io::valueOf(cloud, i, "track"), tracks[i]) << i;
  EXPECT_EQ(io::valueOf(cloud, 2, "chainage"), 1025);

  const std::string page = io::contentOf(folder / "page.html");
  for (const char* text :
       {"<th>track</th>", "<td>right</td>", "Track left, envelope wide", "Track right, envelope tall"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, testing::Not(HasSubstr("{{")));
  EXPECT_THAT(page, testing::Not(HasSubstr("Track left, envelope tall")));
  EXPECT_THAT(io::contentOf(folder / "drawn/section_1.svg"), HasSubstr("Section 1, track right, chainage 1005.000"));
}

TEST_F(GaugeProgramOfTracks, EachIsComparedWithItsOwnEarlierList)
{
  const std::string rest = " --profile {wide.csv} --report {week.json} ";
  ASSERT_EQ(gauge("{both.xyz}" + both + rest).exit_code, 0);
  folder.write("next.xyz", "500005 3999998.6 32\n500025 3999996 29.5\n"); // left alone; right is free where it was not
  const Outcome next = gauge("{next.xyz}" + both + rest + "--previous {week.json} --infringements {list.csv}");
  EXPECT_EQ(next.told(), "");
  EXPECT_THAT(next.out, testing::StartsWith("1 infringement of 1 point, 0 new, 1 persisting, 2 resolved"));
  const std::vector<std::string> list = linesOf("list.csv");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_THAT(list[1], testing::StartsWith("1,left:C250002_1999999_16,persisting,left,"));
  EXPECT_THAT(list[2], HasSubstr(",resolved,right,"));
  EXPECT_THAT(list[3], HasSubstr(",resolved,right,"));

  ASSERT_EQ(gauge("{both.xyz}" + both + rest).exit_code, 0);
  const Outcome one = gauge("{both.xyz} --axis right={right.axis}" + rest + "--previous {week.json}");
  EXPECT_THAT(one.err, HasSubstr("week.json: lists infringements of the track 'left', which is not given now"));
  EXPECT_THAT(one.out, HasSubstr("0 new, 2 persisting, 0 resolved, 1 not visited"));
  const Outcome again = gauge("{both.xyz}" + both + rest + "--previous {week.json}");
  EXPECT_EQ(again.told(), "");
  EXPECT_THAT(again.out, HasSubstr("0 new, 3 persisting, 0 resolved, the worst"));
  const Outcome unnamed = gauge("{both.xyz} --axis {line.axis}" + rest + "--previous {week.json}");
  EXPECT_THAT(unnamed.out, HasSubstr("1 new, 0 persisting, 0 resolved, 3 not visited"));
}

TEST_F(GaugeProgramOfTracks, TakesTheirAlignmentsFromOneFile)
{
  const auto alignment = [](const std::string& name, int y) {
    const std::string north = std::to_string(y);
    return "<Alignment name=\"" + name + "\" length=\"20\" staStart=\"" + north + "\"><CoordGeom><Line><Start>" +
           north + " 500000</Start><End>" + north + " 500020</End></Line></CoordGeom></Alignment>\n";
  };
  folder.write("line.xml",
               "<?xml version=\"1.0\"?><LandXML version=\"1.2\"><Units><Metric linearUnit=\"meter\"/></Units>"
               "<Alignments>" +
                   alignment("A", 4000000) + alignment("B", 3999996) + "</Alignments></LandXML>");
  const Outcome done =
      gauge("{both.xyz} --axis left={line.xml} --axis right={line.xml} --alignment right=B --alignment "
            "left=A --profile {wide.csv} --above 40 --table {table.csv} --step 20");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::vector<std::string> table = linesOf("table.csv");
  ASSERT_EQ(table.size(), 3u);
  EXPECT_THAT(table[1], testing::StartsWith("left,4e+06,4000020,"));
  EXPECT_THAT(table[2], testing::StartsWith("right,3999996,4000016,"));
}

TEST_F(GaugeProgramOfTracks, RefusesWhatNamesNoTrack)
{
  folder.write("bend.axis", "start 0 0 0\narc 20 9\n");
  const std::string wide = " --profile {wide.csv} ";
  expectRefused("{both.xyz} --axis {line.axis} --axis right={right.axis}" + wide, 2, "several tracks need names");
  expectRefused("{both.xyz} --axis a={line.axis} --axis a={right.axis}" + wide, 2, "another track is called 'a', too");
  expectRefused("{both.xyz} --axis a= --axis b={right.axis}" + wide, 2, "--axis: a=: lacks one of both");
  expectRefused("{both.xyz}" + both + wide + "--track middle", 2,
                "--track: no track is called 'middle': give one of left, right");
  expectRefused("{both.xyz} --axis {line.axis}" + wide + "--track left", 2, "give --axis left=FILE");
  expectRefused("{both.xyz}" + both + wide + "--track left", 2, "no profile counts on the track 'right'");
  expectRefused("{both.xyz} --axis left={line.axis} --axis bend={bend.axis}" + wide, 1,
                "track bend: reach: 10 beside the axis is more than 0.8");
  expectRefused("{both.xyz} --axis left={line.axis} --axis bend={bend.axis} --reach 5 --vehicle 19,3" + wide, 1,
                "track bend: vehicle: its pivots, 19 apart, do not fit");
  expectRefused("{both.xyz} {o.pcd}" + both + wide + "--page {p.html} --at 7", 2,
                "give one from 100 to 220 of track left, or 1000 to 1030 of track right");
  expectRefused(both + "--pivots 8 --poses-out {poses.txt}", 2, "--poses-out: follows one axis: give --axis once");
}

TEST_F(GaugeProgram, PosesOfAVehicleOnPivots)
{
  const Outcome done = gauge("--axis {line.axis} --pivots 8 --step 6 --poses-out {poses.txt}");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "3 poses of a vehicle on two pivots\n");
  const std::vector<std::string> poses = linesOf("poses.txt");
  ASSERT_EQ(poses.size(), 3u);
  std::istringstream last(poses[2]);
  std::vector<double> numbers(12);
  for (double& number : numbers) last >> number;
  EXPECT_NEAR(numbers[0], 1, 1e-12);
  EXPECT_NEAR(numbers[3], 500016, 1e-9);
  EXPECT_NEAR(numbers[11], 30, 1e-12);
}

TEST_F(GaugeProgram, RefusesWrongInputInOneLine)
{
  folder.write("crossed.csv", "offset,height\n0,0\n1,1\n1,0\n0,1\n");
  folder.write("bend.axis", "start 0 0 0\narc 20 9\n");
  const std::string both = "{scan.xyz} --axis {line.axis} --profile {box.csv} ";
  expectRefused("{scan.xyz} --axis {line.axis}", 2, "--profile is required");
  expectRefused("--axis {line.axis}", 2, "INPUT is required");
  expectRefused("--axis {line.axis} --pivots 8", 2, "--pivots: makes poses: give --poses-out FILE");
  expectRefused("{scan.xyz} --axis {line.axis} --profile {crossed.csv}", 1,
                "crossed.csv: its edges from (0, 0) to (1, 1)");
  expectRefused("{scan.xyz} --axis {bend.axis} --profile {box.csv}", 1, "more than 0.8 of its smallest radius, 9");
  expectRefused(both + "--range wagon=1:2", 2, "--range: wagon=1:2: no profile is called 'wagon': give one of box");
  expectRefused(both + "--range 5", 2, "--range: '5' is no pair: give FROM:TO");
  expectRefused(both + "--range 7:5", 1, "envelope box: its range ends at 5, before it begins at 7");
  expectRefused(both + "--vehicle 19", 2, "--vehicle: '19' is no pair: give P,O");
  expectRefused(both + "--profile {box.csv}", 2, "another is called 'box', too: rename a file");
  expectRefused(both + "--page {page.html} --at 205", 2,
                "--at: 205: the axis has no such chainage: give one from 100 to 220");
  ASSERT_EQ(gauge(both + "--report {week.json}").exit_code, 0);
  expectRefused(both + "--previous {week.json} --limit 0.1", 1,
                "week.json: lists infringements with --limit 0, now it is 0.1: ask with the same limit");
  expectRefused(both + "--previous {box.csv}", 1, "box.csv: is no report of a gauging run");
  expectRefused("--axis {line.axis} --pivots 8 --poses-out {p.txt} --previous {week.json}", 2, "give INPUT");
  expectRefused(both + "--at 105", 2, "--at: draws sections");
  expectRefused(both + "--table {box.csv}", 2, "box.csv");
  expectRefused("{none.xyz} --axis {line.axis} --profile {box.csv}", 1, "none.xyz");
}

} // namespace
} // namespace pcl_bsh
