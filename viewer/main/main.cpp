#include "viewer/program.h"

#include <tbb/scalable_allocator.h>

int main(int argc, char** argv)
{
    // Frames need the same memory again and again: what is larger than that is not given back to the system in
    // between, as fresh pages cost a quarter of a short frame.
    constexpr std::intptr_t kKept = 1 << 20; // bytes
    scalable_allocation_mode(TBBMALLOC_SET_HUGE_SIZE_THRESHOLD, kKept);
    return viewer::run_program(argc, argv);
}
