// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/free_space.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/site/export_site.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <string>

namespace pcl_bsh::site {

namespace fs = std::filesystem;

namespace {

/// Writes some sources one after the other, window by window. A window has as many records as memory can hold, and
/// collects them from all tiles.
class Exporter {
public:
  Exporter(const Site& site, std::size_t first, std::size_t last, const Fields& fields, const ExportOptions& options)
  : site_(site),
    first_(first),
    layout_(layoutOf(fields)),
    copy_(site.fields, layout_),
    options_(options)
  {
    for (std::size_t i = 0; i < site.sources.size(); ++i) {
      begins_.push_back(points_);
      if (i >= first && i < last) points_ += site.sources[i].points;
    }
    last_ = last;
  }

  void write(const fs::path& path)
  {
    if (io::extensionOf(path) != ".pcd")
      throw files::FileError(path, "is not the name of a .pcd file, which is what sites are exported to",
                             "name a .pcd file");
    if (points_ > io::max_points)
      throw files::FileError(path, "would have more than 2147483647 points", "export the sources one by one");
    const std::string head = io::binaryPcdHeader(layout_.fields, static_cast<std::uint32_t>(points_));
    files::requireSpace({{path, head.size() + points_ * layout_.point_step}});
    files::FileReplacement file(path);
    file.stream() << head;
    const std::uint64_t step = layout_.point_step;
    const std::uint64_t most = std::max<std::uint64_t>(options_.memory / 2 / step, 1);
    for (std::uint64_t begin = 0; begin < points_; begin += most) {
      const std::uint64_t end = std::min(begin + most, points_);
      window_.assign((end - begin) * step, 0);
      fill(begin, end);
      file.stream().write(reinterpret_cast<const char*>(window_.data()), static_cast<std::streamsize>(window_.size()));
      if (options_.progress && !options_.progress(end, points_)) throw Cancelled();
    }
    file.commit();
  }

private:
  void fill(std::uint64_t begin, std::uint64_t end)
  {
    std::vector<bool> is_filled(end - begin, false);
    std::uint64_t filled = 0;
    pcl::PCLPointCloud2 cloud;
    for (const Tile& tile : site_.tiles) {
      cloud = readTile(site_, tile, std::move(cloud));
      const PointNames names(cloud);
      for (std::size_t i = 0; i < cloud.width; ++i) {
        const std::uint8_t* const bytes = cloud.data.data() + i * cloud.point_step;
        const auto [source, record] = names(bytes);
        if (source < first_ || source >= last_ || record >= site_.sources[source].points) continue;
        const std::uint64_t number = begins_[source] + record;
        if (number < begin || number >= end) continue;
        copy_(bytes, window_.data() + (number - begin) * layout_.point_step);
        filled += is_filled[number - begin] ? 0 : 1; // a record that is there twice hides no missing one
        is_filled[number - begin] = true;
      }
    }
    if (filled != end - begin)
      throw files::FileError(site_.folder, "its tiles do not hold each record once", "make the site again");
  }

  const Site& site_;
  std::size_t first_, last_ = 0;
  pcl::PCLPointCloud2 layout_;
  RecordCopy copy_;
  const ExportOptions& options_;
  std::vector<std::uint64_t> begins_; ///< of each source, the number of its first point in the output
  std::uint64_t points_ = 0;
  std::vector<std::uint8_t> window_;
};

} // namespace

void exportCloud(const Site& site, const fs::path& file, const ExportOptions& options)
{
  Exporter(site, 0, site.sources.size(), site.fields, options).write(file);
}

void exportSource(const Site& site, std::size_t source, const fs::path& file, const ExportOptions& options)
{
  Fields fields = site.sources[source].fields;
  for (const auto& field : site.fields) {
    const auto had = [&](const Source& other) { return findField(other.fields, field.name) != nullptr; };
    if (field.name == source_field_name || field.name == record_field_name) continue;
    if (std::none_of(site.sources.begin(), site.sources.end(), had)) fields.push_back(field);
  }
  Exporter(site, source, source + 1, layoutOf(fields).fields, options).write(file);
}

} // namespace pcl_bsh::site
