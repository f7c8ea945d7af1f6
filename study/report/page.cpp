#include "study/report/page.h"

#include "gi/core/html/html.h"
#include "study/analysis/result_tables.h"
#include "study/analysis/shown.h"
#include "study/analysis/threshold_run.h"
#include "study/report/figures.h"
#include "study/stats/summary.h"
#include "study/tables/events.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// A table with its title and note; column descriptions are shown as hints.
std::string html_of(ResultTable const& t)
{
    std::vector<gi::HtmlColumn> columns;
    std::vector<std::vector<gi::HtmlCell>> rows;
    ShownTable const shown = shown_table(t.table);
    for (ShownTable::Head const& head : shown.columns) {
        std::string name = head.name;
        std::replace(name.begin(), name.end(), '_', ' ');
        columns.push_back({name, head.is_number, head.description});
    }
    for (auto const& row : shown.rows) {
        rows.emplace_back();
        for (std::string const& text : row) {
            rows.back().push_back(text);
            if (text.size() > 30)
                rows.back().back().css = "min-width: 14rem"; // where the table is wider than the page
        }
    }
    return gi::html_part(t.title, (t.note.empty() ? "" : gi::html_note(gi::escaped(t.note))) +
                                      gi::html_table(columns, rows));
}

Block const* block_of(Script const& s, std::string const& name)
{
    for (Block const& b : s.blocks)
        if (b.name == name) return &b;
    return nullptr;
}

/// True scores of the items, with mean 0 like the estimates; empty if unknown.
std::vector<double> true_scores(Script const& s, Block const& b, ScaleResult const& scale,
                                ReportFacts const& facts)
{
    int const factor = compared_factor(b);
    if (!facts.truth || scale.unit != "JOD" || factor < 0) return {};
    auto const levels = facts.truth->quality_jod.find(s.factors[std::size_t(factor)].name);
    if (levels == facts.truth->quality_jod.end()) return {};
    std::vector<double> out;
    double sum = 0;
    for (ScaledItem const& item : scale.items) {
        auto const it = levels->second.find(item.name);
        if (it == levels->second.end()) return {};
        out.push_back(it->second);
        sum += it->second;
    }
    for (double& v : out) v -= sum / double(out.size());
    return out;
}

double true_threshold(Block const& b, ReportFacts const& facts, double share)
{
    if (!facts.truth || !b.compare) return kUnknown;
    return true_level(*facts.truth, b.compare->vary, b.compare->harder_up, guess_rate(b.task), share);
}

std::string figures(std::string const& html) { return html.empty() ? "" : gi::html_group("figures", html); }

/// Figures with their heading; empty without figures.
std::string part(std::string const& heading, std::string const& note, std::string const& html)
{
    if (html.empty()) return {};
    return gi::html_part(heading, (note.empty() ? "" : gi::html_note(note)) + figures(html));
}

/// Range from the lowest to the highest score of all groups.
Interval shared_range(Script const& s, Block const& b, BlockResult const& r, ReportFacts const& facts)
{
    Interval range{1e300, -1e300};
    auto const hold = [&](double v) {
        if (!std::isfinite(v)) return;
        range.low = std::min(range.low, v);
        range.high = std::max(range.high, v);
    };
    for (ScaleResult const& scale : r.scales) {
        for (double const v : true_scores(s, b, scale, facts)) hold(v);
        for (ScaledItem const& i : scale.items)
            for (double const v : {i.score.value, i.score.interval.low, i.score.interval.high}) hold(v);
    }
    return range;
}

std::string cheapest_table(Analysis const& a, std::string const& block)
{
    for (ResultTable t : result_tables(a))
        if (t.name == "cheapest") {
            std::erase_if(t.table.rows, [&](auto const& row) { return row[0] != block; });
            for (auto& row : t.table.rows) row.erase(row.begin());
            t.table.columns.erase(t.table.columns.begin());
            return t.table.rows.empty() ? "" : html_of(t);
        }
    return {};
}

std::string scales_html(Script const& s, Block const& b, BlockResult const& r, Analysis const& a,
                        ReportFacts const& facts)
{
    std::string scales, costs, wins, spreads;
    double const level = 1 - a.settings.confidence;
    bool has_truth = false;
    Interval const shared = shared_range(s, b, r, facts);
    for (ScaleResult const& scale : r.scales) {
        auto const truth = true_scores(s, b, scale, facts);
        has_truth = has_truth || !truth.empty();
        scales += scale_figure(scale, truth, shared, scale.group);
        costs += cost_figure(scale, scale.group);
        wins += wins_table(scale, level);
        spreads += spread_figure(scale, b.scale, scale.group);
    }
    std::string note;
    if (r.task == "pair" || r.task == "pair_with_reference")
        note = "1 JOD: 75 % choose the better one (Thurstone, case V; mean 0). Intervals by errors over "
               "observers. ";
    note += "Grey bars at the right join items that do not differ significantly.";
    if (has_truth) note += " Diamonds: true values of the simulated observers.";
    std::string html =
        part("Scores", note, scales) +
        part("Distribution of answers",
             "Proportions of the answers (bars), mean and interval over observers (dots).", spreads);
    if (!costs.empty())
        html += part("Perceived quality against rendering time",
                     "Square: the item compared with. Ring: the cheapest item that does not differ significantly "
                     "from it.",
                     costs) +
                cheapest_table(a, r.name);
    return html + part("Pairs",
                       "Per cent of times that the row was chosen over the column; * differs significantly "
                       "(corrected).",
                       wins);
}

