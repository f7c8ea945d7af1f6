#pragma once
// Where and by what a table was made.

#include <string>

namespace viewer {

struct Machine {
    std::string cpu; ///< its model
    int cores = 0;   ///< that this process may use
    double memory_gib = 0;
};

/// From /proc; what is not there is "unknown" or 0.
Machine this_machine();
/// "12 cores of AMD EPYC 9554, 24 GiB"
std::string to_text(Machine const& machine);
/// As a shell would take it, from /proc; the program's name without its folder.
std::string this_command();
/// Of one word, so that a shell takes it as it is.
std::string shell_quoted(std::string const& word);
/// Universal time, "2026-11-21 12:34 UTC".
std::string this_moment();

} // namespace viewer
