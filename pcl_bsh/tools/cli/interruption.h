// SPDX-License-Identifier: BSD-3-Clause
// Signals, pipes without a reader and closed standard streams, which a program may meet at any moment.
#pragma once

#include <string>

namespace pcl_bsh::cli {

/// From now on SIGINT, SIGTERM and, where it is not ignored, SIGHUP end the program at once, with one line on stderr
/// and exit code 128 + signal, as shells have it. Files are as they were or complete; temporary ones are removed. A
/// pipe whose reader has gone and a limit on the size of files are errors of writing, and end nothing. Call this
/// first, while there is one thread: a thread of its own waits for the signals, all others never see them.
void stopCleanlyOnSignals(const std::string& program);

/// Sets the text about what stays when a signal ends the program, for work that another run continues. Before the first
/// call it says that nothing unfinished was left behind.
void setWhatStays(const std::string& what);

/// Opens /dev/null for each standard stream that the caller has closed: the next file that is opened would otherwise
/// get its number, and the program's output would go into that file.
void openStandardStreams();

} // namespace pcl_bsh::cli
