#include "study/analysis/table_parts.h"

#include "gi/core/quantile.h"
#include "study/numeric/rounding.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

void add_estimate(std::vector<std::string>& row, Uncertain const& u)
{
    row.insert(row.end(), {full_cell(u.value), full_cell(u.interval.low), full_cell(u.interval.high)});
}

std::vector<Column> with_interval(std::vector<Column> columns, std::vector<Column> const& more = {})
{
    columns.back().has_interval = true;
    columns.push_back({"low", "Lower end of the interval"});
    columns.push_back({"high", "Upper end"});
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
}

/// An end that is open is missing.
void add_deviation(std::vector<std::string>& row, double value, Interval const& interval)
{
    for (double const v : {value, interval.low, interval.high})
        row.push_back(std::isfinite(v) ? cell(v) : cell(""));
}

ResultTable agreement(Analysis const& a)
{
    ResultTable t{
        "agreement",
        "Agreement of observers",
        "Kendall's u: 1 if all agree; p under random choices. D: test of all items being equally good. The "
        "first judgement of each pair counts.",
        false,
        {}};
    t.table.columns = {
        name_column("block", "Block"),
        name_column("cell", "Condition"),
        {"observers", "Observers with a first choice of every pair"},
        {"left_out",
         "Observers without: a pair was not judged or tied, or counts do not tell which choice was the first"},
        {"u", "Kendall's coefficient of agreement"},
        {"u_least", "Smallest possible value"},
        {"chi_square", "Its chi-square, corrected"},
        {"df", "Degrees of freedom"},
        {"p_u", "Probability of that u or more under random choices"},
        {"D", "Equality test"},
        {"D_df", "Degrees of freedom"},
        {"p_D", "Probability of that D or more"}};
    for (BlockResult const& b : a.blocks)
        for (AgreementResult const& g : b.agreement) {
            std::vector<std::string> row{cell(b.name), cell(g.cell), cell(g.observers), cell(g.left_out)};
            if (g.kendall)
                row.insert(row.end(),
                           {cell(g.kendall->u), cell(g.kendall->minimum), cell(g.kendall->chi_square_corrected),
                            cell(g.kendall->degrees_of_freedom), cell(g.kendall->p_corrected)});
            else
                row.insert(row.end(), 5, cell(""));
            if (g.equality)
                row.insert(row.end(),
                           {cell(g.equality->d), cell(g.equality->degrees_of_freedom), cell(g.equality->p)});
            else
                row.insert(row.end(), 3, cell(""));
            t.table.rows.push_back(std::move(row));
        }
    return t;
}

ResultTable thresholds(Analysis const& a)
{
    ResultTable t{
        "thresholds",
        "Thresholds",
        "Population means on the scale of the levels. likelihood: of all answers, integrated over observers' "
        "thresholds, interval by the profile; mean of reversals: mean over observers, corrected for the bias of "
        "such runs, Student's interval. sd: where its interval begins at 0, the answers do not show that "
        "observers differ. Methods estimate different proportions correct: compare only equal ones.",
        false,
        {}};
    t.table.columns = with_interval(
        {name_column("block", "Block"),
         name_column("cell", "Condition"),
         name_column("procedure", "Procedure"),
         {"method", "Method of estimation"},
         {"share", "Proportion correct at the threshold"},
         {"level", "Threshold"}},
        {estimate_column("sd",
                         "Standard deviation of thresholds between observers, in units of the scale; by means "
                         "of reversals with the errors of the runs"),
         {"sd_low", "Lower end of its interval"},
         {"sd_high", "Upper end"},
         {"observers", "Observers with an estimate"}});
    for (BlockResult const& b : a.blocks)
        for (ThresholdSummary const& s : b.thresholds) {
            std::vector<std::string> row{cell(b.name), cell(s.cell), cell(s.procedure), cell(s.method),
                                         cell(s.proportion)};
            add_estimate(row, s.level);
            add_deviation(row, s.deviation, s.deviation_interval);
            row.push_back(cell(s.level.n));
            t.table.rows.push_back(std::move(row));
        }
    return t;
}

