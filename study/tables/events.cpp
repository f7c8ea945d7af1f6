#include "study/tables/events.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace study {
namespace {

/// Summary of a trial's stimuli for one row.
struct ShownTogether {
    double onset_s = NAN, end_s = NAN, uncertainty_ms = NAN, render_ms_mean = NAN, render_ms_p99 = NAN;
    std::string methods, settings;
    int planned = 0, shown = 0, dropped = 0;
};

void add_once(std::string& list, std::string const& item)
{
    if (item.empty() || ("," + list + ",").find("," + item + ",") != std::string::npos) return;
    list += (list.empty() ? "" : ",") + item;
}

ShownTogether together(TrialDone const& done)
{
    ShownTogether t;
    double sum = 0;
    int frames = 0;
    for (StimulusShown const& s : done.shown) {
        t.onset_s = std::fmin(t.onset_s, s.onset_s);
        t.end_s = std::fmax(t.end_s, s.onset_s + s.duration_s);
        t.uncertainty_ms = std::fmax(t.uncertainty_ms, s.onset_uncertainty_ms);
        t.render_ms_p99 = std::fmax(t.render_ms_p99, s.render_ms_p99);
        add_once(t.methods, s.onset_method);
        add_once(t.settings, s.settings_sha256);
        t.planned += s.frames_planned;
        t.shown += s.frames_shown;
        t.dropped += s.frames_dropped;
        int const weight = std::max(1, s.frames_shown);
        sum += weight * s.render_ms_mean;
        frames += weight;
    }
    if (frames > 0) t.render_ms_mean = sum / frames;
    return t;
}

/// HED 8.3.0 refers to other columns as {name}; names with other characters have no tags.
bool is_hed_column(std::string const& name) { return hed_name(name) == name; }

std::string hed_references(std::vector<std::string> const& columns)
{
    std::string list;
    for (std::string const& name : columns)
        if (is_hed_column(name)) list += ", {" + name + "}";
    return list;
}

/// A trial shows something, then somebody answers. Each row is one group that holds the numbers of its trial,
/// because validators take rows of one onset (or of none) together, where no tag may be there twice.
std::vector<std::pair<std::string, std::string>> hed_of_phases(Script const& script)
{
    std::string const more = hed_references({"trial", "pass", "attempt"}) +
                             hed_references(factor_columns(script)) + hed_references({"correct"}) + ")";
    std::vector<std::pair<std::string, std::string>> tags;
    for (char const* phase : {"practice", "main", "catch", "repeat"})
        tags.emplace_back(phase, "(Sensory-event, Visual-presentation, Experimental-stimulus, Label/" +
                                     std::string(phase) + more);
    return tags;
}

/// HED of a column of numbers.
std::string hed_number(std::string const& name) { return "(Parameter-label/" + name + ", Parameter-value/#)"; }

std::vector<std::pair<std::string, std::string>> hed_of_levels(Factor const& factor, std::string const& column)
{
    std::vector<std::pair<std::string, std::string>> tags;
    if (!is_hed_column(column)) return tags;
    for (FactorLevel const& level : factor.levels)
        tags.emplace_back(level.name, fmt::format("(Condition-variable/{}, Label/{})", hed_name(factor.name),
                                                  hed_name(level.name)));
    return tags;
}

std::vector<std::pair<std::string, std::string>> const kPhases{
    {"practice", "before the main trials, not analysed"},
    {"main", "a trial of the experiment"},
    {"catch", "its answer is obvious: tests attention"},
    {"repeat", "a repeated main or catch trial, because the previous attempt was invalid"}};
std::vector<std::pair<std::string, std::string>> const kOnsetMethods{
    {"oml", "GLX_OML_sync_control: the display's own time stamp"},
    {"wp_presentation", "Wayland presentation time"},
    {"openxr_predicted", "predicted by the headset's runtime, not measured"},
    {"swap_finish", "after the swap and glFinish, by the monotonic clock"},
    {"simulated", "no display"}};

std::vector<Column> event_columns(Script const& s)
{
    std::vector<Column> columns{
        {"onset", "Onset of the trial's first stimulus, since the beginning of the session", "s"},
        {"duration", "From the first onset to the end of the last stimulus", "s"},
        {"response_time", "From the onset of the last stimulus to the answer", "s"},
        {"trial", "Number of the trial in its pass of the block, from 1", "", {}, "Experimental-trial/#"},
        {"block", "Block of the script"},
        {"pass", "Number of the pass of the block, from 1", "", {}, hed_number("pass")},
        {"part", "Part of the session, from 1; each resumption adds one"},
        {"phase", "Kind of trial", "", kPhases, "", hed_of_phases(s)},
        {"attempt", "Number of the attempt at the trial, from 1", "", {}, hed_number("attempt")},
        {"repeat", "Repeat of the condition, from 1; number of the run for adaptive procedures"}};
    auto const names = factor_columns(s);
    for (std::size_t f = 0; f < s.factors.size(); ++f)
        columns.push_back({names[f],
                           fmt::format("Level of the factor {}; n/a if stimuli differ in it", s.factors[f].name),
                           "",
                           {},
                           "",
                           hed_of_levels(s.factors[f], names[f])});
    std::vector<Column> const more{
        {"cond_a", "Stimulus a"},
        {"cond_b", "Stimulus b"},
        {"cond_more", "Further stimuli, separated by commas"},
        {"reference", "The reference, if it was also shown"},
        {"order", "Letters of the stimuli in order of presentation"},
        {"level", "Level of the varied setting"},
        {"procedure", "Procedure that chose the level"},
        {"selected", "What else was selected when the trial came: the pair, or levels of further settings"},
        {"response", "Answer; for rankings the letters of the stimuli, best first"},
        {"value", "Numeric answer: rating, magnitude, adjusted level"},
        {"answer", "The correct answer"},
        {"correct",
         "Whether the answer was correct",
         "",
         {},
         "",
         {{"true", "(Agent-action, Participant-response, Correct-action)"},
          {"false", "(Agent-action, Participant-response, Incorrect-action)"}}},
        {"device", "Input that gave the answer"},
        {"response_uncertainty_ms", "Uncertainty (plus or minus) of response_time, onset included", "ms"},
        {"onset_method", "How onsets were timed", "", kOnsetMethods},
        {"onset_uncertainty_ms", "Uncertainty (plus or minus) of onsets, as far as software can measure it", "ms"},
        {"frames_planned", "Frames of all stimuli that should have been shown"},
        {"frames_shown", "Frames that were shown"},
        {"frames_dropped", "Frames that came too late"},
        {"render_ms_mean", "Mean rendering time per frame", "ms"},
        {"render_ms_p99", "99th percentile of the rendering time, of the slowest stimulus", "ms"},
        {"settings_sha256", "Hashes of the stimuli's renderer settings, separated by commas"},
        {"bookkeeping_ms", "Time between the trials for journal and choice of the next step", "ms"},
        {"valid", "Whether the trial was valid"},
        {"reason", "Why not"},
        {"analysis", "Whether it counts in analyses, and why not"}};
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
}

std::string phase_of(TrialRow const& row)
{
    if (row.done->attempt > 1) return "repeat";
    return std::string(name_of(row.step->trial.phase));
}

void add_factors(std::vector<std::string>& cells, Script const& s, TrialRow const& row)
{
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        int const level = shared_level(*row.block, row.step->trial, int(f));
        cells.push_back(level < 0 ? cell("") : cell(s.factors[f].levels[std::size_t(level)].name));
    }
}

