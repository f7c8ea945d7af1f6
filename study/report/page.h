#pragma once
// A self-contained HTML page that shows an analysis: inline figures, no scripts, no other files; printable.

#include "study/analysis/analysis.h"
#include "study/tables/result_table.h"

#include <span>

namespace study {

/// True parameters of simulated observers (written by study/observers).
struct SimulatedTruth {
    std::map<std::string, std::map<std::string, double>> quality_jod; ///< by factor and level
    struct Varied {
        double threshold = 0, slope = 1;
        PsychometricChoice function{Psychometric::weibull, {}};
        Scale scale = Scale::log10;
    };
    std::map<std::string, Varied> varied; ///< by setting
    double lapse = 0;
};
/// @throws ScriptError if the text has another form
SimulatedTruth read_truth(std::string const& json, std::string const& name);
/// Level at which the proportion correct is `proportion`; NaN if there is none, or the setting is unknown.
double true_level(SimulatedTruth const& truth, std::string const& setting, bool harder_up, double guess,
                  double proportion);

struct ReportFacts {
    std::string program; ///< "lightwell 0.1.0 (git 1a2b3c4)"
    std::optional<SimulatedTruth> truth;
    std::vector<double> frame_interval_ms{}; ///< between neighbouring frames of a stimulus; empty = not recorded
    std::vector<ResultTable> gaze{};         ///< what people looked at; empty = not recorded
};

/// @param sessions the analysed sessions, for their provenance
std::string report_page(Script const& script, std::span<RecordedSession const> sessions, Analysis const& analysis,
                        ReportFacts const& facts);

} // namespace study