ResultTable runs(Analysis const& a)
{
    ResultTable t{"runs",
                  "Thresholds of single runs",
                  "From the trials of the run. likelihood: with the scale and lapse rate of all observers, or "
                  "weak priors if there are fewer than three.",
                  true,
                  {}};
    t.table.columns = with_interval({name_column("block", "Block"),
                                     name_column("participant", "Participant"),
                                     name_column("cell", "Condition"),
                                     name_column("procedure", "Procedure"),
                                     {"run", "Run, from 1"},
                                     {"trials", "Trials"},
                                     {"reversals", "Reversals of a staircase"},
                                     {"method", "Method of estimation"},
                                     {"share", "Proportion correct at the threshold"},
                                     {"level", "Threshold"}},
                                    {name_column("remark", "Remark on its reliability")});
    for (BlockResult const& b : a.blocks)
        for (ThresholdRun const& r : b.runs)
            for (ThresholdEstimate const& e : r.estimates) {
                std::vector<std::string> row{cell(b.name),
                                             cell(r.participant),
                                             cell(r.cell),
                                             cell(r.procedure),
                                             cell(r.run),
                                             cell(int(r.levels.size())),
                                             cell(int(r.reversals.size())),
                                             cell(e.method),
                                             cell(e.proportion)};
                add_estimate(row, e.level);
                row.push_back(cell(e.note));
                t.table.rows.push_back(std::move(row));
            }
    return t;
}