std::vector<std::string> event_cells(Script const& s, TrialRow const& row)
{
    Trial const& trial = row.step->trial;
    TrialDone const& done = *row.done;
    ShownTogether const t = together(done);
    std::vector<std::string> cells{seconds_cell(t.onset_s + row.offset_s),
                                   seconds_cell(t.end_s - t.onset_s),
                                   done.reaction_ms ? seconds_cell(*done.reaction_ms * 1e-3) : cell(""),
                                   cell(row.step->number),
                                   cell(row.block->name),
                                   cell(row.step->pass + 1),
                                   cell(row.part),
                                   phase_of(row),
                                   cell(done.attempt),
                                   cell(trial.repeat)};
    add_factors(cells, s, row);
    auto const label = [&](std::size_t i) {
        return i < trial.stimuli.size() ? cell(stimulus_label(s, *row.block, trial.stimuli[i])) : cell("");
    };
    std::string more;
    for (std::size_t i = 2; i < trial.stimuli.size(); ++i) more += (more.empty() ? "" : ",") + label(i);
    std::string const procedure =
        trial.procedure >= 0 ? row.block->procedures[std::size_t(trial.procedure)].name : "";
    std::vector<std::string> const rest{
        label(0),
        label(1),
        cell(more),
        trial.reference ? cell(stimulus_label(s, *row.block, *trial.reference)) : cell(""),
        cell(trial.order),
        cell(done.level),
        cell(procedure),
        cell(done.chosen),
        cell(done.response),
        cell(done.value),
        cell(trial.answer),
        cell(done.is_correct),
        cell(done.device),
        done.reaction_ms ? cell(done.response_uncertainty_ms) : cell(""),
        cell(t.methods),
        cell(t.uncertainty_ms),
        cell(t.planned),
        cell(t.shown),
        cell(t.dropped),
        cell(t.render_ms_mean),
        cell(t.render_ms_p99),
        cell(t.settings),
        cell(done.bookkeeping_ms),
        cell(done.is_valid),
        cell(done.reason),
        row.is_kept_though_invalid ? "counted though invalid" : std::string(name_of(row.status))};
    cells.insert(cells.end(), rest.begin(), rest.end());
    return cells;
}

