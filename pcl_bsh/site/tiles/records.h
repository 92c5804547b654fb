// SPDX-License-Identifier: BSD-3-Clause
// The records of a site: its sources' fields together, and how a record of a source becomes one of the site.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/search/find_field.h>
#include <pcl_bsh/site/site.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::site {

using Fields = std::vector<pcl::PCLPointField>;

/// A cloud of such fields, side by side, without points.
pcl::PCLPointCloud2 layoutOf(const Fields& fields);

/// The fields that hold something, side by side.
Fields packed(const pcl::PCLPointCloud2& header);

/// All fields of these, each once, then `source` and `record`. Coordinates are float64 where those of any source are.
/// @param names of the sources, for messages
/// @throws files::FileError for a field whose types differ, or that has the name of one of the two
Fields united(const std::vector<Fields>& sources, const std::vector<std::filesystem::path>& names);

/// Fails unless there are x y z of one floating-point type, `source` and `record`, each once.
void requireSiteFields(const io::JsonReader& json, const Fields& fields);

/// Copies fields by name from records of one layout to records of another. Values stay as they are, except that float32
/// becomes float64, or the reverse, where the types are these two. Fields that a record lacks are NaN, or 0 where they
/// are of whole numbers.
class RecordCopy {
public:
  RecordCopy(const Fields& from, const pcl::PCLPointCloud2& to);

  void operator()(const std::uint8_t* from, std::uint8_t* to) const;

private:
  struct Bytes {
    std::size_t from, to, count;
  };
  struct Number {
    std::size_t from, to;
    bool widens; ///< float32 to float64
  };
  std::vector<std::uint8_t> blank_;
  std::vector<Bytes> bytes_;
  std::vector<Number> numbers_;
};

/// Whether it is the name of a coordinate: x, y or z.
bool isAxis(const std::string& name);

/// The records of a buffer as points.
PointsView viewOfRecords(const pcl::PCLPointCloud2& layout, const std::uint8_t* records, std::size_t count);

/// The place of a field in the records. @pre there is one
inline std::size_t offsetOf(const pcl::PCLPointCloud2& layout, const std::string& name)
{
  return findField(layout, name)->offset;
}

/// The names of points in records of a site.
class PointNames {
public:
  explicit PointNames(const pcl::PCLPointCloud2& layout)
  : source_at_(offsetOf(layout, source_field_name)),
    record_at_(offsetOf(layout, record_field_name))
  {
  }

  SitePoint operator()(const std::uint8_t* record) const
  {
    SitePoint point;
    std::memcpy(&point.source, record + source_at_, sizeof point.source);
    std::memcpy(&point.record, record + record_at_, sizeof point.record);
    return point;
  }

  void set(std::uint8_t* record, const SitePoint& point) const
  {
    std::memcpy(record + source_at_, &point.source, sizeof point.source);
    std::memcpy(record + record_at_, &point.record, sizeof point.record);
  }

private:
  std::size_t source_at_, record_at_;
};

/// Returns the name of a tile's point.
inline SitePoint nameOf(const pcl::PCLPointCloud2& cloud, std::uint32_t i)
{
  return PointNames(cloud)(cloud.data.data() + std::size_t{i} * cloud.point_step);
}

} // namespace pcl_bsh::site
