// SPDX-License-Identifier: BSD-3-Clause
#include "certify_options.h"

#include <pcl_bsh/tools/cli/command_line.h>

#include <pcl_bsh/io/clouds/formats.h>

#include <cstdint>

namespace pcl_bsh::cli {
namespace {

constexpr auto certify_footer =
    R"(Every sphere is checked against every point below it in exact arithmetic. Its radius is compared with that of the
smallest sphere around the same points, also exact, as CGAL finds it.
Reads {read}, pipes, and standard input as -; --report - is standard output.
Exit code: 0 all points are in their spheres; 1 some are not, or failed; 2 command line not understood; 130 stopped by Ctrl-C.
This program is under the GPL-3.0-or-later, because it contains CGAL's Bounding_volumes.

Example: how tight are the spheres over a hall, by each way of fitting?
  pcl_bsh_certify hall.ply --report hall.json)";

} // namespace

std::optional<CertifyProgramOptions> parseCertifyOptions(int argc, char** argv)
{
  CertifyProgramOptions options;
  std::optional<SphereFit> fit;
  options.certify.threads = 0;
  CLI::App app("Proves that no point of a cloud lies outside the bounding spheres above it.", certify_program);
  app.footer(io::withFormats(certify_footer));
  app.add_option("CLOUD", options.cloud, "cloud whose hierarchy is built and certified")->type_name("")->required();
  app.add_option("--fit", fit, "box, ritter or minimal: how centres are chosen (default: each in turn)")
      ->type_name("FIT")
      ->transform(choice(fits));
  app.add_option("--sample", options.certify.sample,
                 "on each level, compare N spheres with the smallest (default: 1000); all:\n"
                 "every one. Containment is always checked for all")
      ->type_name("N")
      ->transform(number<std::uint64_t>("give a number of spheres, or all"))
      ->transform(CLI::Validator(
          [](std::string& text) {
            if (text == "all") text = std::to_string(CertifyOptions::all);
            return std::string();
          },
          "")); // the last is the first to be called
  app.add_option("--threads", options.certify.threads,
                 "0: all of the machine's (default); any number gives the same result")
      ->type_name("N")
      ->transform(number<unsigned>(give_threads));
  ReadOptions reading;
  reading.addTo(app);
  app.add_option("--report", options.report, "JSON file for the results")->type_name("FILE");
  if (!understood(app, certify_program, argc, argv)) return std::nullopt;

  if (fit) std::erase_if(options.wanted, [&](const auto& named) { return named.second != *fit; });
  options.reading = reading.read({options.cloud});
  options.files.reads("CLOUD", options.cloud).writes("--report", options.report.value_or(""));
  return options;
}

} // namespace pcl_bsh::cli
