#include "viewer/cli/ar/ar_chain_check.h"

#include "ar/capture/clock.h"
#include "ar/runtime/ar_window.h"
#include "ar/runtime/counter_check.h"
#include "ar/runtime/scratch_folder.h"
#include "gi/core/error.h"
#include "viewer/base/arguments.h"
#include "viewer/bench/bench_record.h"

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
        ScratchFolder const folder;
        CounterSession const c = make_counter_session(folder.path(), {width, height}, 30, report);
        CounterCheck check(c);
        ArRunOptions o;
        o.frames = s.frames;
        // The pose depends on the capture time, so that a frame with a wrong time is detected.
        o.tracked = [&c, start_s = std::optional<double>()](ar::Frame const& f) mutable {
            if (!start_s) start_s = f.captured_s - double(f.sequence) / c.rate_hz;
            return std::optional(c.camera_at(f.captured_s - *start_s));
        };
        std::optional<ArWindow> window;
        o.opened = [&](ar::SourceDescription const& source, ArPipeline const&) {
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
        ArSummary summary;
        run_ar(
            c.session, o,
            [&](ArFrameRecord& f, ArResult const& r) {
                double const before_s = ar::steady_now_s();
                if (window) window->show(f, r);
                check.add(f, window ? window->shown() : r.rgb, s.in_window, before_s, ar::steady_now_s());
                if (window && window->wants_close()) stop.request();
            },
            stop, report, summary);
        CounterVerdict const& v = check.verdict();
        std::vector<double> latency_ms;
        for (ArFrameRecord const& f : summary.frames)
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
