// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/write_data.h>

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkXMLMultiBlockDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <stdexcept>

namespace pcl_bsh::vtk {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path)
{
  throw std::runtime_error(path.string() +
                           ": cannot be written: give a folder that exists and may be written to, on a " +
                           "disk with space");
}

/// A folder beside the file to come, gone at the end: what is renamed out of it appears at once.
class Workshop {
public:
  explicit Workshop(const fs::path& path) : path_(path), folder_(path.string() + ".part")
  {
    std::error_code failed;
    fs::remove_all(folder_, failed);
    if (!fs::create_directory(folder_, failed) || failed) fail(path);
  }
  ~Workshop()
  {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  fs::path file(const fs::path& name) const { return folder_ / name; }

  void deliver(const fs::path& name) const
  {
    std::error_code failed;
    const fs::path target = path_.parent_path() / name;
    if (fs::is_directory(folder_ / name)) fs::remove_all(target, failed);
    fs::rename(folder_ / name, target, failed);
    if (failed) fail(target);
  }

private:
  fs::path path_, folder_;
};

template <class Writer>
void run(Writer& writer, const fs::path& file, const fs::path& path)
{
  writer.SetFileName(file.c_str());
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  writer.SetCompressorTypeToNone();
  writer.SetGlobalWarningDisplay(0);
  if (writer.Write() != 1 || writer.GetErrorCode() != 0 || !fs::exists(file)) fail(path);
}

} // namespace

void writeVtp(vtkPolyData& data, const fs::path& path)
{
  const Workshop workshop(path);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  run(*writer, workshop.file(path.filename()), path);
  workshop.deliver(path.filename());
}

void writeVtm(const std::vector<NamedData>& blocks, const fs::path& path)
{
  const Workshop workshop(path);
  vtkNew<vtkMultiBlockDataSet> all;
  for (unsigned i = 0; i < blocks.size(); ++i) {
    all->SetBlock(i, blocks[i].second);
    all->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), blocks[i].first.c_str());
  }
  vtkNew<vtkXMLMultiBlockDataWriter> writer;
  writer->SetInputData(all);
  run(*writer, workshop.file(path.filename()), path);
  if (fs::exists(workshop.file(path.stem()))) workshop.deliver(path.stem());
  workshop.deliver(path.filename());
}

} // namespace pcl_bsh::vtk
