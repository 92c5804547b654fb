// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/plan.h>
#include <pcl_bsh/io/clouds/las/reader.h>
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/parse_number.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t batch_points = 4096;
constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

double coordinate(const std::uint8_t* record, const pcl::PCLPointField& field)
{
  if (field.datatype == pcl::PCLPointField::FLOAT64)
    return lasNumber<double>({reinterpret_cast<const char*>(record), field.offset + 8}, field.offset);
  return lasNumber<float>({reinterpret_cast<const char*>(record), field.offset + 4}, field.offset);
}

bool isFinitePoint(const std::uint8_t* record, const std::array<pcl::PCLPointField, 3>& xyz)
{
  return std::all_of(xyz.begin(), xyz.end(),
                     [&](const pcl::PCLPointField& axis) { return std::isfinite(coordinate(record, axis)); });
}

bool hasPlaces(const LasPoints& points, std::size_t axis, double scale, double offset)
{
  const auto fits = [&](double value) {
    constexpr double lowest = std::numeric_limits<std::int32_t>::min(), most = std::numeric_limits<std::int32_t>::max();
    const double whole = std::nearbyint((value - offset) / scale);
    const double nearest = std::clamp(whole, lowest, most); // beyond the range by a rounding: the same coordinate
    return whole == nearest || nearest * scale + offset == value;
  };
  return points.size() == 0 || (fits(points.least(axis)) && fits(points.greatest(axis)));
}

/// The least power of ten for which the extent needs 31 bits, a bit to spare, and doubles tell its multiples apart.
double scaleFor(const LasPoints& points)
{
  if (points.size() == 0) return 0.001;
  double least = std::numeric_limits<double>::min() * 0x1p40;
  for (std::size_t k = 0; k < 3; ++k) {
    const double half = points.greatest(k) / 2 - points.least(k) / 2;
    const double far = std::max(std::abs(points.least(k)), std::abs(points.greatest(k)));
    least = std::max({least, half * 0x1p-30, far * 0x1p-50});
  }
  constexpr double usual = 1e-6; // points that lie in one place need no less
  if (least < std::numeric_limits<double>::min() * 0x1p41) return usual;
  const double exponent = std::ceil(std::log10(least));
  return parseNumber<double>("1e" + std::to_string(static_cast<int>(exponent))); // the double nearest to it
}

void chooseScale(const LasPoints& points, LasPlan& plan)
{
  plan.scale.fill(scaleFor(points));
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = points.size() == 0 ? 0 : points.least(k) / 2 + points.greatest(k) / 2;
    const double step = 1000 * plan.scale[k]; // a round offset
    plan.offset[k] = std::nearbyint(middle / step) * step;
    const bool finite = std::isfinite(plan.scale[k] * 0x1p31 + std::abs(plan.offset[k])); // as readers ask for
    if (!finite || !hasPlaces(points, k, plan.scale[k], plan.offset[k])) {
      throw FormatError("its coordinates " + std::string(axis_names[k]) + " are too far apart for LAS",
                        "write a .pcd instead");
    }
  }
}

void placeCoordinates(const LasPoints& points, const LasHeader* header, LasPlan& plan)
{
  if (header == nullptr) return chooseScale(points, plan);
  plan.scale = header->block.scale;
  plan.offset = header->block.offset;
  for (std::size_t k = 0; k < 3; ++k) {
    if (hasPlaces(points, k, plan.scale[k], plan.offset[k])) continue;
    const double middle = points.least(k) / 2 + points.greatest(k) / 2;
    // Rounded up, for 32 bits reach one further below zero than above.
    plan.offset[k] += std::ceil((middle - plan.offset[k]) / plan.scale[k]) * plan.scale[k];
    const bool apart = plan.scale[k] > std::abs(middle) * 0x1p-50; // doubles tell multiples apart
    if (!apart || !hasPlaces(points, k, plan.scale[k], plan.offset[k])) return chooseScale(points, plan);
  }
}

bool hasChannels(const LasPoints& points)
{
  return points.field("red") != nullptr && points.field("green") != nullptr && points.field("blue") != nullptr;
}

