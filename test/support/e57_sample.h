// SPDX-License-Identifier: BSD-3-Clause
// Writes E57 files (ASTM E2807), whole or damaged on purpose. They leave out what readers of points do without, and
// strict ones ask for: formatName, guid, versions, images2D, values of elements, namespaces of extensions.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_bsh {

/// A value of each point: its element in the prototype, and what is stored.
struct E57SampleValue {
  std::string element;
  unsigned bits = 0;
  std::vector<std::uint64_t> stored;
  std::string bytes = {}; ///< in place of these

  static std::string limits(std::int64_t least, std::int64_t most)
  {
    return " minimum=\"" + std::to_string(least) + "\" maximum=\"" + std::to_string(most) + "\"";
  }

  static E57SampleValue integer(const std::string& name, std::int64_t least, std::int64_t most,
                                const std::vector<std::int64_t>& values, const std::string& type = "type=\"Integer\"")
  {
    E57SampleValue value{"<" + name + " " + type + limits(least, most) + "/>", 0, {}};
    value.bits =
        static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least)));
    for (const std::int64_t v : values)
      value.stored.push_back(static_cast<std::uint64_t>(v) - static_cast<std::uint64_t>(least));
    return value;
  }

  static E57SampleValue scaled(const std::string& name, std::int64_t least, std::int64_t most, const std::string& scale,
                               const std::string& offset, const std::vector<std::int64_t>& values)
  {
    return integer(name, least, most, values,
                   "type=\"ScaledInteger\" scale=\"" + scale + "\" offset=\"" + offset + "\"");
  }

  static E57SampleValue doubles(const std::string& name, const std::vector<double>& values)
  {
    E57SampleValue value{"<" + name + " type=\"Float\"/>", 64, {}};
    for (const double v : values) value.stored.push_back(std::bit_cast<std::uint64_t>(v));
    return value;
  }

  static E57SampleValue floats(const std::string& name, const std::vector<float>& values,
                               const std::string& attributes = "")
  {
    E57SampleValue value{"<" + name + " type=\"Float\" precision=\"single\"" + attributes + "/>", 32, {}};
    for (const float v : values) value.stored.push_back(std::bit_cast<std::uint32_t>(v));
    return value;
  }

  /// Least significant bits first, one value behind the other.
  std::string stream() const
  {
    if (!bytes.empty()) return bytes;
    std::string packed((bits * stored.size() + 7) / 8, '\0');
    for (std::size_t i = 0; i < stored.size(); ++i)
      for (std::size_t b = 0; b < bits; ++b)
        if ((stored[i] >> b & 1U) != 0) {
          const std::size_t at = i * bits + b;
          packed[at / 8] = static_cast<char>(packed[at / 8] | 1 << at % 8);
        }
    return packed;
  }
};

struct E57SampleScan {
  std::vector<E57SampleValue> values;
  std::string more_xml = {};  ///< as <pose>
  std::string records = {};   ///< recordCount; empty: as many as the first value has
  std::size_t piece = 2000;   ///< bytes of a stream in a packet: streams of other widths are out of step
  bool other_packets = false; ///< an index and an empty packet before each packet of data

  static std::string pose(const std::string& rotation_wxyz, const std::string& translation)
  {
    const auto element = [](const std::string& names, const std::string& numbers) {
      std::istringstream in(numbers);
      std::string xml, number;
      for (const char name : names)
        if (in >> number) xml += std::string("<") + name + " type=\"Float\">" + number + "</" + name + ">";
      return xml;
    };
    return "<pose type=\"Structure\">" +
           (rotation_wxyz.empty() ? ""
                                  : "<rotation type=\"Structure\">" + element("wxyz", rotation_wxyz) + "</rotation>") +
           (translation.empty() ? ""
                                : "<translation type=\"Structure\">" + element("xyz", translation) + "</translation>") +
           "</pose>";
  }
};

struct E57Sample {
  std::vector<E57SampleScan> scans;
  std::string more_xml = {}; ///< in the root
  std::size_t page = 1024;

  template <class T>
  static void append(std::string& to, T number)
  {
    to.append(reinterpret_cast<const char*>(&number), sizeof number);
  }

