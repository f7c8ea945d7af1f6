#include "gi/render/pass_loop.h"

#include "gi/core/error.h"
#include "gi/core/threads.h"
#include "gi/render/checkpoint.h"

#include <algorithm>
#include <utility>

namespace gi {

PassLoop::PassLoop(RenderSettings const& settings, StopRequest const& stop, RenderProgress const& progress,
                   Report& report, double spent_s)
    : settings_(settings),
      stop_(stop),
      progress_(progress),
      report_(report),
      sums_(settings.width, settings.height),
      start_(Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(spent_s)))
{
}

/// Returns the number of paths of the next pass: few enough to respond to Ctrl-C and update the progress bar in
/// time, and to keep the budget; many enough that the overhead of a pass is negligible.
std::uint32_t PassLoop::next_pass(double seconds_per_path) const
{
    constexpr double kPassSeconds = 0.5;
    double paths = seconds_per_path > 0 ? kPassSeconds / seconds_per_path : 1;
    if (settings_.budget_s > 0 && seconds_per_path > 0)
        paths = std::min(paths, (settings_.budget_s - seconds_since(start_)) / seconds_per_path);
    if (settings_.until_relmse > 0) paths = std::min(paths, std::max(16.0, 0.25 * double(sums_.paths)));
    auto const next = std::uint32_t(std::clamp(paths, 1.0, std::max(1.0, double(limit()) - double(sums_.paths))));
    return sums_.further.empty() ? next : std::max(next, *std::ranges::max_element(sums_.further));
}

void PassLoop::announce_state()
{
    if (!is_announced_ && settings_.before_checkpoint)
        settings_.before_checkpoint(checkpoint_bytes(sums_.width, sums_.height));
    is_announced_ = true;
}

/// A failed write (full disk) is reported, but must not end the render.
bool PassLoop::save(std::uint64_t print)
{
    announce_state();
    auto const begun = Clock::now();
    bool is_written = true;
    try {
        save_checkpoint(settings_.checkpoint, sums_, print);
    } catch (InputError const& e) {
        report_.lose("checkpoints that could not be written", 1, e.what());
        is_written = false;
    }
    saved_ = Clock::now();
    last_checkpoint_s_ = std::chrono::duration<double>(saved_ - begun).count();
    checkpoints_s_ += last_checkpoint_s_;
    return is_written;
}

bool PassLoop::is_checkpoint_due() const
{
    constexpr double kMostShare = 0.02;
    return keeps_state() && settings_.checkpoint_s > 0 &&
           seconds_since(saved_) >= std::max(settings_.checkpoint_s, last_checkpoint_s_ / kMostShare);
}

void PassLoop::resume(std::uint64_t print)
{
    if (settings_.resume && !std::exchange(is_resumed_, true))
        load_checkpoint(settings_.checkpoint, sums_, print, &stop_, &report_);
}

/// Counts what the device was asked to do, per path of every pixel.
void PassLoop::report_device(DeviceWork const& before, double paths)
{
    DeviceWork work = device_work();
    work -= before;
    report_.count("kernel launches per pass", double(work.launches) / paths);
    report_.count("waits for the device per pass", double(work.waits) / paths);
    report_.count("bytes to and from the device per pass",
                  double(work.bytes_to_device + work.bytes_to_host) / paths);
}

RenderResult PassLoop::run(std::uint64_t print, Pass const& pass)
{
    constexpr std::uint32_t kPathsForVariance = 16;

    resume(print);
    std::uint32_t const resumed = sums_.paths;
    bool is_saved = sums_.has_paths();
    double const earlier = sums_.seconds;
    RenderResult result;
    DeviceWork const device_before = device_work();
    auto const first_pass = Clock::now();
    saved_ = first_pass;
    bool const watches = settings_.until_relmse > 0 || bool(progress_);
    double relmse = resumed > 0 && watches ? sums_.relative_mse() : 0;
    double per_path = 0;
    while (true) {
        if (sums_.paths >= limit() && sums_.further.empty()) break;
        if (sums_.has_paths() && stop_.requested()) {
            result.end = RenderEnd::interrupted;
            break;
        }
        if (settings_.budget_s > 0 && sums_.paths > resumed &&
            seconds_since(start_) + per_path > settings_.budget_s) {
            result.end = RenderEnd::budget;
            break;
        }
        if (settings_.until_relmse > 0 && sums_.further.empty() && sums_.paths >= kPathsForVariance &&
            relmse < settings_.until_relmse) {
            result.end = RenderEnd::error_target;
            break;
        }
        try {
            on_threads(settings_.threads, [&] { pass(sums_, next_pass(per_path)); });
        } catch (Interrupted const&) {
            if (!sums_.has_paths() || !stop_.requested()) throw;
            sums_.seconds = earlier + seconds_since(start_);
            continue;
        }
        double const now = seconds_since(start_);
        sums_.seconds = earlier + now;
        per_path = (seconds_since(first_pass) - checkpoints_s_) / double(sums_.paths - resumed);
        if (watches) relmse = sums_.relative_mse();
        if (progress_) {
            double fraction = double(sums_.paths) / double(limit());
            if (settings_.budget_s > 0) fraction = std::max(fraction, now / settings_.budget_s);
            if (settings_.until_relmse > 0 && relmse > 0)
                fraction = std::max(fraction, settings_.until_relmse / relmse);
            progress_({std::min(1.0, fraction), sums_.paths, relmse});
        }
        if (is_checkpoint_due() && sums_.paths < limit()) is_saved |= save(print);
    }
    bool const may_go_on = keeps_state() && (result.end == RenderEnd::interrupted ||
                                             (settings_.resume && result.end != RenderEnd::paths));
    print_ = print;
    if (may_go_on) result.resumable = (!settings_.by_rows && save(print)) || is_saved;
    if (settings_.share.merge) settings_.share.merge(sums_);
    report_.add_time("trace", seconds_since(first_pass) - checkpoints_s_);
    if (settings_.space == Space::device && sums_.paths > resumed)
        report_device(device_before, double(sums_.paths - resumed));
    if (is_announced_) report_.add_time("checkpoints", checkpoints_s_);
    report_.lose("paths cut at 1024 surfaces", sums_.counts.cut_paths);
    report_.lose("path terms that were not finite, dropped", sums_.counts.invalid_paths);
    result.seconds = sums_.seconds;
    result.paths = sums_.paths;
    // Of complete passes, as the number of paths.
    result.relmse = watches && !settings_.share.merge ? relmse : sums_.relative_mse();
    return result;
}

void PassLoop::deliver(World const& world, RenderResult& result)
{
    if (!settings_.by_rows) {
        result.picture = sums_.picture(world);
        return;
    }
    auto const sums = std::make_shared<Accumulator const>(std::move(sums_));
    result.rows = picture_rows(sums, picture_shape(world));
    result.color_rows = picture_rows(sums, picture_shape(world, PictureLayers::color_and_depth));
    if (!keeps_state()) return;
    auto const announce = is_announced_ ? nullptr : settings_.before_checkpoint;
    result.save_state = [file = settings_.checkpoint, sums, print = print_, announce](DiskWait wait) {
        if (announce) announce(checkpoint_bytes(sums->width, sums->height));
        save_checkpoint(file, *sums, print, wait);
    };
}

} // namespace gi
