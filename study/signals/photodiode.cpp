#include "study/signals/photodiode.h"

#include "gi/core/error.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace study {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Levels {
    double dark = 0, bright = 0, noise = 0;
};

/// Two means of the values (Lloyd's iteration from the extremes).
Levels two_levels(std::vector<double> const& v)
{
    auto const [low, high] = std::minmax_element(v.begin(), v.end());
    Levels l{*low, *high, 0};
    for (int i = 0; i < 50; ++i) {
        double const middle = 0.5 * (l.dark + l.bright);
        double sums[2]{}, counts[2]{};
        for (double const x : v) {
            sums[x > middle] += x;
            counts[x > middle] += 1;
        }
        if (counts[0] == 0 || counts[1] == 0) break;
        double const dark = sums[0] / counts[0], bright = sums[1] / counts[1];
        if (dark == l.dark && bright == l.bright) break;
        l.dark = dark;
        l.bright = bright;
    }
    double const middle = 0.5 * (l.dark + l.bright);
    std::vector<double> off;
    for (double const x : v) off.push_back(std::abs(x - (x > middle ? l.bright : l.dark)));
    l.noise = 1.4826 * gi::median(off) / (l.bright - l.dark); // edges count little
    return l;
}

struct Line {
    double at_mean = 0, slope = 0, slope_se = 0, mean_x = 0;
    double at(double x) const { return at_mean + slope * (x - mean_x); }
};
/// Least squares.
Line line_through(std::vector<double> const& x, std::vector<double> const& y)
{
    Line l;
    double const n = double(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        l.mean_x += x[i] / n;
        l.at_mean += y[i] / n;
    }
    double xx = 0, xy = 0, ee = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - l.mean_x) * (x[i] - l.mean_x);
        xy += (x[i] - l.mean_x) * (y[i] - l.at_mean);
    }
    if (xx > 0) l.slope = xy / xx;
    for (std::size_t i = 0; i < x.size(); ++i) ee += std::pow(y[i] - l.at(x[i]), 2);
    l.slope_se = xx > 0 && n > 2 ? std::sqrt(ee / (n - 2) / xx) : kNone;
    return l;
}

/// The offset (recorder - session) for which most of the first onsets have a flash.
/// Every difference between the first flashes and onsets votes; differences within the tolerance count together.
double first_offset(std::vector<Flash> const& flashes, std::vector<ReportedOnset> const& onsets)
{
    constexpr std::size_t kFirst = 40;
    constexpr double kTolerance_s = 0.02;
    std::vector<double> votes;
    std::size_t const n = std::min(onsets.size(), kFirst), m = std::min(flashes.size(), 3 * kFirst);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < m; ++k) votes.push_back(flashes[k].start_s - onsets[i].time_s);
    std::sort(votes.begin(), votes.end());
    std::size_t best = 0, from = 0, best_from = 0;
    for (std::size_t to = 0; to < votes.size(); ++to) {
        while (votes[to] - votes[from] > kTolerance_s) ++from;
        if (to - from + 1 > best) {
            best = to - from + 1;
            best_from = from;
        }
    }
    if (best < std::max<std::size_t>(2, n / 3))
        throw gi::InputError(fmt::format("the flashes do not fit the onsets ({} of the first {} agree)", best, n),
                             "the recording may be of another session or part, or the diode is not on the patch",
                             "check --session and --part, or record from before the first trial");
    return votes[best_from + best / 2];
}

