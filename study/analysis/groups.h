#pragma once
// Grouping of trials for analysis.

#include "study/analysis/analysis.h"

#include <functional>

namespace study {

/// The trials of all sessions of one participant.
struct ObserverTrials {
    std::string participant;
    std::vector<TrialRow> rows;
    TrialDetail detail = TrialDetail::trials;
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
/// The group of all trials, then one for each level of each factor that varies between the counted trials of the
/// block, except the given factors.
std::vector<Group> groups_of(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                             std::vector<int> const& items_of);

/// A trial's levels of the factors of groups, as text: "scene=arches display=hmd"; "all" if they have none.
/// @param groups  from groups_of
std::string cell_name(Script const& script, std::vector<Group> const& groups, TrialRow const& row);

/// The levels of trials as texts, with as many digits as tell them apart.
std::map<double, std::string> level_names(std::vector<ObserverTrials> const& trials);

/// The counted trials of a block by observer, including empty lists.
std::vector<ObserverTrials> counted(std::vector<ObserverTrials> const& observers, int block,
                                    Group const& group = {});

/// The factors whose levels are the items of a rating: those of the reference that the block crosses, otherwise
/// the last one that it crosses.
std::vector<int> rated_factors(Script const& script, Block const& block);

/// Mean rendering time per frame of each item's stimuli, by observer; all frames have equal weight.
/// @param item  index of a stimulus's item; -1 = none
std::vector<Uncertain> render_times(std::vector<ObserverTrials> const& observers, int items, double confidence,
                                    std::function<int(TrialRow const&, Stimulus const&)> const& item);

/// Mean and Student's interval over observers; NaN are ignored. One observer has no interval, and neither have values
/// that do not vary: they say nothing of what others would answer.
/// @param size  magnitude of the numbers that the values were computed from, if it may be larger than theirs
Uncertain mean_of(std::vector<double> const& values, double confidence, double size = 0);
/// p-value of Student's two-sided test of "the mean is 0"; NaN for fewer than two values, and for values that do not
/// vary beyond rounding. @param size  as for mean_of
double mean_p(std::vector<double> const& values, double size = 0);
/// p-values adjusted by Holm's step-down procedure (1979, Scand. J. Stat. 6:65). NaN are ignored.
std::vector<double> holm(std::vector<double> const& p);
/// Fills in p_holm of all differences, and finds the cheapest item that does not differ significantly from the
/// reference, or from the best one.
/// @param reference item; -1 = not judged
void judge_differences(ScaleResult& scale, int reference, double level);

/// Notes on scores and differences in which observers do not vary.
void note_no_variation(ScaleResult& scale);
void add_fact(ScaleResult& scale, std::string_view name, double value);
void add_note(ScaleResult& scale, std::string_view text);

} // namespace study
