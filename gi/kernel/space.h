#pragma once
// Where data lie and kernels run.

#include <cstdint>

namespace gi {

enum class Space : std::uint8_t { host, device };

/// Whether this build has the CUDA twins of the kernels (the cuda preset).
#if defined(LIGHTWELL_CUDA_BUILD)
inline constexpr bool kCudaBuild = true;
#else
inline constexpr bool kCudaBuild = false;
#endif

/// Throws std::runtime_error: this program cannot run `what` on a device.
[[noreturn]] void throw_no_cuda(char const* what);

} // namespace gi