void summarise(DiodeResult& r, std::vector<ReportedOnset> const& onsets, bool has_mean)
{
    std::map<std::string, std::vector<double>> by_method;
    for (MatchedOnset const& m : r.matched) by_method[onsets[m.onset].method].push_back(m.lag_ms);
    if (by_method.size() > 1)
        for (MatchedOnset const& m : r.matched) by_method["all"].push_back(m.lag_ms);
    for (auto& [method, lags] : by_method) {
        LagSummary s;
        s.method = method;
        s.count = int(lags.size());
        double mean = 0, squares = 0;
        for (double const v : lags) mean += v / double(lags.size());
        for (double const v : lags) squares += (v - mean) * (v - mean);
        s.sd_ms = lags.size() > 1 ? std::sqrt(squares / double(lags.size() - 1)) : kNone;
        s.mean_ms = has_mean ? mean : kNone;
        s.mean_se_ms = has_mean ? s.sd_ms / std::sqrt(double(lags.size())) : kNone;
        std::vector<double> const sorted = gi::sorted_values(lags);
        auto const at = [&](double p) { return gi::quantile_of_sorted(sorted, p); };
        s.least_ms = sorted.front();
        s.p5_ms = at(0.05);
        s.median_ms = at(0.5);
        s.p95_ms = at(0.95);
        s.most_ms = sorted.back();
        r.methods.push_back(s);
    }
}

} // namespace

FlashesFound find_flashes(std::vector<double> const& time_s, std::vector<double> const& light, double hold_ms)
{
    if (light.size() < 3 || light.size() != time_s.size())
        throw gi::InputError(fmt::format("{} samples", light.size()), "a signal has more", "record longer");
    Levels const l = two_levels(light);
    if (!(l.bright > l.dark) || l.noise > 0.25)
        throw gi::InputError(fmt::format("the signal does not have two levels (noise {:.0f} % of its range)",
                                         100 * (l.bright > l.dark ? l.noise : 1)),
                             "flashes cannot be told from noise",
                             "check the cable, the gain, and that the diode is on "
                             "the patch");
    FlashesFound out{{}, l.dark, l.bright, l.noise, 0};
    double const middle = 0.5 * (l.dark + l.bright), beyond = 0.25 * (l.bright - l.dark), hold_s = 1e-3 * hold_ms;
    std::vector<Flash> raw;
    bool is_bright = light[0] > middle;
    if (is_bright) raw.push_back({time_s[0], time_s.back()});
    double crossed_s = time_s[0]; // the last crossing of the middle
    for (std::size_t i = 1; i < light.size(); ++i) {
        if ((light[i] > middle) != (light[i - 1] > middle))
            crossed_s =
                time_s[i - 1] + (time_s[i] - time_s[i - 1]) * (middle - light[i - 1]) / (light[i] - light[i - 1]);
        bool const changes = is_bright ? light[i] < middle - beyond : light[i] > middle + beyond;
        if (!changes) continue;
        is_bright = !is_bright;
        if (is_bright)
            raw.push_back({crossed_s, time_s.back()});
        else
            raw.back().end_s = crossed_s;
    }
    for (Flash const& f : raw) { // gaps that are too short join their neighbours
        if (!out.flashes.empty() && f.start_s - out.flashes.back().end_s < hold_s)
            out.flashes.back().end_s = f.end_s;
        else
            out.flashes.push_back(f);
    }
    out.glitches = int(std::erase_if(out.flashes, [&](Flash const& f) { return f.end_s - f.start_s < hold_s; }));
    return out;
}

