#include "viewer/base/version.h"

#include "git_hash.h" // written by cmake/git_hash.cmake

namespace viewer {

std::string version_number() { return LIGHTWELL_VERSION; }
std::string git_hash() { return LIGHTWELL_GIT_HASH; }
std::string version_text() { return "lightwell " + version_number() + " (git " + git_hash() + ")"; }

} // namespace viewer