  std::uint64_t physical(std::uint64_t logical) const { return logical / (page - 4) * page + logical % (page - 4); }

  static std::uint32_t checksum(const std::string& bytes)
  {
    std::uint32_t sum = ~std::uint32_t{0};
    for (const char c : bytes) {
      sum ^= static_cast<std::uint8_t>(c);
      for (int bit = 0; bit < 8; ++bit) sum = sum >> 1U ^ ((sum & 1U) != 0 ? 0x82f63b78U : 0);
    }
    return ~sum;
  }

  /// The file whose content, without checksums, this is.
  std::string paged(std::string logical) const
  {
    logical.resize((logical.size() + page - 5) / (page - 4) * (page - 4));
    std::string file;
    for (std::size_t at = 0; at < logical.size(); at += page - 4) {
      const std::string payload = logical.substr(at, page - 4);
      file += payload;
      const std::uint32_t sum = checksum(payload);
      for (const unsigned shift : {24U, 16U, 8U, 0U}) file += static_cast<char>(sum >> shift);
    }
    return file;
  }

  static std::string packet(char type, std::string rest)
  {
    rest.resize((rest.size() + 4 + 3) / 4 * 4 - 4);
    std::string head{type, '\0'};
    append(head, static_cast<std::uint16_t>(rest.size() + 4 - 1));
    return head + rest;
  }

  std::string section(const E57SampleScan& scan, std::uint64_t at) const
  {
    std::vector<std::string> streams;
    std::size_t packets = 0;
    for (const E57SampleValue& value : scan.values) {
      streams.push_back(value.stream());
      packets = std::max(packets, (streams.back().size() + scan.piece - 1) / scan.piece);
    }
    std::string body;
    for (std::size_t p = 0; p < packets; ++p) {
      if (scan.other_packets) body += packet(0, std::string(12, '\1')) + packet(2, "");
      std::string data;
      append(data, static_cast<std::uint16_t>(streams.size()));
      std::string pieces;
      for (const std::string& stream : streams) {
        const std::string piece = stream.substr(std::min(stream.size(), p * scan.piece), scan.piece);
        append(data, static_cast<std::uint16_t>(piece.size()));
        pieces += piece;
      }
      body += packet(1, data + pieces);
    }
    std::string head(8, '\0');
    head[0] = 1;
    append(head, std::uint64_t{32} + body.size());
    append(head, physical(at + 32));
    append(head, std::uint64_t{0});
    return head + body;
  }

  /// The content without checksums, which paged() makes a file of.
  std::string logical() const
  {
    std::string content(48, '\0'), xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
                                         "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\">\n" +
                                         more_xml + "<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">\n";
    for (const E57SampleScan& scan : scans) {
      const std::string records =
          scan.records.empty() ? std::to_string(scan.values.empty() ? 0 : scan.values[0].stored.size()) : scan.records;
      xml += "<vectorChild type=\"Structure\">" + scan.more_xml + "<points type=\"CompressedVector\" fileOffset=\"" +
             std::to_string(physical(content.size())) + "\" recordCount=\"" + records +
             "\"><prototype type=\"Structure\">";
      for (const E57SampleValue& value : scan.values) xml += value.element + '\n';
      xml += "</prototype></points></vectorChild>\n";
      content += section(scan, content.size());
    }
    return withXml(content, xml + "</data3D></e57Root>\n");
  }

  std::string withXml(std::string content, const std::string& xml) const
  {
    const std::uint64_t at = content.size();
    content += xml;
    const std::uint64_t pages = (content.size() + page - 5) / (page - 4);
    std::string head = "ASTM-E57";
    append(head, std::uint32_t{1});
    append(head, std::uint32_t{0});
    append(head, pages * page);
    append(head, physical(at));
    append(head, static_cast<std::uint64_t>(xml.size()));
    append(head, static_cast<std::uint64_t>(page));
    return content.replace(0, head.size(), head);
  }

  std::string text() const { return paged(logical()); }

  /// One scan of a few Cartesian points, which are double.
  static E57SampleScan points(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z)
  {
    return {{E57SampleValue::doubles("cartesianX", x), E57SampleValue::doubles("cartesianY", y),
             E57SampleValue::doubles("cartesianZ", z)}};
  }
};

} // namespace pcl_bsh