DiodeResult compare_with_onsets(DiodeSignal const& signal, std::vector<ReportedOnset> const& onsets,
                                DiodeSettings const& s)
{
    if (onsets.empty())
        throw gi::InputError("the session has no onset", "there is nothing to compare with",
                             "name another --part");
    DiodeResult r;
    r.found = find_flashes(signal.time_s, signal.light, s.hold_ms);
    std::vector<Flash> const& flashes = r.found.flashes;
    if (flashes.empty())
        throw gi::InputError("no flash in the signal", "the patch is white while a stimulus is visible",
                             "write timing: {sync_patch: {px: 60}} in the script, and put the diode on it");
    bool const has_mean = s.clock != DiodeClock::own;
    // The recorder's time of each reported onset: by the offset that is tracked along, or by its trigger.
    std::vector<Flash> triggers;
    if (s.clock == DiodeClock::trigger) {
        if (signal.trigger.empty())
            throw gi::InputError("the recording has no trigger channel", "--clock trigger compares with it",
                                 "record two channels, or use --clock own");
        triggers = find_flashes(signal.time_s, signal.trigger, 0).flashes;
        if (triggers.empty()) throw gi::InputError("no trigger in the second channel", "", "check the cable");
    }
    bool const is_tracked = s.clock != DiodeClock::session;
    double offset_s = is_tracked ? first_offset(s.clock == DiodeClock::trigger ? triggers : flashes, onsets) : 0;
    double const early_s = 1e-3 * s.most_early_ms, late_s = 1e-3 * s.most_lag_ms;
    std::vector<char> taken(flashes.size());
    std::vector<double> session_s, recorder_s, lag_s; // of matched onsets
    std::vector<std::size_t> of;
    std::size_t k = 0, t = 0;
    for (std::size_t i = 0; i < onsets.size(); ++i) {
        double expected_s = onsets[i].time_s + offset_s;
        if (s.clock == DiodeClock::trigger) {
            while (t < triggers.size() && triggers[t].start_s < expected_s - early_s) ++t;
            if (t == triggers.size() || triggers[t].start_s > expected_s + early_s) {
                r.missed.push_back(i);
                continue;
            }
            offset_s += triggers[t].start_s - expected_s;
            expected_s = triggers[t].start_s;
        }
        double const end_s =
            std::min(expected_s + late_s, i + 1 < onsets.size() ? onsets[i + 1].time_s + offset_s - early_s
                                                                : std::numeric_limits<double>::max());
        while (k < flashes.size() && flashes[k].start_s < expected_s - early_s) ++k;
        if (k == flashes.size() || flashes[k].start_s > std::max(end_s, expected_s + early_s)) {
            r.missed.push_back(i);
            continue;
        }
        taken[k] = 1;
        session_s.push_back(onsets[i].time_s);
        recorder_s.push_back(s.clock == DiodeClock::trigger ? expected_s : flashes[k].start_s);
        lag_s.push_back(flashes[k].start_s - expected_s);
        of.push_back(i);
        r.matched.push_back({i, 0, 1e3 * (flashes[k].end_s - flashes[k].start_s)});
        // Clocks drift: the next onset is looked for where the last ones were.
        if (s.clock == DiodeClock::own) offset_s += 0.2 * std::clamp(lag_s.back(), -0.02, 0.02);
        bool is_doubled = false;
        double const until_s = expected_s + std::max(onsets[i].duration_s, late_s) - early_s;
        for (std::size_t n = k + 1; n < flashes.size() && flashes[n].start_s < std::min(until_s, end_s); ++n) {
            taken[n] = 1;
            is_doubled = true;
        }
        if (is_doubled) r.doubled.push_back(i);
        ++k;
    }
    r.extra = int(std::count(taken.begin(), taken.end(), 0));
    if (r.matched.size() < 2)
        throw gi::InputError(fmt::format("{} of {} onsets have a flash", r.matched.size(), onsets.size()),
                             "there is nothing to measure", "check --clock, and that the diode is on the patch");
    std::vector<double> difference_s; // recorder - session
    for (std::size_t i = 0; i < session_s.size(); ++i) difference_s.push_back(recorder_s[i] - session_s[i]);
    Line const line = line_through(session_s, difference_s);
    r.drift_ppm = 1e6 * line.slope;
    r.drift_se_ppm = 1e6 * line.slope_se;
    if (is_tracked) r.offset_s = line.at(0);
    for (std::size_t i = 0; i < r.matched.size(); ++i)
        r.matched[i].lag_ms =
            1e3 * (s.clock == DiodeClock::own ? difference_s[i] - line.at(session_s[i]) : lag_s[i]);
    summarise(r, onsets, has_mean);
    if (signal.rate_hz > 0 && signal.rate_hz < 1000)
        r.warnings.push_back(fmt::format("{:.0f} samples a second: lags are no better than {:.1f} ms",
                                         signal.rate_hz, 500 / signal.rate_hz));
    if (!has_mean)
        r.warnings.emplace_back(
            "the recorder has its own clock: jitter and drift are measured, the mean lag is not "
            "(record a trigger channel, or samples with the session's clock)");
    if (r.found.noise > 0.1)
        r.warnings.push_back(fmt::format("noise of {:.0f} % of the flashes' height", 100 * r.found.noise));
    return r;
}

} // namespace study
