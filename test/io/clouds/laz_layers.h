// SPDX-License-Identifier: BSD-3-Clause
// Compressed items of LAZ that lie in layers; see laz_coder.h.
#pragma once

#include "laz_items.h"

namespace pcl_bsh::io::laz_test {

/// A stream that is left out when nothing in it changes.
struct LayerCoder {
  Coder coder;
  bool changes = false;
};

struct LayeredItem {
  LayeredItem(std::size_t layer_count, unsigned of_version) : layers(layer_count), version(of_version) {}
  virtual ~LayeredItem() = default;
  virtual void start(const std::string& item, unsigned& channel) = 0;
  virtual void write(const std::string& item, unsigned& channel) = 0;
  std::vector<LayerCoder> layers;
  unsigned version;
};

struct Point14Channel {
  explicit Point14Channel(const std::string& item) : last(item), times(at<std::int64_t>(item, 22), false)
  {
    heights.fill(at<std::int32_t>(item, 8));
    intensities.fill(at<std::uint16_t>(item, 12));
  }

  std::string last;
  bool time_changed = false;
  std::vector<Model> changed{8, Model(128)}, returns{16, Model(16)}, numbers{16, Model(16)}, classes{64, Model(256)},
      flags{64, Model(64)}, user_data{64, Model(256)};
  Model channel{3}, number_at_same_time{13};
  std::array<Median, 12> xs, ys;
  std::array<std::int32_t, 8> heights{};
  std::array<std::uint16_t, 8> intensities{};
  Integers x{32, 2}, y{32, 22}, z{32, 20}, intensity{16, 4}, angle{16, 2}, source{16};
  Times times;
};

struct Point14 : LayeredItem {
  explicit Point14(unsigned of_version) : LayeredItem(9, of_version) {}

  static unsigned channelOf(const std::string& item) { return byteAt(item, 15) >> 4 & 3U; }
  static unsigned numberOf(const std::string& item) { return byteAt(item, 14) & 15U; }
  static unsigned returnsOf(const std::string& item) { return byteAt(item, 14) >> 4; }
  static unsigned flagsOf(const std::string& item) { return (byteAt(item, 15) & 15U) | byteAt(item, 15) >> 6 << 4; }
  static unsigned placeOf(const std::string& item)
  {
    return (numberOf(item) == 1 ? 1U : 0U) + (numberOf(item) >= returnsOf(item) ? 2U : 0U);
  }

  void start(const std::string& item, unsigned& channel) override
  {
    channel = current = channelOf(item);
    channels[current].emplace(item);
    layers[0].changes = true;
  }