/// PCL's packed colour, where no channels stand beside it; extra bytes of that name and type are what the file says
/// they are.
/// @param given the fields of the header's points
const pcl::PCLPointField* packedColourOf(const LasPoints& points, const std::vector<LasField>& given)
{
  if (hasChannels(points)) return nullptr;
  const auto is_colour = [&](const pcl::PCLPointField& field) {
    const auto is_extra = [&](const LasField& other) { return !other.descriptor.empty() && other.name == field.name; };
    return isPackedColour(field) && std::none_of(given.begin(), given.end(), is_extra);
  };
  const auto found = std::find_if(points.fields().begin(), points.fields().end(), is_colour);
  return found == points.fields().end() ? nullptr : &*found;
}

bool names(const std::vector<LasField>& fields, const char* name)
{
  return std::any_of(fields.begin(), fields.end(), [&](const LasField& field) { return field.name == name; });
}

/// The header's format, or the least format that also has the time, colour or infrared which the cloud has and the
/// header's points had not.
/// @param given, given_fields of the header's points
void chooseFormat(const LasPoints& points, std::uint8_t given, const std::vector<LasField>& given_fields,
                  bool packed_colour, LasPlan& plan)
{
  const bool extended = given >= 6;
  const bool coloured = hasChannels(points) || packed_colour;
  const bool time = points.field("gps_time") != nullptr && !names(given_fields, "gps_time");
  const bool colour = coloured && !names(given_fields, "red");
  const bool infrared = extended && points.field("nir") != nullptr && !names(given_fields, "nir");
  plan.format = given;
  if (!time && !colour && !infrared) return;
  for (std::uint8_t format = 0; format <= 10; ++format) {
    const std::vector<LasField> fields = lasFields(format, {}, {}), before = lasFields(given, {}, {});
    const auto lacks = [&](const char* name, bool wanted) {
      return (wanted || names(before, name)) && !names(fields, name);
    };
    if ((format >= 6) != extended || hasLasWaves(format) != hasLasWaves(given) || lacks("gps_time", time) ||
        lacks("red", colour) || lacks("nir", infrared)) {
      continue;
    }
    plan.format = format;
    constexpr std::uint8_t first_with_colours = 2;
    plan.minor = std::max(plan.minor, first_with_colours);
    return;
  }
}

/// The meaning of our own fields, in at most 32 letters.
std::string descriptionOf(const std::string& name)
{
  constexpr std::array<std::array<const char*, 2>, 4> known = {{
      {"collision", "1 collides, 2 undecided, 0 free"},
      {"distance", "smallest distance; NaN: free"},
      {"first_pose", "first pose that collides, or -1"},
      {"closest_pose", "pose of smallest distance, or -1"},
  }};
  const auto found = std::find_if(known.begin(), known.end(), [&](const auto& row) { return name == row[0]; });
  return found == known.end() ? "" : (*found)[1];
}

/// Whether the field's values go to that place without a change.
bool fits(const LasPoints& points, const LasTarget& target)
{
  const LasField& field = target.field;
  if (field.kind == LasField::Kind::plain && field.stored == target.datatype) return true;
  LasTarget first = target;
  first.field.at = 12; // it is no coordinate
  bool all = true;
  std::string records;
  const std::size_t length = first.field.at + field.count * sizeOf(field.stored);
  points.forEachBatch([&](const std::uint8_t* in, std::size_t count) {
    records.assign(count * length, '\0');
    all =
        all && encodeLas(first.field, in + target.from, target.datatype, points.step(), count, records.data(), length);
  });
  return all;
}

/// Gives the cloud's fields their places.
class Planner {
public:
  /// @param extra_fields of the header's points, beyond those of their format
  /// @param packed the packed colour; null: none
  Planner(const LasPoints& points, std::vector<LasField> extra_fields, const pcl::PCLPointField* packed, LasPlan& plan)
  : points_(points),
    extra_fields_(std::move(extra_fields)),
    packed_(packed),
    plan_(plan)
  {
    for (std::size_t i = 0; i < points.fields().size(); ++i) places_.emplace(points.fields()[i].name, i);
    taken_.resize(points.fields().size(), false);
  }

