#pragma once
// Where data lie and kernels run.

#include <cstdint>

namespace gi {

enum class Space : std::uint8_t { host, device };

/// Throws std::runtime_error: this program cannot run `what` on a device.
[[noreturn]] void throw_no_cuda(char const* what);

} // namespace gi
