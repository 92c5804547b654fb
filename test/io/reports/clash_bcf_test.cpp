// SPDX-License-Identifier: BSD-3-Clause
#include "one_list.h"
#include "support/bcf_reader.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/picture.h>
#include <pcl_bsh/io/reports/zip_archive.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <functional>
#include <set>

namespace pcl_bsh::io {
namespace {

using files::TemporaryFolder;
using testing::HasSubstr;

/// A row of points ten apart, and a probe that comes near to some of them.
class ClashBcf : public testing::Test {
protected:
  explicit ClashBcf()
  {
    for (int i = 0; i < 4; ++i)
      for (const double coordinate : {10.0 * i, 0.0, 5.0}) row.push_back(coordinate);
  }

  /// A run: the probe at these points of the row.
  ClashReport reportAt(const std::vector<int>& stops)
  {
    poses.clear();
    for (const int stop : stops) {
      poses.push_back(Eigen::Isometry3d::Identity());
      poses.back().translation() = Eigen::Vector3d(10.0 * stop, 0.25, 5.0);
    }
    TrajectoryRequest request;
    request.clearance = 0.5;
    request.distances = request.first_poses = request.closest_poses = request.pose_summaries = true;
    found = collideAlong({SphereHierarchy(scan)}, SphereHierarchy(model), poses, request);
    ClashQuestion question;
    question.input = "scans/hall.ply";
    question.obstacle = "0123456789abcdefghi_$A.ply";
    question.clearance = 0.5;
    return {.question = question,
            .cluster_distance = 1.0,
            .clashes = findClashes(scan, found, 1.0),
            .scan = scan,
            .model = model,
            .poses = poses,
            .found = found,
            .survey = {poses, extentOf(scan)},
            .unit = "mm",
            .coordinate_system = "UTM & <32N>"};
  }

  /// As a program of coordinators changes the markup of one topic.
  static void change(const std::filesystem::path& file, const std::string& guid, const std::string& from,
                     const std::string& to)
  {
    ZipFiles files = filesOfZip(files::contentOf(file));
    std::string& markup = files.at(guid + "/markup.bcf");
    const std::size_t at = markup.find(from);
    ASSERT_NE(at, std::string::npos) << markup;
    markup.replace(at, from.size(), to);
    std::ofstream(file, std::ios::binary) << zipped(files, "2026-11-29");
  }

  std::vector<double> row;
  std::array<double, 3> probe = {0, 0, 0};
  PointsView scan = viewOf(row.data(), 4), model = viewOf(probe.data(), 1);
  std::vector<Eigen::Isometry3d> poses;
  TrajectoryResult found;
  TemporaryFolder folder;

