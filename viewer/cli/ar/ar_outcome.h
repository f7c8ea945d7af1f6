#pragma once
// Did a command over frames or pictures succeed? Decides exit code 1, so that scripts notice failure.

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace viewer {

struct FrameTally {
    std::uint64_t looked_at = 0; ///< frames in which the camera was searched for
    std::uint64_t found = 0;     ///< of these, with a trusted pose of their own
    std::uint64_t refused = 0;   ///< frames that could not be read or used, besides those
    std::string lost_by = {};    ///< the most frequent cause of a missing pose; empty = unknown
    std::string hint = {};       ///< what the pictures say about it; empty = nothing
};

/// Declares --require-found; the text is empty unless given.
void declare_require_found(CLI::App& command, std::string& text);
/// Parses "90%" or "0.9": 0 to 1. Empty: nothing. @throws gi::InputError
std::optional<double> parse_share(std::string const& option, std::string const& text);

/// The message if more frames or pictures were refused than used; `what` is their plural.
std::optional<std::string> most_refused(std::uint64_t used, std::uint64_t refused, std::string const& what);
/// The message if the camera was found in no frame or most frames were refused; with `required`, if the share of
/// all frames (refused ones included) with a trusted pose is less.
std::optional<std::string> shortfall(FrameTally const& tally, std::optional<double> required);
/// Prints the message on stderr, if there is one. @return exit code, 1 or 0
int exit_code_of(std::optional<std::string> const& message);

} // namespace viewer