std::vector<Column> gaze_columns()
{
    return {{"gaze_samples", "Samples of gaze while stimuli were visible"},
            {"gaze_valid", "Those in which the eyes were found"},
            {"gaze_dropped", "Samples missing between others, by the median step"},
            {"gaze_fixating", "Valid samples near the place of fixation, as the block demands"}};
}

std::vector<Column> physical_columns()
{
    return {{"width_deg", "Width of the picture, as seen around its centre", "deg"},
            {"height_deg", "Height of the picture", "deg"},
            {"mean_cd_m2", "Mean luminance of its first picture on the display", "cd/m2"},
            {"peak_cd_m2", "Luminance of its brightest pixel", "cd/m2"},
            {"clipped_pixels", "Pixels with a channel beyond the display's peak, or below its black but not 0"}};
}

std::vector<std::pair<std::string, std::string>> const kFrames{
    {"exact", "finished pictures alone"},
    {"shown", "between finished pictures, surfaces drawn for the newest pose with the light of earlier ones"}};

std::vector<Column> light_columns()
{
    return {{"frames_kind", "Frames that could be shown", "", kFrames},
            {"frames_drawn", "Frames whose surfaces were drawn for a newer pose than that of their light"},
            {"light_age_ms", "At the onset, since the pose for which the light of the first frame was rendered",
             "ms"}};
}

} // namespace

std::vector<std::string> factor_columns(Script const& script)
{
    static std::set<std::string> const taken{"onset",
                                             "duration",
                                             "response_time",
                                             "trial",
                                             "block",
                                             "pass",
                                             "part",
                                             "phase",
                                             "attempt",
                                             "repeat",
                                             "cond_a",
                                             "cond_b",
                                             "cond_more",
                                             "reference",
                                             "order",
                                             "level",
                                             "procedure",
                                             "selected",
                                             "response",
                                             "value",
                                             "answer",
                                             "correct",
                                             "device",
                                             "analysis",
                                             "onset_method",
                                             "valid",
                                             "reason",
                                             "frames_shown",
                                             "frames_planned",
                                             "frames_dropped",
                                             "render_ms_mean",
                                             "render_ms_p99",
                                             "settings_sha256",
                                             "sound",
                                             "at",
                                             "event_onset",
                                             "offset_ms",
                                             "error_ms",
                                             "underruns",
                                             "missing",
                                             "bookkeeping_ms",
                                             "response_uncertainty_ms",
                                             "onset_uncertainty_ms",
                                             "stimulus",
                                             "place",
                                             "questionnaire",
                                             "time_point",
                                             "kind",
                                             "item",
                                             "text",
                                             "raw",
                                             "reversed",
                                             "scored",
                                             "participant",
                                             "participant_id",
                                             "session",
                                             "number",
                                             "task",
                                             "trial_type",
                                             "hed",
                                             "HED",
                                             "start",
                                             "time_taken",
                                             "sample",
                                             "channel",
                                             "stim_file",
                                             "gaze_samples",
                                             "gaze_valid",
                                             "gaze_dropped",
                                             "gaze_fixating",
                                             "width_deg",
                                             "height_deg",
                                             "mean_cd_m2",
                                             "peak_cd_m2",
                                             "clipped_pixels",
                                             "frames_kind",
                                             "frames_drawn",
                                             "light_age_ms"};
    std::vector<std::string> names;
    for (Factor const& f : script.factors) names.push_back(taken.count(f.name) ? "factor_" + f.name : f.name);
    return names;
}

