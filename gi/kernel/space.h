#pragma once
// Memory and execution spaces: host or CUDA device.

#include <cstdint>

namespace gi {

enum class Space : std::uint8_t { host, device };

/// True if this build includes the CUDA versions of the kernels (the cuda preset).
#if defined(LIGHTWELL_CUDA_BUILD)
inline constexpr bool kCudaBuild = true;
#else
inline constexpr bool kCudaBuild = false;
#endif

/// Throws std::runtime_error because this build cannot run `what` on a device.
[[noreturn]] void throw_no_cuda(char const* what);

} // namespace gi
