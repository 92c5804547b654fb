// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/axis_file.h>

#include <pcl_bsh/io/files/file_error.h>

#include "support/temporary_folder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

constexpr auto made_line = R"(# a made line
angle gon
start 500000 4000000 100   # to the east
chainage 1000
gauge 1.5
straight 80
clothoid 60 inf 300
arc 120 300
clothoid 60 300 inf
straight 80
height 1000 30
height 1200 32 60
height 1400 30
cant 1080 0
cant 1140 0.12
cant 1260 0.12
cant 1320 0
equation 1200 1500
)";

TEST(AxisFile, ElementsAsText)
{
  const files::TemporaryFolder folder;
  const Axis axis = readAxis(folder.write("line.axis", made_line));
  EXPECT_DOUBLE_EQ(axis.length(), 400);
  EXPECT_NEAR(axis.frame(50).origin[0], 500050, 1e-9);
  EXPECT_NEAR(axis.frame(50).origin[1], 4000000, 1e-9);
  EXPECT_DOUBLE_EQ(axis.curvature(200), 1 / 300.0);
  EXPECT_LT(axis.frame(400).origin[1], 4000000) << "it turns to the right";
  EXPECT_DOUBLE_EQ(axis.cant(110), 0.06);
  EXPECT_NEAR(axis.frame(100).origin[2], 31 + 0.75 * 0.04 / 1.5, 1e-12) << "the low rail has the height";
  EXPECT_NEAR(axis.frame(200).origin[2], 32 - 0.02 * 60 / 8 + 0.06, 1e-12);
  EXPECT_DOUBLE_EQ(axis.chainage(199), 1199);
  EXPECT_DOUBLE_EQ(axis.chainage(250), 1550);
}

std::string refusalOfAxis(const char* name, const std::string& text, const AxisSettings& settings = {})
{
  const files::TemporaryFolder folder;
  try {
    readAxis(folder.write(name, text), settings);
    return {};
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr(name));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
}

