#pragma once
// The random numbers of studies: PCG32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically
// Good Algorithms for Random Number Generation", XSH-RR 64/32) and the shuffle of Fisher and Yates (Durstenfeld
// 1964, CACM 7(7):420). Standard libraries differ in their distributions and shuffles; integers, uniform() and
// shuffle() here are the same on every compiler, so that a seed and a participant's number reproduce an order.

#include "gi/core/rng.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>

namespace study {

class Random {
public:
    /// @param stream only its lower 63 bits count. The states of two streams of one seed differ by an amount that
    /// depends only on their numbers: use part() for many independent streams.
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : engine_(seed, stream) {}

    /// Generator for one part of many, such as a participant or a simulation. Seed and index are hashed, so that
    /// neighbours are independent.
    static Random part(std::uint64_t seed, std::uint64_t index)
    {
        std::uint64_t const hashed = gi::mix_bits(index + gi::mix_bits(seed + kGolden));
        return Random(hashed, gi::mix_bits(hashed + kGolden));
    }

    std::uint32_t next() { return engine_.next(); }

    /// Uniform in {0, ..., n - 1}, each exactly as likely. @throws std::invalid_argument n = 0
    std::uint32_t below(std::uint32_t n)
    {
        if (n == 0) throw std::invalid_argument("random number below 0 (there is none) use 1 or more");
        std::uint32_t const uneven = (0u - n) % n; // 2^32 mod n: reject this many of the lowest, to avoid bias
        for (;;)
            if (std::uint32_t const r = next(); r >= uneven) return r % n;
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniform() { return engine_.uniform_double(); }

    /// Standard normal (Box and Muller 1958). Its last bits depend on the mathematical library.
    double normal()
    {
        double const radius = std::sqrt(-2 * std::log(1 - uniform()));
        return radius * std::cos(6.283185307179586476925 * uniform());
    }

    /// Shuffles; every order is equally likely.
    template <class T>
    void shuffle(std::span<T> items)
    {
        for (std::size_t i = items.size(); i > 1; --i) {
            using std::swap;
            swap(items[i - 1], items[below(std::uint32_t(i))]);
        }
    }
    template <class Container>
    void shuffle(Container& items)
    {
        shuffle(std::span(items));
    }

private:
    static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
    gi::Pcg32 engine_;
};

} // namespace study
