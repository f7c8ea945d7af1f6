#include "viewer/base/version.h"

#include "gi/core/processor_level.h"
#include "gi/render/embree.h"
#include "git_hash.h" // written by cmake/git_hash.cmake

namespace viewer {

std::string version_number() { return LIGHTWELL_VERSION; }
std::string git_hash() { return LIGHTWELL_GIT_HASH; }
std::string embree_version() { return RTC_VERSION_STRING; }
std::string program_text() { return "lightwell " + version_number() + " (git " + git_hash() + ")"; }
std::string version_text()
{
    return "lightwell " + version_number() + " (git " + git_hash() + ", " + gi::kCompiledLevel + ", Embree " +
           embree_version() + ")";
}

} // namespace viewer
