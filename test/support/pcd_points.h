// SPDX-License-Identifier: BSD-3-Clause
// Points of PCD files, in ascii or binary, for tests of what knows no files.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

struct PcdPoints {
  Scalar scalar = Scalar::float32;
  std::vector<Point3> points;
};

/// @throws std::runtime_error naming the file when it is not there, or has no fields x, y, z of one type, float32 or
///   float64, or is compressed
inline PcdPoints readPcdPoints(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  const auto wrong = [&](const std::string& what) { return std::runtime_error(path + ": " + what); };
  std::map<std::string, std::vector<std::string>> header;
  std::string line;
  while (header.count("DATA") == 0) {
    if (!std::getline(file, line)) throw wrong("is no PCD file");
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    while (words >> word) header[key].push_back(word);
  }
  const auto entry = [&](const char* key, std::size_t i) -> const std::string& {
    if (header[key].size() <= i) throw wrong("its header lacks " + std::string(key));
    return header[key][i];
  };
  const std::string axes[] = {"x", "y", "z"};
  std::size_t column_of[3] = {}, offset_of[3] = {}, width = 0, columns = 0, stride = 0, found = 0;
  for (std::size_t i = 0; i < header["FIELDS"].size(); ++i) {
    const std::size_t size = std::stoul(entry("SIZE", i)), count = std::stoul(entry("COUNT", i));
    for (std::size_t k = 0; k < 3; ++k)
      if (header["FIELDS"][i] == axes[k]) {
        if (entry("TYPE", i) != "F" || (width != 0 && width != size)) throw wrong("x, y and z are of other types");
        column_of[k] = columns;
        offset_of[k] = stride;
        width = size;
        ++found;
      }
    columns += count;
    stride += size * count;
  }
  if (found != 3) throw wrong("it has no x, y and z");
  PcdPoints read;
  read.scalar = width == sizeof(float) ? Scalar::float32 : Scalar::float64;
  read.points.resize(std::stoul(entry("POINTS", 0)));
  const std::string data = entry("DATA", 0);
  std::vector<char> record(stride);
  for (Point3& point : read.points) {
    if (data == "binary") {
      file.read(record.data(), static_cast<std::streamsize>(stride));
      for (std::size_t k = 0; k < 3; ++k) {
        float narrow = 0;
        if (read.scalar == Scalar::float32)
          std::memcpy(&narrow, record.data() + offset_of[k], sizeof narrow);
        else
          std::memcpy(&point[k], record.data() + offset_of[k], sizeof(double));
        if (read.scalar == Scalar::float32) point[k] = static_cast<double>(narrow);
      }
    }
    else if (data == "ascii") {
      std::string word;
      for (std::size_t column = 0; column < columns; ++column) {
        file >> word;
        for (std::size_t k = 0; k < 3; ++k) // strtod, for streams read neither nan nor inf
          if (column == column_of[k]) point[k] = std::strtod(word.c_str(), nullptr);
      }
    }
    else {
      throw wrong("DATA " + data + " is not read here");
    }
    if (!file) throw wrong("it ends early");
  }
  return read;
}

} // namespace pcl_bsh::test
