// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/vtk/block_files.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <stdexcept>
#include <system_error>

namespace pcl_bsh::vtk {
namespace {

namespace fs = std::filesystem;

/// What is exported is read by name, and has files of its own beside it: not a pipe or a device.
void requireFile(const fs::path& path)
{
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw files::FileError(path, "is no ordinary file", "name another file");
}

/// As a text, since VTK's writer crashes where a disk is full (9.1: vtkXMLUnstructuredDataWriter frees what it has not
/// set).
void fill(files::FileReplacement& file, vtkPolyData& data)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  writer->WriteToOutputStringOn();
  writer->SetDataModeToBinary(); // appended data is refused by expat since its mends of 2024
  writer->SetCompressorTypeToNone();
  if (writer->Write() != 1) throw std::runtime_error("VTK: could not write poly data as XML");
  file.stream() << writer->GetOutputString();
}

} // namespace

void writeVtp(vtkPolyData& data, const fs::path& path)
{
  requireFile(path);
  files::FileReplacement file(path);
  fill(file, data);
  file.commit();
}

void writeVtm(const std::vector<NamedData>& blocks, const fs::path& path)
{
  requireFile(path);
  files::FileReplacement list(path);
  BlockFiles pieces(path);
  pieces.makeFolder();
  for (const NamedData& block : blocks) {
    const fs::path name = pieces.next();
    files::FileReplacement file(name);
    fill(file, *block.second);
    pieces.commit(file, name, block.first);
  }
  list.stream() << pieces.list();
  list.commit([&] { pieces.keep(); }); // a program that is stopped here leaves either list with its blocks
  pieces.removeEarlier();
}

void requireWritableData(const fs::path& path)
{
  requireFile(path);
  files::requireWritable(path);
  if (path.extension() == ".vtm") static_cast<void>(BlockFiles(path));
}

} // namespace pcl_bsh::vtk