Table events_table(Script const& script, std::vector<TrialRow> const& rows, int block)
{
    Table table{event_columns(script)};
    bool const has_gaze = std::any_of(rows.begin(), rows.end(), [&](TrialRow const& row) {
        return row.step->block == block && row.done->gaze_samples;
    });
    if (has_gaze)
        for (Column const& column : gaze_columns()) table.columns.push_back(column);
    for (TrialRow const& row : rows) {
        if (row.step->block != block) continue;
        table.rows.push_back(event_cells(script, row));
        if (!has_gaze) continue;
        TrialDone const& t = *row.done;
        for (auto const& count : {t.gaze_samples, t.gaze_valid, t.gaze_dropped, t.gaze_fixating})
            table.rows.back().push_back(count ? cell(*count) : cell(""));
    }
    return table;
}

Table stimuli_table(Script const& script, std::vector<TrialRow> const& rows, int block)
{
    auto const names = factor_columns(script);
    Table table{{{"onset", "Onset of the stimulus, since the beginning of the session", "s"},
                 {"duration", "How long it was shown", "s"},
                 {"trial", "Number of the trial in its pass of the block, from 1", "", {}, "Experimental-trial/#"},
                 {"pass", "Number of the pass of the block, from 1"},
                 {"attempt", "Number of the attempt at the trial, from 1"},
                 {"place", "Place in the order of presentation, from 1", "", {}, hed_number("place")},
                 {"stimulus",
                  "Letter of the stimulus; r is the reference",
                  "",
                  {},
                  "(Sensory-event, Visual-presentation, Experimental-stimulus, Label/#" +
                      hed_references({"trial", "place"}) + hed_references(names) + ")"}}};
    for (std::size_t f = 0; f < names.size(); ++f)
        table.columns.push_back(
            {names[f], "Level of the factor", "", {}, "", hed_of_levels(script.factors[f], names[f])});
    auto const any_shown = [&](auto const& has) {
        return std::any_of(rows.begin(), rows.end(), [&](TrialRow const& row) {
            return row.step->block == block && std::ranges::any_of(row.done->shown, has);
        });
    };
    bool const is_physical = any_shown([](StimulusShown const&s) { return s.clipped_pixels || s.width_deg; }),
               has_light = any_shown([](StimulusShown const&s) { return !s.frames_kind.empty(); });
    std::vector<Column> const more{{"level", "Level of the varied setting, for the varied stimulus"},
                                   {"onset_method", "How the onset was timed", "", kOnsetMethods},
                                   {"onset_uncertainty_ms", "Uncertainty (plus or minus) of the onset", "ms"},
                                   {"frames_planned", "Frames that should have been shown"},
                                   {"frames_shown", "Frames that were shown"},
                                   {"frames_dropped", "Frames that came too late"},
                                   {"render_ms_mean", "Mean rendering time per frame", "ms"},
                                   {"render_ms_p99", "99th percentile of the rendering time", "ms"},
                                   {"settings_sha256", "Hash of the renderer's settings"}};
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    if (is_physical)
        for (Column const& column : physical_columns()) table.columns.push_back(column);
    if (has_light)
        for (Column const& column : light_columns()) table.columns.push_back(column);
    for (TrialRow const& row : rows) {
        if (row.step->block != block) continue;
        int place = 0;
        for (StimulusShown const& s : row.done->shown) {
            std::vector<std::string> cells{seconds_cell(s.onset_s + row.offset_s),
                                           seconds_cell(s.duration_s),
                                           cell(row.step->number),
                                           cell(row.step->pass + 1),
                                           cell(row.done->attempt),
                                           cell(++place),
                                           std::string(1, s.letter)};
            Stimulus const* const stimulus = stimulus_of(row.step->trial, s.letter);
            for (std::size_t f = 0; f < script.factors.size(); ++f)
                cells.push_back(stimulus ? cell(script.factors[f].levels[std::size_t(stimulus->levels[f])].name)
                                         : cell(""));
            bool const is_varied = stimulus != nullptr && stimulus->is_varied;
            std::vector<std::string> const rest{is_varied ? cell(row.done->level) : cell(""),
                                                cell(s.onset_method),
                                                cell(s.onset_uncertainty_ms),
                                                cell(s.frames_planned),
                                                cell(s.frames_shown),
                                                cell(s.frames_dropped),
                                                cell(s.render_ms_mean),
                                                cell(s.render_ms_p99),
                                                cell(s.settings_sha256)};
            cells.insert(cells.end(), rest.begin(), rest.end());
            if (is_physical) {
                for (auto const& v : {s.width_deg, s.height_deg, s.mean_cd_m2, s.peak_cd_m2})
                    cells.push_back(cell(v));
                cells.push_back(s.clipped_pixels ? cell(*s.clipped_pixels) : cell(""));
            }
            if (has_light) {
                cells.push_back(s.frames_kind.empty() ? "exact" : cell(s.frames_kind));
                cells.push_back(s.frames_drawn ? cell(*s.frames_drawn) : cell(""));
                cells.push_back(cell(s.light_age_ms));
            }
            table.rows.push_back(std::move(cells));
        }
    }
    return table;
}

