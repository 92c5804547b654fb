// SPDX-License-Identifier: BSD-3-Clause
// The item POINT14, versions 3 and 4: what all records of formats 6 to 10 begin with, in nine layers.
#include <pcl_bsh/io/clouds/las/laz/gps_times.h>
#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>
#include <pcl_bsh/io/clouds/las/laz/return_contexts.h>
#include <pcl_bsh/io/clouds/las/laz/streaming_median.h>

#include <algorithm>

namespace pcl_bsh::io::laz {

namespace {

/// A record's first 30 bytes, apart.
struct Point14 {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0, source = 0;
  std::uint8_t number = 0, returns = 0;
  std::uint8_t flags = 0; ///< four of the classification, scan direction, edge of flight line
  std::uint8_t channel = 0, classification = 0, user_data = 0;
  std::int16_t angle = 0;
  std::uint64_t time = 0;

  explicit Point14(const char* item)
  : x(loaded<std::int32_t>(item)),
    y(loaded<std::int32_t>(item + 4)),
    z(loaded<std::int32_t>(item + 8)),
    intensity(loaded<std::uint16_t>(item + 12)),
    source(loaded<std::uint16_t>(item + 20)),
    classification(loaded<std::uint8_t>(item + 16)),
    user_data(loaded<std::uint8_t>(item + 17)),
    angle(loaded<std::int16_t>(item + 18)),
    time(loaded<std::uint64_t>(item + 22))
  {
    const unsigned of_returns = loaded<std::uint8_t>(item + 14), of_flags = loaded<std::uint8_t>(item + 15);
    number = static_cast<std::uint8_t>(of_returns & 15U);
    returns = static_cast<std::uint8_t>(of_returns >> 4);
    flags = static_cast<std::uint8_t>((of_flags & 15U) | (of_flags >> 6 << 4));
    channel = static_cast<std::uint8_t>(of_flags >> 4 & 3U);
  }

  void write(char* item) const
  {
    store(item, x);
    store(item + 4, y);
    store(item + 8, z);
    store(item + 12, intensity);
    store(item + 14, static_cast<std::uint8_t>(number | returns << 4U));
    const unsigned held = flags, of_channel = channel;
    store(item + 15, static_cast<std::uint8_t>((held & 15U) | of_channel << 4U | (held & 0x30U) << 2U));
    store(item + 16, classification);
    store(item + 17, user_data);
    store(item + 18, angle);
    store(item + 20, source);
    store(item + 22, time);
  }
};

enum Layer14 { returns_xy, heights, classes, flags, intensities, angles, user_data, sources, times, layers_14 };

/// Single 3, first 1, last 2, between these 0.
unsigned placeOfReturn(const Point14& point)
{
  return (point.number == 1 ? 1U : 0U) + (point.number >= point.returns ? 2U : 0U);
}

using Models = std::vector<SymbolModel>;

Models models(std::size_t count, unsigned symbols)
{
  return Models(count, SymbolModel(symbols));
}

struct PointChannel {
  explicit PointChannel(const Point14& point) : last(point), times_of(false)
  {
    heights.fill(point.z);
    intensities.fill(point.intensity);
  }

  Point14 last;
  bool time_changed = false; ///< at the last point
  Models changed = models(8, 128), returns = models(16, 16), numbers = models(16, 16), classes = models(64, 256),
         flags = models(64, 64), user_data = models(64, 256);
  SymbolModel channel{3}, number_at_same_time{13};
  std::array<StreamingMedian, 12> x_differences, y_differences;
  std::array<std::int32_t, 8> heights{};
  std::array<std::uint16_t, 8> intensities{};
  IntegerDecompressor x{32, 2}, y{32, 22}, z{32, 20}, intensity{16, 4}, angle{16, 2}, source{16};
  GpsTimes times_of;
};

class Point14Item : public LayeredItem {
public:
  explicit Point14Item(bool tells_channel) : tells_channel_(tells_channel) {}

  std::size_t layers() const override { return layers_14; }

  void start(const char* item, std::span<Layer> layers, unsigned& channel) override
  {
    const Point14 first(item);
    layers_ = layers;
    channel = channel_ = first.channel;
    channels_[channel_].emplace(first);
  }

