// SPDX-License-Identifier: BSD-3-Clause
// Compressed items of LAZ; see laz_coder.h.
#pragma once

#include "laz_coder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>

namespace pcl_bsh::io::laz_test {

template <typename T>
T at(const std::string& bytes, std::size_t place)
{
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

inline unsigned byteAt(const std::string& bytes, std::size_t place)
{
  return static_cast<unsigned char>(bytes[place]);
}

struct Item {
  virtual ~Item() = default;
  virtual void start(const std::string& item) = 0;
  virtual void write(Coder& out, const std::string& item) = 0;
};

/// Five values in order; the new one takes the place of the least or the greatest.
struct Median {
  void add(std::int32_t value)
  {
    const std::int32_t before = sorted[2];
    sorted.erase(greatest_goes ? sorted.end() - 1 : sorted.begin());
    sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), value), value);
    if (greatest_goes ? value >= before : value <= before) greatest_goes = !greatest_goes;
  }

  std::vector<std::int32_t> sorted = std::vector<std::int32_t>(5);
  bool greatest_goes = true;
};

inline std::int32_t minus(std::int32_t a, std::int32_t b)
{
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

inline unsigned evenBelow(unsigned width, unsigned most)
{
  return width < most ? width / 2 * 2 : most;
}

inline unsigned levelOf(unsigned n, unsigned r)
{
  return std::min(n > r ? n - r : r - n, 7U);
}

struct Point10V1 : Item {
  void start(const std::string& item) override { last = item; }
  void write(Coder& out, const std::string& item) override
  {
    const auto median = [](std::array<std::int32_t, 3> of) {
      std::sort(of.begin(), of.end());
      return of[1];
    };
    const std::int32_t dx = minus(at<std::int32_t>(item, 0), at<std::int32_t>(last, 0)),
                       dy = minus(at<std::int32_t>(item, 4), at<std::int32_t>(last, 4));
    x.write(out, median(xs), dx);
    y.write(out, median(ys), dy, std::min(x.width, 19U));
    const unsigned width = (x.width + y.width) / 2;
    z.write(out, at<std::int32_t>(last, 8), at<std::int32_t>(item, 8), std::min(width, 19U));
    unsigned changes = at<std::uint16_t>(item, 12) != at<std::uint16_t>(last, 12) ? 32 : 0;
    for (unsigned k = 0; k < 4; ++k)
      if (item[14 + k] != last[14 + k]) changes |= 16U >> k;
    if (at<std::uint16_t>(item, 18) != at<std::uint16_t>(last, 18)) changes |= 1;
    out.symbol(changed, changes);
    if ((changes & 32U) != 0) intensity.write(out, at<std::uint16_t>(last, 12), at<std::uint16_t>(item, 12));
    if ((changes & 16U) != 0) out.symbol(bytes[0][byteAt(last, 14)], byteAt(item, 14));
    if ((changes & 8U) != 0) out.symbol(bytes[1][byteAt(last, 15)], byteAt(item, 15));
    if ((changes & 4U) != 0)
      angle.write(out, static_cast<int>(byteAt(last, 16)), static_cast<int>(byteAt(item, 16)), width < 3);
    if ((changes & 2U) != 0) out.symbol(bytes[2][byteAt(last, 17)], byteAt(item, 17));
    if ((changes & 1U) != 0) source.write(out, at<std::uint16_t>(last, 18), at<std::uint16_t>(item, 18));
    xs[next] = dx;
    ys[next] = dy;
    next = (next + 1) % 3;
    last = item;
  }

  std::string last;
  std::array<std::int32_t, 3> xs{}, ys{};
  std::size_t next = 0;
  Integers x{32}, y{32, 20}, z{32, 20}, intensity{16}, angle{8, 2}, source{16};
  Model changed{64};
  std::vector<std::vector<Model>> bytes{3, std::vector<Model>(256, Model(256))};
};

struct Point10V2 : Item {
  void start(const std::string& item) override
  {
    last = item;
    last[12] = last[13] = 0;
  }
  void write(Coder& out, const std::string& item) override
  {
    static constexpr unsigned contexts[8][8] = {
        {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},    {13, 1, 2, 4, 7, 11, 11, 10},
        {12, 3, 4, 5, 8, 12, 12, 11},    {11, 6, 7, 8, 9, 13, 13, 12},   {10, 10, 11, 12, 13, 14, 14, 13},
        {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
    };
    const unsigned flags = byteAt(item, 14), r = flags & 7U, n = flags >> 3 & 7U, m = contexts[n][r];
    const auto of = at<std::uint16_t>(item, 12);
    unsigned changes = (item[14] != last[14] ? 32 : 0) | (of != intensities[m] ? 16 : 0);
    for (unsigned k = 0; k < 3; ++k)
      if (item[15 + k] != last[15 + k]) changes |= 8U >> k;
    if (at<std::uint16_t>(item, 18) != at<std::uint16_t>(last, 18)) changes |= 1;
    out.symbol(changed, changes);
    if ((changes & 32U) != 0) out.symbol(bytes[0][byteAt(last, 14)], flags);
    if ((changes & 16U) != 0) intensity.write(out, intensities[m], of, std::min(m, 3U));
    if ((changes & 16U) != 0) intensities[m] = of;
    if ((changes & 8U) != 0) out.symbol(bytes[1][byteAt(last, 15)], byteAt(item, 15));
    if ((changes & 4U) != 0) out.symbol(angles[flags >> 6 & 1U], (byteAt(item, 16) - byteAt(last, 16)) & 255U);
    if ((changes & 2U) != 0) out.symbol(bytes[2][byteAt(last, 17)], byteAt(item, 17));
    if ((changes & 1U) != 0) source.write(out, at<std::uint16_t>(last, 18), at<std::uint16_t>(item, 18));

    const unsigned single = n == 1 ? 1 : 0;
    const std::int32_t dx = minus(at<std::int32_t>(item, 0), at<std::int32_t>(last, 0)),
                       dy = minus(at<std::int32_t>(item, 4), at<std::int32_t>(last, 4));
    x.write(out, xs[m].sorted[2], dx, single);
    xs[m].add(dx);
    y.write(out, ys[m].sorted[2], dy, single + evenBelow(x.width, 20));
    ys[m].add(dy);
    std::int32_t& height = heights[levelOf(n, r)];
    z.write(out, height, at<std::int32_t>(item, 8), single + evenBelow((x.width + y.width) / 2, 18));
    height = at<std::int32_t>(item, 8);
    last = item;
  }

  std::string last;
  std::array<Median, 16> xs, ys;
  std::array<std::uint16_t, 16> intensities{};
  std::array<std::int32_t, 8> heights{};
  Integers x{32, 2}, y{32, 22}, z{32, 20}, intensity{16, 4}, source{16};
  Model changed{64};
  std::vector<Model> angles{2, Model(256)};
  std::vector<std::vector<Model>> bytes{3, std::vector<Model>(256, Model(256))};
};

struct GpsTime11V1 : Item {
  void start(const std::string& item) override { last = at<std::int64_t>(item, 0); }
  void write(Coder& out, const std::string& item) override
  {
    const auto now = at<std::int64_t>(item, 0);
    const auto difference =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(now) - static_cast<std::uint64_t>(last));
    const auto d = static_cast<std::int32_t>(difference);
    const bool small = d == difference;
    last = now;
    if (last_difference == 0) {
      out.symbol(zero, d == 0 && small ? 0 : small ? 1 : 2);
      if (small && d != 0) integers.write(out, 0, last_difference = d, 0);
      if (!small) out.bits64(static_cast<std::uint64_t>(now));
      return;
    }
    if (small && d == 0) return out.symbol(multiples, 511);
    if (!small) {
      out.symbol(multiples, 510);
      return out.bits64(static_cast<std::uint64_t>(now));
    }
    const double ratio = std::floor(double{static_cast<float>(d)} / last_difference + 0.5);
    const auto multiple = static_cast<std::int32_t>(std::clamp(ratio, 0.0, 509.0));
    out.symbol(multiples, static_cast<unsigned>(multiple));
    const unsigned context = multiple == 1 ? 1 : multiple == 0 ? 2 : multiple < 10 ? 3 : multiple < 50 ? 4 : 5;
    const auto prediction =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(last_difference));
    integers.write(out, multiple == 0 ? last_difference / 4 : prediction, d, context);
    if (multiple == 0 || multiple == 509) ++extremes;
    if (multiple == 1 || ((multiple == 0 || multiple == 509) && extremes > 3)) {
      last_difference = d;
      extremes = 0;
    }
  }

  std::int64_t last = 0;
  std::int32_t last_difference = 0;
  unsigned extremes = 0;
  Model zero{3}, multiples{512};
  Integers integers{32, 6};
};