  void SetUp() override { scan = viewOf(row.data(), 4); }
};

TEST_F(ClashBcf, IsWhatTheSchemasSay)
{
  ClashReport report = reportAt({0, 2});
  ASSERT_EQ(report.clashes.size(), 2U);
  report.clashes[1].status = ClashStatus::resolved;
  for (const bool is_3 : {false, true}) {
    const BcfSchema schema(is_3);
    const auto files = filesOfZip(clashBcf(report, is_3));
    std::set<std::string> roots;
    for (const auto& [name, content] : files) {
      if (content[0] == '{' || name.ends_with(".png")) continue;
      EXPECT_EQ(schema.faultsOf(content), "") << name << '\n' << content;
      pugi::xml_document document;
      document.load_buffer(content.data(), content.size());
      roots.insert(document.document_element().name());
    }
    EXPECT_EQ(files.size(), (is_3 ? 8U : 6U) + (drawsPictures() ? 1U : 0U)) << "one of both clashes is there";
    EXPECT_EQ(roots.size(), is_3 ? 5U : 3U);
    const std::string list = is_3 ? files.at(bcfListDocument()) : files.at("clashes.json");
    EXPECT_EQ(parseClashes(list, "list").clashes.size(), 2U);
    for (const Clash& clash : report.clashes) {
      const std::string guid = bcfGuid(clash.id), &xml = files.at(guid + "/markup.bcf");
      EXPECT_THAT(xml, HasSubstr("Guid=\"" + guid + "\" TopicType=\"Clash\" TopicStatus=\"" +
                                 (clash.status == ClashStatus::resolved ? "Closed" : "Open")));
      EXPECT_THAT(xml, HasSubstr("<Title>" + clash.id + ": 0.25 mm, 0123456789abcdefghi_$A.ply in hall.ply</Title>"));
      EXPECT_THAT(xml, HasSubstr("coordinate system: UTM &amp; &lt;32N&gt;"));
    }
  }
}

TEST_F(ClashBcf, ClashesThatAreThereHavePictures)
{
  ClashReport report = reportAt({0, 2});
  report.clashes[1].status = ClashStatus::resolved;
  const auto snapshotOf = [](const std::string& markup) {
    pugi::xml_document document;
    document.load_buffer(markup.data(), markup.size());
    const auto root = document.document_element();
    return std::string(root.child("Viewpoints").child_value("Snapshot")) +
           root.child("Topic").child("Viewpoints").child("ViewPoint").child_value("Snapshot");
  };
  for (const bool is_3 : {false, true}) {
    const auto files = filesOfZip(clashBcf(report, is_3));
    const std::string there = bcfGuid(report.clashes[0].id), gone = bcfGuid(report.clashes[1].id);
    EXPECT_EQ(snapshotOf(files.at(there + "/markup.bcf")), drawsPictures() ? "snapshot.png" : "");
    EXPECT_EQ(snapshotOf(files.at(gone + "/markup.bcf")), "");
    EXPECT_FALSE(files.contains(gone + "/snapshot.png"));
    if (drawsPictures()) {
      EXPECT_EQ(sizeOfPng(files.at(there + "/snapshot.png")), (std::pair{780UL, 945UL}));
    }
  }
  const std::vector<std::string> told = writeClashes(folder / "list.bcf", report);
  EXPECT_EQ(told.size(), drawsPictures() ? 0U : 1U);
  EXPECT_TRUE(writeClashes(folder / "list.json", report).empty());
}

TEST_F(ClashBcf, FeetOfTheSurveyAreMetres)
{
  ClashReport report = reportAt({2});
  report.unit = "us-ft";
  const auto files = filesOfZip(clashBcf(report, true));
  pugi::xml_document document;
  const std::string& xml = files.at(bcfGuid(report.clashes[0].id) + "/viewpoint.bcfv");
  document.load_buffer(xml.data(), xml.size());
  const auto start = document.document_element().child("Lines").child("Line").child("StartPoint");
  EXPECT_NEAR(start.child("X").text().as_double(), 20 * 1200.0 / 3937, 1e-12);
}

TEST_F(ClashBcf, ViewpointsLookAtTheClash)
{
  const ClashReport report = reportAt({2});
  const auto files = filesOfZip(clashBcf(report, true));
  pugi::xml_document document;
  const std::string& xml = files.at(bcfGuid(report.clashes[0].id) + "/viewpoint.bcfv");
  document.load_buffer(xml.data(), xml.size());
  const auto root = document.document_element(), camera = root.child("PerspectiveCamera");
  const auto vector = [](const pugi::xml_node& node) {
    return Eigen::Vector3d(node.child("X").text().as_double(), node.child("Y").text().as_double(),
                           node.child("Z").text().as_double());
  };
  const Eigen::Vector3d at = vector(camera.child("CameraViewPoint")), way = vector(camera.child("CameraDirection")),
                        up = vector(camera.child("CameraUpVector"));
  EXPECT_NEAR(way.norm(), 1, 1e-12);
  EXPECT_NEAR(up.norm(), 1, 1e-12);
  EXPECT_NEAR(up.dot(way), 0, 1e-12);
  EXPECT_GT(up.z(), 0);
  const Eigen::Vector3d target(0.02, 0, 0.005); // in metres
  EXPECT_LT(((target - at).normalized() - way).norm(), 1e-9) << "to the middle of the box";
  EXPECT_GT((target - at).norm(), 0.001) << "at some cluster distances";
  const auto line = root.child("Lines").child("Line");
  EXPECT_LT((vector(line.child("StartPoint")) - target).norm(), 1e-12);
  EXPECT_LT((vector(line.child("EndPoint")) - target - Eigen::Vector3d(0, 0.00025, 0)).norm(), 1e-12);
  const auto selection = root.child("Components").child("Selection");
  EXPECT_STREQ(selection.first_child().child_value("AuthoringToolId"), "hall.ply");
  EXPECT_STREQ(selection.last_child().attribute("IfcGuid").value(), "0123456789abcdefghi_$A");
}

TEST_F(ClashBcf, AnEarlierFileBringsBackWhatPeopleSaid)
{
  for (const std::string name : {"old.bcf", "old.bcfzip"}) {
    const bool is_3 = name == "old.bcf";
    const auto file = folder / name;
    ClashReport before = reportAt({0, 1, 2});
    writeClashes(file, before);
    const std::string kept = bcfGuid(before.clashes[0].id), gone = bcfGuid(before.clashes[1].id);
    const std::string comment =
        "<Comment Guid=\"AB3E5B5C-0000-4000-8000-000000000001\"><Date>2026-11-20T10:00:00Z</Date>"
        "<Author>ada@example.com</Author><Comment>move the \xc3\xbc duct &amp; ask</Comment>"
        "</Comment><Comment Guid=\"AB3E5B5C-0000-4000-8000-000000000002\"><Date/><Author>eve@example.com</Author>"
        "<Comment>some programs leave the date empty</Comment><ModifiedDate>yesterday</ModifiedDate>"
        "<ModifiedAuthor>eve@example.com</ModifiedAuthor></Comment>";
    change(file, kept, "TopicStatus=\"Open\"", "TopicStatus=\"In Progress\"");
    change(file, kept, "<CreationAuthor>pcl_bsh</CreationAuthor>",
           "<CreationAuthor>pcl_bsh</CreationAuthor><AssignedTo>bob@example.com</AssignedTo>");
    change(file, kept, is_3 ? "<Viewpoints>" : "<Viewpoints ",
           is_3 ? "<Comments>" + comment + "</Comments><Viewpoints>" : comment + "<Viewpoints ");
    change(file, gone, "TopicStatus=\"Open\"", "TopicStatus=\"In Progress\"");

    const ClashList earlier = readClashes(file);
    EXPECT_EQ(earlier.clashes.size(), 3U);
    EXPECT_EQ(earlier.topics.size(), 3U);
    ClashReport now = reportAt({0, 3});
    if (now.clashes[0].id != before.clashes[0].id) std::swap(now.clashes[0], now.clashes[1]);
    compareWithList(now, file, earlier, SphereHierarchy(scan), SphereHierarchy(model));
    now.clashes.back().status = ClashStatus::resolved;
    for (const bool again_3 : {false, true}) {
      const auto files = filesOfZip(clashBcf(now, again_3));
      const std::string& markup = files.at(kept + "/markup.bcf");
      EXPECT_EQ(BcfSchema(again_3).faultsOf(markup), "") << markup;
      EXPECT_THAT(markup, HasSubstr("TopicStatus=\"In Progress\""));
      EXPECT_THAT(markup, HasSubstr("<AssignedTo>bob@example.com</AssignedTo>"));
      EXPECT_THAT(markup, HasSubstr("<Comment>move the \xc3\xbc duct &amp; ask</Comment>"));
      EXPECT_THAT(markup, HasSubstr("ab3e5b5c-0000-4000-8000-000000000001"));
      EXPECT_THAT(files.at(bcfGuid(now.clashes.back().id) + "/markup.bcf"), HasSubstr("TopicStatus=\"Closed\""));
      for (const Clash& clash : now.clashes) {
        if (clash.status != ClashStatus::fresh) continue;
        EXPECT_THAT(files.at(bcfGuid(clash.id) + "/markup.bcf"), HasSubstr("TopicStatus=\"Open\""));
      }
      EXPECT_EQ(parseBcf(clashBcf(now, again_3)).topics.at(kept).comments.size(), 2U);
    }
  }
}

TEST_F(ClashBcf, GuidsFollowFromIds)
{
  EXPECT_EQ(bcfGuid("C1_2_3"), bcfGuid("C1_2_3"));
  EXPECT_NE(bcfGuid("C1_2_3"), bcfGuid("C1_2_4"));
  EXPECT_THAT(bcfGuid("C1_2_3"), testing::MatchesRegex("[0-9a-f]*-[0-9a-f]*-5[0-9a-f]*-[89ab][0-9a-f]*-[0-9a-f]*"));
}

TEST_F(ClashBcf, IsTheSameBytesAgain)
{
  const ClashReport report = reportAt({0, 2});
  EXPECT_EQ(clashBcf(report, true), clashBcf(report, true));
}

TEST_F(ClashBcf, HostileArchivesAreRefused)
{
  const auto refusalOf = [&](const std::string& archive) {
    const auto file = folder.write("bad.bcf", archive);
    try {
      readClashes(file);
    }
    catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(file.string() + ": "));
      return std::string(error.what());
    }
    ADD_FAILURE() << "was read";
    return std::string();
  };
  const auto withFile = [&](const std::string& name, const std::string& content = "x") {
    return refusalOf(zipped({{name, content}}, "2026-11-29"));
  };
  const std::string sound = clashBcf(reportAt({0, 2}), true);
  for (std::size_t size = 1; size < sound.size(); size += 97)
    EXPECT_THAT(refusalOf(sound.substr(0, size)), HasSubstr("is no whole zip archive"));
  for (const char* name : {"../markup.bcf", "/markup.bcf", "a/../../markup.bcf", "a\\..\\markup.bcf", "C:markup.bcf"})
    EXPECT_THAT(withFile(name), HasSubstr("which leads out of the archive")) << name;
  EXPECT_THAT(withFile("a/markup.bcf"), HasSubstr("has 'a/markup.bcf', which is no topic"));
  EXPECT_THAT(withFile("a/markup.bcf", "<Markup><Topic/></Markup>"), HasSubstr("it has no Guid"));
  EXPECT_THAT(withFile("bcf.version"), HasSubstr("holds no list of clashes"));
  const std::string zeros(std::size_t{1} << 20, '\0');
  ZipFiles bomb;
  for (int i = 0; i < 257; ++i) bomb[std::to_string(i) + "/markup.bcf"] = zeros;
  EXPECT_THAT(refusalOf(zipped(bomb, "2026-11-29")), HasSubstr("unpacks to more than 256 MiB"));
  std::string lying = zipped({{"clashes.json", zeros}}, "2026-11-29");
  const std::size_t entry = lying.rfind("PK\1\2");
  lying.replace(entry + 24, 4, std::string(4, '\1')); // another size
  EXPECT_NE(refusalOf(lying), "");
  EXPECT_THAT(folder.files(), 1U) << "nothing is written";
}

} // namespace
} // namespace pcl_bsh::io
