// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include <pcl_bsh/io/text/parse_number.h>
#include <pcl_bsh/version.h>

#include <array>
#include <cstdint>
#include <iostream>

namespace pcl_bsh::cli {
namespace {

/// A shell replaces an unset variable by an empty text, which must not pass for a missing option.
void requireNoneEmpty(const CLI::App& app)
{
  for (const CLI::Option* const option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty()) throw UsageError(option->get_name() + ": is empty: give a value, or leave it out");
  for (const CLI::App* const command : app.get_subcommands()) requireNoneEmpty(*command); // those that were given
}

bool understood(CLI::App& app, const std::string& program, const std::function<void()>& parse)
{
  app.set_version_flag("--version", program + " " PCL_BSH_VERSION_TEXT, "print the program's version and exit");
  try {
    parse();
    requireNoneEmpty(app);
    return true;
  }
  catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  }
  catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
    return false;
  }
  catch (const CLI::ValidationError& error) { // from a validator: the text is complete
    throw UsageError(error.what());
  }
  catch (const CLI::ParseError& error) {
    throw UsageError("command line: " + std::string(error.what()) + ": see " + program + " --help");
  }
}

} // namespace

bool understood(CLI::App& app, const std::string& program, int argc, const char* const* argv)
{
  return understood(app, program, [&] { app.parse(argc, argv); });
}

bool understood(CLI::App& app, const std::string& program, std::vector<std::string> arguments,
                const std::function<void()>& check)
{
  return understood(app, program, [&] {
    app.parse(std::move(arguments));
    check();
  });
}

template <typename Number>
CLI::Validator number(std::string remedy, std::function<bool(Number)> accepted)
{
  return {[remedy = std::move(remedy), accepted = std::move(accepted)](std::string& text) -> std::string {
            try {
              const auto value = io::parseNumber<Number>(text);
              if (accepted && !accepted(value)) return text + ": " + remedy;
              if constexpr (std::is_integral_v<Number>) text = std::to_string(value);
              return "";
            }
            catch (const io::FormatError& error) {
              return std::string(error.what()) + ": " + remedy;
            }
          },
          ""};
}

template CLI::Validator number(std::string, std::function<bool(double)>);
template CLI::Validator number(std::string, std::function<bool(int)>);
template CLI::Validator number(std::string, std::function<bool(unsigned)>);
template CLI::Validator number(std::string, std::function<bool(std::uint64_t)>);

CLI::Option* addThreads(CLI::App& app, unsigned& threads, const std::string& help)
{
  return app.add_option("--threads", threads, help)
      ->type_name("N")
      ->transform(number<unsigned>("give a number of threads, 0 for all"));
}

CLI::Validator numberOfName(std::vector<std::pair<std::string, int>> names)
{
  return {[names = std::move(names)](std::string& text) -> std::string {
            std::string known;
            for (std::size_t i = 0; i < names.size(); ++i) {
              if (names[i].first == text) {
                text = std::to_string(names[i].second);
                return "";
              }
              known += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i].first;
            }
            return "'" + text + "' is unknown: give " + known;
          },
          ""};
}

CLI::Validator amount(std::uint64_t unit, std::uint64_t least, std::string remedy)
{
  return {[=](std::string& text) -> std::string {
            constexpr std::array letters = {'K', 'M', 'G'};
            std::uint64_t factor = 1;
            std::string digits = text;
            for (std::size_t i = 0; i < letters.size() && !digits.empty(); ++i) {
              if (digits.back() != letters[i]) continue;
              for (std::size_t k = 0; k <= i; ++k) factor *= unit;
              digits.pop_back();
              break;
            }
            const bool whole =
                !digits.empty() && digits.size() <= 9 && digits.find_first_not_of("0123456789") == std::string::npos;
            const std::uint64_t value = whole ? std::stoull(digits) * factor : 0;
            if (value < least) return "'" + text + "' is not such an amount: " + remedy;
            text = std::to_string(value);
            return "";
          },
          ""};
}

} // namespace pcl_bsh::cli
