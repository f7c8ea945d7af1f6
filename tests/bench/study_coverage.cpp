// Bias and coverage of what `study analyze` reports, over many simulated experiments:
//   bench_study_coverage [detection|false_alarms|thresholds|observers] [EXPERIMENTS [OBSERVERS [TRIALS [ROWS]]]]
// OBSERVERS of each experiment (20); TRIALS of each observer in detection (30); ROWS: only those whose names
// contain this. Rows are printed as they are finished, as a Markdown table.

#include "tests/study_analysis/coverage.h"

#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

namespace {

using namespace study;
using namespace study::test;

/// Of the command line.
struct Choice {
    int observers = 20, trials = 30;
    std::string rows;

    bool has(std::string const& row) const { return row.find(rows) != std::string::npos; }
};
Choice g_choice;

void print(Tally const& t, char const* unit)
{
    double const error = 100 * std::sqrt(0.05 * 0.95 / std::max(1, t.experiments));
    fmt::print("| {} | {} | {:+.3f} {} | {:.1f} | {} | {} | {} | {:.1f} |\n", t.name, t.experiments, t.bias(),
               unit, t.coverage(), t.below, t.above, t.unknown, error);
    std::fflush(stdout);
}

/// On stderr, as a row may take an hour.
void show_progress(Tally const& t)
{
    if (t.experiments % 50 == 0) fmt::print(stderr, "{}: {}, {:.1f} %\n", t.name, t.experiments, t.coverage());
}

void detection_row(DetectionExperiment e, std::string const& name, int experiments)
{
    if (!g_choice.has(name)) return;
    e.observers = g_choice.observers;
    e.trials = g_choice.trials;
    AnalysisSettings settings;
    settings.draws = 0;
    Tally t{name};
    for (int i = 0; i < experiments; ++i) {
        Analysis const a = analyse_detection(e, 1000 * std::uint64_t(i) + std::uint64_t(e.task), settings);
        Uncertain const& d = a.blocks.at(0).detections.at(0).observer_dprime;
        t.add(d.value, d.interval, e.mean);
    }
    print(t, "");
}

void detection(int experiments)
{
    for (double const sd : {0.0, 0.3})
        for (double const mean : {0.0, 0.5, 1.0, 2.0})
            for (int k = 0; k < 5; ++k) {
                if (mean == 0 && sd > 0) continue; // without sensitivity nobody differs
                DetectionExperiment e;
                e.task = DetectionTask(k);
                e.mean = mean;
                e.sd = sd;
                detection_row(e, fmt::format("d' of {}, mean {}, sd {}", name_of(e.task), mean, sd),
                              mean == 0 ? experiments : std::max(1, experiments / 3));
            }
}

/// Same-different by observers with many false alarms.
void false_alarms(int experiments)
{
    for (double const mean : {0.0, 1.0, 2.0, 4.0}) {
        DetectionExperiment e;
        e.task = DetectionTask::same_different;
        e.mean = mean;
        e.criterion = -0.15;
        detection_row(e, fmt::format("d' of same_different, mean {}, 40 % false alarms", mean), experiments);
    }
}

Interval decades(Interval const& i) { return {std::log10(i.low), std::log10(i.high)}; }

std::vector<ThresholdExperiment> threshold_experiments()
{
    std::vector<ThresholdExperiment> all;
    for (char const* const method : {"constant", "staircase", "questplus"}) {
        ThresholdExperiment e;
        e.method = method;
        all.push_back(e);
        e.lapse = 0.05;
        all.push_back(e);
        if (e.method == "constant") {
            e.eta = 0.2;
            all.push_back(e);
        }
        e = {};
        e.method = method;
        e.slope_sd = 0.25;
        all.push_back(e);
    }
    ThresholdExperiment e;
    e.false_alarms = 0.3;
    all.push_back(e);
    return all;
}

std::string name_of(ThresholdExperiment const& e)
{
    return fmt::format("{}{}, lapses {}{}{}", e.method, e.false_alarms > 0 ? " yes_no, false alarms 0.3" : "",
                       e.lapse, e.eta > 0 ? fmt::format(", overdispersion {}", e.eta) : "",
                       e.slope_sd > 0 ? ", slopes differ" : "");
}

void thresholds(int experiments)
{
    AnalysisSettings settings;
    settings.draws = 0;
    for (ThresholdExperiment e : threshold_experiments()) {
        if (!g_choice.has(name_of(e))) continue;
        e.observers = g_choice.observers;
        Tally group{name_of(e) + ": population"}, own{name_of(e) + ": observers"},
            target{name_of(e) + ": population, mean of reversals"}, quest{name_of(e) + ": observers, QUEST+"},
            reversals{name_of(e) + ": observers, mean of reversals"};
        for (int i = 0; i < experiments; ++i) {
            SimulatedThresholds const s = analyse_thresholds(e, std::uint64_t(i), settings);
            BlockResult const& b = s.analysis.blocks.at(0);
            auto const is_share = [&](double p) { return std::abs(p - s.share) < 1e-9; };
            for (ThresholdSummary const& t : b.thresholds) {
                if (t.method == "likelihood" && is_share(t.proportion))
                    group.add(std::log10(t.level.value), decades(t.level.interval), kMeanThreshold);
                if (t.method == "mean of reversals")
                    target.add(std::log10(t.level.value), decades(t.level.interval), s.at_target);
            }
            for (std::size_t k = 0; k < b.runs.size(); ++k)
                for (ThresholdEstimate const& t : b.runs[k].estimates) {
                    if (t.method == "likelihood" && is_share(t.proportion))
                        own.add(std::log10(t.level.value), decades(t.level.interval), s.own[k]);
                    if (t.method == "QUEST+ posterior")
                        quest.add(std::log10(t.level.value), decades(t.level.interval), s.own[k]);
                    if (t.method == "mean of reversals")
                        reversals.add(std::log10(t.level.value), decades(t.level.interval), s.own_target[k]);
                }
        }
        for (Tally const* const t : {&group, &target, &own, &reversals, &quest})
            if (t->experiments > 0) print(*t, "decades");
    }
}

/// Hierarchical models, which take longest.
void observers(int experiments)
{
    AnalysisSettings const settings;
    auto const add = [&](Tally& mean, Tally& each, HierarchicalResult const& h, double truth,
                         std::vector<double> const& own, bool is_log) {
        auto const on = [&](double v) { return is_log ? std::log10(v) : v; };
        auto const both = [&](Interval const& i) { return Interval{on(i.low), on(i.high)}; };
        mean.add(on(h.mean.value), both(h.mean.interval), truth);
        for (std::size_t k = 0; k < own.size(); ++k)
            each.add(on(h.each[k].value), both(h.each[k].interval), own[k]);
    };
    auto const detect = [&](DetectionTask task, double sd) {
        DetectionExperiment e;
        e.task = task;
        e.mean = 1.5;
        e.sd = sd;
        e.observers = g_choice.observers;
        e.trials = g_choice.trials;
        std::string const name = fmt::format("hierarchical d' of {}, sd {}", study::test::name_of(task), sd);
        if (!g_choice.has(name)) return;
        Tally mean{name + ": population"}, each{name + ": observers"};
        for (int i = 0; i < experiments; ++i) {
            std::vector<double> own;
            Analysis const a = analyse_detection(e, 50000 + std::uint64_t(i), settings, &own);
            add(mean, each, a.blocks.at(0).hierarchical.at(0), e.mean, own, false);
            show_progress(mean);
        }
        print(mean, "");
        print(each, "");
    };
    for (double const sd : {0.4, 0.2, 0.8})
        for (int k = 0; k < 5; ++k) detect(DetectionTask(k), sd);
    for (ThresholdExperiment e : threshold_experiments()) {
        if ((e.lapse == 0.05 && e.eta == 0) || !g_choice.has(name_of(e))) continue;
        e.observers = g_choice.observers;
        Tally mean{"hierarchical, " + name_of(e) + ": population"},
            each{"hierarchical, " + name_of(e) + ": observers"};
        for (int i = 0; i < experiments; ++i) {
            SimulatedThresholds const s = analyse_thresholds(e, 50000 + std::uint64_t(i), settings);
            add(mean, each, s.analysis.blocks.at(0).hierarchical.at(0), kMeanThreshold, s.own, true);
            show_progress(mean);
        }
        print(mean, "decades");
        print(each, "decades");
    }
}

} // namespace

int main(int argc, char** argv)
{
    std::string const what = argc > 1 ? argv[1] : "";
    int const experiments = argc > 2 ? std::atoi(argv[2]) : 100;
    if (argc > 3) g_choice.observers = std::atoi(argv[3]);
    if (argc > 4) g_choice.trials = std::atoi(argv[4]);
    if (argc > 5) g_choice.rows = argv[5];
    fmt::print("| estimate | intervals | bias | coverage % | below | above | no estimate or end | +- % |\n"
               "|---|---|---|---|---|---|---|---|\n");
    if (what.empty() || what == "detection") detection(experiments);
    if (what.empty() || what == "false_alarms") false_alarms(experiments);
    if (what.empty() || what == "thresholds") thresholds(experiments);
    if (what.empty() || what == "observers") observers(experiments);
    return 0;
}
