#include "viewer/cli/ar/ar_chain_check.h"

#include "ar/capture/clock.h"
#include "ar/runtime/counter_check.h"
#include "ar/runtime/scratch_folder.h"
#include "gi/core/error.h"
#include "viewer/base/arguments.h"
#include "viewer/bench/bench_record.h"
#include "viewer/camera_view/ar_window.h"

namespace viewer {

ChainChecked check_chain(ChainCheckSettings const& s, gi::StopRequest& stop, gi::Report& report)
{
    ChainChecked checked;
    BenchTable& table = checked.table;
    table = start_table("ar_counter", "Numbers and a ball in frames that show their own number",
                        {"size", "read_from", "frames", "overtaken", "without_number", "of_another_number",
                         "ball_elsewhere", "times_wrong", "ball_off_most_px",
                         s.in_window ? "capture_to_swap_ms" : "capture_to_result_ms"});
    for (std::string const& size : s.sizes) {
        auto const [width, height] = parse_size(size);
        ar::ScratchFolder const folder;
        ar::CounterSession const c = ar::make_counter_session(folder.path(), {width, height}, 30, report);
        ar::CounterCheck check(c);
        ar::RunOptions o;
        o.frames = s.frames;
        // The pose depends on the capture time, so that a frame with a wrong time is detected.
        o.tracked = [&c, start_s = std::optional<double>()](ar::Frame const& f) mutable {
            if (!start_s) start_s = f.captured_s - double(f.sequence) / c.rate_hz;
            return std::optional(c.camera_at(f.captured_s - *start_s));
        };
        std::optional<ArWindow> window;
        o.opened = [&](ar::SourceDescription const& source, ar::Pipeline const&) {
            if (!s.in_window) return;
            ArWindowSettings settings{.size_px = source.size_px};
            settings.has_panel = false;
            settings.keeps_shown = true;
            window.emplace(settings, report);
        };
        o.idle = [&] {
            if (window) window->idle();
            if (window && window->wants_close()) stop.request();
        };
        ar::RunSummary summary;
        ar::run_frames(
            c.session, o,
            [&](ar::RunFrame& f, ar::FrameResult const& r) {
                double const before_s = ar::steady_now_s();
                if (window) window->show(f, r);
                check.add(f, window ? window->shown() : r.rgb, s.in_window, before_s, ar::steady_now_s());
                if (window && window->wants_close()) stop.request();
            },
            stop, report, summary);
        ar::CounterVerdict const& v = check.verdict();
        std::vector<double> latency_ms;
        for (ar::RunFrame const& f : summary.frames)
            latency_ms.push_back(s.in_window ? f.swapped_ms : f.latency_ms);
        table.add({size, std::string(s.in_window ? "window" : "composite"), double(v.frames),
                   double(summary.overtaken), double(v.unread), double(v.other), double(v.misplaced),
                   double(v.mistimed), v.most_off_px, latency_ms.empty() ? Cell() : Cell(summarise(latency_ms))});
        checked.good = checked.good && v.good();
        if (stop.requested()) break;
    }
    return checked;
}

} // namespace viewer