  void place()
  {
    for (const LasField& field : lasFields(plan_.format, plan_.scale, plan_.offset)) {
      if (field.kind == LasField::Kind::colour) continue;
      if (packed_ != nullptr && (field.name == "green" || field.name == "blue")) continue;
      if (packed_ != nullptr && field.name == "red") {
        plan_.targets.push_back({field, packed_->offset, packed_->datatype, true});
        continue;
      }
      const bool coordinate = field.at < 12;
      if (!take(field, coordinate)) plan_.targets.push_back({field});
    }
    const auto holds_colour = [](const LasTarget& target) {
      return target.field.name == "red" && (target.packed_colour || target.datatype != 0);
    };
    if (std::any_of(plan_.targets.begin(), plan_.targets.end(), holds_colour)) {
      for (std::size_t i = 0; i < taken_.size(); ++i) {
        const pcl::PCLPointField& field = points_.fields()[i];
        if (field.name == "rgb" && isPackedColour(field)) taken_[i] = true; // it says no more than they do
      }
    }
    plan_.record_length = lasRecordBytes(plan_.format);
    placeExtraBytes();
  }

private:
  /// Takes the cloud's field for this one of the file, if it fits.
  bool take(const LasField& field, bool certainly)
  {
    const auto found = places_.find(field.name);
    if (found == places_.end() || taken_[found->second]) return false;
    const pcl::PCLPointField& from = points_.fields()[found->second];
    const LasTarget target = {field, from.offset, from.datatype};
    if (from.count != field.count || (!certainly && !fits(points_, target))) return false;
    plan_.targets.push_back(target);
    taken_[found->second] = true;
    return true;
  }

  void placeExtraBytes()
  {
    std::string descriptors;
    bool changed = false;
    for (LasField& field : extra_fields_) {
      field.at = plan_.record_length;
      if (!take(field, false)) {
        changed = true;
        addNewInPlaceOf(field, descriptors);
        continue;
      }
      const std::size_t bytes = sizeOf(field.stored) * field.count;
      plan_.record_length += bytes;
      if (!field.descriptor.empty())
        descriptors += field.descriptor;
      else
        appendUndescribed(descriptors, bytes);
    }
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (taken_[i]) continue;
      changed = true;
      addNew(i, descriptors);
    }
    constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
    if (plan_.record_length > most) throw FormatError("a point takes more than 65535 bytes", "write a .pcd instead");
    if (changed && descriptors.size() > most) {
      throw FormatError("the points have more than 341 extra fields", "write a .pcd instead");
    }
    if (changed) plan_.descriptors = std::move(descriptors);
  }

  /// Bytes without a description get one when others have one: type 0, with their number.
  static void appendUndescribed(std::string& descriptors, std::size_t bytes)
  {
    for (; bytes > 0; bytes -= std::min<std::size_t>(bytes, 255)) {
      std::string descriptor(las_descriptor_bytes, '\0');
      descriptor[3] = static_cast<char>(std::min<std::size_t>(bytes, 255));
      descriptor.replace(4, 11, "extra_bytes");
      descriptors += descriptor;
    }
  }

  /// A field of the file whose type and scale the cloud's values do not fit gets others, where it was.
  void addNewInPlaceOf(const LasField& field, std::string& descriptors)
  {
    const auto found = places_.find(field.name);
    if (found != places_.end() && !taken_[found->second]) addNew(found->second, descriptors);
  }

  void addNew(std::size_t position, std::string& descriptors)
  {
    const pcl::PCLPointField& field = points_.fields()[position];
    for (std::uint32_t k = 0; k < field.count; ++k) addNew(field, k, descriptors);
    taken_[position] = true;
  }

  void addNew(const pcl::PCLPointField& field, std::uint32_t k, std::string& descriptors)
  {
    const std::string name = field.count == 1 ? field.name : field.name + '[' + std::to_string(k) + ']';
    constexpr std::size_t longest = 32;
    if (name.size() > longest) {
      throw FormatError("the name of field '" + name + "' is longer than the 32 letters of LAS", "rename the field");
    }
    const std::size_t bytes = sizeOf(field.datatype);
    const std::uint8_t stored =
        field.datatype == pcl::PCLPointField::BOOL ? std::uint8_t{pcl::PCLPointField::UINT8} : field.datatype;
    plan_.targets.push_back({{.name = name, .datatype = stored, .at = plan_.record_length, .stored = stored},
                             field.offset + k * bytes,
                             stored});
    plan_.record_length += bytes;
    descriptors += newDescriptor(name, stored, descriptionOf(name));
  }

  const LasPoints& points_;
  std::vector<LasField> extra_fields_;
  const pcl::PCLPointField* packed_;
  LasPlan& plan_;
  std::map<std::string, std::size_t> places_; ///< of the cloud's fields by name
  std::vector<bool> taken_;                   ///< whether a field of the cloud has a place
};

} // namespace

