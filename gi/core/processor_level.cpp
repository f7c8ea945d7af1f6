// Compiled for any processor (gi/CMakeLists.txt), so that it can say what this one lacks.

#include "gi/core/processor_level.h"

#include <cstring>
#ifdef __x86_64__
#include <cpuid.h>
#endif

namespace gi {

bool has_level(char const* level)
{
#ifdef __x86_64__
    __builtin_cpu_init();
    bool const v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    unsigned a = 0, b = 0, c1 = 0, c = 0, d = 0;
    __get_cpuid(1, &a, &b, &c1, &d);
    __get_cpuid(0x80000001, &a, &b, &c, &d);
    bool const v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma") && (c1 & bit_MOVBE) != 0 &&
                    (c1 & bit_F16C) != 0 && (c & bit_LZCNT) != 0;
    if (std::strcmp(level, "x86-64-v2") == 0) return v2;
    if (std::strcmp(level, "x86-64-v3") == 0) return v3;
    if (std::strcmp(level, "x86-64-v4") == 0)
        return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
#endif
    return true;
}

} // namespace gi