std::string thresholds_html(Block const& b, BlockResult const& r, ReportFacts const& facts)
{
    std::string html, curves;
    html += part("Detection", "", detections_figure(r.detections, guess_rate(b.task), r.name));
    std::string const setting = b.compare ? b.compare->vary : "level";
    for (CurveResult const& c : r.curves)
        curves += curve_figure(c, r, setting, true_threshold(b, facts, c.proportion));
    html += part("Psychometric functions",
                 "Trials of all observers and procedures pooled, with Wilson's intervals; larger dots mean more "
                 "trials. Shaded: interval of the threshold." +
                     std::string(facts.truth ? " Diamond: true value of the simulated observers." : ""),
                 curves);
    std::map<std::string, std::vector<ThresholdSummary>> cells;
    for (ThresholdSummary const& t : r.thresholds) cells[t.cell].push_back(t);
    std::string drawn;
    for (auto const& [cell, list] : cells) {
        std::vector<double> truth;
        for (ThresholdSummary const& t : list) truth.push_back(true_threshold(b, facts, t.proportion));
        drawn += thresholds_figure(list, r, truth, cell);
    }
    html += part("Thresholds by method", "", drawn);
    std::map<std::string, std::vector<ThresholdRun>> runs;
    for (ThresholdRun const& run : r.runs)
        for (Procedure const& p : b.procedures)
            if (p.name == run.procedure && is_adaptive(p)) runs[run.procedure + ", " + run.cell].push_back(run);
    std::string tracks;
    for (auto const& [name, list] : runs) {
        double const share = list.front().estimates.empty() ? kUnknown : list.front().estimates.front().proportion;
        tracks += tracks_figure(list, r, name, true_threshold(b, facts, share));
    }
    if (!tracks.empty()) html += gi::html_part("Runs", tracks);
    return html;
}

std::string block_html(Script const& s, BlockResult const& r, Analysis const& a, ReportFacts const& facts)
{
    Block const* const b = block_of(s, r.name);
    if (b == nullptr) return {};
    std::string html;
    if (!r.prompt.empty()) html += gi::html_paragraph("“" + r.prompt + "”", "prompt");
    for (ScaleResult const& scale : r.scales)
        if (!scale.refused.empty()) html += gi::html_paragraph(scale.group + ": no scale: " + scale.refused);
    if (!r.scales.empty()) html += scales_html(s, *b, r, a, facts);
    return gi::html_section(r.name + " (" + r.task + ")", html + thresholds_html(*b, r, facts));
}

/// Exclusions by reason; lists the participants if they are few.
std::string exclusions_html(Analysis const& a)
{
    std::map<std::pair<std::string, std::string>, std::vector<Exclusion const*>> reasons;
    for (Exclusion const& e : a.exclusions) reasons[{e.what, e.why}].push_back(&e);
    ResultTable t{"exclusions", "Excluded, or to be inspected", "", false, {}};
    t.table.columns = {{"what", "left out, kept, or look at"},
                       {"why", "Reason"},
                       {"trials", "Trials concerned"},
                       {"participants", "Number of participants concerned"},
                       {"who", "Participants"}};
    for (auto const& [key, list] : reasons) {
        int trials = 0;
        std::string who;
        for (std::size_t i = 0; i < list.size(); ++i) {
            trials += list[i]->trials;
            if (i < 6) who += (i ? ", " : "") + list[i]->participant;
        }
        if (list.size() > 6) who += ", ...";
        t.table.rows.push_back(
            {cell(key.first), cell(key.second), cell(trials), cell(int(list.size())), cell(who)});
    }
    return t.table.rows.empty() ? "" : html_of(t);
}

std::string timing_html(Analysis const& a, ReportFacts const& facts)
{
    std::string html = histogram(facts.frame_interval_ms, "ms", "Intervals between frames");
    html += histogram(a.timing.frame_ms, "ms", "Rendering time per frame, means of stimuli");
    html += histogram(a.timing.uncertainty_ms, "ms", "Uncertainty of onsets");
    for (ReactionResult const& r : a.timing.reactions) html += histogram(r.ms, "ms", "Reaction times, " + r.block);
    return figures(html);
}

