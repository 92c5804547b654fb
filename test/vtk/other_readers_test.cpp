// SPDX-License-Identifier: BSD-3-Clause
// VTK's readers see the points, colours and normals of the files that are written; what its writers write is read
// alike.
#include "io/clouds/samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gtest/gtest.h>

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>

namespace pcl_bsh::io {
namespace {

constexpr std::size_t count = 50;

pcl::PCLPointCloud2 samples()
{
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "rgb", "normal_x", "normal_y", "normal_z"})
    addField(cloud, name, Field::FLOAT32);
  allocate(cloud, count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<float>(i);
    const float xyz[] = {k / 3, -k, 1e-3F * k}, normal[] = {std::sin(k), std::cos(k), 0};
    const auto colour = static_cast<std::uint32_t>(((255 - i) << 16) | (i << 8) | (7 * i % 256));
    std::uint8_t* const record = &cloud.data[i * cloud.point_step];
    std::memcpy(record, xyz, sizeof xyz);
    std::memcpy(record + 12, &colour, sizeof colour);
    std::memcpy(record + 16, normal, sizeof normal);
  }
  return cloud;
}

template <typename Reader>
vtkSmartPointer<vtkPolyData> readBy(const std::filesystem::path& file)
{
  const vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

void expectPoints(vtkPolyData& data, const pcl::PCLPointCloud2& cloud)
{
  ASSERT_EQ(data.GetNumberOfPoints(), static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const double* const p = data.GetPoint(static_cast<vtkIdType>(i));
    EXPECT_EQ(static_cast<float>(p[0]), valueOf(cloud, i, "x")) << i;
    EXPECT_EQ(static_cast<float>(p[1]), valueOf(cloud, i, "y")) << i;
    EXPECT_EQ(static_cast<float>(p[2]), valueOf(cloud, i, "z")) << i;
  }
}

void expectNormals(vtkPolyData& data, const pcl::PCLPointCloud2& cloud)
{
  vtkDataArray* const normals = data.GetPointData()->GetNormals();
  ASSERT_NE(normals, nullptr);
  for (std::size_t i = 0; i < count; ++i) {
    const double* const n = normals->GetTuple3(static_cast<vtkIdType>(i));
    EXPECT_EQ(static_cast<float>(n[0]), valueOf(cloud, i, "normal_x")) << i;
    EXPECT_EQ(static_cast<float>(n[1]), valueOf(cloud, i, "normal_y")) << i;
  }
}

TEST(OtherReaders, VtkReadsPly)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = samples();
  writeCloud(folder / "a.ply", cloud, {1, 2, 3, 0.5F, 0.5F, 0.5F, 0.5F});
  const auto data = readBy<vtkPLYReader>(folder / "a.ply");
  expectPoints(*data, cloud);
  expectNormals(*data, cloud);
  vtkDataArray* const colours = data->GetPointData()->GetArray("RGB");
  ASSERT_NE(colours, nullptr);
  for (std::size_t i = 0; i < count; ++i) {
    const double* const c = colours->GetTuple3(static_cast<vtkIdType>(i));
    const std::uint32_t colour = colourOf(cloud, i);
    EXPECT_EQ(c[0], colour >> 16 & 255U) << i;
    EXPECT_EQ(c[1], colour >> 8 & 255U) << i;
    EXPECT_EQ(c[2], colour & 255U) << i;
  }
}

TEST(OtherReaders, VtkReadsObj)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = samples();
  writeCloud(folder / "a.obj", cloud);
  expectPoints(*readBy<vtkOBJReader>(folder / "a.obj"), cloud);
}

TEST(OtherReaders, WhatVtkWritesIsRead)
{ // which has no normals
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = samples();
  const vtkNew<vtkPoints> points;
  const vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetName("RGB");
  for (std::size_t i = 0; i < count; ++i) {
    points->InsertNextPoint(valueOf(cloud, i, "x"), valueOf(cloud, i, "y"), valueOf(cloud, i, "z"));
    const std::uint32_t colour = colourOf(cloud, i);
    colours->InsertNextTuple3(colour >> 16 & 255U, colour >> 8 & 255U, colour & 255U);
  }
  const vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->SetScalars(colours);
  const vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(data);
  writer->SetArrayName("RGB");
  const std::string name = (folder / "a.ply").string();
  writer->SetFileName(name.c_str());
  for (const int order : {VTK_LITTLE_ENDIAN, VTK_BIG_ENDIAN, -1}) {
    order < 0 ? writer->SetFileTypeToASCII() : writer->SetFileTypeToBinary();
    if (order >= 0) writer->SetDataByteOrder(order);
    ASSERT_EQ(writer->Write(), 1);
    const pcl::PCLPointCloud2 read = readCloud(name);
    ASSERT_EQ(read.width, count) << order;
    for (std::size_t i = 0; i < count; ++i) {
      for (const char* field : {"x", "y", "z"})
        EXPECT_NEAR(valueOf(read, i, field), valueOf(cloud, i, field), order < 0 ? 1e-4 : 0) << order << ' ' << field;
      EXPECT_EQ(colourOf(read, i), colourOf(cloud, i)) << order << ' ' << i;
    }
  }
}

} // namespace
} // namespace pcl_bsh::io
