#pragma once
// Version of the program, and what else the last bits of its pictures depend on.

#include <string>

namespace viewer {

/// "lightwell 0.2.0 (git 1a2b3c4)": the same on all machines.
std::string program_text();
/// "lightwell 0.2.0 (git 1a2b3c4, x86-64-v3, Embree 4.3.3)": the commit ("unknown" outside of a checkout), the level of
/// processors (processor_level.h) and the version of Embree that it was compiled for. Records and recordings have it.
std::string version_text();
std::string version_number();
std::string git_hash();
std::string embree_version();

} // namespace viewer
