// SPDX-License-Identifier: BSD-3-Clause
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

class CertifyProgram : public testing::Test {
protected:
  CertifyProgram() { io::writeCloud(cloud, io::randomCloud<double>(500, 1, {})); }

  /// One line, the code, and nothing written.
  void expectFailure(const std::string& arguments, int exit_code, const std::string& message) const
  {
    const std::size_t files = folder.files();
    const Outcome failed = run("pcl_bsh_certify", arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments;
    EXPECT_THAT(failed.err, StartsWith("pcl_bsh_certify: ")) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(failed.out, "");
    EXPECT_EQ(folder.files(), files) << arguments;
  }

  const io::TemporaryFolder folder;
  const std::string cloud = (folder / "cloud.pcd").string();
  const std::string report = (folder / "report.json").string();
};

} // namespace

TEST_F(CertifyProgram, EveryFit)
{
  const Outcome done = run("pcl_bsh_certify", cloud + " --report " + report);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Certified"));
  const Json json = Json::parse(io::contentOf(report));
  EXPECT_EQ(json["holds"], true);
  EXPECT_EQ(json["cloud"]["points"], 500);
  ASSERT_EQ(json["fits"].size(), 3U);
  for (const Json& fit : json["fits"]) {
    EXPECT_THAT(done.out, HasSubstr(fit["fit"].get<std::string>()));
    EXPECT_EQ(fit["finite"], 500);
    EXPECT_EQ(fit["total"]["leaks"], 0);
    EXPECT_EQ(fit["missing_points"], 0);
    EXPECT_GE(fit["levels"].size(), 3U);
    const Json& ratio = fit["total"]["radius_ratio"];
    EXPECT_GT(ratio["measured"], 10);
    EXPECT_GE(ratio["mean"], 1.0);
    EXPECT_GE(ratio["worst"], ratio["mean"]);
    EXPECT_EQ(ratio["histogram"]["spheres"].size(), ratio["histogram"]["below"].size() + 1);
  }
}

TEST_F(CertifyProgram, OneFitAndSample)
{
  const Outcome done = run("pcl_bsh_certify", cloud + " --fit minimal --sample 2 --threads 2 --report " + report);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const Json json = Json::parse(io::contentOf(report));
  ASSERT_EQ(json["fits"].size(), 1U);
  EXPECT_EQ(json["fits"][0]["fit"], "minimal");
  for (const Json& level : json["fits"][0]["levels"]) EXPECT_LE(level["radius_ratio"]["measured"], 2);
  EXPECT_EQ(run("pcl_bsh_certify", cloud + " --fit box --sample all").exit_code, 0);
}

TEST_F(CertifyProgram, Help)
{
  const Outcome help = run("pcl_bsh_certify", "--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* text : {"CLOUD", "--fit", "--sample", "--report", "--threads", "Example:", "GPL"})
    EXPECT_THAT(help.out, HasSubstr(text));
}

TEST_F(CertifyProgram, Refusals)
{
  expectFailure("", 2, "CLOUD");
  expectFailure(cloud + " --fit tight", 2, "--fit: 'tight'");
  expectFailure(cloud + " --sample some", 2, "--sample: ");
  expectFailure(cloud + " --threads -1", 2, "--threads: ");
  expectFailure(cloud + " --report " + cloud, 2, "--report: ");
  expectFailure(cloud + " --report " + (folder / "none/report.json").string(), 1, "no folder");
  expectFailure((folder / "none.pcd").string(), 1, "no such file");
  expectFailure(folder.write("bad.xyz", "nan 0 0\n").string(), 1, "no finite point");
  expectFailure(folder.write("cut.ply", "ply\n").string(), 1, "truncated");
}

} // namespace pcl_bsh