Table sounds_table(Script const& script, std::vector<TrialRow> const& rows, int block)
{
    std::vector<std::pair<std::string, std::string>> tags;
    for (Sound const& s : script.sounds)
        tags.emplace_back(s.name,
                          fmt::format("(Sensory-event, Auditory-presentation, Cue, Label/{}{})", hed_name(s.name),
                                      hed_references({"trial", "pass", "attempt", "event_onset"})));
    Table table{
        {{"onset", "When the first sample left, as the sound device says; since the beginning of the session",
          "s"},
         {"duration", "Duration of the sound", "s"},
         {"trial", "Number of the trial in its pass of the block, from 1", "", {}, "Experimental-trial/#"},
         {"pass", "Number of the pass of the block, from 1", "", {}, hed_number("pass")},
         {"attempt", "Number of the attempt at the trial, from 1", "", {}, hed_number("attempt")},
         {"sound", "Its name in the script", "", {}, "", tags},
         {"at", "What it was due with: the fixation, or stimuli by their letters"},
         {"event_onset", "Onset of that, since the beginning of the session", "s", {}, hed_number("event-onset")},
         {"offset_ms", "Wanted time from event_onset to the sound", "ms"},
         {"error_ms", "How much later it came than wanted", "ms"},
         {"underruns", "Times that the device ran out of samples while it played"},
         {"missing", "Why it was not played"}}};
    for (TrialRow const& row : rows) {
        if (row.step->block != block) continue;
        for (SoundPlayed const& s : row.done->sounds)
            table.rows.push_back({s.onset_s ? seconds_cell(*s.onset_s + row.offset_s) : cell(""),
                                  seconds_cell(s.duration_s), cell(row.step->number), cell(row.step->pass + 1),
                                  cell(row.done->attempt), cell(s.sound), cell(s.at),
                                  seconds_cell(s.event_s + row.offset_s), cell(s.offset_ms), cell(error_ms(s)),
                                  cell(s.underruns), cell(s.missing)});
    }
    return table;
}

} // namespace study
