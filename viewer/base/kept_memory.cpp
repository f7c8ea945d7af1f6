#include "viewer/base/kept_memory.h"

#include <malloc.h>

namespace viewer {

void keep_freed_memory()
{
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 64 << 20);
    mallopt(M_ARENA_MAX, 1); // malloc_trim() leaves the free end of every other arena as it is
}

} // namespace viewer
