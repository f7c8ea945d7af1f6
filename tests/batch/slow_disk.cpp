// Loaded before others (LD_PRELOAD) it makes a disk slow: writing back takes 80 ms.

#include <unistd.h>

extern "C" int syncfs(int)
{
    usleep(80000);
    return 0;
}
