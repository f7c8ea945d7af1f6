#include "study/analysis/result_tables.h"

#include "study/analysis/table_parts.h"
#include "study/numeric/rounding.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

std::string percent(double confidence) { return fmt::format("{:.0f} %", 100 * confidence); }

/// Low and high of an interval as columns, after that of the estimate.
void add_interval(std::vector<Column>& columns, std::string const& prefix, double confidence)
{
    columns.back().has_interval = true;
    columns.push_back({prefix + "low", "Lower end of the " + percent(confidence) + " interval"});
    columns.push_back({prefix + "high", "Upper end"});
}

/// Sets values that are 0 but for the noise of a solver to 0. @param least  smallest number that is none
void add(std::vector<std::string>& row, Uncertain const& u, double least = 0)
{
    for (double const v : {u.value, u.interval.low, u.interval.high})
        row.push_back(full_cell(std::abs(v) < least ? 0.0 : v));
}

/// The smallest number beside these scores that is not rounding, or, where they are fitted in a natural unit, noise.
double least_of(ScaleResult const& s)
{
    double largest = 0;
    for (ScaledItem const& i : s.items) largest = std::fmax(largest, std::abs(i.score.value));
    return std::fmax(kRounding * largest, s.unit == "JOD" || s.unit == "utility" ? kSolverNoise : 0);
}

ResultTable exclusions(Analysis const& a)
{
    ResultTable t{"exclusions", "Excluded, or to be inspected", "", false, {}};
    t.table.columns = {name_column("participant", "Participant"),
                       name_column("what", "left out, kept, or look at"),
                       name_column("why", "Reason"),
                       {"trials", "Trials concerned"}};
    for (Exclusion const& e : a.exclusions)
        t.table.rows.push_back({cell(e.participant), cell(e.what), cell(e.why), cell(e.trials)});
    return t;
}

ResultTable observers(Analysis const& a)
{
    ResultTable t{
        "observers",
        "Observers",
        "T: circular triads (a over b over c over a) and their maximum; zeta: 1 is consistent. Outlier: "
        "interquartile ranges below the lower quartile of agreement with all others (pwcmp); near 1.5 and "
        "above should be inspected. Bias: exact test of first as often as second.",
        false,
        {}};
    t.table.columns = {name_column("participant", "Participant"),
                       {"used", "Whether the participant is analysed"},
                       {"complete", "Whether all sessions are complete"},
                       {"trials", "Trials that count"},
                       {"invalid", "Invalid trials without a valid repetition"},
                       {"repeated", "Trials that were repeated later"},
                       {"unanswered", "Trials without an answer"},
                       {"catch_right", "Catch trials answered correctly"},
                       {"catches", "Catch trials"},
                       {"chose_first", "Proportion of answers first (or left)"},
                       {"p_bias", "Probability of this or a more extreme proportion without bias"},
                       {"T", "Circular triads"},
                       {"T_most", "Largest possible number"},
                       {"zeta", "Consistency"},
                       {"outlier", "Largest outlier score over blocks"},
                       {"rt_median_ms", "Median reaction time", "ms"}};
    for (ObserverSummary const& o : a.observers) {
        double outlier = kUnknown;
        for (auto const& [block, score] : o.outlier_score) outlier = std::fmax(outlier, score);
        bool const has_pairs = o.most_triads > 0;
        t.table.rows.push_back({cell(o.participant), cell(!o.is_excluded), cell(o.is_complete), cell(o.counted),
                                cell(o.invalid), cell(o.superseded), cell(o.unanswered),
                                o.catches > 0 ? cell(o.catches_right) : cell(""), cell(o.catches),
                                o.choices > 0 ? cell(double(o.chose_first) / o.choices) : cell(""), cell(o.bias_p),
                                has_pairs ? cell(o.triads) : cell(""), has_pairs ? cell(o.most_triads) : cell(""),
                                cell(o.zeta), cell(outlier), cell(o.reaction_median_ms)});
    }
    return t;
}

