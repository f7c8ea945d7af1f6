// Fixations and saccades found in simulated gaze, against those that were simulated.

#include "study/gaze/clean_gaze.h"
#include "study/gaze/gaze_events.h"
#include "tests/study_gaze/simulated_gaze.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace study::test {
namespace {

struct Scores {
    double recall = 0, precision = 0;
    double start_ms = 0, length_ms = 0; ///< mean errors: found - true
    double amplitude_deg = 0;           ///< rms error
    double peak = 0;                    ///< mean ratio, found to true
};

double overlap(double a0, double a1, double b0, double b1)
{
    return std::max(0.0, std::min(a1, b1) - std::max(a0, b0)) / (std::max(a1, b1) - std::min(a0, b0));
}

/// Events match if they share more than `least` of the time that either takes, which makes pairs unique for 1/2.
template <class True, class Found, class Each>
Scores matched(std::vector<True> const& truth, std::vector<Found> const& found, double least, Each const& each)
{
    Scores s;
    int n = 0;
    std::vector<bool> taken(found.size());
    for (True const& t : truth) {
        std::size_t best = found.size();
        double most = least;
        for (std::size_t f = 0; f < found.size(); ++f)
            if (double const o = overlap(t.start_s, t.end_s, found[f].start_s, found[f].end_s); !taken[f] && o > most) {
                most = o;
                best = f;
            }
        if (best == found.size()) continue;
        taken[best] = true;
        ++n;
        s.start_ms += 1e3 * (found[best].start_s - t.start_s);
        s.length_ms += 1e3 * (found[best].end_s - found[best].start_s - t.end_s + t.start_s);
        each(t, found[best], s);
    }
    s.recall = double(n) / double(truth.size());
    s.precision = double(n) / double(found.size());
    for (double* v : {&s.start_ms, &s.length_ms, &s.amplitude_deg, &s.peak}) *v /= n;
    s.amplitude_deg = std::sqrt(s.amplitude_deg);
    return s;
}

struct Found {
    Scores fixations, saccades;
    GazeEvents events;
};

Found found_in(SimulatedGaze const& gaze, GazeEventSettings const& settings)
{
    GazeCounts counts;
    Found f;
    f.events = find_gaze_events(clean_gaze(gaze.samples, kGazeScreen, counts), kGazeScreen, settings);
    f.fixations = matched(gaze.fixations, f.events.fixations, 0.5, [](auto&, auto&, Scores&) {});
    f.saccades = matched(gaze.saccades, f.events.saccades, 0.2,
                         [](SimulatedGaze::Saccade const& t, Saccade const& g, Scores& s) {
                             s.amplitude_deg += std::pow(g.amplitude_deg - t.amplitude_deg, 2);
                             s.peak += g.peak_deg_s / t.peak_deg_s;
                         });
    return f;
}

struct Case {
    double rate_hz, noise_deg, jitter, dropped;
    double least; ///< of recall and precision
};

TEST(GazeEvents, AreThoseSimulated)
{
    fmt::print("{:>5} {:>7} {:>6} {:>5} | {:>5} fixations: {:>6} {:>6} {:>7} {:>8} | saccades: {:>6} {:>6} {:>8} {:>5}\n",
               "Hz", "noise", "jitter", "lost", "", "recall", "prec.", "start", "length", "recall", "prec.", "rms deg",
               "peak");
    for (Case const& c : {Case{60, 0.05, 0, 0, 0.95},
                          {60, 0.3, 0.2, 0, 0.9},
                          {120, 0.1, 0, 0.02, 0.9},
                          {250, 0.05, 0.2, 0, 0.95},
                          {250, 0.2, 0, 0, 0.95},
                          {500, 0.05, 0, 0, 0.97},
                          {500, 0.3, 0, 0, 0.9},
                          {1000, 0.05, 0, 0.01, 0.97},
                          {1000, 0.3, 0.2, 0, 0.95}}) {
        SimulatedGazeSettings set;
        set.rate_hz = c.rate_hz;
        set.noise_deg = c.noise_deg;
        set.jitter = c.jitter;
        set.dropped = c.dropped;
        set.length_s = 120;
        SimulatedGaze const gaze = simulated_gaze(set);
        for (GazeMethod const method : {GazeMethod::ivt, GazeMethod::idt}) {
            GazeEventSettings settings;
            settings.method = method;
            if (method == GazeMethod::idt) settings.dispersion_deg = 1 + 4 * c.noise_deg;
            Found const f = found_in(gaze, settings);
            fmt::print("{:5} {:7} {:6} {:5} | {:>5} fixations: {:6.3f} {:6.3f} {:6.1f} ms {:6.1f} ms | saccades: {:6.3f} "
                       "{:6.3f} {:8.3f} {:5.2f}\n",
                       c.rate_hz, c.noise_deg, c.jitter, c.dropped, method == GazeMethod::ivt ? "I-VT" : "I-DT",
                       f.fixations.recall, f.fixations.precision, f.fixations.start_ms, f.fixations.length_ms,
                       f.saccades.recall, f.saccades.precision, f.saccades.amplitude_deg, f.saccades.peak);
            // The extent of a fixation grows with noise and rate, until no threshold tells it from a small saccade.
            if (method == GazeMethod::idt && c.noise_deg > 0.1) continue;
            double const least = method == GazeMethod::ivt ? c.least : c.least - 0.1;
            EXPECT_GE(f.fixations.recall, least);
            EXPECT_GE(f.fixations.precision, least);
            if (method == GazeMethod::idt) continue;
            EXPECT_GE(f.saccades.recall, c.least);
            EXPECT_GE(f.saccades.precision, c.least);
            EXPECT_NEAR(f.fixations.start_ms, 0, 1e3 / c.rate_hz);
        }
    }
}

TEST(GazeEvents, HaveExactAngles)
{
    // A jump of 100 px is 2.77 degrees at the centre and less at the edge.
    std::vector<GazeSample> samples;
    for (int i = 0; i < 100; ++i) samples.push_back({0.01 * i, i < 50 ? 800.0 : 900.0, 0, NAN, true});
    GazeEvents const e = find_gaze_events(samples, kGazeScreen, {});
    ASSERT_EQ(e.saccades.size(), 1u);
    ASSERT_EQ(e.fixations.size(), 2u);
    double const cm = 53.1 / 1920;
    double const deg = (std::atan(900 * cm / 57.3) - std::atan(800 * cm / 57.3)) * 180 / 3.141592653589793;
    EXPECT_NEAR(e.saccades[0].amplitude_deg, deg, 1e-9);
    EXPECT_LT(deg, 2.4);
    EXPECT_DOUBLE_EQ(e.fixations[0].x_px, 800);
    EXPECT_NEAR(e.fixations[0].end_s, e.saccades[0].start_s, 1e-12);
    EXPECT_NEAR(e.saccades[0].end_s, e.fixations[1].start_s, 1e-12);
    EXPECT_TRUE(e.fixations[0].is_cut) << "it may have begun before the recording";
    EXPECT_FALSE(e.saccades[0].is_cut);
}

TEST(GazeEvents, FixationsThatTouchHaveASaccadeByDispersion)
{
    std::vector<GazeSample> samples;
    for (int i = 0; i < 100; ++i) samples.push_back({0.01 * i, i < 50 ? 0.0 : 300.0, 0, NAN, true});
    GazeEventSettings settings;
    settings.method = GazeMethod::idt;
    GazeEvents const e = find_gaze_events(samples, kGazeScreen, settings);
    ASSERT_EQ(e.fixations.size(), 2u);
    ASSERT_EQ(e.saccades.size(), 1u);
    EXPECT_TRUE(e.saccades[0].is_cut) << "its duration is unknown";
    EXPECT_NEAR(e.saccades[0].amplitude_deg, deg_between(kGazeScreen, {0, 0}, {300, 0}), 1e-9);
}

/// Gaze at rest, 500 Hz, without samples from 0.4 s for so long; afterwards moved by some degrees.
GazeEvents with_loss(double lost_s, double moved_deg, bool leaves_out)
{
    std::vector<GazeSample> samples;
    for (int i = 0; i < 500; ++i) {
        double const t = 0.002 * i;
        bool const is_lost = t >= 0.4 && t < 0.4 + lost_s;
        if (!is_lost || !leaves_out)
            samples.push_back({t, px_of_direction(t < 0.4 ? 0 : moved_deg, 0).first, 0, NAN, !is_lost});
    }
    return find_gaze_events(samples, kGazeScreen, {});
}

TEST(GazeEvents, BridgeShortLossesOfGazeAtRest)
{
    for (bool const leaves_out : {false, true}) {
        GazeEvents const blink = with_loss(0.12, 0, leaves_out);
        EXPECT_EQ(blink.fixations.size(), 2u);
        EXPECT_EQ(blink.saccades.size(), 0u);
        ASSERT_EQ(blink.losses.size(), 1u);
        EXPECT_NEAR(blink.losses[0].end_s - blink.losses[0].start_s, 0.12, 1e-9);
        EXPECT_TRUE(blink.fixations[0].is_cut && blink.fixations[1].is_cut);

        GazeEvents const flicker = with_loss(0.06, 0.2, leaves_out);
        EXPECT_EQ(flicker.fixations.size(), 1u);
        EXPECT_EQ(flicker.bridged, 1);
        EXPECT_TRUE(flicker.losses.empty());

        GazeEvents const moved = with_loss(0.06, 4, leaves_out);
        EXPECT_EQ(moved.fixations.size(), 2u);
        EXPECT_EQ(moved.saccades.size(), 0u) << "nobody has seen it";
        EXPECT_EQ(moved.losses.size(), 1u);
    }
}

TEST(GazeEvents, OfNothingAreNone)
{
    EXPECT_TRUE(find_gaze_events({}, kGazeScreen, {}).fixations.empty());
    std::vector<GazeSample> lost(50);
    for (int i = 0; i < 50; ++i) lost[std::size_t(i)].time_s = 0.01 * i;
    EXPECT_TRUE(find_gaze_events(lost, kGazeScreen, {}).fixations.empty());
    lost[20].is_valid = true;
    GazeEvents const alone = find_gaze_events(lost, kGazeScreen, {});
    EXPECT_TRUE(alone.fixations.empty());
    EXPECT_EQ(alone.alone, 1);
}

} // namespace
} // namespace study::test
