// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/ignored_points.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/question/record_numbers.h>
#include <pcl_bsh/question/text_numbers.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pcl_bsh {
namespace {

using IgnoredKind = IgnoredPoints::Kind;
using IgnoredTerm = IgnoredPoints::Term;

constexpr auto box_name = "box", plane_name = "plane", mask_name = "mask";

std::optional<IgnoredTerm> termOf(std::string_view text)
{
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) return std::nullopt;
  const std::string_view name = text.substr(0, equals);
  const auto numbers = numbersOf(text.substr(equals + 1));
  if (!numbers && name == mask_name) return IgnoredTerm{IgnoredKind::mask, std::string(text.substr(equals + 1)), {}};
  if (!numbers) return std::nullopt;
  const std::vector<double>& n = *numbers;
  if (name == box_name) {
    const bool is_box = n.size() == 6 && n[0] <= n[3] && n[1] <= n[4] && n[2] <= n[5];
    return is_box ? std::optional(IgnoredTerm{IgnoredKind::box, {}, n}) : std::nullopt;
  }
  if (name == plane_name) {
    const bool is_plane = n.size() == 5 && std::hypot(n[0], n[1], n[2]) > 0.0 && n[4] >= 0.0;
    return is_plane ? std::optional(IgnoredTerm{IgnoredKind::plane, {}, n}) : std::nullopt;
  }
  return IgnoredTerm{IgnoredKind::values, std::string(name), n};
}

/// @throws InvalidInput
void requireMaskOf(const IgnoredTerm& term, const PointsView& view, const std::string& cloud)
{
  if (!term.mask)
    throw InvalidInput(Input::points, "ignored points", "mask " + term.field + " is not read",
                       "read it before the question is asked, as programs and stages do");
  if (term.mask->size() != view.count)
    throw InvalidInput(Input::points, cloud,
                       "has " + counted(view.count, "point") + ", and mask " + term.field + " has " +
                           counted(term.mask->size(), "value"),
                       "give the mask a value for each point, in the order of the file");
}

bool isIn(const std::vector<double>& n, IgnoredKind kind, const Point3& p)
{
  if (kind == IgnoredKind::box)
    return n[0] <= p[0] && p[0] <= n[3] && n[1] <= p[1] && p[1] <= n[4] && n[2] <= p[2] && p[2] <= n[5];
  return std::abs(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - n[3]) <= n[4] * std::hypot(n[0], n[1], n[2]);
}

} // namespace

std::string IgnoredPoints::Term::text() const
{
  if (kind == IgnoredKind::mask) return plainText(mask_name, '=', field);
  std::string all = kind == IgnoredKind::box ? box_name : kind == IgnoredKind::plane ? plane_name : field;
  for (const double& number : numbers) all += (&number == numbers.data() ? "=" : ",") + textOfNumbers(number);
  return all;
}

IgnoredPoints IgnoredPoints::parse(const std::string& text)
{
  IgnoredPoints ignored;
  if (text.empty()) return ignored;
  for (const std::string_view part : partsOf(text, ';')) {
    const auto term = termOf(part);
    if (!term) {
      throw InvalidInput(
          Input::points, "ignored points", "'" + std::string(part) + "' is none",
          "give FIELD=N,N, box=X,Y,Z,X,Y,Z of the least and the greatest, plane=NX,NY,NZ,D,TOLERANCE, or "
          "mask=FILE, with ; between several");
    }
    ignored.terms.push_back(*term);
  }
  return ignored;
}

std::string IgnoredPoints::text() const
{
  std::string all;
  for (const IgnoredTerm& term : terms) all += (all.empty() ? "" : ";") + term.text();
  return all;
}

CountedPoints countedPoints(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                            const IgnoredPoints& ignored)
{
  CountedPoints counted;
  counted.ignored.resize(ignored.terms.size());
  std::vector<std::optional<RecordNumbers>> numbers(ignored.terms.size());
  std::vector<std::vector<std::size_t>> found(ignored.terms.size()); // by each value of a term
  for (std::size_t t = 0; t < ignored.terms.size(); ++t) {
    const IgnoredTerm& term = ignored.terms[t];
    found[t].resize(term.kind == IgnoredKind::values ? term.numbers.size() : 1);
    if (term.kind == IgnoredKind::mask) requireMaskOf(term, view, cloud);
    if (term.kind == IgnoredKind::values)
      numbers[t].emplace(view, fields, term.field, cloud,
                         RecordNumbers::Purpose{Input::points, "of points to ignore", "give one of its fields"});
  }
  const auto meets = [&](std::size_t t, std::uint32_t record) {
    const IgnoredTerm& term = ignored.terms[t];
    std::size_t place = 0;
    if (term.kind == IgnoredKind::values) {
      const auto value = std::find(term.numbers.begin(), term.numbers.end(), (*numbers[t])[record]);
      if (value == term.numbers.end()) return false;
      place = static_cast<std::size_t>(value - term.numbers.begin());
    }
    else if (term.kind == IgnoredKind::mask ? (*term.mask)[record] == 0
                                            : !isIn(term.numbers, term.kind, view.point(record))) {
      return false;
    }
    ++found[t][place];
    return true;
  };
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    std::size_t t = 0;
    while (t < ignored.terms.size() && !meets(t, record)) ++t;
    if (t == ignored.terms.size())
      counted.records.push_back(static_cast<std::int32_t>(record));
    else
      ++counted.ignored[t];
  }
  counted.all = view.size() - counted.records.size();
  for (std::size_t t = 0; t < found.size(); ++t) {
    const IgnoredTerm& term = ignored.terms[t];
    const auto none = std::find(found[t].begin(), found[t].end(), std::size_t{0});
    if (none == found[t].end()) continue;
    const std::string what =
        term.kind == IgnoredKind::values
            ? plainText(term.field, '=', term.numbers[static_cast<std::size_t>(none - found[t].begin())])
            : term.text();
    throw InvalidInput(Input::points, cloud, "has no point to ignore of '" + what + "'",
                       "leave it out, or check its numbers, the frame and the unit");
  }
  return counted;
}

} // namespace pcl_bsh
