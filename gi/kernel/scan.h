#pragma once
// Prefix sums in either space.

#include "gi/core/view.h"
#include "gi/kernel/space.h"

#include <cstdint>

namespace gi {

/// out[i] = in[0] + ... + in[i - 1]. Both are equally long, lie in `space` and may be the same. Sums wrap at 2^32.
void exclusive_scan(Space space, View<std::uint32_t const> in, View<std::uint32_t> out);

} // namespace gi
