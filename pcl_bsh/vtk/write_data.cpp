// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/vtk/block_files.h>
#include <pcl_bsh/vtk/write_data.h>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <system_error>

namespace pcl_bsh::vtk {
namespace {

namespace fs = std::filesystem;

/// VTK's writer goes back in its file, which a pipe or a device cannot.
void requireFile(const fs::path& path)
{
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw files::FileError(path, "is no ordinary file", "name another file");
}

/// Fills the file that is to be renamed to `path`, and tells it by that name when this fails.
void fill(files::FileReplacement& file, vtkPolyData& data, const fs::path& path)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  writer->SetFileName(file.name().c_str());
  writer->SetDataModeToBinary(); // appended data is refused by expat since its mends of 2024
  writer->SetCompressorTypeToNone();
  const int displayed = vtkObject::GetGlobalWarningDisplay(); // of the whole process
  vtkObject::GlobalWarningDisplayOff();
  const int written = writer->Write();
  vtkObject::SetGlobalWarningDisplay(displayed);
  std::error_code error; // VTK removes what it could not write to the end
  if (written != 1 || writer->GetErrorCode() != 0 || !fs::exists(file.name(), error))
    throw files::FileError(path, "cannot be written", "choose a folder with room that you may write to");
}

} // namespace

void writeVtp(vtkPolyData& data, const fs::path& path)
{
  requireFile(path);
  files::FileReplacement file(path);
  fill(file, data, path);
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
    fill(file, *block.second, name);
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
