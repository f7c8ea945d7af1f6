// Describes a session's results as text.

#include "ar/runtime/runner.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace ar {

namespace {

std::map<std::string, std::size_t> causes_of(std::vector<RunFrame> const& frames)
{
    std::map<std::string, std::size_t> causes;
    for (RunFrame const& f : frames)
        if (!f.lost_by.empty()) ++causes[f.lost_by];
    return causes;
}

/// Lines of text: causes of frames without a trusted pose, markers and boards that were left out.
std::string describe_lost(std::vector<RunFrame> const& frames)
{
    std::string causes, left_out;
    for (auto const& [cause, n] : causes_of(frames))
        causes += fmt::format("{}{} ({})", causes.empty() ? "without a trusted pose: " : ", ", n, cause);
    auto const add = [&](int RunFrame::*count, char const* what) {
        int n = 0, in = 0;
        for (RunFrame const& f : frames) {
            n += f.*count;
            in += f.*count > 0;
        }
        if (n > 0) left_out += fmt::format("{}: {}, in {} frames\n", what, n, in);
    };
    add(&RunFrame::markers_ambiguous, "markers whose identifier is in the picture more than once");
    add(&RunFrame::markers_unknown, "markers that the map does not have");
    add(&RunFrame::boards_left_out, "boards that contradict the map");
    return (causes.empty() ? causes : causes + "\n") + left_out;
}

} // namespace

Spread spread_of(std::vector<double> values)
{
    values = gi::sorted_values(std::move(values));
    if (values.empty()) return {};
    return {gi::quantile_of_sorted(values, 0.5), gi::quantile_of_sorted(values, 0.95), values.back()};
}

std::size_t count_found(std::vector<RunFrame> const& frames)
{
    return std::size_t(std::count_if(frames.begin(), frames.end(),
                                     [](RunFrame const& f) { return f.state == PoseState::tracked; }));
}

std::string most_lost_by(std::vector<RunFrame> const& frames)
{
    auto const causes = causes_of(frames);
    auto const most = std::max_element(causes.begin(), causes.end(),
                                       [](auto const& a, auto const& b) { return a.second < b.second; });
    return most == causes.end() ? std::string() : most->first;
}

std::string describe(RunSummary const& s)
{
    std::size_t const n = s.frames.size();
    std::size_t const found = count_found(s.frames);
    std::string text =
        fmt::format("{} frames in {:.2f} s: {:.1f} frames/s; camera found in {} ({:.1f} %)\n", n, s.seconds,
                    n / std::max(s.seconds, 1e-9), found, n > 0 ? 100.0 * double(found) / double(n) : 0);
    PoseTally poses;
    for (RunFrame const& f : s.frames) poses.add(f.state, f.confidence, f.estimated.has_value());
    text += describe(poses);
    text += describe_lost(s.frames);
    if (!s.light.empty()) text += fmt::format("virtual objects lit by {}\n", s.light);
    text += fmt::format("source: {}{}\n", describe(s.source),
                        s.end.kind == SourceState::Kind::lost ? "; lost: " + s.end.reason : "");
    if (s.overtaken > 0)
        text +=
            fmt::format("overtaken: {} frames (a newer one was there before they were rendered)\n", s.overtaken);
    if (s.unfinished > 0) text += fmt::format("unfinished at the end: {} frames\n", s.unfinished);
    if (s.refused > 0) text += fmt::format("refused: {} frames\n", s.refused);
    text += fmt::format("{:<24} {:>9} {:>9} {:>9}\n", "", "median", "95 %", "most");
    auto const line = [&](char const* name, auto const& value) {
        std::vector<double> values;
        for (RunFrame const& f : s.frames)
            if (std::optional<double> const v = value(f)) values.push_back(*v);
        Spread const d = spread_of(std::move(values));
        if (d.most > 0) text += fmt::format("{:<24} {:>9.2f} {:>9.2f} {:>9.2f}\n", name, d.median, d.p95, d.most);
    };
    line("read (ms)", [](auto const& f) { return f.read_ms; });
    line("frame's age (ms)", [](auto const& f) { return f.age_ms; });
    line("decode (ms)", [](auto const& f) { return f.times.decode_ms; });
    line("detect (ms)", [](auto const& f) { return f.times.detect_ms; });
    line("pose (ms)", [](auto const& f) { return f.times.pose_ms; });
    line("waits for rendering (ms)", [](auto const& f) { return f.times.wait_ms; });
    line("light (ms)", [](auto const& f) { return f.times.light_ms; });
    line("render (ms)", [](auto const& f) { return f.times.render_ms; });
    line("composite (ms)", [](auto const& f) { return f.times.composite_ms; });
    line("capture to result (ms)", [](auto const& f) { return f.latency_ms; });
    line("waits to be shown (ms)", [](auto const& f) { return f.show_wait_ms; });
    line("present (ms)", [](auto const& f) { return f.present_ms; });
    line("capture to swap (ms)", [](auto const& f) { return f.swapped_ms; });
    line("reprojection RMS (px)", [](auto const& f) { return f.rms_px; });
    line("expected error (mm)", [](auto const& f) {
        return f.expected_error_m ? std::optional(1e3 * *f.expected_error_m) : std::nullopt;
    });
    return text;
}

std::string describe(PoseTally const& t)
{
    std::string states;
    for (std::size_t k = 0; k < kPoseStates; ++k)
        if (t.states[k] > 0)
            states += fmt::format("{}{} {}", states.empty() ? "" : ", ", t.states[k], name_of(PoseState(k)));
    if (states.empty()) return {};
    std::string text = "poses: " + states;
    if (!t.confidence.empty())
        text += fmt::format("; confidence {:.3f} (median), {:.3f} (5 %)", gi::quantile(t.confidence, 0.5),
                            gi::quantile(t.confidence, 0.05));
    return text + "\n";
}

} // namespace ar
