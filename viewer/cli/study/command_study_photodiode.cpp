#include "gi/core/error.h"
#include "gi/core/file.h"
#include "study/journal/journal_file.h"
#include "study/signals/photodiode.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct PhotodiodeOptions {
    std::string file, session, clock = "own", out;
    study::DiodeSettings settings;
    int part = 1;
    bool json = false, sounds = false;
    double threshold = 0.05;
};

void add_sounds(study::TrialDone const& t, std::vector<study::ReportedOnset>& onsets)
{
    for (study::SoundPlayed const& s : t.sounds)
        if (s.onset_s)
            onsets.push_back({*s.onset_s, s.duration_s, 0, "sound",
                              fmt::format("step {} attempt {}, {} at {}", t.step + 1, t.attempt, s.sound, s.at)});
}

/// Onsets of one part of a session; stimuli that are shown together have one.
/// @param sounds instead of stimuli
std::vector<study::ReportedOnset> onsets_of(study::SessionRecord const& record, int wanted_part, bool sounds)
{
    std::vector<study::ReportedOnset> onsets;
    int part = 0;
    for (study::JournalEntry const& entry : record.entries) {
        if (auto const* const s = std::get_if<study::SessionStarted>(&entry)) part = s->part;
        auto const* const t = std::get_if<study::TrialDone>(&entry);
        if (t == nullptr || part != wanted_part) continue;
        if (sounds) {
            add_sounds(*t, onsets);
            continue;
        }
        for (study::StimulusShown const& s : t->shown) {
            if (!onsets.empty() && onsets.back().time_s == s.onset_s) {
                onsets.back().place += s.letter;
                continue;
            }
            onsets.push_back({s.onset_s, s.duration_s, s.onset_uncertainty_ms, s.onset_method,
                              fmt::format("step {} attempt {}, {}", t->step + 1, t->attempt, s.letter)});
        }
    }
    std::sort(onsets.begin(), onsets.end(), [](auto const& a, auto const& b) { return a.time_s < b.time_s; });
    return onsets;
}

nlohmann::ordered_json number(double v) { return std::isfinite(v) ? nlohmann::ordered_json(v) : nullptr; }

nlohmann::ordered_json to_json(study::DiodeResult const& r, std::vector<study::ReportedOnset> const& onsets)
{
    nlohmann::ordered_json j{{"onsets", onsets.size()},          {"flashes", r.found.flashes.size()},
                             {"matched", r.matched.size()},      {"missed", r.missed.size()},
                             {"doubled", r.doubled.size()},      {"extra", r.extra},
                             {"glitches", r.found.glitches},     {"noise", r.found.noise},
                             {"drift_ppm", number(r.drift_ppm)}, {"drift_se_ppm", number(r.drift_se_ppm)}};
    for (study::LagSummary const& s : r.methods)
        j["methods"].push_back({{"onset_method", s.method},
                                {"count", s.count},
                                {"lag_mean_ms", number(s.mean_ms)},
                                {"lag_mean_se_ms", number(s.mean_se_ms)},
                                {"jitter_sd_ms", number(s.sd_ms)},
                                {"p5_ms", s.p5_ms},
                                {"median_ms", s.median_ms},
                                {"p95_ms", s.p95_ms},
                                {"least_ms", s.least_ms},
                                {"most_ms", s.most_ms}});
    j["warnings"] = r.warnings;
    return j;
}

/// A row per onset, for figures elsewhere.
std::string table_text(study::DiodeResult const& r, std::vector<study::ReportedOnset> const& onsets)
{
    std::string text = "onset,onset_s,onset_method,state,lag_ms,flash_ms\n";
    std::vector<study::MatchedOnset const*> of(onsets.size());
    for (study::MatchedOnset const& m : r.matched) of[m.onset] = &m;
    for (std::size_t i = 0; i < onsets.size(); ++i) {
        bool const is_doubled = std::find(r.doubled.begin(), r.doubled.end(), i) != r.doubled.end();
        text += fmt::format("\"{}\",{:.6f},{},{},{},{}\n", onsets[i].place, onsets[i].time_s, onsets[i].method,
                            of[i] == nullptr ? "missed"
                            : is_doubled     ? "doubled"
                                             : "matched",
                            of[i] ? fmt::format("{:.4f}", of[i]->lag_ms) : "NA",
                            of[i] ? fmt::format("{:.3f}", of[i]->duration_ms) : "NA");
    }
    return text;
}

