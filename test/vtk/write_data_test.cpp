// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/vtk/write_data.h>

#include <gtest/gtest.h>

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkXMLMultiBlockDataReader.h>

#include <sys/resource.h>

#include <csignal>
#include <iterator>
#include <set>
#include <stdexcept>

namespace pcl_bsh::vtk {
namespace {

namespace fs = std::filesystem;
using files::contentOf;
using files::TemporaryFolder;

vtkSmartPointer<vtkPolyData> dataOf(int points)
{
  vtkNew<vtkPoints> coordinates;
  for (int i = 0; i < points; ++i) coordinates->InsertNextPoint(i, 0, 0);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(coordinates);
  return data;
}

std::set<std::string> namesIn(const fs::path& folder)
{
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

std::string failureOf(const fs::path& path)
{
  for (const bool early : {true, false}) {
    try {
      early ? requireWritableData(path) : writeVtm({{"a", dataOf(1)}}, path);
      ADD_FAILURE() << path << " is written";
    }
    catch (const std::runtime_error& error) {
      if (!early) return error.what();
    }
  }
  return {};
}

/// Points of each block, by VTK's own reader.
std::vector<std::pair<std::string, vtkIdType>> read(const fs::path& path)
{
  vtkNew<vtkXMLMultiBlockDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  auto* const all = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  std::vector<std::pair<std::string, vtkIdType>> blocks;
  for (unsigned i = 0; all != nullptr && i < all->GetNumberOfBlocks(); ++i) {
    auto* const block = vtkPolyData::SafeDownCast(all->GetBlock(i));
    blocks.emplace_back(all->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()),
                        block != nullptr ? block->GetNumberOfPoints() : -1);
  }
  return blocks;
}

/// VTK's own writer of files crashes there.
TEST(WriteVtm, LeavesNothingOnAFullDisk)
{
  const TemporaryFolder folder;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const rlim_t room : {rlim_t{0}, rlim_t{300}, rlim_t{4000}}) {
    const rlimit limits = {room, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limits);
    EXPECT_THROW(writeVtm({{"a", dataOf(5000)}}, folder / "a.vtm"), files::FileError);
    EXPECT_THROW(writeVtp(*dataOf(5000), folder / "a.vtp"), files::FileError);
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(folder.files(), 0U);
  }
}

/// A failed file is not removed once more when the program is told to stop: by then it may be another file.
TEST(WriteVtm, ForgetsWhatItCouldNotWrite)
{
  const TemporaryFolder written, failed;
  writeVtm({{"a", dataOf(5000)}}, written / "a.vtm");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limits = {4000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limits);
  EXPECT_THROW(writeVtm({{"a", dataOf(5000)}}, failed / "a.vtm"), files::FileError);
  setrlimit(RLIMIT_FSIZE, &before);
  const fs::path source = (written / "a.vtm").parent_path(), target = (failed / "a.vtm").parent_path();
  fs::copy(source, target, fs::copy_options::recursive); // of somebody else
  const auto count = [](const fs::path& folder) {
    return std::distance(fs::recursive_directory_iterator(folder), fs::recursive_directory_iterator());
  };
  static_cast<void>(files::discardUnfinished());
  EXPECT_GE(count(target), 3);
  EXPECT_EQ(count(target), count(source));
}

TEST(WriteVtm, VtkReadsItBack)
{
  const TemporaryFolder folder;
  const fs::path file = folder / "a & \"b\".vtm";
  writeVtm({{"one <1>", dataOf(3)}, {"two", dataOf(5)}}, file);
  EXPECT_EQ(read(file), (std::vector<std::pair<std::string, vtkIdType>>{{"one <1>", 3}, {"two", 5}}));
  writeVtm({{"three", dataOf(7)}}, file);
  EXPECT_EQ(read(file), (std::vector<std::pair<std::string, vtkIdType>>{{"three", 7}}));
  EXPECT_EQ(namesIn(folder / "a & \"b\"").size(), 1U) << "the earlier blocks are gone";
}

/// XML has no place for them.
TEST(WriteVtm, ControlCharactersOfANameAreQuestionMarks)
{
  const TemporaryFolder folder;
  writeVtm({{"a\nb\x1f \x7f'", dataOf(1)}}, folder / "a.vtm");
  EXPECT_EQ(read(folder / "a.vtm").at(0).first, "a?b? \x7f'");
}

TEST(WriteVtm, RemovesOnlyWhatAnEarlierListNames)
{
  const TemporaryFolder folder;
  const fs::path file = folder / "hall.vtm";
  fs::create_directory(folder / "hall");
  // As VTK's own writer names them; the second is of nobody.
  folder.write("hall/hall_0.vtp", "old");
  folder.write("hall/hall_1.vtp", "other");
  folder.write("secret_0.vtp", "outside");
  folder.write("hall.vtm", "<DataSet index=\"0\" file=\"hall/hall_0.vtp\"/><DataSet file=\"hall/../secret_0.vtp\"/>"
                           "<DataSet file=\"hall/hall_../../secret_0.vtp\"/>");
  writeVtm({{"a", dataOf(1)}}, file);
  EXPECT_EQ(namesIn(folder / "hall"), (std::set<std::string>{"hall_0_0.vtp", "hall_1.vtp"}));
  EXPECT_EQ(contentOf(folder / "hall/hall_1.vtp"), "other");
  EXPECT_EQ(contentOf(folder / "secret_0.vtp"), "outside");
}

TEST(WriteVtm, AFolderOfTheUsersIsInTheWay)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "hall");
  folder.write("hall/scan.pcd", "mine");
  const std::string message = failureOf(folder / "hall.vtm");
  EXPECT_NE(message.find("and holds scan.pcd, which is not a block: name another .vtm"), std::string::npos) << message;
  EXPECT_EQ(namesIn(folder.path()), std::set<std::string>{"hall"});
  EXPECT_EQ(contentOf(folder / "hall/scan.pcd"), "mine");

  folder.write("file", "mine");
  EXPECT_NE(failureOf(folder / "file.vtm").find("is in the way"), std::string::npos);
  EXPECT_EQ(contentOf(folder / "file"), "mine");
  EXPECT_EQ(folder.files(), 2U);
}