/// Times of GPSTIME11 version 2, and without the symbols of an unchanged time of POINT14.
struct Times {
  Times(std::int64_t first, bool with_unchanged) : times{first}, skip(with_unchanged ? 0 : 1) {}

  void write(Coder& out, std::int64_t now)
  {
    const auto from = [&](unsigned sequence) {
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(now) - static_cast<std::uint64_t>(times[sequence]));
    };
    const auto small = [](std::int64_t of) { return static_cast<std::int32_t>(of) == of; };
    const bool after_zero = differences[last] == 0;
    Model& model = after_zero ? zero : multiples;
    const unsigned huge_symbol = after_zero ? 2 : 512;
    if (now == times[last] && skip == 0) return out.symbol(model, after_zero ? 0 : 511);
    if (!small(from(last))) {
      for (unsigned i = 1; i < 4; ++i) {
        if (!small(from((last + i) % 4))) continue;
        out.symbol(model, huge_symbol + i - skip);
        last = (last + i) % 4;
        return write(out, now);
      }
      out.symbol(model, huge_symbol - skip);
      integers.write(out, static_cast<std::int32_t>(times[last] >> 32), static_cast<std::int32_t>(now >> 32), 8);
      out.bits(32, static_cast<std::uint32_t>(now));
      last = newest = (newest + 1) % 4;
      differences[last] = 0;
      extremes[last] = 0;
      times[last] = now;
      return;
    }
    const auto d = static_cast<std::int32_t>(from(last));
    times[last] = now;
    if (after_zero) {
      out.symbol(zero, 1 - skip);
      integers.write(out, 0, d, 0);
      differences[last] = d;
      extremes[last] = 0;
      return;
    }
    const double ratio = std::round(double{static_cast<float>(d)} / differences[last]);
    const auto multiple = static_cast<std::int32_t>(std::clamp(ratio, -10.0, 500.0));
    out.symbol(multiples, static_cast<unsigned>(multiple >= 0 ? multiple : 500 - multiple));
    const auto prediction =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(differences[last]));
    const unsigned context = multiple == 1     ? 1
                             : multiple == 0   ? 7
                             : multiple == -10 ? 6
                             : multiple < 0    ? 5
                             : multiple < 10   ? 2
                             : multiple < 500  ? 3
                                               : 4;
    integers.write(out, prediction, d, context);
    if (multiple == 1) extremes[last] = 0;
    if ((multiple == 0 || multiple == -10 || multiple == 500) && ++extremes[last] > 3) {
      differences[last] = d;
      extremes[last] = 0;
    }
  }

  std::array<std::int64_t, 4> times;
  unsigned skip;
  std::array<std::int32_t, 4> differences{};
  std::array<unsigned, 4> extremes{};
  unsigned last = 0, newest = 0;
  Model zero{6 - skip}, multiples{516 - skip};
  Integers integers{32, 9};
};

