#pragma once
// Sorting on host or device.

#include "gi/core/view.h"
#include "gi/kernel/space.h"

#include <cstdint>

namespace gi {

/// Sorts keys in ascending order and their values with them; equal keys keep their order. All views lie in `space`
/// and have one length, of less than 2^31. @param scratch_keys, scratch_values  overwritten
void sort_pairs(Space space, View<std::uint64_t> keys, View<std::uint32_t> values,
                View<std::uint64_t> scratch_keys, View<std::uint32_t> scratch_values);

} // namespace gi