TEST(AxisFile, RefusalsOfElementsNameTheLine)
{
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\nstrait 10\n"),
              HasSubstr("line 2 begins with 'strait': begin it with"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0\n"), HasSubstr("line 1 has fewer values than it should"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\nstraight 10 20\n"), HasSubstr("line 2 has more values"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\nstraight ten\n"), HasSubstr("'ten'"));
  EXPECT_THAT(refusalOfAxis("a.axis", "angle turns\n"),
              HasSubstr("'turns' is no unit of angles: give deg, gon or rad"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\n"), HasSubstr("holds no element"));
  EXPECT_THAT(refusalOfAxis("a.axis", "straight 10\n"), HasSubstr("has no start"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\nstraight -10\n"),
              HasSubstr("an element has the length -10: leave it out"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\nstraight 10\ncant 0 150\n"),
              HasSubstr("its cant 150 is more than half"));
  EXPECT_THAT(refusalOfAxis("a.axis", "start 0 0 0\nstraight 10\nheight 5 1\nheight 2 1\n"),
              HasSubstr("order of distances"));
}

TEST(AxisFile, PointsAsColumns)
{
  const files::TemporaryFolder folder;
  std::string text = "Chainage;E;N;H;cant\n";
  for (int i = 0; i <= 20; ++i)
    text += std::to_string(1000 + 5 * i) + ';' + std::to_string(5e5 + 100 * std::sin(0.05 * i)) + ';' +
            std::to_string(4e6 + 100 * std::cos(0.05 * i)) + ";30;120\n";
  std::vector<std::string> remarks;
  const Axis axis = readAxis(folder.write("points.csv", text), {"", 0.001}, &remarks);
  EXPECT_NEAR(axis.length(), 100, 1e-4);
  EXPECT_NEAR(axis.curvature(50), 0.01, 1e-5);
  EXPECT_DOUBLE_EQ(axis.cant(50), 0.12);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("its arcs through 21 points are within 0.0312 of straight lines"));
  AxisSettings settings;
  settings.cant_unit = 0.001;
  settings.fit = 0.01;
  EXPECT_LE(readAxis(folder / "points.csv", settings, &remarks).description().plan.size(), 8u) << "of 40";
  EXPECT_THAT(remarks[0],
              testing::MatchesRegex("its [0-9] arcs are within .* of its 21 points, the smallest radius is .*"));
  folder.write("elements.axis", "start 0 0 90\nstraight 40\n");
  try {
    readAxis(folder / "elements.axis", settings);
    ADD_FAILURE();
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("arcs are fitted to points alone: leave the fit out"));
  }
}

TEST(AxisFile, RefusalsOfPointsNameTheLine)
{
  EXPECT_THAT(refusalOfAxis("a.csv", "1,2,3,4\n"), HasSubstr("line 1 names no columns: name them in the first line"));
  EXPECT_THAT(refusalOfAxis("a.csv", "x,y,z\n1,2,3\n"), HasSubstr("line 1 names no column chainage"));
  EXPECT_THAT(refusalOfAxis("a.csv", "chainage,x,y,z\n1,2,3\n"),
              HasSubstr("line 2 has 3 values, and the first line has 4"));
  EXPECT_THAT(refusalOfAxis("a.csv", "chainage,x,y,z\n1,2,3,four\n"), HasSubstr("line 2 is damaged: 'four'"));
  EXPECT_THAT(refusalOfAxis("a.csv", "chainage,x,y,z\n1,0,0,0\n\n0,10,0,0\n"),
              HasSubstr("line 4 is no point of an axis: its chainage 0 does not exceed the one before, 1"));
  EXPECT_THAT(refusalOfAxis("a.csv", "chainage,x,y,z\n1,0,0,0\n2,1,0,0\n3,1,1,0\n"),
              HasSubstr("line 3 is no point of an axis: the axis turns by"));
  EXPECT_THAT(refusalOfAxis("a.csv", "chainage,x,y,z\n1,0,0,0\n"), HasSubstr("has 1 points: give two at least"));
}

/// The made line as LandXML, with coordinates of a millimetre.
std::string landXmlOf(const Axis& axis)
{
  const auto place = [&](const char* name, double x, double y) {
    char text[120];
    std::snprintf(text, sizeof text, "<%s>%.4f %.4f</%s>", name, y, x, name);
    return std::string(text);
  };
  const auto at = [&](const char* name, double distance) {
    return place(name, axis.frame(distance).origin[0], axis.frame(distance).origin[1]);
  };
  const auto corner = [&](double distance, double along) {
    const AxisFrame frame = axis.frame(distance);
    return place("PI", frame.origin[0] + along * frame.along[0], frame.origin[1] + along * frame.along[1]);
  };
  const AxisFrame arc = axis.frame(140);
  return "<?xml version=\"1.0\"?>\n<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\">\n"
         "<Units><Metric linearUnit=\"meter\"/></Units>\n<Alignments><Alignment name=\"left\" "
         "staStart=\"1000\">\n<CoordGeom>\n<Line>" +
         at("Start", 0) + at("End", 80) +
         "</Line>\n<Spiral length=\"60\" radiusStart=\"INF\" radiusEnd=\"300\" rot=\"cw\" spiType=\"clothoid\">" +
         at("Start", 80) + corner(80, 40) + at("End", 140) + "</Spiral>\n<Curve rot=\"cw\" crvType=\"arc\">" +
         at("Start", 140) + place("Center", arc.origin[0] + 300 * arc.along[1], arc.origin[1] - 300 * arc.along[0]) +
         at("End", 260) +
         "</Curve>\n<Spiral length=\"60\" radiusStart=\"300\" radiusEnd=\"INF\" rot=\"cw\" spiType=\"clothoid\">" +
         at("Start", 260) + corner(260, 20) + at("End", 320) + "</Spiral>\n<Line>" + at("Start", 320) + at("End", 400) +
         "</Line>\n</CoordGeom>\n<StaEquation staInternal=\"1200\" staBack=\"1200\" staAhead=\"1500\"/>\n"
         "<Profile><ProfAlign><PVI>1000 30</PVI><ParaCurve length=\"60\">1200 32</ParaCurve><PVI>1400 "
         "30</PVI></ProfAlign></Profile>\n"
         "<Cant gauge=\"1.5\" rotationPoint=\"insideRail\"><CantStation station=\"1080\" appliedCant=\"0\"/>"
         "<CantStation station=\"1140\" appliedCant=\"120\" curvature=\"cw\"/><CantStation station=\"1260\" "
         "appliedCant=\"120\" curvature=\"cw\"/>"
         "<CantStation station=\"1320\" appliedCant=\"0\"/></Cant>\n</Alignment></Alignments></LandXML>\n";
}

TEST(AxisFile, LandXmlIsTheSameLine)
{
  const files::TemporaryFolder folder;
  AxisDescription level = parseElements(made_line);
  level.cants.clear(); // which moves the middle between the rails
  const std::string text = landXmlOf(Axis(level));
  std::vector<std::string> remarks;
  const Axis axis = readAxis(folder.write("line.xml", text), {}, &remarks);
  const Axis truth(parseElements(made_line));
  EXPECT_NEAR(axis.length(), 400, 1e-3);
  EXPECT_LT(axis.fit().gap, 2e-4);
  for (double at = 5; at < 400; at += 9.1) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(axis.frame(at).origin[k], truth.frame(at).origin[k], 3e-4) << at;
    EXPECT_NEAR(axis.cant(at), truth.cant(at), 1e-12);
    EXPECT_NEAR(axis.chainage(at), truth.chainage(at), 1e-9);
  }
  EXPECT_THAT(remarks, testing::Contains("its cant is taken for millimetres"));

  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return refusalOfAxis("line.xml", changed);
  };
  EXPECT_THAT(with("clothoid", "bloss"), HasSubstr("line 7, Spiral: spiType=\"bloss\" is no clothoid"));
  EXPECT_THAT(with("meter", "foot"), HasSubstr("lengths are in 'foot'"));
  EXPECT_THAT(with("rot=\"cw\" crvType", "rot=\"up\" crvType"), HasSubstr("line 8, Curve: rot=\"up\" is no turn"));
  EXPECT_THAT(with("length=\"60\"", "length=\"6o\""), HasSubstr("length=\"6o\" is no number"));
  EXPECT_THAT(with("length=\"60\"", "length=\"61\""), HasSubstr("the next element starts"));
  EXPECT_THAT(with("</CoordGeom>", ""), HasSubstr("is no XML"));
  EXPECT_THAT(with("insideRail", "leftRail"), HasSubstr("rotationPoint=\"leftRail\" is not known"));
  EXPECT_THAT(refusalOfAxis("line.xml", text, {"right"}), HasSubstr("holds no alignment 'right': give one of left"));
  EXPECT_THAT(refusalOfAxis("line.xml", "<html/>"), HasSubstr("has no element LandXML"));
}

} // namespace
} // namespace pcl_bsh::io
