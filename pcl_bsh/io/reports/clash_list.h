// SPDX-License-Identifier: BSD-3-Clause
// The question of a list of clashes, and the places where its run looked. They make lists of two runs comparable.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/reports/bcf_topics.h>
#include <pcl_bsh/question/question.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// A question with a clearance. Read from a list, it has the options that the list states, and no others.
struct ClashQuestion : Question {
  std::string input, obstacle; ///< file names
};

/// The source of a point of an input that is made of several files.
struct SourcePoint {
  std::string file;
  std::uint32_t record = 0;
};

/// An uncertainty as text: a length or `K x field NAME`, then the uncertainty of poses, if any.
std::string uncertaintyText(const Uncertainty& uncertainty);

/// An uncertainty in JSON: a length; or an object of a length, or of a field and how many of its sigmas count, with the
/// uncertainty of poses, if any.
Json uncertaintyJson(const Uncertainty& uncertainty);

/// Where a run looked.
struct Survey {
  std::size_t poses = 0;
  std::string path_checksum;  ///< of all numbers of the poses, in order
  std::optional<Extent> path; ///< of the obstacle's origin on it
  std::optional<Extent> scan; ///< of the input's finite points

  Survey() = default;
  Survey(const std::vector<Eigen::Isometry3d>& poses, const std::optional<Extent>& scan);
};

/// The question of a run about an obstacle, and the clashes that it listed, without points and pairs.
struct ClashList {
  std::string name; ///< of the obstacle, where the file lists several
  ClashQuestion question;
  bool states_options = true;   ///< false of lists of earlier versions, which state the clearance alone
  std::optional<Survey> survey; ///< none of lists of earlier versions
  std::vector<Clash> clashes;
  BcfTopics topics = {}; ///< of a BCF file
};

/// A list in JSON, from a file of its own or from a BCF file.
struct ListText {
  std::string list;
  std::string name; ///< file, and entry in a BCF file, for errors
  BcfTopics topics = {};
};

/// @throws as readClashLists()
ListText readListText(const std::filesystem::path& path);

/// Parses the lists of a text. @throws as readClashLists()
std::vector<ClashList> listsOf(const ListText& text);

/// The lists of an earlier run, one for each of its obstacles, for compareWithEarlier().
/// @param path of a list in JSON, or of BCF
/// @throws files::FileError when the file cannot be read, or is no BCF; JsonError naming the place in it that no run
/// would have written
std::vector<ClashList> readClashLists(const std::filesystem::path& path);

/// Parses such a list in JSON. @throws JsonError, whose message begins with `name`
std::vector<ClashList> parseClashLists(std::string_view text, const std::string& name);

/// Finds the list of an obstacle by its name or, where one of the two has no name, by its file. Returns null where
/// there was no such obstacle.
const ClashList* findList(const std::vector<ClashList>& lists, const std::string& name, const ClashQuestion& question);

/// Whether the earlier list, read from `path`, can tell what is new now.
/// @return warnings, a line each: clouds of other names; motion between poses tested in one run only; a list of an
///   earlier version. Names of inputs may differ in numbers, months and weekdays, as from week to week
/// @throws files::FileError when options differ that decide which points collide: clashes would seem new or resolved
///   that are not. These are all options except swept motion and `seen`, whose places are listed apart
std::vector<std::string> requireComparable(const std::filesystem::path& path, const ClashList& earlier,
                                           const ClashQuestion& now);

/// Whether the two runs looked at the same places.
/// @param nearness boxes of scans are equal if their sides differ by no more than this
/// @return warnings, a line each: another path, a scan of another extent
std::vector<std::string> surveyWarnings(const std::filesystem::path& path, const ClashList& earlier, const Survey& now,
                                        double nearness);

} // namespace pcl_bsh::io
