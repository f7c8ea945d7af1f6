#include "viewer/program.h"

#include <malloc.h>

int main(int argc, char** argv)
{
    // Frames need the same memory again and again; taking its pages anew costs a quarter of a short one.
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 64 << 20);
    mallopt(M_ARENA_MAX, 2); // each keeps what it once had
    return viewer::run_program(argc, argv);
}
