#include "study/gaze/gaze_tables.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numbers>

namespace study {
namespace {

/// Identifies a view in each of its rows.
std::vector<Column> view_columns()
{
    return {name_column("recording", "Name of the recording"),
            name_column("participant", "Participant"),
            name_column("block", "Block, or the task of a file"),
            {"step", "Step of the plan, or row of the table of events, from 1"},
            {"attempt", "Number of the attempt at the trial, from 1"},
            name_column("shown", "Letters of the stimuli shown side by side"),
            name_column("condition", "Levels of the factors of each of them")};
}
std::vector<std::string> view_cells(AnalysedGaze const& a, GazeView const& v)
{
    return {cell(a.recording.name), cell(a.recording.participant),
            cell(v.block),          v.step < 0 ? cell("") : cell(v.step + 1),
            cell(v.attempt),        cell(v.shown),
            cell(v.condition)};
}
template <class... Cells>
void add_row(Table& table, std::vector<std::string> cells, Cells&&... more)
{
    (cells.push_back(std::forward<Cells>(more)), ...);
    table.rows.push_back(std::move(cells));
}

double mean_of(double sum, std::size_t n) { return n > 0 ? sum / double(n) : NAN; }

ResultTable recordings_table(GazeAnalysis const& analysis)
{
    ResultTable t{"gaze_recordings", "Recordings of gaze", "", false, {}};
    t.table.columns = {name_column("recording", "Name of the recording"),
                       name_column("participant", "Participant"),
                       name_column("eyes", "Whose places count"),
                       {"rate_hz", "Samples a second, by the median step", "Hz"},
                       {"valid_share", "Share of the time, from the first sample to the last, with valid samples"},
                       {"fixations", "Fixations"},
                       {"saccades", "Saccades"},
                       {"losses", "Times without valid samples that are not bridged"},
                       {"bridged", "Times without valid samples that are bridged"},
                       {"merged", "Fixations that became part of the one before"},
                       {"short_fixations", "Fixations left out, as they are too short"},
                       {"alone", "Valid samples without a valid neighbour, in neither fixation nor saccade"}};
    for (auto const& a : analysis.recordings) {
        GazeEvents const& e = a->events;
        add_row(t.table, {cell(a->recording.name), cell(a->recording.participant), cell(a->recording.eyes)},
                cell(1 / e.step_s), cell(a->valid_share), cell(int(e.fixations.size())),
                cell(int(e.saccades.size())), cell(int(e.losses.size())), cell(e.bridged), cell(e.merged),
                cell(e.short_fixations), cell(e.alone));
    }
    return t;
}

ResultTable samples_table(GazeAnalysis const& analysis)
{
    ResultTable t{"gaze_samples", "Samples of gaze, and what became of them", "", false, {}};
    t.table.columns = {name_column("recording", "Name of the recording"),
                       name_column("source", "Where they came from")};
    for (NamedCount const& c : kGazeCounts) t.table.columns.push_back({c.name, c.meaning});
    for (auto const& a : analysis.recordings) {
        add_row(t.table, {cell(a->recording.name), cell(a->recording.source)});
        for (NamedCount const& c : kGazeCounts) t.table.rows.back().push_back(cell(a->recording.counts.*c.count));
    }
    return t;
}

ResultTable sequences_table(GazeAnalysis const& analysis)
{
    ResultTable t{"main_sequences",
                  "Main sequence of saccades",
                  "Peak velocity is at_1_deg times the amplitude to the power of the slope.",
                  false,
                  {}};
    t.table.columns = {name_column("recording", "Name of the recording"),
                       {"saccades", "Whole saccades of 0.5 degrees and more"},
                       {"slope", "Exponent of peak velocity by amplitude: the slope on logarithmic axes"},
                       {"slope_se", "Its standard error"},
                       {"at_1_deg", "Peak velocity of a saccade of 1 degree", "deg/s"},
                       {"ms_per_deg", "Slope of the duration by amplitude", "ms/deg"},
                       {"ms_per_deg_se", "Its standard error", "ms/deg"},
                       {"ms_at_0_deg", "Duration, extrapolated to no amplitude", "ms"}};
    for (auto const& a : analysis.recordings) {
        MainSequence const& m = a->sequence;
        add_row(t.table, {cell(a->recording.name)}, cell(m.saccades), cell(m.slope), cell(m.slope_se),
                cell(m.at_one_deg), cell(m.ms_per_deg), cell(m.ms_per_deg_se), cell(m.ms_at_zero));
    }
    return t;
}

ResultTable views_table(GazeAnalysis const& analysis)
{
    ResultTable t{"gaze_views", "Gaze while something was shown", "", true, {}};
    t.table.columns = view_columns();
    for (Column const& c :
         std::vector<Column>{{"start_s", "Beginning, since that of the session or recording", "s"},
                             {"duration_s", "How long it was shown", "s"},
                             {"counted", "Whether analyses of answers count the trial"},
                             {"valid_share", "Share of the time with valid samples"},
                             {"usable", "Whether that is enough"},
                             {"losses", "Times without valid samples that are not bridged"},
                             {"lost_ms", "How long they are together", "ms"},
                             {"fixations", "Fixations that overlap it"},
                             {"dwell_ms", "How long they are in it together", "ms"},
                             {"fixation_ms", "Mean duration of those that are whole and begin in it", "ms"},
                             {"saccades", "Saccades that begin in it"},
                             {"first_saccade_ms", "From its beginning to the first one", "ms"},
                             {"amplitude_deg", "Their mean amplitude", "deg"},
                             {"path_deg", "Sum of their amplitudes", "deg"}})
        t.table.columns.push_back(c);
    for (auto const& a : analysis.recordings)
        for (ViewedGaze const& v : a->views) {
            double dwell = 0, whole = 0;
            std::size_t n = 0;
            for (SeenFixation const& f : v.fixations) {
                dwell += f.dwell_s;
                if (f.fixation->is_cut || f.fixation->start_s < v.view->start_s) continue;
                whole += f.fixation->end_s - f.fixation->start_s;
                ++n;
            }
            add_row(t.table, view_cells(*a, *v.view), seconds_cell(v.view->start_s),
                    seconds_cell(v.view->end_s - v.view->start_s), cell(v.view->is_counted), cell(v.valid_share),
                    cell(v.is_usable), cell(v.losses), cell(1e3 * v.lost_s), cell(int(v.fixations.size())),
                    cell(1e3 * dwell), cell(1e3 * mean_of(whole, n)), cell(int(v.saccades.size())),
                    cell(v.first_saccade_ms), cell(mean_of(v.path_deg, v.saccades.size())), cell(v.path_deg));
        }
    return t;
}

/// Mean of participants' means, with its standard error.
struct Spread {
    double mean = NAN, se = NAN;
};
Spread spread_of(std::vector<double> const& values)
{
    double sum = 0, squares = 0;
    for (double const v : values) sum += v;
    double const n = double(values.size()), mean = mean_of(sum, values.size());
    for (double const v : values) squares += (v - mean) * (v - mean);
    return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : NAN};
}

ResultTable conditions_table(GazeAnalysis const& analysis)
{
    struct Sums {
        double views = 0, seconds = 0, fixations = 0, fixation_ms = 0, whole = 0, saccades = 0, path_deg = 0;
    };
    std::map<std::pair<std::string, std::string>, std::map<std::string, Sums>> all;
    std::map<std::pair<std::string, std::string>, int> left_out;
    for (auto const& a : analysis.recordings)
        for (ViewedGaze const& v : a->views) {
            std::pair const key(v.view->block, v.view->condition);
            if (!v.view->is_counted || !v.is_usable) {
                ++left_out[key];
                continue;
            }
            Sums& s = all[key][a->recording.participant.empty() ? a->recording.name : a->recording.participant];
            ++s.views;
            s.seconds += v.view->end_s - v.view->start_s;
            s.fixations += double(v.fixations.size());
            s.saccades += double(v.saccades.size());
            s.path_deg += v.path_deg;
            for (SeenFixation const& f : v.fixations)
                if (!f.fixation->is_cut && f.fixation->start_s >= v.view->start_s) {
                    s.fixation_ms += 1e3 * (f.fixation->end_s - f.fixation->start_s);
                    ++s.whole;
                }
        }
    ResultTable t{"gaze_conditions",
                  "Gaze by condition",
                  "Means of participants' means with standard errors, over views that count and have enough valid "
                  "samples.",
                  false,
                  {}};
    t.table.columns = {name_column("block", "Block, or the task of a file"),
                       name_column("condition", "Levels of the factors of each stimulus"),
                       {"participants", "Participants"},
                       {"views", "Views that count"},
                       {"left_out", "Views that do not: practice, invalid, or with too few valid samples"},
                       {"fixations_per_s", "Fixations per second", "1/s"},
                       {"fixations_per_s_se", "Standard error over participants", "1/s"},
                       {"fixation_ms", "Mean duration of fixations", "ms"},
                       {"fixation_ms_se", "Standard error over participants", "ms"},
                       {"amplitude_deg", "Mean amplitude of saccades", "deg"},
                       {"amplitude_deg_se", "Standard error over participants", "deg"}};
    for (auto const& [key, n] : left_out) all[key];
    for (auto const& [key, people] : all) {
        std::vector<double> rate, ms, deg;
        double views = 0;
        for (auto const& [id, s] : people) {
            views += s.views;
            rate.push_back(s.fixations / s.seconds);
            if (s.whole > 0) ms.push_back(s.fixation_ms / s.whole);
            if (s.saccades > 0) deg.push_back(s.path_deg / s.saccades);
        }
        Spread const r = spread_of(rate), d = spread_of(ms), s = spread_of(deg);
        add_row(t.table, {cell(key.first), cell(key.second)}, cell(int(people.size())), cell(int(views)),
                cell(left_out[key]), cell(r.mean), cell(r.se), cell(d.mean), cell(d.se), cell(s.mean), cell(s.se));
    }
    return t;
}

double from_left(AnalysedGaze const& a, double x_px) { return x_px + 0.5 * a.recording.screen.width_px; }
double from_top(AnalysedGaze const& a, double y_px) { return y_px + 0.5 * a.recording.screen.height_px; }

ResultTable fixations_table(GazeAnalysis const& analysis)
{
    ResultTable t{
        "fixations", "Fixations", "In the order of their numbers they are the scan path of a view.", true, {}};
    t.table.columns = view_columns();
    for (Column const& c :
         std::vector<Column>{{"number", "Number in the view, from 1"},
                             {"onset_ms", "Beginning, since that of the view; negative if it began before", "ms"},
                             {"duration_ms", "Duration", "ms"},
                             {"dwell_ms", "Duration within the view", "ms"},
                             {"x_px", "Mean place, from the left of the screen", "pixel"},
                             {"y_px", "Mean place, from the top of the screen, down", "pixel"},
                             {"x_deg", "Direction, from the centre of the screen to the right", "deg"},
                             {"y_deg", "Direction, from the centre of the screen down", "deg"},
                             {"rms_deg", "Root mean square of the samples' angles from it", "deg"},
                             {"pupil_mm", "Mean diameter of the pupil, as the eye tracker reports it", "mm"},
                             {"samples", "Samples"},
                             {"cut", "Whether samples are lost at its beginning or end"}})
        t.table.columns.push_back(c);
    for (auto const& a : analysis.recordings)
        for (ViewedGaze const& v : a->views)
            for (SeenFixation const& s : v.fixations) {
                Fixation const& f = *s.fixation;
                ScreenGeometry const& screen = a->recording.screen;
                add_row(t.table, view_cells(*a, *v.view), cell(s.number),
                        cell(1e3 * (f.start_s - v.view->start_s)), cell(1e3 * (f.end_s - f.start_s)),
                        cell(1e3 * s.dwell_s), cell(from_left(*a, f.x_px)), cell(from_top(*a, f.y_px)),
                        cell(deg_of_place(screen, f.x_px, false)), cell(deg_of_place(screen, f.y_px, true)),
                        cell(f.rms_deg), cell(f.pupil_mm), cell(f.samples), cell(f.is_cut));
            }
    return t;
}

ResultTable saccades_table(GazeAnalysis const& analysis)
{
    ResultTable t{"saccades", "Saccades", "", true, {}};
    t.table.columns = view_columns();
    for (Column const& c :
         std::vector<Column>{{"number", "Number in the view, from 1"},
                             {"onset_ms", "Beginning, since that of the view", "ms"},
                             {"duration_ms", "Duration", "ms"},
                             {"amplitude_deg", "Angle between gaze before and after it", "deg"},
                             {"direction_deg", "On the screen: 0 to the right, 90 up, -180 to 180", "deg"},
                             {"peak_deg_s", "Greatest velocity", "deg/s"},
                             {"from_x_px", "Place before it, from the left of the screen", "pixel"},
                             {"from_y_px", "Place before it, from the top of the screen, down", "pixel"},
                             {"to_x_px", "Place after it, from the left of the screen", "pixel"},
                             {"to_y_px", "Place after it, from the top of the screen, down", "pixel"},
                             {"cut", "Whether a part of it is missing, as samples are lost"}})
        t.table.columns.push_back(c);
    for (auto const& a : analysis.recordings)
        for (ViewedGaze const& v : a->views) {
            auto const [across, down] = pixels_per_cm(a->recording.screen);
            int number = 0;
            for (Saccade const* const s : v.saccades) {
                double const up_cm = -(s->to_y_px - s->from_y_px) / down;
                double const right_cm = (s->to_x_px - s->from_x_px) / across;
                add_row(t.table, view_cells(*a, *v.view), cell(++number),
                        cell(1e3 * (s->start_s - v.view->start_s)), cell(1e3 * (s->end_s - s->start_s)),
                        cell(s->amplitude_deg), cell(std::atan2(up_cm, right_cm) * 180 / std::numbers::pi),
                        cell(s->peak_deg_s), cell(from_left(*a, s->from_x_px)), cell(from_top(*a, s->from_y_px)),
                        cell(from_left(*a, s->to_x_px)), cell(from_top(*a, s->to_y_px)), cell(s->is_cut));
            }
        }
    return t;
}

} // namespace

std::vector<ResultTable> gaze_tables(GazeAnalysis const& analysis)
{
    return {recordings_table(analysis), samples_table(analysis), sequences_table(analysis),
            conditions_table(analysis), views_table(analysis),   fixations_table(analysis),
            saccades_table(analysis)};
}

} // namespace study
