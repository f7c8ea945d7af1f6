// Ends a program that this machine's processor does not run, with a message, before anything else runs. Compiled for any
// processor (viewer/CMakeLists.txt).

#include "gi/core/processor_level.h"

#include <cstring>
#include <unistd.h>

namespace {

__attribute__((constructor(101))) void check_processor()
{
    if (gi::has_level(gi::kCompiledLevel)) return;
    for (char const* const text :
         {"lightwell: this program is for processors of the level ", gi::kCompiledLevel,
          " (this machine's is of a lower one) install a package, or build it here: scripts/build release\n"})
        if (write(2, text, std::strlen(text)) < 0) break;
    _exit(2);
}

} // namespace