/// hall_<number>.vtp and hall_<number>_<number>.vtp may be there: anything else is the user's.
TEST(WriteVtm, TellsFilesOfTheUsersFromBlocks)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "hall");
  for (const char* const name :
       {"ball_0.vtp", "hall_0.vtq", "hall.vtp", "hall_.vtp", "hall0.vtp", "hall_0_.vtp", "hall__0.vtp", "hall_0__1.vtp",
        "hall_0_1_2.vtp", "hall_x.vtp", "hall_:.vtp", "hall_-1.vtp", "hall0_1.vtp", "vtp", "hall_0"}) {
    const fs::path file = folder / "hall" / name;
    folder.write(std::string("hall/") + name, "mine");
    EXPECT_NE(failureOf(folder / "hall.vtm").find(std::string("and holds ") + name + ", which is not a block"),
              std::string::npos)
        << name;
    EXPECT_NO_THROW(requireWritableData(folder / "hall.vtp")) << "which has no blocks";
    EXPECT_EQ(contentOf(file), "mine");
    fs::remove(file);
  }
  for (const char* const name : {"hall_0.vtp", "hall_9.vtp", "hall_10_0.vtp", "hall_0_19.vtp"})
    folder.write(std::string("hall/") + name, "block");
  EXPECT_NO_THROW(requireWritableData(folder / "hall.vtm"));
  writeVtm({{"a", dataOf(1)}}, folder / "hall.vtm");
  EXPECT_EQ(namesIn(folder / "hall").count("hall_1_0.vtp"), 1U) << "there is one of generation 0";
}

TEST(WriteVtm, LeavesNothingWhenItFails)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "out.vtm"); // is no file
  EXPECT_THROW(writeVtm({{"a", dataOf(1)}}, folder / "out.vtm"), std::runtime_error);
  EXPECT_THROW(writeVtm({{"a", dataOf(1)}}, folder / "none/out.vtm"), std::runtime_error);
  EXPECT_THROW(writeVtp(*dataOf(1), folder / "none/out.vtp"), std::runtime_error);
  EXPECT_EQ(folder.files(), 1U);
}

} // namespace
} // namespace pcl_bsh::vtk
