// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace pcl_bsh::site {

namespace {

using Field = pcl::PCLPointField;

bool isOwn(const std::string& name)
{
  return name == source_field_name || name == record_field_name;
}

/// Returns a record without values: NaN, or 0 in fields of whole numbers.
std::vector<std::uint8_t> blankRecord(const pcl::PCLPointCloud2& layout)
{
  std::vector<std::uint8_t> record(layout.point_step, 0);
  for (const Field& field : layout.fields) {
    io::withFieldType(field.datatype, [&](auto value) {
      using Value = decltype(value);
      if constexpr (std::is_floating_point_v<Value>) {
        value = std::numeric_limits<Value>::quiet_NaN();
        for (std::uint32_t i = 0; i < field.count; ++i)
          std::memcpy(record.data() + field.offset + i * sizeof value, &value, sizeof value);
      }
    });
  }
  return record;
}

} // namespace

bool isAxis(const std::string& name)
{
  return name == "x" || name == "y" || name == "z";
}

pcl::PCLPointCloud2 layoutOf(const Fields& fields)
{
  pcl::PCLPointCloud2 layout;
  for (const Field& field : fields) io::addField(layout, field.name, field.datatype, field.count);
  layout.height = 1;
  return layout;
}

Fields packed(const pcl::PCLPointCloud2& header)
{
  pcl::PCLPointCloud2 empty = header;
  empty.width = empty.height = empty.row_step = 0;
  empty.data.clear();
  return layoutOf(io::namedFields(empty)).fields;
}

Fields united(const std::vector<Fields>& sources, const std::vector<std::filesystem::path>& names)
{
  Fields all;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    for (const Field& field : sources[i]) {
      if (isOwn(field.name)) {
        throw files::FileError(names[i], "has a field named '" + field.name + "', as sites have one of their own",
                               "rename the field");
      }
      const auto named = [&](const Field& other) { return other.name == field.name; };
      if (std::count_if(sources[i].begin(), sources[i].end(), named) > 1)
        throw files::FileError(names[i], "has two fields named '" + field.name + "'", "rename one");
      auto same = std::find_if(all.begin(), all.end(), named);
      if (same == all.end()) {
        all.push_back(field);
      }
      else if (isAxis(field.name)) {
        same->datatype = std::max(same->datatype, field.datatype); // FLOAT64 is the greater number
      }
      else if (same->datatype != field.datatype || same->count != field.count) {
        throw files::FileError(names[i], "its field '" + field.name + "' has another type than in an earlier cloud",
                               "convert or rename the field");
      }
    }
  }
  static_assert(int{Field::FLOAT32} < int{Field::FLOAT64});
  pcl::PCLPointCloud2 layout = layoutOf(all);
  for (const char* own : {source_field_name, record_field_name}) io::addField(layout, own, Field::UINT32);
  return layout.fields;
}

void requireSiteFields(const io::JsonReader& json, const Fields& fields)
{
  for (const Field& field : fields) {
    const auto same = [&](const Field& other) { return other.name == field.name; };
    if (std::count_if(fields.begin(), fields.end(), same) > 1)
      json.fail("'" + field.name + "' is there twice", "make the site again");
  }
  for (const char* own : {source_field_name, record_field_name}) {
    const Field* const field = findField(fields, own);
    if (field == nullptr || field->datatype != Field::UINT32 || field->count != 1)
      json.fail(std::string("there is no field '") + own + "' of type uint32", "make the site again");
  }
  try {
    viewOf(layoutOf(fields));
  }
  catch (const std::invalid_argument& error) {
    json.fail(error.what(), "make the site again");
  }
}

RecordCopy::RecordCopy(const Fields& from, const pcl::PCLPointCloud2& to) : blank_(blankRecord(to))
{
  for (const Field& target : to.fields) {
    const Field* const origin = findField(from, target.name);
    if (origin == nullptr) continue;
    if (origin->datatype != target.datatype) {
      numbers_.push_back({origin->offset, target.offset, origin->datatype == Field::FLOAT32});
      continue;
    }
    const Bytes bytes = {origin->offset, target.offset, io::sizeOf(target)};
    if (!bytes_.empty() && bytes_.back().from + bytes_.back().count == bytes.from &&
        bytes_.back().to + bytes_.back().count == bytes.to) {
      bytes_.back().count += bytes.count;
    }
    else {
      bytes_.push_back(bytes);
    }
  }
}

void RecordCopy::operator()(const std::uint8_t* from, std::uint8_t* to) const
{
  std::memcpy(to, blank_.data(), blank_.size());
  for (const Bytes& bytes : bytes_) std::memcpy(to + bytes.to, from + bytes.from, bytes.count);
  for (const Number& number : numbers_) {
    float narrow;
    double wide;
    if (number.widens) {
      std::memcpy(&narrow, from + number.from, sizeof narrow);
      wide = narrow;
      std::memcpy(to + number.to, &wide, sizeof wide);
    }
    else {
      std::memcpy(&wide, from + number.from, sizeof wide);
      narrow = static_cast<float>(wide);
      std::memcpy(to + number.to, &narrow, sizeof narrow);
    }
  }
}

PointsView viewOfRecords(const pcl::PCLPointCloud2& layout, const std::uint8_t* records, std::size_t count)
{
  PointsView view;
  view.data = records;
  view.count = count;
  view.stride = layout.point_step;
  view.offset = {offsetOf(layout, "x"), offsetOf(layout, "y"), offsetOf(layout, "z")};
  view.scalar = findField(layout, "x")->datatype == Field::FLOAT32 ? Scalar::float32 : Scalar::float64;
  return view;
}

} // namespace pcl_bsh::site
