#pragma once
// One page (HTML) that shows an analysis: drawings inline, no scripts, nothing beside it; it prints.

#include "study/analysis/analysis.h"

#include <span>

namespace study {

/// What a simulation says of its observers (study/observers writes it).
struct SimulatedTruth {
    std::map<std::string, std::map<std::string, double>> quality_jod; ///< by factor and level
    struct Varied {
        double threshold = 0, slope = 1;
        bool is_weibull = true;
    };
    std::map<std::string, Varied> varied; ///< by setting
    double lapse = 0;
};
/// @throws ScriptError where it is no such text
SimulatedTruth read_truth(std::string const& json, std::string const& name);
/// Where the share of right answers is `proportion`; NaN where it never is, or the setting is not known.
double true_level(SimulatedTruth const& truth, std::string const& setting, bool harder_up, double guess,
                  double proportion);

struct ReportFacts {
    std::string program; ///< "lightwell 0.1.0 (git 1a2b3c4)"
    std::optional<SimulatedTruth> truth;
    std::vector<double> frame_interval_ms{}; ///< between neighbouring frames of a stimulus; empty = not kept
};

/// @param sessions those that were analysed, for their provenance
std::string report_page(Script const& script, std::span<RecordedSession const> sessions, Analysis const& analysis,
                        ReportFacts const& facts);

} // namespace study