LasPoints::LasPoints(const pcl::PCLPointCloud2& cloud) : cloud_(cloud), fields_(namedFields(cloud))
{
  least_.fill(std::numeric_limits<double>::infinity());
  greatest_.fill(-std::numeric_limits<double>::infinity());
  std::array<pcl::PCLPointField, 3> xyz;
  for (std::size_t k = 0; k < 3; ++k) {
    const pcl::PCLPointField* const axis = field(axis_names[k]);
    const bool real = axis != nullptr && axis->count == 1 &&
                      (axis->datatype == pcl::PCLPointField::FLOAT32 || axis->datatype == pcl::PCLPointField::FLOAT64);
    if (!real) throw FormatError("the cloud has not one each of x, y and z", "write a cloud with float x y z");
    xyz[k] = *axis;
  }
  const std::size_t records = std::size_t{cloud.width} * cloud.height;
  for (std::size_t i = 0; i < records; ++i) {
    const std::uint8_t* const record = cloud.data.data() + i * cloud.point_step;
    if (!isFinitePoint(record, xyz)) continue;
    ++size_;
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = coordinate(record, xyz[k]);
      least_[k] = std::min(least_[k], value);
      greatest_[k] = std::max(greatest_[k], value);
    }
  }
}

const pcl::PCLPointField* LasPoints::field(const std::string& name) const
{
  const auto is_it = [&](const pcl::PCLPointField& field) { return field.name == name; };
  const auto found = std::find_if(fields_.begin(), fields_.end(), is_it);
  if (found == fields_.end() || std::any_of(found + 1, fields_.end(), is_it)) return nullptr;
  return &*found;
}

void LasPoints::forEachBatch(const std::function<void(const std::uint8_t*, std::size_t)>& use) const
{
  const std::array<pcl::PCLPointField, 3> xyz = {*field("x"), *field("y"), *field("z")};
  const std::size_t records = std::size_t{cloud_.width} * cloud_.height;
  std::vector<std::uint8_t> kept;
  for (std::size_t first = 0; first < records; first += batch_points) {
    const std::size_t count = std::min(batch_points, records - first);
    const std::uint8_t* const begin = cloud_.data.data() + first * step();
    if (size_ == records) {
      use(begin, count);
      continue;
    }
    kept.clear();
    for (const std::uint8_t* record = begin; record != begin + count * step(); record += step()) {
      if (isFinitePoint(record, xyz)) kept.insert(kept.end(), record, record + step());
    }
    if (!kept.empty()) use(kept.data(), kept.size() / step());
  }
}

void LasPlan::encode(const std::uint8_t* in, std::size_t step, std::size_t points, std::string& records) const
{
  records.assign(points * record_length, '\0');
  for (const LasTarget& target : targets) {
    if (target.packed_colour) {
      encodeLasColour(in + target.from, step, points, target.field.at, records.data(), record_length);
    }
    else if (target.datatype != 0) {
      encodeLas(target.field, in + target.from, target.datatype, step, points, records.data(), record_length);
    }
    else if (target.field.name == "return_number" || target.field.name == "number_of_returns") {
      constexpr std::uint8_t one = 1;
      encodeLas(target.field, &one, pcl::PCLPointField::UINT8, 0, points, records.data(), record_length);
    }
  }
}

LasPlan planLas(const LasPoints& points, const LasHeader* header)
{
  LasPlan plan;
  placeCoordinates(points, header, plan);
  const std::uint8_t given_format = header == nullptr ? 6 : header->block.format;
  plan.minor = header == nullptr ? 4 : header->block.minor;
  std::vector<LasField> fields = lasFields(given_format, {}, {});
  const auto of_format = static_cast<std::ptrdiff_t>(fields.size());
  if (header != nullptr) fields = lasFieldsOf(header->block, header->descriptors);
  const pcl::PCLPointField* const packed = packedColourOf(points, fields);
  chooseFormat(points, given_format, fields, packed != nullptr, plan);
  Planner(points, {fields.begin() + of_format, fields.end()}, packed, plan).place();
  return plan;
}

} // namespace pcl_bsh::io
