#pragma once
// Random draws from a density of many real numbers whose logarithm and gradient can be computed: the No-U-Turn
// sampler (Hoffman & Gelman 2014, JMLR 15:1593) with multinomial choice along the path and the generalised
// criterion of turning (Betancourt 2017, arXiv:1701.02434), a diagonal metric, and during warm-up the step size by
// dual averaging and the metric in windows of growing length, as in Stan. Bounded parameters are passed
// transformed (log, logit), with the logarithm of the Jacobian added to the density.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace study {

/// Returns the logarithm of the density at x, up to a constant, and writes its gradient, of the same size.
/// -infinity or NaN = impossible. Chains call it from several threads at once.
using LogDensity = std::function<double(std::span<double const> x, std::span<double> gradient)>;

struct SamplerSettings {
    int chains = 4;
    int warm_up = 300;       ///< draws of each chain that adapt it and are thrown away
    int draws = 700;         ///< of each chain that are kept
    double acceptance = 0.8; ///< wanted mean probability of acceptance: higher = smaller steps, fewer divergences
    int most_doublings = 8;  ///< of a path: at most 2^n - 1 steps per draw
    double spread = 0.5; ///< chains start at the given point plus this much standard normal noise per parameter
    std::uint64_t seed = 1;
    /// Called after each draw with the share of draws done. From several threads, but never by two at once.
    std::function<void(double)> progress{};
};

struct Draws {
    std::size_t parameters = 0;
    int chains = 0, per_chain = 0;
    std::vector<double> values; ///< [chain][draw][parameter]
    /// Draws, after warm-up, along whose path energy was not conserved: the density has places that the step size
    /// cannot resolve, and estimates may be biased.
    int divergences = 0;
    int longest_paths = 0;    ///< draws, after warm-up, whose path was stopped by most_doublings
    double acceptance = 0;    ///< mean, after warm-up
    std::vector<double> step; ///< by chain
    long evaluations = 0;     ///< of the density

    std::span<double const> at(int chain, int draw) const
    {
        return std::span(values).subspan(
            (std::size_t(chain) * std::size_t(per_chain) + std::size_t(draw)) * parameters, parameters);
    }
};

/// Independent of the number of threads; the same seed gives the same draws on one machine. On another one the
/// last bits of exp and log differ, which changes the paths, not what is estimated within its Monte Carlo error.
/// @throws std::invalid_argument no parameters, chains or draws, or no finite density near the start
Draws sample(LogDensity const& density, std::span<double const> start, SamplerSettings const& settings = {});

/// How well chains agree on one quantity (Vehtari, Gelman, Simpson, Carpenter & Bürkner 2021, Bayesian Anal.
/// 16:667).
struct Convergence {
    double r_hat = 0; ///< the larger of rank-normalised split R-hat and the same of the distance from the median
    double bulk = 0;  ///< effective number of draws for the centre
    double tail = 0;  ///< effective number of draws for the 5 % and 95 % quantiles, the smaller
};
/// @param chains draws of one quantity by chain, equally many. NaN if a chain has fewer than 4 draws or draws are
/// not finite; a constant quantity has R-hat NaN.
Convergence convergence(std::vector<std::vector<double>> const& chains);

/// What a posterior says of one quantity.
struct Posterior {
    double mean = 0, deviation = 0, low = 0, median = 0, high = 0; ///< low, high: equal tails
    Convergence convergence;
};
/// @param quantity of the parameters of one draw
Posterior posterior(Draws const& draws, std::function<double(std::span<double const>)> const& quantity,
                    double confidence = 0.95);

/// Sums up diagnostics of a fit.
struct SamplerReport {
    double worst_r_hat = 0, least_bulk = 0, least_tail = 0; ///< over the quantities that were looked at
    int draws = 0, divergences = 0, longest_paths = 0;
    long evaluations = 0; ///< of the density
};
void look_at(SamplerReport& report, Convergence const& quantity);
SamplerReport report_of(Draws const& draws);
inline constexpr double kMostRHat = 1.01;
/// What is wrong with the draws; empty = nothing. R-hat up to kMostRHat, 100 effective draws per chain and no
/// divergence are wanted.
std::string complaint(SamplerReport const& report, int chains);

/// Returns fit(settings), which has a SamplerReport `report`; if its chains differ (kMostRHat), which some of
/// thousands do by chance, a second one with twice the draws and warm-up: then it takes three times as long.
/// Who asks for fewer draws than usual gets no more: short chains often differ.
template <class Fit>
auto fit_by_draws(SamplerSettings settings, Fit const& fit)
{
    auto first = fit(settings);
    bool const few = settings.draws < SamplerSettings{}.draws;
    if (few || first.report.worst_r_hat <= kMostRHat) return first;
    settings.warm_up *= 2;
    settings.draws *= 2;
    return fit(settings);
}

} // namespace study
