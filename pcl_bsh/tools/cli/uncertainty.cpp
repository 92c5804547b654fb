// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty.h"

#include "command_line.h"

#include <pcl_bsh/io/text/parse_number.h>

#include <cmath>

namespace pcl_bsh::cli {

namespace {

Uncertainty uncertaintyOf(const char* option, const std::string& text, double sigmas)
{
  if (!io::isNumber(text) && !io::looksLikeNumber(text)) return {text, sigmas};
  const double length = io::isNumber(text) ? io::parseNumber<double>(text) : -1.0;
  if (!(length >= 0.0 && std::isfinite(length)))
    throw UsageError(std::string(option) + ": '" + text + "': give a finite length >= 0, or the name of a field");
  return length;
}

} // namespace

void UncertaintyOptions::addTo(CLI::App& app, const std::string& input_name)
{
  app.add_option("--uncertainty", input,
                 "how far " + input_name +
                     "'s points may truly be from where they were measured: a\n"
                     "length, or the field that holds each point's sigma. What collides only\n"
                     "perhaps gets 2 in the field 'collision'; distances are those of the\n"
                     "measured places (default: 0)")
      ->type_name("U");
  app.add_option("--obstacle-uncertainty", obstacle, "the same for OBSTACLE's points (default: 0)")->type_name("U");
  app.add_option("--sigmas", sigmas, "by how many sigmas a point may be off, where U is a field (default: 1)")
      ->type_name("K")
      ->transform(number<double>("give a number >= 0", [](double k) { return k >= 0 && std::isfinite(k); }));
}

void UncertaintyOptions::read(Uncertainty& of_input, Uncertainty& of_obstacle) const
{
  of_input = uncertaintyOf("--uncertainty", input, sigmas.value_or(1.0));
  of_obstacle = uncertaintyOf("--obstacle-uncertainty", obstacle, sigmas.value_or(1.0));
  if (sigmas && of_input.field.empty() && of_obstacle.field.empty())
    throw UsageError("--sigmas: no uncertainty is a field: give the length itself");
}

} // namespace pcl_bsh::cli
