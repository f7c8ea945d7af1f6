#pragma once
// Power of an experiment by simulation: how often would its analysis find an effect, for several sizes of the
// effect, numbers of participants and numbers of repeats? Every simulation is the whole experiment: plans of the
// script, model observers, the analysis of study/analysis.

#include "study/analysis/analysis.h"
#include "study/observers/observer.h"
#include "study/tables/table.h"

#include <functional>

namespace study {

struct PowerSettings {
    int block = 0; ///< the one that is tested
    /// An effect of the table `effects` ("display x scene" or "display:scene"), or "A - B", two items whose scores
    /// are compared; blanks do not matter.
    std::string test;
    /// Factors by which effects of the observers' model (`scaled`) are multiplied; 0 = no effect.
    std::vector<double> effects{1};
    std::vector<int> scaled;       ///< factors of the script; empty = all, and interactions
    std::vector<int> participants; ///< numbers; rising
    std::vector<int> repeats;      ///< of the block; empty = the script's
    int simulations = 200;
    double alpha = 0.05;
    std::uint64_t seed = 1;
    bool has_recovery = false; ///< compare estimates with those of a very large simulated experiment
};

/// For one combination.
struct PowerPoint {
    int repeats = 1, participants = 0;
    double effect = 0;
    int simulations = 0, found = 0;
    int refused = 0;             ///< simulations whose data had no such test: not found
    double power = kUnknown;     ///< found / simulations
    Interval interval;           ///< 95 %, Wilson
    double estimate = kUnknown;  ///< mean of the estimates: difference of scores, or partial eta squared
    double deviation = kUnknown; ///< their standard deviation
    double truth = kUnknown;     ///< with recovery
    double coverage = kUnknown;  ///< share of intervals that contain it
};

struct PowerStudy {
    std::string block, test, unit;
    std::vector<PowerPoint> points; ///< by repeats, effect, participants
    int simulations_planned = 0;
    bool is_complete = true; ///< false: stopped before the last simulation
};

/// Simulations are independent of each other; within one, smaller numbers of participants are its first ones, and
/// effects and repeats share their observers. @param go_on  called often, with the share that is done; false =
/// stop, keeping what is done
/// @throws ScriptError an unknown test (naming those that exist), an impossible design
PowerStudy study_power(Script const& script, ObserverModel const& model, PowerSettings const& settings,
                       std::function<bool(double)> const& go_on);

/// Model with effects multiplied.
ObserverModel scaled_model(ObserverModel const& model, std::vector<int> const& factors, double by);

Table power_table(PowerStudy const& study, PowerSettings const& settings);
std::string power_json(PowerStudy const& study, PowerSettings const& settings);
/// Aligned text for a terminal.
std::string power_text(PowerStudy const& study, PowerSettings const& settings);
/// One HTML page with power against participants, a curve for each size of the effect.
std::string power_page(Script const& script, PowerStudy const& study, PowerSettings const& settings,
                       std::string const& program);

} // namespace study
