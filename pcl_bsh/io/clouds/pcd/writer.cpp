// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/pcd/lzf.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/number_text.h>

#include <pcl/common/io.h>

#include <sstream>

namespace pcl_bsh::io {

namespace {

constexpr std::string_view first_line = "# .PCD v0.7 - Point Cloud Data file format";

/// One header line: its key and a value for each of a range.
template <typename Range, typename Value>
void writeLine(std::ostream& out, const char* key, const Range& range, Value&& value)
{
  out << key;
  for (const auto& item : range) out << ' ' << value(item);
  out << '\n';
}

std::string headerText(const Fields& fields, std::uint32_t width, std::uint32_t height, const Viewpoint& viewpoint,
                       const char* storage)
{
  using Field = pcl::PCLPointField;
  std::ostringstream header;
  header.imbue(std::locale::classic());
  header << first_line << "\nVERSION 0.7\n";
  writeLine(header, "FIELDS", fields, [](const Field& field) { return field.name; });
  writeLine(header, "SIZE", fields, [](const Field& field) { return sizeOf(field.datatype); });
  writeLine(header, "TYPE", fields, [](const Field& field) { return pcl::getFieldType(field.datatype); });
  writeLine(header, "COUNT", fields, [](const Field& field) { return field.count; });
  header << "WIDTH " << width << "\nHEIGHT " << height << '\n';
  writeLine(header, "VIEWPOINT", viewpoint, [](double value) { return numberText(value); });
  header << "POINTS " << std::uint64_t{width} * height << "\nDATA " << storage << '\n';
  return header.str();
}

/// All values of the first field, of the second, ...: alike values side by side compress better.
std::vector<std::uint8_t> columnsOf(const pcl::PCLPointCloud2& cloud, const Fields& fields, std::size_t bytes)
{
  std::vector<std::uint8_t> columns(bytes);
  std::uint8_t* value = columns.data();
  const std::size_t points = std::size_t{cloud.width} * cloud.height;
  for (const pcl::PCLPointField& field : fields) {
    const std::size_t size = sizeOf(field);
    for (std::size_t i = 0; i < points; ++i, value += size) {
      std::memcpy(value, cloud.data.data() + i * cloud.point_step + field.offset, size);
    }
  }
  return columns;
}

void writeCompressed(std::ostream& out, const std::vector<std::uint8_t>& columns)
{
  const std::string compressed = lzfOf(columns);
  for (const std::size_t size : {compressed.size(), columns.size()}) {
    const auto stored = static_cast<std::uint32_t>(size);
    out.write(reinterpret_cast<const char*>(&stored), sizeof stored);
  }
  out << compressed;
}

} // namespace

std::string binaryPcdHeader(const Fields& fields, std::uint32_t points, std::size_t padded)
{
  std::string text = headerText(fields, points, 1, no_viewpoint, "binary");
  if (text.size() < padded) text.insert(first_line.size(), padded - text.size(), ' ');
  return text;
}

void writePcd(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint)
{
  const Fields fields = namedFields(cloud);
  std::uint64_t bytes = 0;
  for (const pcl::PCLPointField& field : fields) bytes += std::uint64_t{cloud.width} * cloud.height * sizeOf(field);

  if (bytes < std::uint64_t{1} << 31) {
    out << headerText(fields, cloud.width, cloud.height, viewpoint, "binary_compressed");
    writeCompressed(out, columnsOf(cloud, fields, bytes));
  }
  else {
    out << headerText(fields, cloud.width, cloud.height, viewpoint, "binary");
    forEachPackedBlock(cloud, fields, Lists::bare, [&](std::string_view block) { out << block; });
  }
}

} // namespace pcl_bsh::io
