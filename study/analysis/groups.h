#pragma once
// Which trials belong together.

#include "study/analysis/analysis.h"

#include <functional>

namespace study {

/// The trials of all sessions of one participant.
struct ObserverTrials {
    std::string participant;
    std::vector<TrialRow> rows;
};

/// Trials of a block that share the level of a factor, or all of them.
struct Group {
    std::string name; ///< "all", "scene=arches"
    int factor = -1, level = -1;

    bool has(TrialRow const& row) const
    {
        return factor < 0 || shared_level(*row.block, row.step->trial, factor) == level;
    }
};
/// All; then each level of each factor that varies between the counted trials of the block, but for the factors
/// given.
std::vector<Group> groups_of(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                             std::vector<int> const& items_of);

/// Levels of the factors that vary between trials of a block, as text: "scene=arches display=hmd"; "all" where
/// none does. @param ignored factors
std::string cell_name(Script const& script, std::vector<Group> const& groups, TrialRow const& row);

/// The counted trials of a block, observer by observer, empty lists included.
std::vector<ObserverTrials> counted(std::vector<ObserverTrials> const& observers, int block,
                                    Group const& group = {});

/// The factors whose levels are the items of a rating: those of the reference that the block crosses, or else the
/// last one that it crosses.
std::vector<int> rated_factors(Script const& script, Block const& block);

/// Mean time to render a frame of the stimuli with that label, observer by observer, frames weighted alike.
/// @param item of a stimulus: its index; -1 = none of them
std::vector<Uncertain> render_times(std::vector<ObserverTrials> const& observers, int items, double confidence,
                                    std::function<int(TrialRow const&, Stimulus const&)> const& item);

/// Mean and Student's interval over observers; values that are NaN are nobody's. One observer has no interval.
Uncertain mean_of(std::vector<double> const& values, double confidence);
/// Student's two-sided test of "the mean is 0"; NaN of fewer than two. No spread: 0, or 1 where the mean is 0.
double mean_p(std::vector<double> const& values);
/// p values by Holm's step-down procedure (1979, Scand. J. Stat. 6:65). NaN stay out of it.
std::vector<double> holm(std::vector<double> const& p);
/// Fills in p_holm of all differences, and finds the cheapest item that does not differ from the reference, or
/// from the best one.
/// @param reference item; -1 = it was not judged
void judge_differences(ScaleResult& scale, int reference, double level);

void add_fact(ScaleResult& scale, std::string_view name, double value);
void add_note(ScaleResult& scale, std::string_view text);

} // namespace study
