// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/clouds/stored_number.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {

namespace {

using Type = pcl::PCLPointField;

/// The parts of a point format (sections 2.5.1 to 2.5.11).
struct FormatParts {
  std::size_t bytes;
  bool extended; ///< formats 6 to 10: more returns, classes and angles
  bool time, colour, infrared, waves;
};

constexpr std::array<FormatParts, 11> formats = {{
    {20, false, false, false, false, false},
    {28, false, true, false, false, false},
    {26, false, false, true, false, false},
    {34, false, true, true, false, false},
    {57, false, true, false, false, true},
    {63, false, true, true, false, true},
    {30, true, true, false, false, false},
    {36, true, true, true, false, false},
    {38, true, true, true, true, false},
    {59, true, true, false, false, true},
    {67, true, true, true, true, true},
}};

constexpr double extended_angle_step = 0.006; // degrees

/// Fields as they follow each other in a record.
class Record {
public:
  void plain(const char* name, std::uint8_t type)
  {
    fields.push_back({.name = name, .datatype = type, .at = next_, .stored = type});
    next_ += sizeOf(type);
  }

  void scaled(const char* name, std::uint8_t type, std::uint8_t stored, double scale, double offset)
  {
    fields.push_back({.name = name, .datatype = type, .kind = LasField::Kind::scaled, .at = next_, .stored = stored});
    fields.back().scaling[0] = {scale, offset, std::nullopt};
    next_ += sizeOf(stored);
  }

  /// Names of the groups of bits of the next byte, from its lowest bit.
  void bits(const std::vector<std::pair<const char*, unsigned>>& groups)
  {
    unsigned shift = 0;
    for (const auto& [name, count] : groups) {
      fields.push_back({.name = name,
                        .datatype = Type::UINT8,
                        .kind = LasField::Kind::bits,
                        .at = next_,
                        .stored = Type::UINT8,
                        .shift = static_cast<std::uint8_t>(shift),
                        .bits = static_cast<std::uint8_t>(count)});
      shift += count;
    }
    ++next_;
  }

  void colour()
  {
    const std::size_t red = next_;
    for (const char* name : {"red", "green", "blue"}) plain(name, Type::UINT16);
    fields.push_back(
        {.name = "rgb", .datatype = Type::FLOAT32, .kind = LasField::Kind::colour, .at = red, .stored = Type::UINT16});
  }

