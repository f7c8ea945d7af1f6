#pragma once
// The fields of each kind of entry with their names in a journal, used for both writing and reading.

#include "study/journal/entries.h"

#include <concepts>

namespace study {

/// A field that was added later, and is written only if it has a value or is not empty: journals of earlier
/// versions do not have it.
struct LaterField {
    char const* name;
    operator char const*() const { return name; }
};

/// visit(entry, f) calls f(name, field) for each field in the order of the line.
template <class Entry>
struct Fields;

template <>
struct Fields<SessionStarted> {
    static constexpr char const* kKind = "session_started";
    static void visit(auto& e, auto&& f)
    {
        f("experiment", e.experiment);
        f("participant_id", e.participant_id);
        f("participant", e.participant);
        f("session", e.session);
        f("part", e.part);
        f("utc", e.utc);
        f("clock_s", e.clock_s);
        f("version", e.version);
        f("git_hash", e.git_hash);
        f("script_sha256", e.script_sha256);
        f("plan_sha256", e.plan_sha256);
        f("seed", e.seed);
        f("consent_sha256", e.consent_sha256);
        f("about", e.about);
        f("is_simulated", e.is_simulated);
        f("gap_s", e.gap_s);
    }
};

template <>
struct Fields<CalibrationDone> {
    static constexpr char const* kKind = "calibration_done";
    static void visit(auto& e, auto&& f)
    {
        f("frames", e.frames);
        f("nominal_hz", e.nominal_hz);
        f("period_mean_ms", e.period_mean_ms);
        f("period_sd_ms", e.period_sd_ms);
        f("onset_method", e.onset_method);
        f("passed", e.passed);
        f("reason", e.reason);
    }
};

template <>
struct Fields<StimulusShown> {
    static void visit(auto& e, auto&& f)
    {
        f("letter", e.letter);
        f("onset_s", e.onset_s);
        f("duration_s", e.duration_s);
        f("onset_method", e.onset_method);
        f("onset_uncertainty_ms", e.onset_uncertainty_ms);
        f("frames_planned", e.frames_planned);
        f("frames_shown", e.frames_shown);
        f("frames_dropped", e.frames_dropped);
        f("render_ms_mean", e.render_ms_mean);
        f("render_ms_p99", e.render_ms_p99);
        f("settings_sha256", e.settings_sha256);
        f(LaterField{"mean_cd_m2"}, e.mean_cd_m2);
        f(LaterField{"peak_cd_m2"}, e.peak_cd_m2);
        f(LaterField{"clipped_pixels"}, e.clipped_pixels);
        f(LaterField{"width_deg"}, e.width_deg);
        f(LaterField{"height_deg"}, e.height_deg);
        f(LaterField{"left_px"}, e.left_px);
        f(LaterField{"top_px"}, e.top_px);
        f(LaterField{"width_px"}, e.width_px);
        f(LaterField{"height_px"}, e.height_px);
        f(LaterField{"frames_kind"}, e.frames_kind);
        f(LaterField{"frames_drawn"}, e.frames_drawn);
        f(LaterField{"light_age_ms"}, e.light_age_ms);
    }
};

template <>
struct Fields<SoundPlayed> {
    static void visit(auto& e, auto&& f)
    {
        f("sound", e.sound);
        f("at", e.at);
        f("event_s", e.event_s);
        f("offset_ms", e.offset_ms);
        f("onset_s", e.onset_s);
        f("duration_s", e.duration_s);
        f("underruns", e.underruns);
        f("missing", e.missing);
    }
};

template <>
struct Fields<TrialDone> {
    static constexpr char const* kKind = "trial_done";
    static void visit(auto& e, auto&& f)
    {
        f("step", e.step);
        f("attempt", e.attempt);
        f("shown", e.shown);
        f("level", e.level);
        f("response", e.response);
        f("value", e.value);
        f("is_correct", e.is_correct);
        f("response_s", e.response_s);
        f("reaction_ms", e.reaction_ms);
        f("response_uncertainty_ms", e.response_uncertainty_ms);
        f("device", e.device);
        f("is_valid", e.is_valid);
        f("reason", e.reason);
        f("bookkeeping_ms", e.bookkeeping_ms);
        f(LaterField{"gaze_samples"}, e.gaze_samples);
        f(LaterField{"gaze_valid"}, e.gaze_valid);
        f(LaterField{"gaze_dropped"}, e.gaze_dropped);
        f(LaterField{"gaze_fixating"}, e.gaze_fixating);
        f(LaterField{"chosen"}, e.chosen);
        f(LaterField{"sounds"}, e.sounds);
    }
};

template <>
struct Fields<StepDone> {
    static constexpr char const* kKind = "step_done";
    static void visit(auto& e, auto&& f)
    {
        f("step", e.step);
        f("start_s", e.start_s);
        f("end_s", e.end_s);
        f("reason", e.reason);
    }
};

template <>
struct Fields<ItemAnswered> {
    static constexpr char const* kKind = "item_answered";
    static void visit(auto& e, auto&& f)
    {
        f("step", e.step);
        f("time_s", e.time_s);
        f("item", e.item);
        f("answer", e.answer);
        f("text", e.text);
    }
};

template <>
struct Fields<QuestionnaireDone> {
    static constexpr char const* kKind = "questionnaire_done";
    static void visit(auto& e, auto&& f)
    {
        f("step", e.step);
        f("start_s", e.start_s);
        f("end_s", e.end_s);
        f("answers", e.answers);
        f(LaterField{"texts"}, e.texts);
    }
};

template <>
struct Fields<ParticipantAsked> {
    static constexpr char const* kKind = "participant_asked";
    static void visit(auto& e, auto&& f) { f("answers", e.answers); }
};

template <>
struct Fields<NoteTaken> {
    static constexpr char const* kKind = "note_taken";
    static void visit(auto& e, auto&& f)
    {
        f("time_s", e.time_s);
        f("note_kind", e.kind);
        f("text", e.text);
    }
};

template <>
struct Fields<SessionEnded> {
    static constexpr char const* kKind = "session_ended";
    static void visit(auto& e, auto&& f)
    {
        f("time_s", e.time_s);
        f("utc", e.utc);
        f("is_complete", e.is_complete);
        f("reason", e.reason);
    }
};

/// Parts of entries, which have fields of their own.
template <class T>
concept EntryPart = std::same_as<T, StimulusShown> || std::same_as<T, SoundPlayed>;

} // namespace study
