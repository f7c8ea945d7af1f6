#pragma once
// The values that options can take, for shell completion.

#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace viewer {

/// Sets the values of an option that shells offer, where no CLI::IsMember check names them. Returns the option.
CLI::Option* offer(CLI::Option* option, std::vector<std::string> values);
/// The values that an option can take; empty: any, such as files.
std::vector<std::string> choices_of(CLI::Option const& option);

} // namespace viewer
