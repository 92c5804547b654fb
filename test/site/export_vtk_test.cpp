// SPDX-License-Identifier: BSD-3-Clause
// A site in pieces for ParaView, read again by VTK.
#include "tools/programs/program_run.h"

#ifdef PCL_BSH_SITE_VTK
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/site/export_vtk.h>
#include <pcl_bsh/site/make_site.h>

#include <gmock/gmock.h>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPPolyDataReader.h>

#include <cmath>
#include <limits>
#include <set>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(SitePieces, AreReadByVtk)
{
  const files::TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud = io::randomCloud<double>(900, 1, io::ply_datatypes);
  for (std::size_t i = 0; i < 900; i += 90) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    std::memcpy(&cloud.data[i * cloud.point_step + 8], &none, sizeof none);
  }
  io::writeCloud(folder / "a.pcd", cloud);
  MakeOptions options;
  options.tile_points = 100;
  const Site site = makeSite({folder / "a.pcd"}, folder / "site", options);
  exportPieces(site, folder / "pieces.pvtp");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "pieces"), fs::directory_iterator()), site.tiles.size());

  std::set<std::uint32_t> records;
  const int pieces = 3; // as three processes of ParaView read it
  for (int piece = 0; piece < pieces; ++piece) {
    const vtkNew<vtkXMLPPolyDataReader> reader;
    reader->SetFileName((folder / "pieces.pvtp").c_str());
    reader->UpdatePiece(piece, pieces, 0);
    vtkPolyData& data = *reader->GetOutput();
    EXPECT_GT(data.GetNumberOfPoints(), 100);
    EXPECT_LT(data.GetNumberOfPoints(), 500);
    EXPECT_EQ(data.GetPoints()->GetDataType(), VTK_DOUBLE);
    EXPECT_EQ(data.GetVerts()->GetNumberOfConnectivityIds(), data.GetNumberOfPoints());
    for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) {
      const auto array = [&](const char* name) { return data.GetPointData()->GetArray(name); };
      const auto record = static_cast<std::uint32_t>(array("record")->GetTuple1(i));
      EXPECT_TRUE(records.insert(record).second);
      const std::uint8_t* const bytes = &cloud.data[record * cloud.point_step];
      EXPECT_EQ(std::memcmp(data.GetPoint(i), bytes, 24), 0);
      for (const auto& field : cloud.fields) {
        if (field.name.size() == 1) continue;
        ASSERT_NE(array(field.name.c_str()), nullptr) << field.name;
        ASSERT_EQ(array(field.name.c_str())->GetNumberOfComponents(), static_cast<int>(field.count));
        const std::size_t size = io::sizeOf(field);
        const auto* const values = static_cast<const std::uint8_t*>(array(field.name.c_str())->GetVoidPointer(0));
        EXPECT_EQ(std::memcmp(values + static_cast<std::size_t>(i) * size, bytes + field.offset, size), 0)
            << field.name;
      }
    }
  }
  EXPECT_EQ(records.size(), 890u) << "the finite points";

  EXPECT_THROW(exportPieces(site, folder / "site.pvtp"), files::FileError) << "the folder is the user's";
  EXPECT_FALSE(fs::exists(folder / "site.pvtp"));
  const auto stop = [](std::uint64_t done, std::uint64_t) { return done < 300; };
  EXPECT_THROW(exportPieces(site, folder / "new.pvtp", stop), Cancelled);
  EXPECT_FALSE(fs::exists(folder / "new.pvtp"));
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST(SitePieces, HaveNamesOfAnyLetters)
{
  const files::TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z", "a&b", "c<d>", "e\"f", "g'h"})
    io::addField(cloud, axis, pcl::PCLPointField::FLOAT32);
  io::allocate(cloud, 3);
  io::writeCloud(folder / "a.pcd", cloud);
  const Site site = makeSite({folder / "a.pcd"}, folder / "site");
  const fs::path file = folder / "p & <q> \"r\".pvtp";
  exportPieces(site, file);
  const vtkNew<vtkXMLPPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 3);
  for (const char* const name : {"a&b", "c<d>", "e\"f", "g'h", "record"})
    EXPECT_NE(reader->GetOutput()->GetPointData()->GetArray(name), nullptr) << name;
}

TEST(SitePieces, TakeAnEmptyFolderAndNoFile)
{
  const files::TemporaryFolder folder;
  folder.write("a.xyz", "x y z\n1 2 3\n4 5 6\n");
  const Site site = makeSite({folder / "a.xyz"}, folder / "site");
  fs::create_directory(folder / "empty");
  exportPieces(site, folder / "empty.pvtp");
  EXPECT_FALSE(fs::is_empty(folder / "empty"));
  folder.write("taken", "");
  EXPECT_THROW(exportPieces(site, folder / "taken.pvtp"), files::FileError);
  EXPECT_TRUE(fs::is_regular_file(folder / "taken"));
  EXPECT_FALSE(fs::exists(folder / "taken.pvtp"));
}

TEST(SitePieces, ByTheProgram)
{
  const files::TemporaryFolder folder;
  folder.write("a.xyz", "x y z\n1 2 3\n4 5 6\n");
  makeSite({folder / "a.xyz"}, folder / "site");
  const auto made = run("pcl_bsh_site", "export site all.pvtp", folder.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("wrote all.pvtp in 1 pieces"));
  EXPECT_EQ(run("pcl_bsh_site", "export site all.pvtp", folder.path()).exit_code, 1) << "is there already";
}

} // namespace
} // namespace pcl_bsh::site
#endif
