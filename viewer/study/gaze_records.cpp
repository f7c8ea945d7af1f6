#include "viewer/study/study_records.h"

#include "gi/core/gzip.h"
#include "study/gaze/session_gaze.h"
#include "study/tables/bids.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {

std::vector<study::TextFile> gaze_files(std::filesystem::path const& dir, study::Script const& script,
                                        study::RecordedSession const& session)
{
    study::SessionGaze const gaze = study::read_session_gaze(dir, script, session);
    for (std::string const& remark : gaze.remarks) std::fputs((remark + "\n").c_str(), stderr);
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
    return {{study::gaze_stem(script, session) + ".tsv.gz", gi::gzip(rows)},
            study::gaze_sidecar(script, session, rate_hz, gaze.samples.front().time_s)};
}

} // namespace viewer
