#pragma once
#include <string>

namespace viewer {

/// "lightwell 0.1.0 (git 1a2b3c4)"; the hash is "unknown" outside of a checkout.
std::string version_text();
std::string version_number();
std::string git_hash();

} // namespace viewer