  void write(const std::string& item, unsigned& channel) override
  {
    Point14Channel& before = *channels[current];
    const unsigned to = channelOf(item);
    if (!channels[to]) channels[to].emplace(before.last);
    Point14Channel& c = *channels[to];
    const unsigned n = returnsOf(item), r = numberOf(item), last_n = returnsOf(c.last), last_r = numberOf(c.last);
    const bool time = at<std::int64_t>(item, 22) != at<std::int64_t>(c.last, 22),
               angle = at<std::int16_t>(item, 18) != at<std::int16_t>(c.last, 18),
               source = at<std::uint16_t>(item, 20) != at<std::uint16_t>(c.last, 20);
    const unsigned step = (r + 16 - last_r) % 16, step_code = step == 0 ? 0 : step == 1 ? 1 : step == 15 ? 2 : 3;
    Coder& out = layers[0].coder;
    out.symbol(before.changed[placeOf(before.last) + (before.time_changed ? 4U : 0U)],
               step_code | (n != last_n ? 4U : 0U) | (angle ? 8U : 0U) | (time ? 16U : 0U) | (source ? 32U : 0U) |
                   (to != current ? 64U : 0U));
    if (to != current) out.symbol(before.channel, (to + 3 - current) % 4);
    channel = version >= 4 || to != current ? to : 0;
    current = to;
    if (n != last_n) out.symbol(c.returns[last_n], n);
    if (step_code == 3 && time) out.symbol(c.numbers[last_r], r);
    if (step_code == 3 && !time) out.symbol(c.number_at_same_time, step - 2);

    static constexpr unsigned contexts[16][16] = {
        {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5}, {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
        {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3}, {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
        {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4}, {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
        {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4}, {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
        {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4}, {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
        {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4}, {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
        {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4}, {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
        {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5}, {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5},
    };
    const std::size_t context = 2 * std::size_t{contexts[n][r]} + (time ? 1 : 0);
    const unsigned single = n == 1 ? 1 : 0, place = placeOf(item), time_bit = time ? 1 : 0;
    const std::int32_t dx = minus(at<std::int32_t>(item, 0), at<std::int32_t>(c.last, 0)),
                       dy = minus(at<std::int32_t>(item, 4), at<std::int32_t>(c.last, 4));
    c.x.write(out, c.xs[context].sorted[2], dx, single);
    c.xs[context].add(dx);
    c.y.write(out, c.ys[context].sorted[2], dy, single + evenBelow(c.x.width, 20));
    c.ys[context].add(dy);

    const auto differs = [&](std::size_t from, std::size_t bytes) {
      return item.compare(from, bytes, c.last, from, bytes) != 0;
    };
    std::int32_t& height = c.heights[levelOf(n, r)];
    c.z.write(layer(1, differs(8, 4)), height, at<std::int32_t>(item, 8),
              single + evenBelow((c.x.width + c.y.width) / 2, 18));
    height = at<std::int32_t>(item, 8);
    layer(2, differs(16, 1)).symbol(c.classes[(byteAt(c.last, 16) & 31U) * 2 + (place == 3 ? 1 : 0)], byteAt(item, 16));
    layer(3, flagsOf(item) != flagsOf(c.last)).symbol(c.flags[flagsOf(c.last)], flagsOf(item));
    std::uint16_t& intensity = c.intensities[2 * place + time_bit];
    c.intensity.write(layer(4, differs(12, 2)), intensity, at<std::uint16_t>(item, 12), place);
    intensity = at<std::uint16_t>(item, 12);
    if (angle) c.angle.write(layer(5, true), at<std::int16_t>(c.last, 18), at<std::int16_t>(item, 18), time_bit);
    layer(6, differs(17, 1)).symbol(c.user_data[byteAt(c.last, 17) / 4], byteAt(item, 17));
    if (source) c.source.write(layer(7, true), at<std::uint16_t>(c.last, 20), at<std::uint16_t>(item, 20));
    if (time) c.times.write(layer(8, true), at<std::int64_t>(item, 22));
    c.last = item;
    c.time_changed = time;
  }

  Coder& layer(std::size_t index, bool changes)
  {
    if (changes) layers[index].changes = true;
    return layers[index].coder;
  }

  std::array<std::optional<Point14Channel>, 4> channels;
  unsigned current = 0;
};

/// Items behind the first: each channel has models and a last item. Version 3 takes the last item of the channel that
/// is left, unless the channel is new.
template <class Models>
struct ChannelItem : LayeredItem {
  ChannelItem(std::size_t layer_count, unsigned of_version, Models fresh_models)
  : LayeredItem(layer_count, of_version),
    fresh(std::move(fresh_models))
  {
  }

  void start(const std::string& item, unsigned& channel) override
  {
    current = channel;
    lasts[channel] = item;
    models[channel] = fresh;
  }

  void write(const std::string& item, unsigned& channel) override
  {
    std::string* last = &*lasts[current];
    if (channel != current) {
      const bool is_new = !lasts[channel];
      if (is_new) {
        lasts[channel] = *last;
        models[channel] = fresh;
      }
      if (is_new || version >= 4) last = &*lasts[channel];
      current = channel;
    }
    encode(*models[current], *last, item);
    *last = item;
  }

  virtual void encode(Models& with, const std::string& last, const std::string& item) = 0;

  Models fresh;
  std::array<std::optional<std::string>, 4> lasts;
  std::array<std::optional<Models>, 4> models;
  unsigned current = 0;
};

struct ColourModels14 {
  Colours colours;
  Model changed{4};
  std::vector<Model> infrared{2, Model(256)};
};

struct Rgb14 : ChannelItem<ColourModels14> {
  Rgb14(unsigned of_version, bool infrared) : ChannelItem(infrared ? 2 : 1, of_version, {}) {}
  void encode(ColourModels14& with, const std::string& last, const std::string& item) override
  {
    layers[0].changes |= item.compare(0, 6, last, 0, 6) != 0;
    with.colours.write(layers[0].coder, last, item);
    if (layers.size() == 1) return;
    unsigned changes = 0;
    for (unsigned k = 0; k < 2; ++k)
      if (item[6 + k] != last[6 + k]) changes |= 1U << k;
    layers[1].changes |= changes != 0;
    layers[1].coder.symbol(with.changed, changes);
    for (unsigned k = 0; k < 2; ++k)
      if ((changes >> k & 1U) != 0)
        layers[1].coder.symbol(with.infrared[k], (byteAt(item, 6 + k) - byteAt(last, 6 + k)) & 255U);
  }
};

struct WavePacket14 : ChannelItem<Waves> {
  explicit WavePacket14(unsigned of_version) : ChannelItem(1, of_version, {}) {}
  void encode(Waves& with, const std::string& last, const std::string& item) override
  {
    layers[0].changes |= item != last;
    with.write(layers[0].coder, last, item);
  }
};

struct Bytes14 : ChannelItem<std::vector<Model>> {
  Bytes14(unsigned of_version, std::size_t size) : ChannelItem(size, of_version, std::vector<Model>(size, Model(256)))
  {
  }
  void encode(std::vector<Model>& with, const std::string& last, const std::string& item) override
  {
    for (unsigned k = 0; k < item.size(); ++k) {
      layers[k].changes |= item[k] != last[k];
      layers[k].coder.symbol(with[k], (byteAt(item, k) - byteAt(last, k)) & 255U);
    }
  }
};

} // namespace pcl_bsh::io::laz_test
