#include "ar/capture/clock.h"
#include "ar/capture/session_reader.h"
#include "ar/runtime/runner.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct ReplayOptions {
    SourceArguments source;
    std::uint64_t frames = 0;
    double seconds = 0;
    bool fast = false, check = false, json = false;
};

struct Played {
    std::uint64_t frames = 0, gaps = 0, longest_gap = 0;
    double first_s = 0, last_s = 0; ///< capture times
    std::vector<double> ages_ms;
    ar::SourceCounts counts;
    ar::SourceState end;
    std::uint64_t lost_while_recording = 0;

    double span_s() const { return last_s - first_s; }
    double rate_hz() const { return span_s() > 0 ? double(frames - 1) / span_s() : 0; }
    /// Description of each kind of loss.
    std::vector<std::string> losses() const
    {
        std::vector<std::string> all;
        if (counts.dropped > 0) all.push_back(fmt::format("{} frames dropped", counts.dropped));
        if (counts.refused > 0)
            all.push_back(fmt::format("{} damaged or missing ({})", counts.refused, counts.last_refusal));
        if (lost_while_recording > 0) all.push_back(fmt::format("{} lost while recording", lost_while_recording));
        if (end.kind == ar::SourceState::Kind::lost) all.push_back(end.reason);
        return all;
    }
};

Played play(ar::FrameSource& source, ReplayOptions const& o, gi::StopRequest const& stop)
{
    Played p;
    gi::ProgressBar bar("replay " + o.source.source);
    std::uint64_t expected_frames = o.frames, last = 0;
    if (auto const* session = dynamic_cast<ar::SessionSource const*>(&source); session != nullptr) {
        if (auto const& finished = session->header().finished) {
            p.lost_while_recording = finished->lost;
            if (expected_frames == 0) expected_frames = finished->frames;
        }
    }
    double const start_s = ar::steady_now_s();
    while (!stop.requested() && (o.frames == 0 || p.frames < o.frames) &&
           (o.seconds == 0 || ar::steady_now_s() - start_s < o.seconds)) {
        auto const frame = source.next(std::chrono::milliseconds(100));
        if (!frame && source.state().kind != ar::SourceState::Kind::running) break;
        if (!frame) continue;
        if (p.frames == 0) {
            p.first_s = frame->captured_s;
        } else if (frame->sequence > last + 1) {
            ++p.gaps;
            p.longest_gap = std::max(p.longest_gap, frame->sequence - last - 1);
        }
        last = frame->sequence;
        p.last_s = frame->captured_s;
        p.ages_ms.push_back(1e3 * (frame->arrived_s - frame->captured_s));
        ++p.frames;
        bar.update(expected_frames > 0 ? double(p.frames) / double(expected_frames) : 0,
                   describe(source.counts()));
    }
    p.counts = source.counts();
    p.end = source.state();
    return p;
}

nlohmann::ordered_json played_json(Played const& p, ar::SourceDescription const& d)
{
    ar::Spread const age = ar::spread_of(p.ages_ms);
    nlohmann::ordered_json j;
    j["source"] = d.name;
    j["size_px"] = {d.size_px.x, d.size_px.y};
    j["format"] = name_of(d.format);
    j["frames"] = p.frames;
    j["seconds"] = p.span_s();
    j["rate_hz"] = p.rate_hz();
    j["nominal_rate_hz"] = d.frames_per_s;
    j["age_ms"] = {{"median", age.median}, {"p95", age.p95}, {"most", age.most}};
    j["gaps"] = p.gaps;
    j["longest_gap"] = p.longest_gap;
    j["dropped"] = p.counts.dropped;
    j["damaged"] = p.counts.refused;
    j["last_damage"] = p.counts.last_refusal;
    j["lost_while_recording"] = p.lost_while_recording;
    j["losses"] = p.losses();
    return j;
}

void print(Played const& p, ar::SourceDescription const& d)
{
    ar::Spread const age = ar::spread_of(p.ages_ms);
    fmt::print("{}: {} x {} px, {}\n", d.name, d.size_px.x, d.size_px.y, name_of(d.format));
    fmt::print("{} frames in {:.2f} s: {:.2f} per second ({:g} nominal)\n", p.frames, p.span_s(), p.rate_hz(),
               d.frames_per_s);
    fmt::print("age at arrival: median {:.2f} ms, 95 % {:.2f}, most {:.2f}\n", age.median, age.p95, age.most);
    fmt::print("gaps: {}, the longest of {} frames\n", p.gaps, p.longest_gap);
    auto const losses = p.losses();
    fmt::print("lost: {}\n", losses.empty() ? "nothing" : fmt::format("{}", fmt::join(losses, "; ")));
}

int run_replay(ReplayOptions const& o)
{
    auto const source = open(o.source, o.fast ? ar::Pace::fastest : ar::Pace::own, ar::Delivery::every);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    Played const p = play(*source, o, stop);
    if (o.json)
        fmt::print("{}", to_text(played_json(p, source->description())));
    else
        print(p, source->description());
    if (stop.requested()) return interrupted_code();
    return o.check && !p.losses().empty() ? 1 : 0;
}

} // namespace

void add_ar_replay(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<ReplayOptions>();
    CLI::App* const c =
        ar.add_subcommand("replay", "Play a recorded session or any source, and print the timing of its frames.");
    declare_source_arguments(*c, o->source);
    c->add_option("--frames", o->frames, "end after this many frames")->check(in_range(1, 1e9));
    c->add_option("--seconds", o->seconds, "end after this many seconds")->check(in_range(1e-3, 1e6));
    c->add_flag("--fast", o->fast, "read files as fast as possible");
    c->add_flag("--check", o->check, "exit code 1 if a frame was lost or damaged");
    c->add_flag("--json", o->json, "print JSON");
    c->footer(R"(Prepared by:
  lightwell ar record counter --out replayed --frames 10
Examples:
  lightwell ar replay replayed
  lightwell ar replay replayed --fast --json
  lightwell ar replay counter --frames 100 --fast --check)");
    c->callback([o, &exit_code] { exit_code = run_replay(*o); });
}

} // namespace viewer
