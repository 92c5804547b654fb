// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_gauge about a site says what it says about the file of all its points.
#include "two_ranks.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <iomanip>
#include <map>
#include <memory>
#include <random>
#include <sstream>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A line with a curve and profiles about it, and two scans beside one another, of points with times.
class GaugeSite : public testing::Test {
protected:
  static void SetUpTestSuite()
  {
    folder = std::make_unique<files::TemporaryFolder>();
    folder->write("line.axis", "start 500000 4000000 90\nchainage 100\nstraight 20\narc 40 60\nheight 100 30\n");
    folder->write("box.csv", "offset,height\n-1.5,0\n1.5,0\n1.5,4\n-1.5,4\n");
    folder->write("tall.csv", "offset,height\n-1,0\n1,0\n1,5\n-1,5\n");
    folder->write("path.csv", "time,x,y,z\n0,500000,4000000,32\n15,500020,4000000,32\n");
    std::mt19937 random(11);
    const auto within = [&](double least, double most) { return std::uniform_real_distribution(least, most)(random); };
    std::array<std::ostringstream, 2> scans;
    for (int i = 0; i < 6000; ++i) {
      std::ostringstream& scan = scans[i < 3500 ? 0 : 1];
      scan << std::setprecision(12) << within(499995, 500070) << ',' << within(3999960, 4000010) << ','
           << within(28, 38) << ',' << within(0, 20) << '\n';
    }
    const std::string names = "x,y,z,gps_time\n";
    folder->write("a.csv", names + scans[0].str());
    folder->write("b.csv", names + scans[1].str() + "nan,nan,nan,3\n");
    folder->write("all.csv", names + scans[0].str() + scans[1].str() + "nan,nan,nan,3\n");
    made = run("pcl_bsh_site", "make a.csv b.csv --tile-points 400 --out valley", folder->path());
  }

  static void TearDownTestSuite() { folder.reset(); }

  /// All that a run writes, without the name of its scan. @param command gauges INPUT
  template <class Command>
  std::map<std::string, std::string> answers(const std::string& input, const Command& command)
  {
    const Outcome done =
        command(input + " --axis line.axis --profile box.csv --profile tall.csv --origin-path path.csv "
                        "--seen-spacing 0.5 --table told/table.csv --infringements told/list.csv --report "
                        "told/report.json --page told/page.html --sections told/sections --at 110 --threads 1",
                (fs::create_directory(*folder / "told"), folder->path()));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    std::map<std::string, std::string> all = {{"said", done.out}, {"warned", done.told()}};
    for (const auto& entry : fs::recursive_directory_iterator(*folder / "told"))
      if (entry.is_regular_file()) all[entry.path().filename()] = files::contentOf(entry.path());
    fs::remove_all(*folder / "told");
    for (auto& [name, text] : all)
      for (std::size_t at; (at = text.find(input)) != std::string::npos;) text.replace(at, input.size(), "SCAN");
    return all;
  }

  static Outcome runHere(const std::string& arguments, const fs::path& place)
  {
    return run("pcl_bsh_gauge", arguments, place);
  }

  static Outcome runOnRanks(const std::string& arguments, const fs::path& place)
  {
    return runOnTwoRanks(arguments, place, "pcl_bsh_gauge");
  }

  static std::unique_ptr<files::TemporaryFolder> folder;
  static Outcome made;
};

std::unique_ptr<files::TemporaryFolder> GaugeSite::folder;
Outcome GaugeSite::made;

TEST_F(GaugeSite, SaysWhatAFileSays)
{
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto of_file = answers("all.csv", runHere), of_site = answers("valley", runHere);
  EXPECT_THAT(of_file.at("said"), HasSubstr("1 not finite"));
  EXPECT_THAT(of_file.at("warned"), HasSubstr("does not have, the first record"));
  EXPECT_GT(nlohmann::json::parse(of_file.at("report.json"))["infringements"].size(), 10U);
  EXPECT_GT(of_file.size(), 10U) << "sections, too";
  EXPECT_EQ(of_site, of_file);
}

TEST_F(GaugeSite, SaysTheSameOnTwoRanks)
{
  if (!hasMpirun()) GTEST_SKIP() << "no mpirun";
  EXPECT_EQ(answers("valley", runOnRanks), answers("valley", runHere));
  const Outcome failed = runOnTwoRanks("valley --axis line.axis --profile box.csv --table nowhere/table.csv",
                                       folder->path(), "pcl_bsh_gauge");
  EXPECT_NE(failed.exit_code, 0) << "and ends";
  EXPECT_THAT(failed.err, HasSubstr("nowhere/table.csv"));
}

/// Sums are right, and tiles have records that their source has not.
TEST_F(GaugeSite, RefusesRecordsThatNoSourceHas)
{
  fs::copy(*folder / "valley", *folder / "swapped", fs::copy_options::recursive);
  auto json = nlohmann::json::parse(files::contentOf(*folder / "swapped/site.json"));
  std::swap(json["sources"][0]["points"], json["sources"][1]["points"]);
  folder->write("swapped/site.json", json.dump());
  const Outcome refused = runHere("swapped --axis line.axis --profile box.csv", folder->path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.told(), "pcl_bsh_gauge: swapped: its tiles do not hold each record once: make the site again\n");
}

TEST_F(GaugeSite, RefusesWhatIsOfFiles)
{
  const std::string rest = " --axis line.axis --profile box.csv ";
  for (const auto& [arguments, line] :
       {std::pair<std::string, const char*>{"valley out.pcd" + rest, "OUTPUT: is written of a file, not of a site"},
        {"valley --to-crs EPSG:25832" + rest, "--to-crs: is for files: make the site with it"},
        {"valley --columns x,y,z" + rest, "--columns: x,y,z:"}}) {
    const Outcome refused = runHere(arguments, folder->path());
    EXPECT_EQ(refused.exit_code, 2) << arguments;
    EXPECT_THAT(refused.err, HasSubstr(line)) << arguments;
  }
  fs::create_directory(*folder / "empty");
  const Outcome no_site = runHere("empty" + rest, folder->path());
  EXPECT_EQ(no_site.exit_code, 1);
  EXPECT_THAT(no_site.err, testing::StartsWith("pcl_bsh_gauge: empty"));
}

} // namespace
} // namespace pcl_bsh::site