struct GpsTime11V2 : Item {
  void start(const std::string& item) override { times.emplace(at<std::int64_t>(item, 0), true); }
  void write(Coder& out, const std::string& item) override { times->write(out, at<std::int64_t>(item, 0)); }
  std::optional<Times> times;
};

struct Rgb12V1 : Item {
  void start(const std::string& item) override { last = item; }
  void write(Coder& out, const std::string& item) override
  {
    unsigned changes = 0;
    for (unsigned k = 0; k < 6; ++k)
      if (item[k] != last[k]) changes |= 1U << k;
    out.symbol(changed, changes);
    for (unsigned k = 0; k < 6; ++k)
      if (item[k] != last[k])
        integers.write(out, static_cast<int>(byteAt(last, k)), static_cast<int>(byteAt(item, k)), k);
    last = item;
  }
  std::string last;
  Model changed{64};
  Integers integers{8, 6};
};

struct Colours {
  void write(Coder& out, const std::string& last, const std::string& item)
  {
    const auto now = [&](unsigned k) { return static_cast<int>(byteAt(item, k)); };
    const auto before = [&](unsigned k) { return static_cast<int>(byteAt(last, k)); };
    unsigned changes = 0;
    for (unsigned k = 0; k < 6; ++k)
      if (item[k] != last[k]) changes |= 1U << k;
    for (unsigned k = 2; k < 6; ++k)
      if (item[k] != item[k % 2]) changes |= 64;
    out.symbol(changed, changes);
    const auto difference = [&](unsigned k, int prediction) {
      if (item[k] != last[k]) out.symbol(models[k], static_cast<unsigned>(now(k) - prediction) & 255U);
    };
    difference(0, before(0));
    difference(1, before(1));
    if ((changes & 64U) == 0) return;
    for (unsigned half = 0; half < 2; ++half) {
      int d = now(half) - before(half);
      difference(2 + half, std::clamp(before(2 + half) + d, 0, 255));
      d = (d + now(2 + half) - before(2 + half)) / 2;
      difference(4 + half, std::clamp(before(4 + half) + d, 0, 255));
    }
  }
  Model changed{128};
  std::vector<Model> models{6, Model(256)};
};

