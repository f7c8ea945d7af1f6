#pragma once
// Atomic operations for kernels, with relaxed memory order: kernels use them only to count and to claim slots, and
// results are read after the launch has ended.

#include "gi/core/platform.h"

#include <cstdint>
#if !defined(__CUDA_ARCH__)
#include <atomic>
#endif

namespace gi {

/// Returns the previous value.
GI_FN inline std::uint32_t atomic_add(std::uint32_t& at, std::uint32_t value)
{
#if defined(__CUDA_ARCH__)
    return atomicAdd(&at, value);
#else
    return std::atomic_ref<std::uint32_t>(at).fetch_add(value, std::memory_order_relaxed);
#endif
}

GI_FN inline std::uint64_t atomic_add(std::uint64_t& at, std::uint64_t value)
{
#if defined(__CUDA_ARCH__)
    return atomicAdd(reinterpret_cast<unsigned long long*>(&at), static_cast<unsigned long long>(value));
#else
    return std::atomic_ref<std::uint64_t>(at).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// Writes `value` if there is `expected`. Returns what was there.
GI_FN inline std::uint64_t atomic_exchange_if(std::uint64_t& at, std::uint64_t expected, std::uint64_t value)
{
#if defined(__CUDA_ARCH__)
    return atomicCAS(reinterpret_cast<unsigned long long*>(&at), static_cast<unsigned long long>(expected),
                     static_cast<unsigned long long>(value));
#else
    std::atomic_ref<std::uint64_t>(at).compare_exchange_strong(expected, value, std::memory_order_relaxed);
    return expected;
#endif
}

GI_FN inline void atomic_max(std::uint64_t& at, std::uint64_t value)
{
#if defined(__CUDA_ARCH__)
    atomicMax(reinterpret_cast<unsigned long long*>(&at), static_cast<unsigned long long>(value));
#else
    std::atomic_ref<std::uint64_t> const there(at);
    std::uint64_t old = there.load(std::memory_order_relaxed);
    while (old < value && !there.compare_exchange_weak(old, value, std::memory_order_relaxed)) {
    }
#endif
}

} // namespace gi