  std::vector<LasField> fields;

private:
  std::size_t next_ = 0;
};

const FormatParts& partsOf(std::uint8_t format)
{
  return formats.at(format);
}

/// A stored value, widened as no_data of a descriptor is (table 24: to 8 bytes of its kind).
template <typename T>
std::uint64_t widened(T value)
{
  std::uint64_t bits;
  if constexpr (std::is_floating_point_v<T>) {
    const double wide = value;
    std::memcpy(&bits, &wide, sizeof bits);
  }
  else if constexpr (std::is_signed_v<T>) {
    bits = static_cast<std::uint64_t>(std::int64_t{value});
  }
  else {
    bits = value;
  }
  return bits;
}

/// The stored value whose widened bits these are.
template <typename T>
T narrowed(std::uint64_t bits)
{
  if constexpr (std::is_floating_point_v<T>) {
    double wide;
    std::memcpy(&wide, &bits, sizeof wide);
    return static_cast<T>(wide);
  }
  else {
    return static_cast<T>(bits);
  }
}

template <typename T>
double valueOf(T stored, const LasScaling& scaling)
{
  if (scaling.no_data && widened(stored) == *scaling.no_data) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(stored) * scaling.scale + scaling.offset;
}

/// `to` := `from`. @return whether nothing is lost; otherwise `to` is unchanged
template <typename To, typename From>
bool converted(From from, To& to)
{
  if constexpr (std::is_floating_point_v<To>) {
    const To value = static_cast<To>(from);
    const bool both_nan = value != value && from != from;
    if (!both_nan && static_cast<long double>(value) != static_cast<long double>(from)) return false;
    to = value;
    return true;
  }
  else {
    const auto wide = static_cast<long double>(from);
    const bool inside = wide >= static_cast<long double>(std::numeric_limits<To>::lowest()) &&
                        wide <= static_cast<long double>(std::numeric_limits<To>::max()) && std::trunc(wide) == wide;
    if (inside) to = static_cast<To>(from);
    return inside;
  }
}

template <typename T>
T neighborOf(T value)
{
  if constexpr (std::is_floating_point_v<T>) return std::nextafter(value, std::numeric_limits<T>::max());
  return value < std::numeric_limits<T>::max() ? value + T{1} : value - T{1};
}

/// The stored value nearest to `value`. @param exact whether that is read as `value`
/// @return whether there is one
template <typename T, typename Read>
bool unscaled(double value, const LasScaling& scaling, const Read& read, T& stored, bool& exact)
{
  if (std::isnan(value)) {
    if (scaling.no_data) {
      stored = narrowed<T>(*scaling.no_data);
      if (std::isnan(valueOf(stored, scaling))) return true; // else no value of the type stands for no data
    }
    if constexpr (std::is_floating_point_v<T>) stored = std::numeric_limits<T>::quiet_NaN();
    return std::is_floating_point_v<T>;
  }
  const double wide = (value - scaling.offset) / scaling.scale;
  if constexpr (std::is_floating_point_v<T>) {
    stored = static_cast<T>(wide);
  }
  else {
    const double whole = std::nearbyint(wide);
    if (!converted(whole, stored)) { // at the end of the range, the division may have rounded beyond it
      stored = wide > 0 ? std::numeric_limits<T>::max() : std::numeric_limits<T>::lowest();
      exact = read(valueOf(stored, scaling)) == read(value);
      return exact;
    }
  }
  exact = read(valueOf(stored, scaling)) == read(value);
  if (exact || !std::isnan(valueOf(stored, scaling))) return true;
  // The stored value stands for no data. A neighbour may be read as the same number, where the offset absorbs the
  // difference.
  const T other = neighborOf(stored);
  exact = read(valueOf(other, scaling)) == read(value);
  if (exact) stored = other;
  return true;
}

/// The packed colour 0x00rrggbb.
std::uint32_t packed(const char* record, unsigned shift)
{
  std::uint32_t colour = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const unsigned channel = loaded<std::uint16_t>(record + 2 * k);
    colour = colour << 8 | (channel >> shift & 0xffU);
  }
  return colour;
}

template <typename Use>
void forEachValue(const LasField& field, std::size_t points, Use&& use)
{
  for (std::uint32_t k = 0; k < field.count; ++k)
    for (std::size_t i = 0; i < points; ++i) use(i, k);
}

} // namespace

std::size_t lasRecordBytes(std::uint8_t format)
{
  return partsOf(format).bytes;
}

bool hasLasWaves(std::uint8_t format)
{
  return partsOf(format).waves;
}

bool hasLasColours(std::uint8_t format)
{
  return partsOf(format).colour;
}

std::vector<LasField> lasFields(std::uint8_t format, const std::array<double, 3>& scale,
                                const std::array<double, 3>& offset)
{
  const FormatParts& parts = partsOf(format);
  Record record;
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr std::array axes = {"x", "y", "z"};
    record.scaled(axes[k], Type::FLOAT64, Type::INT32, scale[k], offset[k]);
  }
  record.plain("intensity", Type::UINT16);
  if (parts.extended) {
    record.bits({{"return_number", 4}, {"number_of_returns", 4}});
    record.bits({{"synthetic", 1},
                 {"key_point", 1},
                 {"withheld", 1},
                 {"overlap", 1},
                 {"scanner_channel", 2},
                 {"scan_direction", 1},
                 {"edge_of_flight_line", 1}});
    record.plain("classification", Type::UINT8);
    record.plain("user_data", Type::UINT8);
    record.scaled("scan_angle", Type::FLOAT32, Type::INT16, extended_angle_step, 0);
  }
  else {
    record.bits({{"return_number", 3}, {"number_of_returns", 3}, {"scan_direction", 1}, {"edge_of_flight_line", 1}});
    record.bits({{"classification", 5}, {"synthetic", 1}, {"key_point", 1}, {"withheld", 1}});
    record.scaled("scan_angle", Type::FLOAT32, Type::INT8, 1, 0);
    record.plain("user_data", Type::UINT8);
  }
  record.plain("point_source_id", Type::UINT16);
  if (parts.time) record.plain("gps_time", Type::FLOAT64);
  if (parts.colour) record.colour();
  if (parts.infrared) record.plain("nir", Type::UINT16);
  if (parts.waves) {
    record.plain("wave_descriptor", Type::UINT8);
    record.plain("wave_offset", Type::UINT64);
    record.plain("wave_size", Type::UINT32);
    for (const char* name : {"wave_location", "wave_dx", "wave_dy", "wave_dz"}) record.plain(name, Type::FLOAT32);
  }
  return std::move(record.fields);
}

