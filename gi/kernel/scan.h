#pragma once
// Prefix sums on host or device.

#include "gi/core/view.h"
#include "gi/kernel/space.h"

#include <cstdint>

namespace gi {

/// out[i] = in[0] + ... + in[i - 1]. Both have the same length, lie in `space` and may
/// be the same array. Sums wrap at 2^32.
void exclusive_scan(Space space, View<std::uint32_t const> in, View<std::uint32_t> out);

} // namespace gi
