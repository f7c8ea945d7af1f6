#include "gi/core/processor_level.h"

namespace gi {

#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512CD__) && defined(__AVX512DQ__) &&            \
    defined(__AVX512VL__)
char const* const kCompiledLevel = "x86-64-v4";
#elif defined(__AVX2__) && defined(__BMI2__) && defined(__FMA__)
char const* const kCompiledLevel = "x86-64-v3";
#elif defined(__SSE4_2__) && defined(__POPCNT__)
char const* const kCompiledLevel = "x86-64-v2";
#elif defined(__x86_64__)
char const* const kCompiledLevel = "x86-64";
#else
char const* const kCompiledLevel = "other";
#endif

} // namespace gi
