// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/scan_origins.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/question/record_numbers.h>
#include <pcl_bsh/question/text_numbers.h>
#include <pcl_bsh/seen/seen_space.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace pcl_bsh {
namespace {

[[noreturn]] void refuseText(const std::string& text)
{
  throw InvalidInput(Input::seen, "origin", "'" + text + "' is none",
                     "give X,Y,Z, or of several scans FIELD:N=X,Y,Z;N=X,Y,Z by the field that numbers them");
}

std::string textOf(const Point3& p)
{
  return textOfNumbers(p[0], p[1], p[2]);
}

/// Records of the subsets of a cloud, and what keeps the cloud alive.
struct Subsets {
  std::shared_ptr<const void> points;
  std::vector<std::vector<std::int32_t>> records;
};

/// The scan of each record of a cloud.
class ScanNumbers {
public:
  ScanNumbers(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
              const ScanOrigins& origins)
  : origins_(origins),
    cloud_(cloud)
  {
    if (!origins.field.empty())
      numbers_.emplace(view, fields, origins.field, cloud,
                       RecordNumbers::Purpose{Input::points, "that numbers its scans", "give one of its fields"});
  }

  /// @throws InvalidInput where the scan has no origin
  std::size_t operator[](std::uint32_t record) const
  {
    if (!numbers_) return 0;
    const double scan = (*numbers_)[record];
    const auto found = std::find_if(origins_.entries.begin(), origins_.entries.end(),
                                    [&](const ScanOrigins::Entry& entry) { return entry.scan == scan; });
    if (found == origins_.entries.end()) {
      throw InvalidInput(
          Input::points, cloud_,
          plainText("point ", record, " is of scan ", scan, " in field '", origins_.field, "', which has no origin"),
          "give one for each scan")
          .withIndex(record);
    }
    return static_cast<std::size_t>(found - origins_.entries.begin());
  }

private:
  const ScanOrigins& origins_;
  const std::string& cloud_;
  std::optional<RecordNumbers> numbers_; ///< none: there is one scan
};

/// Adds the beams of records without coordinates.
void addMisses(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud, double beyond,
               const ScanNumbers& scan_of, std::vector<ScanBeams>& scans)
{
  const auto numbersOf = [&](std::string_view name) {
    return RecordNumbers(view, fields, std::string(name), cloud,
                         {Input::seen, "of beams without a return",
                          "leave out `seen_beyond`, or read an .e57 with its beams; the fields are"});
  };
  const RecordNumbers x = numbersOf(beam_field_names[0]), y = numbersOf(beam_field_names[1]),
                      z = numbersOf(beam_field_names[2]);
  auto places = std::make_shared<std::vector<std::vector<Point3>>>(scans.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    const Point3 way = {x[record], y[record], z[record]};
    if (isFinite(view.point(record)) || !isFinite(way) || way == Point3{}) continue;
    const std::size_t scan = scan_of[record];
    const Point3& origin = scans[scan].origin;
    (*places)[scan].push_back({origin[0] + way[0], origin[1] + way[1], origin[2] + way[2]});
  }
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const std::vector<Point3>& of_scan = (*places)[s];
    scans[s].misses = viewOf(of_scan.empty() ? nullptr : of_scan.front().data(), of_scan.size());
    scans[s].misses.owner = places;
    scans[s].misses_beyond = beyond;
  }
}

} // namespace

ScanOrigins ScanOrigins::parse(const std::string& text)
{
  if (text.empty()) return {};
  const auto originOf = [&](std::string_view numbers) {
    const auto xyz = numbersOf(numbers);
    if (!xyz || xyz->size() != 3) refuseText(text);
    return Point3{(*xyz)[0], (*xyz)[1], (*xyz)[2]};
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return of(originOf(text));
  ScanOrigins origins{text.substr(0, colon), {}};
  for (const std::string_view entry : partsOf(std::string_view(text).substr(colon + 1), ';')) {
    const std::size_t equals = entry.find('=');
    const auto number = numbersOf(entry.substr(0, equals));
    if (equals == std::string_view::npos || !number || number->size() != 1) refuseText(text);
    const double scan = number->front();
    const auto same = [&](const Entry& other) { return other.scan == scan; };
    if (std::any_of(origins.entries.begin(), origins.entries.end(), same)) refuseText(text);
    origins.entries.push_back({scan, originOf(entry.substr(equals + 1))});
  }
  if (origins.field.empty()) refuseText(text);
  return origins;
}

std::string ScanOrigins::text() const
{
  if (entries.empty()) return {};
  if (field.empty()) return textOf(entries.front().origin);
  std::string all = field;
  for (const Entry& entry : entries)
    all += (&entry == entries.data() ? ":" : ";") + plainText(entry.scan) + '=' + textOf(entry.origin);
  return all;
}

std::vector<ScanBeams> scansOf(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                               const ScanOrigins& origins, double misses_beyond)
{
  if (origins.empty()) {
    throw InvalidInput(Input::points, cloud, "does not say where its scanner stood",
                       "give `origin`, as X,Y,Z in its frame, or a file that has it (.ptx, .e57, .pcd with VIEWPOINT, "
                       ".ply with camera)");
  }
  std::vector<ScanBeams> scans(origins.entries.size());
  for (std::size_t s = 0; s < scans.size(); ++s) {
    scans[s].origin = origins.entries[s].origin;
    scans[s].returns = view;
  }
  const ScanNumbers scan_of(view, fields, cloud, origins);
  if (misses_beyond > 0.0) addMisses(view, fields, cloud, misses_beyond, scan_of, scans);
  if (origins.field.empty()) return scans;
  auto subsets = std::make_shared<Subsets>();
  subsets->points = view.owner;
  subsets->records.resize(scans.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    if (isFinite(view.point(record))) subsets->records[scan_of[record]].push_back(static_cast<std::int32_t>(record));
  }
  for (std::size_t s = 0; s < scans.size(); ++s) {
    scans[s].returns.restrictTo(subsets->records[s].data(), subsets->records[s].size());
    scans[s].returns.owner = subsets;
  }
  return scans;
}

} // namespace pcl_bsh