/// Gaze by participant, if it was recorded: of all trials, while stimuli were visible.
std::string gaze_html(std::span<RecordedSession const> sessions)
{
    struct Counts {
        int trials = 0, samples = 0, valid = 0, dropped = 0, fixating = 0, left = 0, never = 0;
        bool has_rule = false;
    };
    std::map<std::string, Counts> people;
    for (RecordedSession const& session : sessions)
        for (JournalEntry const& entry : session.record.entries) {
            auto const* const t = std::get_if<TrialDone>(&entry);
            if (t == nullptr || !t->gaze_samples) continue;
            Counts& c = people[session.plan.participant_id];
            ++c.trials;
            c.samples += *t->gaze_samples;
            c.valid += t->gaze_valid.value_or(0);
            c.dropped += t->gaze_dropped.value_or(0);
            c.fixating += t->gaze_fixating.value_or(0);
            c.has_rule = c.has_rule || t->gaze_fixating;
            c.left += t->reason == "gaze_left";
            c.never += t->reason == "no_fixation";
        }
    if (people.empty()) return {};
    ResultTable t{"gaze", "Gaze", "While stimuli were visible.", false, {}};
    t.table.columns = {{"participant", "Participant"},
                       {"trials", "Trials with gaze"},
                       {"samples", "Samples"},
                       {"valid", "Share in which the eyes were found"},
                       {"missing", "Samples missing between others"},
                       {"fixating", "Share of the valid samples near the place of fixation"},
                       {"left", "Trials that ended because gaze left"},
                       {"no_fixation", "Trials that did not begin without a fixation"}};
    for (auto const& [id, c] : people)
        t.table.rows.push_back({cell(id), cell(c.trials), cell(c.samples),
                                c.samples > 0 ? cell(double(c.valid) / c.samples) : cell(""), cell(c.dropped),
                                c.has_rule && c.valid > 0 ? cell(double(c.fixating) / c.valid) : cell(""),
                                cell(c.left), cell(c.never)});
    return html_of(t);
}

/// Sounds of cues, if the script has some: how exactly they came.
std::string sounds_html(Script const& script, std::span<RecordedSession const> sessions)
{
    struct Counts {
        std::vector<double> error_ms;
        std::map<std::string, int> missing;
        int due = 0, underruns = 0;
    };
    std::map<std::string, Counts> by_sound;
    for (RecordedSession const& session : sessions)
        for (JournalEntry const& entry : session.record.entries)
            if (auto const* const t = std::get_if<TrialDone>(&entry))
                for (SoundPlayed const& s : t->sounds) {
                    Counts& c = by_sound[s.sound];
                    ++c.due;
                    c.underruns += s.underruns;
                    if (auto const error = error_ms(s)) c.error_ms.push_back(*error);
                    if (!s.missing.empty()) ++c.missing[s.missing];
                }
    if (by_sound.empty()) return {};
    ResultTable t{
        "sounds",
        "Sounds",
        "Error: how much later the device says that a sound began than the script wants, from the onset of "
        "its stimulus or fixation. The device's own latency is measured by a recording (study photodiode "
        "--sounds).",
        false,
        {}};
    t.table.columns = {{"sound", "Name in the script"},
                       {"due", "Times that it was due"},
                       {"played", "Times that it was played"},
                       {"mean_error", "Mean error, ms"},
                       {"sd", "Standard deviation of errors, ms"},
                       {"least", "Least error, ms"},
                       {"most", "Largest error, ms"},
                       {"underruns", "Times that the device ran out of samples"},
                       {"not_played", "Why, with counts"}};
    for (Sound const& sound : script.sounds) {
        Counts const& c = by_sound[sound.name];
        std::string missing;
        for (auto const& [why, n] : c.missing)
            missing += fmt::format("{}{} ({})", missing.empty() ? "" : ", ", why, n);
        bool const any = !c.error_ms.empty();
        auto const [least, most] = std::minmax_element(c.error_ms.begin(), c.error_ms.end());
        auto const ms = [](double v) { return fmt::format("{:.2f}", v); };
        double const mean = any ? study::mean(c.error_ms) : 0;
        t.table.rows.push_back(
            {cell(sound.name), cell(c.due), cell(int(c.error_ms.size())), any ? ms(mean) : cell(""),
             c.error_ms.size() > 1 ? ms(standard_deviation(c.error_ms)) : cell(""), any ? ms(*least) : cell(""),
             any ? ms(*most) : cell(""), cell(c.underruns), cell(missing)});
    }
    return html_of(t);
}