std::vector<std::uint32_t> layOutLas(const std::vector<LasField>& fields, pcl::PCLPointCloud2& cloud)
{
  std::vector<std::uint32_t> offsets;
  for (const LasField& field : fields) {
    offsets.push_back(cloud.point_step);
    addField(cloud, field.name, field.datatype, field.count);
  }
  return offsets;
}

void decodeLas(const LasField& field, const char* records, std::size_t record_length, std::size_t points,
               std::uint8_t* out, std::size_t step, unsigned colour_shift)
{
  const char* const from = records + field.at;
  if (field.kind == LasField::Kind::colour) {
    for (std::size_t i = 0; i < points; ++i) store(out + i * step, packed(from + i * record_length, colour_shift));
    return;
  }
  if (field.kind == LasField::Kind::bits) {
    const unsigned mask = (1U << field.bits) - 1;
    for (std::size_t i = 0; i < points; ++i) {
      const auto byte = static_cast<std::uint8_t>(from[i * record_length]);
      out[i * step] = static_cast<std::uint8_t>(byte >> field.shift & mask);
    }
    return;
  }
  withFieldType(field.stored, [&](auto zero) {
    using Stored = decltype(zero);
    forEachValue(field, points, [&](std::size_t i, std::uint32_t k) {
      const auto stored = loaded<Stored>(from + i * record_length + k * sizeof(Stored));
      if (field.kind == LasField::Kind::plain) {
        store(out + i * step + k * sizeof stored, stored);
      }
      else if (field.datatype == Type::FLOAT32) {
        store(out + i * step + k * sizeof(float), static_cast<float>(valueOf(stored, field.scaling[k])));
      }
      else {
        store(out + i * step + k * sizeof(double), valueOf(stored, field.scaling[k]));
      }
    });
  });
}

bool encodeLas(const LasField& field, const std::uint8_t* in, std::uint8_t datatype, std::size_t step,
               std::size_t points, char* records, std::size_t record_length)
{
  char* const to = records + field.at;
  bool fits = true;
  withFieldType(datatype, [&](auto cloud_zero) {
    using Value = decltype(cloud_zero);
    withFieldType(field.stored, [&](auto stored_zero) {
      using Stored = decltype(stored_zero);
      const bool coordinate = field.at < 12;
      const bool as_float = field.datatype == Type::FLOAT32;
      const auto read = [&](double value) { return as_float ? static_cast<double>(static_cast<float>(value)) : value; };
      forEachValue(field, points, [&](std::size_t i, std::uint32_t k) {
        const auto value = loaded<Value>(in + i * step + k * sizeof(Value));
        char* const place = to + i * record_length + k * sizeof(Stored);
        if (field.kind == LasField::Kind::bits) {
          std::uint8_t bits = 0;
          const bool held = converted(value, bits) && bits < 1U << field.bits;
          if (held) store(place, static_cast<std::uint8_t>(loaded<std::uint8_t>(place) | bits << field.shift));
          fits = fits && held;
          return;
        }
        Stored stored{};
        bool held = true, exact = true;
        if (field.kind == LasField::Kind::scaled) {
          held = unscaled(static_cast<double>(value), field.scaling[k], read, stored, exact);
        }
        else if constexpr (std::is_same_v<Value, Stored>) {
          stored = value; // the same bits, NaNs too
        }
        else {
          held = converted(value, stored);
        }
        store(place, stored);
        fits = fits && held && (exact || coordinate);
      });
    });
  });
  return fits;
}

void encodeLasColour(const std::uint8_t* in, std::size_t step, std::size_t points, std::size_t red_at, char* records,
                     std::size_t record_length)
{
  constexpr std::uint32_t whole = 257; // 255 becomes 65535
  for (std::size_t i = 0; i < points; ++i) {
    const auto colour = loaded<std::uint32_t>(in + i * step);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t byte = colour >> (16 - 8 * k) & 0xffU;
      store(records + i * record_length + red_at + 2 * k, static_cast<std::uint16_t>(byte * whole));
    }
  }
}

} // namespace pcl_bsh::io