void print_result(study::DiodeResult const& r, std::vector<study::ReportedOnset> const& onsets,
                  study::DiodeClock clock, bool sounds)
{
    fmt::print("{} of {} onsets have a {}; {} missed, {} doubled, {} {} without an onset, {} glitches\n",
               r.matched.size(), onsets.size(), sounds ? "sound" : "flash", r.missed.size(), r.doubled.size(),
               r.extra, sounds ? "sounds" : "flashes", r.found.glitches);
    for (std::size_t const i : r.missed)
        fmt::print("  missed: {} at {:.3f} s\n", onsets[i].place, onsets[i].time_s);
    for (std::size_t const i : r.doubled)
        fmt::print("  doubled: {} at {:.3f} s\n", onsets[i].place, onsets[i].time_s);
    for (study::LagSummary const& s : r.methods) {
        std::string const mean =
            std::isfinite(s.mean_ms) ? fmt::format("lag {:.2f} ms (se {:.2f}), ", s.mean_ms, s.mean_se_ms) : "";
        fmt::print("{}: {} onsets, {}jitter {:.2f} ms (sd), 5 to 95 % {:.2f} to {:.2f}, all {:.2f} to {:.2f} ms\n",
                   s.method, s.count, mean, s.sd_ms, s.p5_ms, s.p95_ms, s.least_ms, s.most_ms);
    }
    fmt::print("drift of the {} {:+.1f} ppm (se {:.1f})\n",
               clock == study::DiodeClock::session ? "lag" : "recorder's clock", r.drift_ppm, r.drift_se_ppm);
    study::LagSummary const& last = r.methods.back();
    for (study::LagSummary const& s : r.methods)
        if (!sounds && std::isfinite(s.mean_ms) && (s.method == "all" || r.methods.size() == 1))
            fmt::print("in the script: timing: {{display_lag_ms: {:.2f}, display_lag_uncertainty_ms: {:.2f}}}\n",
                       s.mean_ms, 1.96 * last.mean_se_ms);
}

int run_photodiode(PhotodiodeOptions const& o)
{
    check_outputs({o.out}, {o.file});
    study::DiodeSettings settings = o.settings;
    settings.clock = o.clock == "session"   ? study::DiodeClock::session
                     : o.clock == "trigger" ? study::DiodeClock::trigger
                                            : study::DiodeClock::own;
    std::filesystem::path journal = o.session;
    if (std::filesystem::is_directory(journal)) journal /= "journal.jsonl";
    auto const onsets = onsets_of(study::read_journal(journal).record, o.part, o.sounds);
    if (onsets.empty())
        throw gi::InputError(fmt::format("{}: part {} has no onset", journal.string(), o.part),
                             "there is nothing to compare with", "name another --part");
    std::string const bytes = gi::read_text(o.file, std::size_t(4) << 30);
    study::DiodeSignal signal =
        bytes.starts_with("RIFF") ? study::read_wav(bytes, o.file) : study::read_diode_csv(bytes, o.file);
    if (o.sounds) signal = study::heard(std::move(signal), o.threshold, settings.hold_ms);
    study::DiodeResult const r = study::compare_with_onsets(signal, onsets, settings);
    if (!o.out.empty()) gi::write_text(o.out, table_text(r, onsets));
    if (o.json)
        std::fputs(to_text(to_json(r, onsets)).c_str(), stdout);
    else
        print_result(r, onsets, settings.clock, o.sounds);
    std::fflush(stdout);
    for (std::string const& w : r.warnings) std::fputs(("doubt: " + w + "\n").c_str(), stderr);
    return r.missed.empty() && r.doubled.empty() ? 0 : 1;
}

} // namespace

void add_study_photodiode(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<PhotodiodeOptions>();
    CLI::App* const c =
        study.add_subcommand("photodiode", "Compare a photodiode's signal, or recorded sounds, with a session's "
                                           "onsets: lag, jitter, missed ones, drift.");
    c->add_option("FILE", o->file, "recording: WAV (channel 1 photodiode, 2 trigger) or CSV (t_s,light,trigger)")
        ->required();
    c->add_option("--session", o->session, "folder of the session (.../beh), or its journal")->required();
    c->add_option("--part", o->part, "part of the session")->check(CLI::Range(1, 1000))->capture_default_str();
    c->add_option(
         "--clock", o->clock,
         "own: the recorder's; session: times of CLOCK_MONOTONIC of the same computer; trigger: the second "
         "channel marks the reported onsets")
        ->check(CLI::IsMember({"own", "session", "trigger"}))
        ->capture_default_str();
    c->add_option("--hold-ms", o->settings.hold_ms, "gaps and flashes that are shorter do not count")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    c->add_option("--most-lag-ms", o->settings.most_lag_ms, "a later flash belongs to no onset")
        ->check(CLI::Range(1.0, 10000.0))
        ->capture_default_str();
    c->add_flag("--sounds", o->sounds,
                "the recording is of sounds (loop-back cable, microphone): compare it with the onsets of cues");
    c->add_option("--threshold", o->threshold, "with --sounds: a sound begins at this share of the loudest sample")
        ->check(CLI::Range(0.001, 0.9))
        ->capture_default_str();
    c->add_option("--most-early-ms", o->settings.most_early_ms, "one that is earlier by more belongs to no onset")
        ->check(CLI::Range(0.0, 10000.0))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "file for a row per onset (CSV)");
    c->add_flag("--json", o->json, "print JSON");
    c->callback([o, &exit_code] { exit_code = run_photodiode(*o); });
    c->footer(R"(Example:
  lightwell study photodiode diode.wav --session data/sub-P001/ses-01/beh --clock trigger
  lightwell study photodiode loop.wav --sounds --session data/sub-P001/ses-01/beh

The photodiode is on timing.sync_patch, which is white while a stimulus is visible.
Exit codes: 0 every onset has one flash, 1 some have none or several, 2 the input or the call is wrong.)");
}

} // namespace viewer
