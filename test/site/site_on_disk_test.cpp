// SPDX-License-Identifier: BSD-3-Clause
// A loss of power leaves a whole site or none: all of its files are on the disk before the document that tells of them.
#include "io/clouds/samples.h"
#include "support/disk_calls.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/site/make_site.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cerrno>

namespace pcl_bsh::site {
namespace {

using testing::Contains;
using testing::Each;
using testing::Not;
using testing::StartsWith;

class SiteOnDisk : public testing::Test {
protected:
  SiteOnDisk() { io::writeCloud(folder / "cloud.pcd", io::randomCloud<float>(2000, 1, {})); }

  Site make(std::uint64_t save_points = 50'000'000) const
  {
    MakeOptions options;
    options.tile_points = 500;
    options.save_points = save_points;
    options.threads = 1;
    return makeSite({folder / "cloud.pcd"}, folder / "site", options);
  }

  /// Expects that the file of this name appears after all earlier writes are on the disk, and is there before later
  /// calls.
  /// @return how often
  static int appearancesAfterAll(const std::vector<std::string>& calls, const std::string& name)
  {
    const std::vector<std::string> expected = {"syncfs site", "write " + name + ".part0", "fsync " + name + ".part0",
                                               "rename " + name + ".part0 " + name, "fsync site"};
    int found = 0;
    for (std::size_t i = 0; i < calls.size(); ++i) {
      if (calls[i] != expected[3]) continue;
      ++found;
      const std::size_t first = i < 3 ? 0 : i - 3;
      EXPECT_EQ(std::vector<std::string>(calls.begin() + static_cast<std::ptrdiff_t>(first),
                                         calls.begin() + static_cast<std::ptrdiff_t>(std::min(i + 2, calls.size()))),
                expected);
    }
    return found;
  }

  const files::TemporaryFolder folder;
};

TEST_F(SiteOnDisk, TilesBeforeTheDocument)
{
  test::DiskCalls disk;
  make();
  EXPECT_THAT(disk.calls, Contains(StartsWith("write tile_0"))) << "tiles";
  EXPECT_EQ(appearancesAfterAll(disk.calls, "site.json"), 1);
}

TEST_F(SiteOnDisk, TilesBeforeWhatIsNotedOfThem)
{
  test::DiskCalls disk;
  make(600);
  EXPECT_GE(appearancesAfterAll(disk.calls, "unfinished_site.state"), 3);
  EXPECT_EQ(appearancesAfterAll(disk.calls, "site.json"), 1);
}

TEST_F(SiteOnDisk, IsNoSiteWhereItsTilesCannotBeBroughtToTheDisk)
{
  {
    test::DiskCalls disk;
    disk.failing["syncfs site"] = EIO;
    EXPECT_THROW(make(), files::FileError);
    EXPECT_THAT(disk.calls, Each(Not(StartsWith("write site.json"))));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "site/site.json"));
  EXPECT_NO_THROW(make());
}

} // namespace
} // namespace pcl_bsh::site
