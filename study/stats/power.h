#pragma once
// Power by simulation: how often would an experiment of this size detect an existing effect? The caller provides
// the experiment and its test.

#include "study/stats/binomial.h"
#include "study/stats/error.h"
#include "study/stats/random.h"

#include <optional>
#include <span>

namespace study {

struct Power {
    int size = 0; ///< as given by the caller
    double power = 0;
    Interval interval; ///< 95 % Wilson interval, from the number of simulations
    int simulations = 0;
    int refused = 0; ///< simulations whose test refused its data (std::invalid_argument): not significant
};

/// @param significant  bool(Random&): simulates once and tests. Simulation i uses Random::part(seed, i),
/// independently of earlier ones. @throws std::invalid_argument no simulations
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

/// Returns the first of `sizes` (numbers of observers, trials, ...) that reaches the wanted power, if any.
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
