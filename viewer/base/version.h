#pragma once
// Version of the program and commit that it was built from.

#include <string>

namespace viewer {

/// "lightwell 0.1.0 (git 1a2b3c4)"; the hash is "unknown" outside of a checkout.
std::string version_text();
std::string version_number();
std::string git_hash();

} // namespace viewer
