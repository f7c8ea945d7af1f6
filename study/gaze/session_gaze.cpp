#include "study/gaze/session_gaze.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "gi/core/text.h"
#include "study/tables/bids.h"

#include <fmt/format.h>

namespace study {
namespace {

struct GazeTableOfPart {
    std::string file;
    double offset_s = 0; ///< from the part's clock to the session's
};

std::vector<GazeTableOfPart> tables_of(RecordedSession const& session)
{
    std::vector<GazeTableOfPart> tables;
    for (TimedEntry const& timed : timed_entries(session))
        if (auto const* const start = std::get_if<SessionStarted>(timed.entry))
            for (auto const& [key, value] : start->about)
                if (key == "gaze_table") {
                    // A part that was cut off before its first row left its name to the next one.
                    if (!tables.empty() && tables.back().file == value) tables.pop_back();
                    tables.push_back({value, timed.offset_s});
                }
    return tables;
}

/// A line t_s,x_px,y_px,pupil_mm,valid,step,shown; false for others, such as one that was cut off.
bool parse_gaze_row(std::string_view line, GazeSample& s, int& step)
{
    auto const cells = gi::split_at_commas(line);
    if (cells.size() != 7) return false;
    auto const time = gi::parse_finite(cells[0]);
    auto const step_number = gi::parse_number<int>(cells[5]);
    if (!time || !step_number) return false;
    s.time_s = *time;
    s.is_valid = cells[4] == "1";
    auto const x = gi::parse_finite(cells[1]), y = gi::parse_finite(cells[2]), pupil = gi::parse_finite(cells[3]);
    if (s.is_valid && (!x || !y)) return false;
    s.x_px = x.value_or(0);
    s.y_px = y.value_or(0);
    if (pupil) s.pupil_mm = *pupil;
    step = *step_number;
    return true;
}

} // namespace

SessionGaze read_session_gaze(std::filesystem::path const& dir, Script const& script,
                              RecordedSession const& session)
{
    SessionGaze gaze;
    std::filesystem::path const folder = dir / session_folder(start_of(script, session));
    for (GazeTableOfPart const& table : tables_of(session)) {
        std::filesystem::path const file = folder / table.file;
        std::error_code none;
        if (!std::filesystem::exists(file, none)) continue; // a part that ended before its first trial
        std::string const text = gi::read_text(file, std::size_t(4) << 30);
        gaze.files.push_back({file.string(), gi::sha256(text)});
        std::string_view rest = text;
        gi::take_until(rest, '\n'); // the header
        int damaged = 0;
        while (!rest.empty()) {
            std::string_view const line = gi::take_until(rest, '\n');
            GazeSample s;
            int step = -1;
            if (!parse_gaze_row(line, s, step)) {
                ++damaged;
                continue;
            }
            s.time_s += table.offset_s;
            gaze.samples.push_back(s);
            gaze.steps.push_back(step);
        }
        gaze.unreadable += damaged;
        if (damaged > 0)
            gaze.remarks.push_back(
                fmt::format("{}: {} lines that are no samples are left out", file.string(), damaged));
    }
    return gaze;
}

} // namespace study
