// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/new_file.h>

#include <gtest/gtest.h>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

TEST(NewFile, GoesOnWhereAnEarlierRunEnded)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "written, and half of");
  {
    NewFile again(file, 8);
    again.append("anew");
  }
  EXPECT_EQ(contentOf(file), "written,anew") << "and stays";
}

TEST(NewFile, RefusesWhatHasBecomeShorterOrIsGone)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "short");
  EXPECT_NO_THROW(NewFile(file, 5));
  for (const fs::path& wrong : {file, folder / "none"}) {
    try {
      const NewFile again(wrong, 6);
      ADD_FAILURE() << wrong;
    }
    catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("is shorter than it was when it was last written: remove the folder"),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_EQ(contentOf(file), "short");
  EXPECT_EQ(folder.files(), 1U);
}

} // namespace pcl_bsh::files