ResultTable parameters(Analysis const& a)
{
    ResultTable t{
        "parameters",
        "Parameters of QUEST+ with several settings",
        "Posterior mean and standard deviation of each run. Compare their spread over observers with the "
        "standard deviations.",
        true,
        {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("cell", "Condition"),
                       name_column("participant", "Participant"),
                       name_column("procedure", "Procedure"),
                       {"run", "Run, from 1"},
                       {"trials", "Trials"},
                       name_column("parameter", "Parameter of the formula"),
                       {"mean", "Posterior mean"},
                       {"sd", "Posterior standard deviation"},
                       name_column("note", "Remark")};
    for (BlockResult const& b : a.blocks)
        for (ThresholdRun const& r : b.runs) {
            std::vector<std::string> const start{cell(b.name),      cell(r.cell), cell(r.participant),
                                                 cell(r.procedure), cell(r.run),  cell(double(r.levels.size()))};
            auto const add = [&](std::vector<std::string> const& rest) {
                t.table.rows.push_back(start);
                t.table.rows.back().insert(t.table.rows.back().end(), rest.begin(), rest.end());
            };
            for (ParameterEstimate const& e : r.parameters)
                add({cell(e.name), cell(e.mean), cell(e.sd), cell(e.note)});
            if (!r.note.empty()) add({cell(""), cell(""), cell(""), cell(r.note)});
        }
    return t;
}

ResultTable curves(Analysis const& a)
{
    ResultTable t{"curves",
                  "Psychometric functions of the average observer",
                  "From all procedures: thresholds differ between observers, scale and lapse rate are common. "
                  "Interval of the mean threshold by the profile likelihood; of a formula, which is fitted to all "
                  "trials pooled, by a bootstrap over observers. Scale and sd: in decades, octaves or decibels if "
                  "the scale of "
                  "the levels is log10, log2 or db.",
                  false,
                  {}};
    t.table.columns = with_interval(
        {name_column("block", "Block"),
         name_column("cell", "Condition"),
         {"observers", "Observers"},
         {"trials", "Trials"},
         {"share", "Proportion correct at the threshold"},
         {"threshold", "Level"}},
        {name_column("function", "Psychometric function, or its formula"),
         estimate_column("sd", "Standard deviation of thresholds between observers"),
         {"sd_low", "Lower end of its interval"},
         {"sd_high", "Upper end"},
         {"scale", "Spread of the function; of a formula its slope"},
         {"lapse", "Lapse rate"},
         {"eta", "Overdispersion: n answers at a level have the variance of n p q (1 + (n - 1) eta^2)"},
         {"deviance", "Deviance of one function through all trials pooled"},
         {"df", "Its degrees of freedom"},
         {"p_fit",
          "Probability of that deviance or more; inaccurate with few trials per level, too small if observers "
          "differ"}});
    for (BlockResult const& b : a.blocks)
        for (CurveResult const& c : b.curves) {
            double trials = 0;
            for (LevelCount const& l : c.counts) trials += l.trials;
            std::vector<std::string> row{cell(b.name), cell(c.cell), cell(c.observers), cell(trials),
                                         cell(c.proportion)};
            add_estimate(row, c.threshold);
            bool const is_fitted = !c.counts.empty();
            auto const fitted = [&](double v) { return is_fitted ? cell(v) : cell(""); };
            row.push_back(cell(c.function));
            Interval const unknown{kUnknown, kUnknown};
            add_deviation(row, is_fitted ? c.deviation : kUnknown, is_fitted ? c.deviation_interval : unknown);
            row.insert(row.end(),
                       {fitted(c.parameters.scale * c.scale_unit), fitted(c.parameters.lapse), fitted(c.eta),
                        fitted(c.pooled.deviance), fitted(c.pooled.degrees_of_freedom), fitted(c.pooled.fit_p)});
            t.table.rows.push_back(std::move(row));
        }
    return t;
}

/// Adds the columns of an estimate: name, name_low and name_high. @param what  meaning of the value
void add_columns(std::vector<Column>& columns, std::string const& name, std::string const& what)
{
    columns.push_back(estimate_column(name, what));
    columns.push_back({name + "_low", "Lower end of its interval"});
    columns.push_back({name + "_high", "Upper end"});
}

ResultTable population(Analysis const& a)
{
    ResultTable t{
        "population",
        "Hierarchical models of the population",
        "Bayesian: every observer has d', criterion or threshold, scale and lapse rate of his or her own. "
        "Posterior means and intervals; sd: between observers, of thresholds in units of the scale. Where "
        "observers hardly differ, 95 % intervals of means hold in 98 to 99 %: for a test of d' = 0 take mean and "
        "p of the table of correct answers. R-hat up to 1.01, effective draws from 400 and no divergences are "
        "wanted.",
        false,
        {}};
    auto& columns = t.table.columns;
    columns = {name_column("block", "Block"),
               name_column("condition", "Condition"),
               name_column("of", "Parameter"),
               {"observers", "Observers"}};
    add_columns(columns, "mean", "Mean of the population");
    add_columns(columns, "sd", "Standard deviation between observers");
    columns.insert(columns.end(), {{"scale", "Spread of the psychometric function, in units of the scale"},
                                   {"lapse", "Lapse rate"},
                                   {"r_hat", "Rank-normalised split R-hat, the worst of all parameters shown"},
                                   {"ess_bulk", "Effective draws for centres, the fewest"},
                                   {"ess_tail", "Effective draws for 5 % and 95 % quantiles, the fewest"},
                                   {"divergences", "Draws that diverged"},
                                   {"draws", "Draws of all chains"}});
    for (BlockResult const& b : a.blocks)
        for (HierarchicalResult const& h : b.hierarchical) {
            if (!h.refused.empty()) continue;
            std::vector<std::string> row{cell(b.name), cell(h.condition), cell(h.parameter), cell(h.observers)};
            add_estimate(row, h.mean);
            add_estimate(row, h.deviation);
            row.insert(row.end(),
                       {cell(h.scale), cell(h.lapse), cell(h.report.worst_r_hat), cell(h.report.least_bulk),
                        cell(h.report.least_tail), cell(h.report.divergences), cell(h.report.draws)});
            t.table.rows.push_back(std::move(row));
        }
    return t;
}

ResultTable population_observers(Analysis const& a)
{
    ResultTable t{"population_observers",
                  "Observers by the hierarchical models",
                  "Shrunken towards the mean of the population, the more the less an observer's own answers say.",
                  true,
                  {}};
    t.table.columns = with_interval({name_column("block", "Block"),
                                     name_column("condition", "Condition"),
                                     name_column("of", "Parameter"),
                                     name_column("participant", "Participant"),
                                     {"value", "Posterior mean"}});
    for (BlockResult const& b : a.blocks)
        for (HierarchicalResult const& h : b.hierarchical)
            for (std::size_t i = 0; i < h.each.size(); ++i) {
                std::vector<std::string> row{cell(b.name), cell(h.condition), cell(h.parameter),
                                             cell(h.participants[i])};
                add_estimate(row, h.each[i]);
                t.table.rows.push_back(std::move(row));
            }
    return t;
}

ResultTable detection(Analysis const& a)
{
    ResultTable t{
        "detection",
        "Correct answers and d'",
        "Proportions with Wilson's interval of all trials. d', negative below chance: of all trials pooled, with "
        "log-linear correction, and the mean of the population, by the likelihood integrated over "
        "observers, interval by its profile.",
        false,
        {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("condition", "Condition"),
                       {"observers", "Observers"},
                       {"right", "Correct answers"},
                       {"trials", "Trials"},
                       estimate_column("share", "Proportion correct"),
                       {"share_low", "Lower end"},
                       {"share_high", "Upper end"},
                       {"dprime_all", "d' of all trials pooled"},
                       estimate_column("dprime", "d', mean of the population"),
                       {"low", "Lower end"},
                       {"high", "Upper end"},
                       {"p", "p-value of that mean being 0"},
                       estimate_column("sd", "Standard deviation of d' between observers"),
                       {"sd_low", "Lower end of its interval"},
                       {"sd_high", "Upper end"},
                       {"criterion", "Mean criterion; positive: no, same or second is preferred"},
                       {"model", "Model of d'"}};
    for (BlockResult const& b : a.blocks)
        for (DetectionResult const& d : b.detections) {
            std::vector<std::string> row{
                cell(b.name),         cell(d.condition),     cell(d.observers),
                cell(d.correct),      cell(d.trials),        cell(d.correct / d.trials),
                cell(d.interval.low), cell(d.interval.high), cell(without_noise(d.dprime))};
            Uncertain const& u = d.observer_dprime;
            add_estimate(
                row,
                {without_noise(u.value), {without_noise(u.interval.low), without_noise(u.interval.high)}, u.n});
            row.push_back(cell(d.p));
            add_deviation(row, without_noise(d.deviation), d.deviation_interval);
            row.insert(row.end(), {cell(without_noise(d.criterion)), cell(d.model)});
            t.table.rows.push_back(std::move(row));
        }
    return t;
}

ResultTable questionnaires(Analysis const& a)
{
    ResultTable t{"questionnaires", "Questionnaires", "Mean over answers, Student's interval.", false, {}};
    t.table.columns =
        with_interval({name_column("questionnaire", "Questionnaire"),
                       name_column("score", "Score"),
                       name_column("when", "Number of the occasion, or the condition in which it was answered"),
                       {"n", "Answers"},
                       {"mean", "Mean"}},
                      {{"sd", "Standard deviation"}});
    for (QuestionnaireResult const& q : a.questionnaires) {
        std::vector<std::string> row{cell(q.questionnaire), cell(q.score), cell(q.when), cell(q.mean.n)};
        add_estimate(row, q.mean);
        row.push_back(cell(q.deviation));
        t.table.rows.push_back(std::move(row));
    }
    return t;
}

ResultTable changes(Analysis const& a)
{
    ResultTable t{"changes",
                  "Changes of questionnaires since their first time",
                  "Paired by participant; p by Student's test, not corrected for the number of tests.",
                  false,
                  {}};
    t.table.columns = with_interval({name_column("questionnaire", "Questionnaire"),
                                     name_column("score", "Score"),
                                     {"from", "Time"},
                                     {"to", "Time"},
                                     {"n", "Participants who answered both"},
                                     {"change", "Mean change"}},
                                    {{"p", "p-value of the change"}});
    for (QuestionnaireChange const& q : a.changes) {
        std::vector<std::string> row{cell(q.questionnaire), cell(q.score), cell(q.from), cell(q.to),
                                     cell(q.change.n)};
        add_estimate(row, q.change);
        row.push_back(cell(q.p));
        t.table.rows.push_back(std::move(row));
    }
    return t;
}

ResultTable timing(Analysis const& a)
{
    ResultTable t{"timing", "Timing", "All trials that ran to their end, including invalid ones.", false, {}};
    t.table.columns = {{"number", "Which"}, {"value", "Value"}};
    TimingResult const& r = a.timing;
    auto const row = [&](std::string const& name, double value) { t.table.rows.push_back({name, cell(value)}); };
    if (r.stimuli == 0) return t;
    std::vector<double> periods, deviations;
    int passed = 0;
    for (CalibrationResult const& c : r.calibrations) {
        periods.push_back(c.done.period_mean_ms);
        deviations.push_back(c.done.period_sd_ms);
        passed += c.done.passed;
    }
    if (!r.calibrations.empty()) {
        row("tests of the display", double(r.calibrations.size()));
        row("tests of the display that it passed", passed);
        row("period of the display, median ms", gi::quantile(periods, 0.5));
        row("standard deviation of the period, largest ms", gi::quantile(deviations, 1));
    }
    for (auto const& [method, n] : r.onset_methods) row("stimuli timed by " + (method.empty() ? "?" : method), n);
    row("onset uncertainty, median ms", gi::quantile(r.uncertainty_ms, 0.5));
    row("onset uncertainty, most ms", gi::quantile(r.uncertainty_ms, 1));
    row("frames planned", double(r.frames_planned));
    row("frames shown", double(r.frames_shown));
    row("frames dropped", double(r.frames_dropped));
    row("stimuli with dropped frames", r.stimuli_with_drops);
    row("stimuli", r.stimuli);
    row("time to render a frame, median of stimuli ms", gi::quantile(r.frame_ms, 0.5));
    row("time to render a frame, 99 % of stimuli ms", gi::quantile(r.frame_ms, 0.99));
    row("bookkeeping between trials, 99 % ms", gi::quantile(r.bookkeeping_ms, 0.99));
    return t;
}

ResultTable calibrations(Analysis const& a)
{
    ResultTable t{"calibrations", "Tests of the display", "", false, {}};
    t.table.columns = {name_column("participant", "Participant"),
                       {"part", "Part of the session"},
                       {"frames", "Frames timed"},
                       {"nominal_hz", "Refresh rate reported by the display", "Hz"},
                       {"period_ms", "Mean period", "ms"},
                       {"sd_ms", "Standard deviation of the period", "ms"},
                       {"passed", "Whether it passed"},
                       {"method", "How onsets are timed"},
                       name_column("reason", "Why not")};
    for (CalibrationResult const& c : a.timing.calibrations)
        t.table.rows.push_back({cell(c.participant), cell(c.part), cell(c.done.frames),
                                c.done.nominal_hz > 0 ? cell(c.done.nominal_hz) : cell(""),
                                cell(c.done.period_mean_ms), cell(c.done.period_sd_ms), cell(c.done.passed),
                                cell(c.done.onset_method), cell(c.done.reason)});
    t.is_long = t.table.rows.size() > 12;
    return t;
}

ResultTable reactions(Analysis const& a)
{
    ResultTable t{"reactions", "Reaction times, ms", "Quantiles of the trials that count.", false, {}};
    t.table.columns = {name_column("block", "Block"), {"trials", "Trials"},     {"q05", "5 %", "ms"},
                       {"q25", "25 %", "ms"},         {"median", "50 %", "ms"}, {"q75", "75 %", "ms"},
                       {"q95", "95 %", "ms"}};
    for (ReactionResult const& r : a.timing.reactions) {
        std::vector<std::string> row{cell(r.block), cell(int(r.ms.size()))};
        for (double const p : {0.05, 0.25, 0.5, 0.75, 0.95}) row.push_back(cell(gi::quantile(r.ms, p)));
        t.table.rows.push_back(std::move(row));
    }
    return t;
}

ResultTable transitions(Analysis const& a)
{
    ResultTable t{"transitions", "Order: how often a trial differs from the previous one", "", false, {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("of", "Factor, answer or procedure"),
                       {"switched", "Proportion of neighbours that differ"},
                       {"by_chance", "Its mean over all orders of the same trials"}};
    for (TransitionResult const& r : a.transitions)
        t.table.rows.push_back({cell(r.block), cell(r.subject), cell(r.switched), cell(r.by_chance)});
    return t;
}

} // namespace

std::vector<ResultTable> detail_tables(Analysis const& a)
{
    return {agreement(a),  thresholds(a),           runs(a),           parameters(a), curves(a), detection(a),
            population(a), population_observers(a), questionnaires(a), changes(a),    timing(a), calibrations(a),
            reactions(a),  transitions(a)};
}

} // namespace study
