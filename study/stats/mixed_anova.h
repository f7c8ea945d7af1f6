#pragma once
// Analysis of variance of observers' cell means in designs between and within observers ("split plot", mixed).
//
// For each within-observers effect the cells are multiplied by orthonormal contrasts; these numbers of an observer
// follow a linear model of the groups. F = (trace H / df1) / (trace E / df2) with the hypothesis' and the error's
// sums of squares H and E; sums of squares are of type III (each effect is adjusted for all others, groups have
// equal weight whatever their sizes). Degrees of effects within observers are multiplied by an epsilon for unequal
// variances and correlations of the cells (sphericity): Greenhouse & Geisser 1959 (Psychometrika 24:95), Huynh &
// Feldt 1976 (J. Educ. Stat. 1:69) as corrected by Lecoutre 1991.

#include "study/numeric/matrix.h"
#include "study/stats/binomial.h"

#include <cstdint>
#include <string>
#include <vector>

namespace study {

struct WithinFactor {
    std::string name;
    int levels = 0;
};
struct BetweenFactor {
    std::string name;
    int levels = 0;
    std::vector<int> level; ///< of each observer, from 0
};
struct MixedDesign {
    std::vector<WithinFactor> within; ///< the cells are all combinations, the last factor varying fastest
    std::vector<BetweenFactor> between;
};

struct AnovaEffect {
    std::string name;                           ///< "group", "group x scene"
    bool is_between = false, is_within = false; ///< it involves such factors
    /// False: there is no variation within groups beyond rounding, so that there is nothing to compare the effect with
    /// (all observers differ by the same), and all numbers but squares and degrees of freedom are NaN.
    bool is_tested = true;
    double f = 0, df1 = 0, df2 = 0, p = 1;
    double squares = 0; ///< sum of squares
    double greenhouse_geisser = 1,
           p_gg = 1;                  ///< epsilon, and p with it; 1 and p without a within factor of 3 or more
    double huynh_feldt = 1, p_hf = 1; ///< at most 1
    double partial_eta2 = 0;          ///< squares / (squares + those of the error)
    /// By the noncentral F distribution (Steiger 2004, Psychol. Methods 9:164). F that is smaller than chance allows has the
    /// upper end 0 there; the end is at least the estimate, which is never 0, and the interval wider than need be.
    Interval eta2;
    /// Without assumption of normality: for effects that involve groups, observers change groups; otherwise the
    /// signs of an observer's contrasts change (Fisher 1935; Anderson & ter Braak 2003). NaN if not asked for.
    double p_permutation = 0;
};

struct AnovaSettings {
    int permutations = 0;
    std::uint64_t seed = 1;
    double confidence = 0.95;
};

/// All main effects and interactions, between ones first; without those of numbers that do not vary at all.
/// @param cells  observers x cells, without gaps
/// @throws std::invalid_argument gaps, sizes that do not match, a combination of groups without observers, no more
/// observers than groups, no variation
std::vector<AnovaEffect> mixed_anova(Matrix const& cells, MixedDesign const& design,
                                     AnovaSettings const& settings = {});

} // namespace study
