#include "viewer/program.h"

#include <tbb/scalable_allocator.h>

int main(int argc, char** argv)
{
    // Frames need the same memory again and again: pages that were taken are kept, whatever the size of the block.
    scalable_allocation_mode(TBBMALLOC_SET_HUGE_SIZE_THRESHOLD, 1 << 30);
    return viewer::run_program(argc, argv);
}