struct Rgb12V2 : Item {
  void start(const std::string& item) override { last = item; }
  void write(Coder& out, const std::string& item) override
  {
    colours.write(out, last, item);
    last = item;
  }
  std::string last;
  Colours colours;
};

struct Waves {
  void write(Coder& out, const std::string& last, const std::string& item)
  {
    out.symbol(descriptor, byteAt(item, 0));
    const auto before = at<std::uint64_t>(last, 1), now = at<std::uint64_t>(item, 1);
    const auto d = static_cast<std::int64_t>(now - before);
    unsigned way = 3;
    if (static_cast<std::int32_t>(d) == d) way = d == 0 ? 0 : d == at<std::uint32_t>(last, 9) ? 1 : 2;
    out.symbol(ways[last_way], way);
    last_way = way;
    if (way == 2) {
      differences.write(out, last_difference, static_cast<std::int32_t>(d));
      last_difference = static_cast<std::int32_t>(d);
    }
    if (way == 3) out.bits64(now);
    sizes.write(out, at<std::int32_t>(last, 9), at<std::int32_t>(item, 9));
    locations.write(out, at<std::int32_t>(last, 13), at<std::int32_t>(item, 13));
    for (unsigned k = 0; k < 3; ++k)
      directions.write(out, at<std::int32_t>(last, 17 + 4 * k), at<std::int32_t>(item, 17 + 4 * k), k);
  }
  Model descriptor{256};
  std::vector<Model> ways{4, Model(4)};
  unsigned last_way = 0;
  std::int32_t last_difference = 0;
  Integers differences{32}, sizes{32}, locations{32}, directions{32, 3};
};

struct WavePacket13 : Item {
  void start(const std::string& item) override { last = item; }
  void write(Coder& out, const std::string& item) override
  {
    waves.write(out, last, item);
    last = item;
  }
  std::string last;
  Waves waves;
};

struct BytesV1 : Item {
  explicit BytesV1(std::size_t size) : integers(8, static_cast<unsigned>(size)) {}
  void start(const std::string& item) override { last = item; }
  void write(Coder& out, const std::string& item) override
  {
    for (unsigned k = 0; k < item.size(); ++k)
      integers.write(out, static_cast<int>(byteAt(last, k)), static_cast<int>(byteAt(item, k)), k);
    last = item;
  }
  std::string last;
  Integers integers;
};

struct BytesV2 : Item {
  explicit BytesV2(std::size_t size) : models(size, Model(256)) {}
  void start(const std::string& item) override { last = item; }
  void write(Coder& out, const std::string& item) override
  {
    for (unsigned k = 0; k < item.size(); ++k) out.symbol(models[k], (byteAt(item, k) - byteAt(last, k)) & 255U);
    last = item;
  }
  std::string last;
  std::vector<Model> models;
};

} // namespace pcl_bsh::io::laz_test