  void read(char* item, unsigned& channel) override
  {
    ArithmeticDecoder& in = *layers_[returns_xy];
    const PointChannel& before = *channels_[channel_];
    const unsigned changed = readChanges(in, placeOfReturn(before.last) + (before.time_changed ? 4U : 0U));
    const bool other_channel = (changed & 64U) != 0;
    channel = tells_channel_ || other_channel ? channel_ : 0;
    PointChannel& now = *channels_[channel_];
    const bool time_changed = (changed & 16U) != 0;
    readReturns(in, now, changed, time_changed);
    readPlace(in, now, time_changed);
    readAttributes(now, time_changed, (changed & 8U) != 0, (changed & 32U) != 0);
    now.time_changed = time_changed;
    now.last.write(item);
  }

private:
  /// Which attributes change; goes to another channel where they say so.
  unsigned readChanges(ArithmeticDecoder& in, unsigned context)
  {
    PointChannel& before = *channels_[channel_];
    const unsigned changed = in.symbol(before.changed[context]);
    if ((changed & 64U) == 0) return changed;
    channel_ = (channel_ + 1 + in.symbol(before.channel)) % 4;
    if (!channels_[channel_]) channels_[channel_].emplace(before.last);
    channels_[channel_]->last.channel = static_cast<std::uint8_t>(channel_);
    return changed;
  }

  static void readReturns(ArithmeticDecoder& in, PointChannel& now, unsigned changed, bool time_changed)
  {
    Point14& point = now.last;
    if ((changed & 4U) != 0) point.returns = static_cast<std::uint8_t>(in.symbol(now.returns[point.returns]));
    unsigned step = changed & 3U; // 1: one more, 2: one less, 3: other
    if (step == 2) step = 15;
    if (step == 3 && !time_changed) step = 2 + in.symbol(now.number_at_same_time);
    if ((changed & 3U) == 3 && time_changed)
      point.number = static_cast<std::uint8_t>(in.symbol(now.numbers[point.number]));
    else
      point.number = static_cast<std::uint8_t>((point.number + step) % 16);
  }

  void readPlace(ArithmeticDecoder& in, PointChannel& now, bool time_changed)
  {
    Point14& point = now.last;
    static constexpr auto contexts = returnTable<16>(returnContext14);
    const std::size_t context = 2 * std::size_t{contexts[point.returns][point.number]} + (time_changed ? 1 : 0);
    const unsigned single = point.returns == 1 ? 1 : 0;
    const std::int32_t x = now.x.read(in, now.x_differences[context].value(), single);
    now.x_differences[context].add(x);
    const unsigned x_width = std::min(now.x.width() & ~1U, 20U);
    const std::int32_t y = now.y.read(in, now.y_differences[context].value(), single + x_width);
    now.y_differences[context].add(y);
    point.x = static_cast<std::int32_t>(static_cast<std::uint32_t>(point.x) + static_cast<std::uint32_t>(x));
    point.y = static_cast<std::int32_t>(static_cast<std::uint32_t>(point.y) + static_cast<std::uint32_t>(y));
    if (!layers_[heights]) return;
    const unsigned width = std::min((now.x.width() + now.y.width()) / 2 & ~1U, 18U);
    std::int32_t& height = now.heights[returnLevel(point.returns, point.number)];
    point.z = height = now.z.read(*layers_[heights], height, single + width);
  }

  void readAttributes(PointChannel& now, bool time_changed, bool angle_changed, bool source_changed)
  {
    Point14& point = now.last;
    const unsigned place = placeOfReturn(point), time_bit = time_changed ? 1 : 0;
    const auto readByte = [&](Layer14 layer, Models& of, unsigned context, std::uint8_t& byte) {
      if (layers_[layer]) byte = static_cast<std::uint8_t>(layers_[layer]->symbol(of[context]));
    };
    readByte(classes, now.classes, (point.classification & 31U) * 2 + (place == 3 ? 1 : 0), point.classification);
    readByte(flags, now.flags, point.flags, point.flags);
    if (layers_[intensities]) {
      std::uint16_t& last = now.intensities[2 * place + time_bit];
      point.intensity = last = static_cast<std::uint16_t>(now.intensity.read(*layers_[intensities], last, place));
    }
    if (layers_[angles] && angle_changed)
      point.angle = static_cast<std::int16_t>(now.angle.read(*layers_[angles], point.angle, time_bit));
    readByte(user_data, now.user_data, point.user_data / 4U, point.user_data);
    if (layers_[sources] && source_changed)
      point.source = static_cast<std::uint16_t>(now.source.read(*layers_[sources], point.source));
    if (layers_[times] && time_changed) point.time = now.times_of.read(*layers_[times], point.time);
  }

  std::array<std::optional<PointChannel>, 4> channels_;
  std::span<Layer> layers_;
  unsigned channel_ = 0;
  bool tells_channel_;
};

} // namespace

std::unique_ptr<LayeredItem> newPoint14(unsigned version, std::size_t /*size*/)
{
  return std::make_unique<Point14Item>(version >= first_version_of_channels);
}

} // namespace pcl_bsh::io::laz
