#pragma once
// Power by simulation: how often would an experiment of this size find what is there? The experiment and its test
// are whatever the caller says.

#include "study/stats/binomial.h"
#include "study/stats/error.h"
#include "study/stats/random.h"

#include <optional>
#include <span>

namespace study {

struct Power {
    int size = 0; ///< as given by the caller
    double power = 0;
    Interval interval; ///< Wilson, 95 %: of so many simulations
    int simulations = 0;
    int refused = 0; ///< simulations whose test refused its data (std::invalid_argument): they found nothing
};

/// @param significant  bool(Random&): simulates once and tests. Simulation i has part i of the seed, whatever
/// comes before. @throws std::invalid_argument no simulations
template <class Experiment>
Power simulate_power(int simulations, std::uint64_t seed, Experiment const& significant, int size = 0)
{
    if (simulations < 1) refuse("power of no simulations", "nothing was tried", "use 1000 or more");
    Power p{size, 0, {}, simulations, 0};
    int found = 0;
    for (int i = 0; i < simulations; ++i) {
        Random random = Random::part(seed, std::uint64_t(i));
        try {
            found += significant(random) ? 1 : 0;
        } catch (std::invalid_argument const&) {
            ++p.refused;
        }
    }
    p.power = double(found) / simulations;
    p.interval = wilson(found, simulations);
    return p;
}

/// The first of `sizes` (of observers, trials, ...) with the power wanted; nothing where none has it.
/// @param significant  bool(Random&, int size)
template <class Experiment>
std::optional<Power> smallest_size(std::span<int const> sizes, double wanted, int simulations, std::uint64_t seed,
                                   Experiment const& significant)
{
    for (int const size : sizes) {
        Power const p = simulate_power(
            simulations, seed, [&](Random& random) { return significant(random, size); }, size);
        if (p.power >= wanted) return p;
    }
    return std::nullopt;
}

} // namespace study
