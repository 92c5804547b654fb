// SPDX-License-Identifier: BSD-3-Clause
// Files damaged at random are read or refused: no crash, no hang, no memory that the file does not justify.
#include "las_sample.h"
#include "samples.h"

#include <pcl_bsh/io/clouds/las/las.h>
#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/clouds/ply/ply.h>

#include <functional>

namespace pcl_bsh::io {

namespace {

using Parse = std::function<pcl::PCLPointCloud2(std::string_view)>;

pcl::PCLPointCloud2 parseAnyPcd(std::string_view file)
{
  Viewpoint viewpoint;
  return parsePcd(file, viewpoint);
}

pcl::PCLPointCloud2 parseAnyPly(std::string_view file)
{
  Viewpoint viewpoint;
  return parsePly(file, viewpoint);
}

pcl::PCLPointCloud2 parseAnyLas(std::string_view file)
{
  LasReader reader(std::make_unique<HeldBytes>(file));
  return reader.readAll();
}

pcl::PCLPointCloud2 parseAnyPtx(std::string_view file)
{
  Viewpoint viewpoint;
  return parsePtx(file, viewpoint);
}

template <typename Write>
std::string written(Write&& write)
{
  std::ostringstream out;
  write(out, randomCloud<float>(5, 2, ply_datatypes));
  return out.str();
}

/// Up to four bytes changed or added, often to ones that mean something; sometimes cut off.
std::string damaged(std::string file, std::mt19937& random)
{
  const std::string telling = "0123456789-.eE \n\r\tnaxyz\xff";
  for (std::size_t hits = 1 + random() % 4; hits > 0; --hits) {
    const std::size_t at = random() % file.size();
    const char byte = random() % 2 ? telling[random() % telling.size()] : static_cast<char>(random());
    if (random() % 4 == 0) {
      file.insert(at, 1, byte);
    }
    else {
      file[at] = byte;
    }
  }
  if (random() % 5 == 0) file.resize(random() % file.size());
  return file;
}

void expectSurvival(const Parse& parse, const std::string& sound)
{
  ASSERT_NO_THROW(parse(sound));
  std::mt19937 random(11);
  std::size_t read = 0;
  constexpr std::size_t rounds = 5000;
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::string file = damaged(sound, random);
    try {
      EXPECT_LE(parse(file).data.size(), 100 * file.size() + 100);
      ++read;
    }
    catch (const FormatError&) {
      // Refused: as good.
    }
  }
  EXPECT_GT(read, 0U);
  EXPECT_LT(read, rounds);
}

} // namespace

TEST(Damage, Pcd)
{
  expectSurvival(parseAnyPcd,
                 written([](std::ostream& out, const auto& cloud) { writePcd(out, cloud, no_viewpoint); }));
  const std::string fields = "VERSION 0.7\nFIELDS x y _ z\nSIZE 4 4 1 4\nTYPE F F U F\nCOUNT 1 1 2 1\nWIDTH 2\n";
  expectSurvival(parseAnyPcd, fields + "HEIGHT 1\nPOINTS 2\nDATA ascii\n1 2 1 7 3\n4 5 1 8 6\n");
  expectSurvival(parseAnyPcd, fields + "HEIGHT 1\nPOINTS 2\nDATA binary\n" + std::string(28, 'x'));
}

TEST(Damage, Ply)
{
  expectSurvival(parseAnyPly, written([](std::ostream& out, const auto& cloud) {
                   writePly(out, cloud, {1, 2, 3, 0.5F, 0.5F, 0.5F, 0.5F});
                 }));
  expectSurvival(parseAnyPly, "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                              "property float z\nproperty list uchar int l\nelement face 1\n"
                              "property list uchar int i\nend_header\n1 2 3 1 7\n4 5 6 1 8\n2 0 1\n");
}

TEST(Damage, Text)
{
  const auto obj = [](std::string_view file) { return parseObj(file); };
  expectSurvival(parseOff, "OFF\n2 1 0\n1 2 3\n4 5 6\n2 0 1\n");
  expectSurvival(obj, "v 1 2 3\nf 1 1 1\n");
  expectSurvival(parseOff, "CNOFF\n2 1 0\n1 2 3 0 0 1 9 8 7 6\n4 5 6 0 1 0 5 4 3 2\n2 0 1\n");
  expectSurvival(obj, "vn 0 0 1\nv 1 2 3 0.2 0.4 1\nf 1//1 1 1\n");
  const auto columns = [](std::string_view file) { return parseColumns(file); };
  expectSurvival(columns, "x y z i\n1 2 3 4\n5 6 7 8\n");
  expectSurvival(columns, "//X,Y,Z,R,G,B\n1,2,3,40,50,60\n5,6,7,8,9,10\n");
}

TEST(Damage, Las)
{
  LasSample sample(4, 7, 6);
  sample.records = {LasSample::record(
      "LASF_Spec", 4, LasSample::descriptor(3, "width", 25, 0.1, 3, 9) + LasSample::descriptor(9, "more"))};
  sample.extended = {LasSample::extendedRecord("somebody", 9, "more")};
  sample.addPoints(2);
  expectSurvival(parseAnyLas, sample.text());
}

TEST(Damage, Scans)
{
  expectSurvival([](std::string_view file) { return parsePts(file); }, "2\n1 2 3 -4 50 60 70\n5 6 7 8 9 10 11\n");
  const std::string head = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n";
  expectSurvival(parseAnyPtx, "1\n2\n" + head + "1 2 3 0.5\n0 0 0 0.5\n1\n1\n" + head + "4 5 6 1\n");
}

} // namespace pcl_bsh::io