/// Answers that participants typed, by item; empty if no item asks for a text.
std::string texts_html(Script const& script, std::span<RecordedSession const> sessions)
{
    std::map<std::pair<Questionnaire const*, std::size_t>, std::vector<std::vector<gi::HtmlCell>>> answers;
    for (RecordedSession const& session : sessions)
        for (AnsweredQuestionnaire const& a : answered_questionnaires(script, session))
            for (std::size_t i = 0; i < a.done->texts.size(); ++i)
                if (!a.done->texts[i].empty())
                    answers[{a.questionnaire, i}].push_back(
                        {session.plan.participant_id, a.condition(script), std::to_string(a.time_point),
                         gi::HtmlCell::of(gi::escaped_lines(a.done->texts[i]),
                                          "min-width: 14rem; white-space: pre-wrap; overflow-wrap: anywhere")});
    std::string html;
    for (auto& [item, rows] : answers) {
        std::vector<gi::HtmlColumn> columns{{"participant", false, ""},
                                            {"condition", false, "Levels of the factors that were fixed then"},
                                            {"time", true, "Number of the occasion in the session"},
                                            {"answer", false, ""}};
        bool const has_conditions =
            std::any_of(rows.begin(), rows.end(), [](auto const& row) { return !row[1].html.empty(); });
        if (!has_conditions) {
            columns.erase(columns.begin() + 1);
            for (auto& row : rows) row.erase(row.begin() + 1);
        }
        html += gi::html_part(item.first->name + ": " + item.first->items[item.second].text,
                              gi::html_table(columns, rows));
    }
    return html.empty() ? "" : gi::html_section("Answers in words", html);
}

std::string provenance(std::span<RecordedSession const> sessions, ReportFacts const& facts)
{
    std::map<std::string, std::map<std::string, int>> values;
    for (RecordedSession const& session : sessions)
        for (JournalEntry const& entry : session.record.entries)
            if (auto const* s = std::get_if<SessionStarted>(&entry)) {
                ++values["recorded with"][s->version + (s->git_hash.empty() ? "" : " (git " + s->git_hash + ")")];
                ++values["script"]["sha256 " + s->script_sha256.substr(0, 16)];
                ++values["date"][s->utc.substr(0, 10)];
                for (auto const& [key, value] : s->about) ++values[key][value];
            }
    std::vector<std::pair<std::string, std::string>> entries{{"report by", facts.program}};
    for (auto const& [key, list] : values) {
        std::string text;
        std::size_t shown = 0;
        for (auto const& [value, n] : list) {
            if (++shown > 5) break;
            text += (shown > 1 ? "; " : "") + value;
        }
        if (list.size() > 5) text += fmt::format("; and {} more", list.size() - 5);
        entries.emplace_back(key, text);
    }
    return gi::html_section("Provenance", gi::html_definitions(entries));
}

} // namespace

std::string report_page(Script const& script, std::span<RecordedSession const> sessions, Analysis const& a,
                        ReportFacts const& facts)
{
    std::string html = findings(a);
    for (BlockResult const& b : a.blocks) html += block_html(script, b, a, facts);

    auto const tables = result_tables(a);
    auto const shown = [&](std::initializer_list<std::string_view> names) {
        std::string found;
        for (std::string_view const name : names)
            for (ResultTable const& t : tables)
                if (t.name == name && !t.is_long) found += html_of(t);
        return found;
    };
    html += gi::html_section(
        "Observers", (a.exclusions.empty() ? gi::html_paragraph("Nothing except practice was excluded.") : "") +
                         exclusions_html(a) + shown({"observers", "factors", "agreement"}));
    html += gi::html_section("Timing", timing_html(a, facts) + shown({"timing", "reactions", "calibrations"}) +
                                           sounds_html(script, sessions) + gaze_html(sessions));
    std::string looks;
    for (ResultTable const& t : facts.gaze)
        if (!t.is_long) looks += html_of(t);
    if (!looks.empty()) html += gi::html_section("What people looked at", looks);
    std::string orders;
    for (TransitionResult const& t : a.transitions) orders += transitions_table(t);
    html += gi::html_section("Order", gi::html_note("How trials followed each other, summed over participants: "
                                                    "from the row to the column.") +
                                          figures(orders));
    html += gi::html_section("Numbers", shown({"scores", "hierarchical_scores", "effects", "group_differences",
                                               "thresholds", "parameters", "curves", "detection", "population",
                                               "questionnaires", "changes", "remarks"}));
    html += texts_html(script, sessions);
    std::string const about = gi::html_paragraph(
        fmt::format("Experiment {}: {} of {} participants, {} sessions, {} complete. Intervals of {:.0f} %, "
                    "{} replicates of bootstraps.",
                    a.experiment, a.participants, a.planned, a.sessions, a.complete, 100 * a.settings.confidence,
                    a.settings.replicates),
        "about");
    return gi::html_page(a.title, html + provenance(sessions, facts), about + gi::html_cautions(a.cautions));
}

} // namespace study
