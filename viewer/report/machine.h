#pragma once
// Machine, command and date with which a table was made.

#include <string>

namespace viewer {

struct MachineFacts {
    std::string cpu; ///< model name
    int cores = 0;   ///< available to this process
    double memory_gib = 0;
};

/// Reads /proc; missing values are "unknown" or 0.
MachineFacts this_machine();
/// "12 cores of AMD EPYC 9554, 24 GiB"
std::string to_text(MachineFacts const& machine);
/// "Debian GNU/Linux 12 (bookworm), Linux 6.1.0"
std::string operating_system();
/// Command line of this process, quoted for a shell, from /proc; the program's name without its folder.
std::string this_command();
/// Current time: "2026-11-21 12:34 UTC".
std::string this_moment();

} // namespace viewer
