#include "viewer/study/study_records.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"
#include "study/signals/gaze.h"
#include "study/tables/bids.h"

#include <array>
#include <fmt/format.h>
#include <zlib.h>

namespace viewer {
namespace {

struct GazeTableOfPart {
    std::string file;
    double offset_s = 0; ///< from the part's clock to the session's
};

std::vector<GazeTableOfPart> tables_of(study::RecordedSession const& session)
{
    std::vector<GazeTableOfPart> tables;
    for (study::TimedEntry const& timed : study::timed_entries(session))
        if (auto const* const start = std::get_if<study::SessionStarted>(timed.entry))
            for (auto const& [key, value] : start->about)
                if (key == "gaze_table") {
                    // A part that was cut off before its first row left its name to the next one.
                    if (!tables.empty() && tables.back().file == value) tables.pop_back();
                    tables.push_back({value, timed.offset_s});
                }
    return tables;
}

/// A line t_s,x_px,y_px,pupil_mm,valid,step,shown; false for others, such as one that was cut off.
bool parse_gaze_row(std::string_view line, study::GazeSample& s, int& step)
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

/// The same bytes for the same text: no time, no name.
std::string gzip(std::string const& text)
{
    z_stream stream{};
    constexpr int kGzip = 15 + 16, kMemory = 8;
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib does not start");
    std::string packed(deflateBound(&stream, uLong(text.size())) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    int const end = deflate(&stream, Z_FINISH);
    packed.resize(packed.size() - stream.avail_out);
    deflateEnd(&stream);
    if (end != Z_STREAM_END) throw std::runtime_error("zlib does not end");
    return packed;
}

/// The samples of a session: the tables that its parts name in the journal (gaze_table), with times since the
/// session's beginning. Places are px from the window's top left corner.
struct RecordedGaze {
    std::vector<study::GazeSample> samples;
    std::vector<int> steps; ///< of the plan, from 0; -1 = none
};

RecordedGaze read_gaze(std::filesystem::path const& dir, study::Script const& script,
                       study::RecordedSession const& session)
{
    RecordedGaze gaze;
    std::filesystem::path const folder = dir / study::session_folder(study::start_of(script, session));
    for (GazeTableOfPart const& table : tables_of(session)) {
        std::filesystem::path const file = folder / table.file;
        std::error_code none;
        if (!std::filesystem::exists(file, none)) continue; // a part that ended before its first trial
        std::string const text = gi::read_text(file, std::size_t(4) << 30);
        std::string_view rest = text;
        gi::take_until(rest, '\n'); // the header
        int damaged = 0;
        while (!rest.empty()) {
            std::string_view const line = gi::take_until(rest, '\n');
            study::GazeSample s;
            int step = -1;
            if (!parse_gaze_row(line, s, step)) {
                ++damaged;
                continue;
            }
            s.time_s += table.offset_s;
            gaze.samples.push_back(s);
            gaze.steps.push_back(step);
        }
        if (damaged > 0)
            std::fputs(
                fmt::format("{}: {} lines that are no samples are left out\n", file.string(), damaged).c_str(),
                stderr);
    }
    return gaze;
}

} // namespace

std::vector<study::TextFile> gaze_files(std::filesystem::path const& dir, study::Script const& script,
                                        study::RecordedSession const& session)
{
    RecordedGaze const gaze = read_gaze(dir, script, session);
    if (gaze.samples.empty()) return {};
    std::string rows;
    for (std::size_t i = 0; i < gaze.samples.size(); ++i) {
        study::GazeSample const& s = gaze.samples[i];
        std::string const step = gaze.steps[i] < 0 ? "n/a" : std::to_string(gaze.steps[i] + 1);
        if (s.is_valid)
            rows += fmt::format("{:.6f}\t{:.2f}\t{:.2f}\t{}\t{}\n", s.time_s, s.x_px, s.y_px,
                                std::isfinite(s.pupil_mm) ? fmt::format("{:.3f}", s.pupil_mm) : "n/a", step);
        else
            rows += fmt::format("{:.6f}\tn/a\tn/a\tn/a\t{}\n", s.time_s, step);
    }
    double const rate_hz = study::summarise(gaze.samples).rate_hz;
    return {{study::gaze_stem(script, session) + ".tsv.gz", gzip(rows)},
            study::gaze_sidecar(script, session, rate_hz, gaze.samples.front().time_s)};
}

} // namespace viewer