ResultTable factors(Analysis const& a)
{
    ResultTable t{"factors",
                  "Factors within and between participants",
                  "As tests of effects take them. An id that is used for several people makes a factor one within "
                  "participants.",
                  false,
                  {}};
    t.table.columns = {
        name_column("factor", "Factor that varies"),
        {"taken_as", "within participants: each is compared with himself or herself; between: they are groups"},
        name_column("levels", "Its levels"),
        name_column("participants", "Participants with each of them, in this order"),
        {"with_several", "Participants with more than one"}};
    for (FactorUse const& f : a.factors)
        t.table.rows.push_back({cell(f.name), f.is_between ? "between participants" : "within participants",
                                cell(fmt::format("{}", fmt::join(f.levels, ", "))),
                                cell(fmt::format("{}", fmt::join(f.participants, ", "))), cell(f.with_several)});
    return t;
}

ResultTable scores(Analysis const& a)
{
    ResultTable t{
        "scores",
        "Scores",
        "JOD: 1 means that 75 % choose the better one (Thurstone, case V), mean 0, maximum likelihood; "
        "intervals by errors over observers, around scores without the bias of maximum likelihood; ties by "
        "their threshold. Ratings: means of observers' means, Student's interval (for ratings "
        "corrected for skewness). Render "
        "times: of the frames "
        "shown, interval over observers.",
        false,
        {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("group", "Trials that share this level"),
                       name_column("item", "Scored item"),
                       {"unit", "Unit of the score"},
                       {"score", "Score"}};
    add_interval(t.table.columns, "", a.settings.confidence);
    t.table.columns.push_back({"observers", "Observers"});
    t.table.columns.push_back({"render_ms", "Mean rendering time per frame", "ms"});
    add_interval(t.table.columns, "render_", a.settings.confidence);
    for (BlockResult const& b : a.blocks)
        for (ScaleResult const& s : b.scales)
            for (ScaledItem const& i : s.items) {
                std::vector<std::string> row{cell(b.name), cell(s.group), cell(i.name), cell(s.unit)};
                add(row, i.score, least_of(s));
                row.push_back(cell(i.score.n));
                add(row, i.render_ms);
                t.table.rows.push_back(std::move(row));
            }
    return t;
}

ResultTable cheapest(Analysis const& a)
{
    ResultTable t{
        "cheapest",
        "The cheapest item without significant difference from the reference",
        "Significance is by the p-value corrected for all pairs. No significant difference is no "
        "proof of equality: the interval shows how large the difference may be. If the reference was not "
        "judged, the best judged item replaces it.",
        false,
        {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("group", "Trials that share this level"),
                       name_column("item", "Cheapest"),
                       {"render_ms", "Mean rendering time per frame of the item", "ms"},
                       name_column("against", "Item that it is compared with"),
                       {"judged", "Whether that is the reference or the best judged item"},
                       {"against_ms", "Mean rendering time per frame of that item", "ms"},
                       {"unit", "Unit of the difference"},
                       {"difference", "Score of the item minus that of the other"}};
    add_interval(t.table.columns, "", a.settings.confidence);
    t.table.columns.push_back({"p_holm", "p-value of the difference, corrected (Holm)"});
    for (BlockResult const& b : a.blocks)
        for (ScaleResult const& s : b.scales)
            if (s.cheapest) {
                Cheapest const& c = *s.cheapest;
                ScaledItem const& item = s.items[std::size_t(c.item)];
                ScaledItem const& against = s.items[std::size_t(c.against)];
                std::vector<std::string> row{cell(b.name),
                                             cell(s.group),
                                             cell(item.name),
                                             cell(item.render_ms.value),
                                             cell(against.name),
                                             c.is_reference ? "reference" : "best of those judged",
                                             cell(against.render_ms.value),
                                             cell(s.unit)};
                add(row, c.difference, least_of(s));
                row.push_back(cell(c.p_holm));
                t.table.rows.push_back(std::move(row));
            }
    return t;
}

ResultTable differences(Analysis const& a)
{
    ResultTable t{
        "differences",
        "Differences between pairs of items",
        "p by Student's distribution on errors over observers; p_holm corrected for all pairs of the group.",
        true,
        {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("group", "Trials that share this level"),
                       name_column("a", "Item"),
                       name_column("b", "Other item"),
                       {"unit", "Unit"},
                       {"difference", "a minus b"}};
    add_interval(t.table.columns, "", a.settings.confidence);
    t.table.columns.push_back({"p", "p-value of the difference"});
    t.table.columns.push_back({"p_holm", "Corrected (Holm)"});
    for (BlockResult const& b : a.blocks)
        for (ScaleResult const& s : b.scales)
            for (ItemDifference const& d : s.differences) {
                std::vector<std::string> row{cell(b.name), cell(s.group), cell(s.items[std::size_t(d.a)].name),
                                             cell(s.items[std::size_t(d.b)].name), cell(s.unit)};
                add(row, d.value, least_of(s));
                row.push_back(cell(d.p));
                row.push_back(cell(d.p_holm));
                t.table.rows.push_back(std::move(row));
            }
    return t;
}

ResultTable fits(Analysis const& a)
{
    ResultTable t{"fits",
                  "Goodness of fit, order effect, tests over all items",
                  "A small p of a deviance means that one scale does not explain the choices.",
                  true,
                  {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("group", "Trials that share this level"),
                       {"number", "Which"},
                       {"value", "Value"}};
    for (BlockResult const& b : a.blocks)
        for (ScaleResult const& s : b.scales)
            for (NamedValue const& f : s.facts)
                t.table.rows.push_back({cell(b.name), cell(s.group), cell(f.name), full_cell(f.value)});
    return t;
}

/// Doubts about single runs, counted by cell, procedure and method.
std::vector<std::pair<std::string, std::string>> doubts_of_runs(BlockResult const& b)
{
    struct Count {
        int runs = 0;
        std::map<std::string, int> doubts{};
    };
    std::map<std::pair<std::string, std::string>, Count> counts;   // group, method
    std::map<std::pair<std::string, std::string>, int> parameters; // group, name and note
    for (ThresholdRun const& r : b.runs) {
        std::string const group = r.cell + ", " + r.procedure;
        for (ThresholdEstimate const& e : r.estimates) {
            Count& c = counts[{group, fmt::format("{} at {:.3g} %", e.method, 100 * e.proportion)}];
            ++c.runs;
            if (!e.doubt.empty()) ++c.doubts[e.doubt];
        }
        for (ParameterEstimate const& e : r.parameters)
            if (!e.note.empty()) ++parameters[{group, e.name + ": " + e.note}];
    }
    std::vector<std::pair<std::string, std::string>> found;
    for (auto const& [where, c] : counts)
        for (auto const& [doubt, n] : c.doubts)
            found.emplace_back(where.first, fmt::format("{} of {} runs, {}: {}", n, c.runs, where.second, doubt));
    for (auto const& [where, n] : parameters)
        found.emplace_back(where.first, fmt::format("{} runs, {}", n, where.second));
    return found;
}

ResultTable refusals(Analysis const& a)
{
    ResultTable t{"remarks", "Results that could not be computed, or only with regularisation", "", false, {}};
    t.table.columns = {name_column("block", "Block"), name_column("group", "Trials that share this level"),
                       name_column("remark", "Remark")};
    auto const say = [&](std::string const& block, std::string const& group, std::string const& text) {
        if (!text.empty()) t.table.rows.push_back({cell(block), cell(group), cell(text)});
    };
    for (BlockResult const& b : a.blocks) {
        for (ScaleResult const& s : b.scales) {
            say(b.name, s.group, s.refused);
            for (std::string const& note : s.notes) say(b.name, s.group, note);
        }
        for (AgreementResult const& g : b.agreement) say(b.name, g.cell, g.refused);
        for (CurveResult const& c : b.curves) {
            say(b.name, c.cell, c.refused);
            say(b.name, c.cell, c.note);
        }
        for (auto const& [group, text] : doubts_of_runs(b)) say(b.name, group, text);
        for (ThresholdSummary const& h : b.thresholds) say(b.name, h.cell + ", " + h.procedure, h.note);
        for (DetectionResult const& d : b.detections) say(b.name, d.condition, d.note);
        for (HierarchicalResult const& h : b.hierarchical) {
            say(b.name, h.condition, h.refused);
            if (!h.note.empty()) say(b.name, h.condition, "hierarchical " + h.parameter + ": " + h.note);
        }
    }
    for (EffectNote const& n : a.effect_notes) say(n.block, n.measure, n.text);
    return t;
}

} // namespace

std::vector<ResultTable> result_tables(Analysis const& a)
{
    std::vector<ResultTable> all{
        exclusions(a),  observers(a), factors(a),         scores(a),        cheapest(a),
        differences(a), fits(a),      hierarchy_table(a), effects_table(a), group_differences_table(a)};
    for (ResultTable& t : detail_tables(a)) all.push_back(std::move(t));
    all.push_back(refusals(a));
    std::erase_if(all, [](ResultTable const& t) { return t.table.rows.empty(); });
    return all;
}

} // namespace study
