#pragma once
#include <malloc.h>

namespace viewer {

/// Makes the process keep the memory that it frees: each frame needs the same amount, and mapping it
/// anew takes a quarter of a short frame. malloc_trim() gives it back where something large has ended.
/// Call before threads start.
inline void keep_freed_memory()
{
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 64 << 20);
    mallopt(M_ARENA_MAX, 1); // malloc_trim() leaves the free end of every other arena as it is
}

} // namespace viewer
