#include "study/script/keys.h"

namespace study {

std::map<std::string, std::set<std::string>> const& script_keys()
{
    static std::map<std::string, std::set<std::string>> const keys{
        {"study",
         {"schema", "id", "title", "seed", "participants", "timing", "factors", "reference", "defaults", "devices",
          "counterbalance", "sequence", "blocks", "questionnaires", "sounds", "record", "resume"}},
        {"participants", {"count", "id", "ask", "consent"}},
        {"ask", {"id", "text", "type", "min", "max", "whole", "choices"}},
        {"timing",
         {"vsync", "onset", "max_dropped_frames", "on_bad_trial", "sync_patch", "calibrate", "display_lag_ms",
          "display_lag_uncertainty_ms", "expected_hz"}},
        {"sync_patch", {"corner", "px"}},
        {"calibrate", {"frames", "max_sd_ms", "max_deviation"}},
        {"defaults",
         {"camera", "warmup_frames", "isi_ms", "iti_ms", "stimulus_ms", "timeout_ms", "min_response_ms",
          "max_response_ms", "expected_response_ms", "feedback_ms", "stimuli", "settings", "gaze", "cues"}},
        {"sound", {"tone_hz", "file", "duration_ms", "ramp_ms", "level_db", "channel"}},
        {"cue", {"sound", "at", "offset_ms"}},
        {"gaze", {"start", "hold", "follow"}},
        {"gaze_start", {"within_deg", "for_ms", "timeout_ms"}},
        {"gaze_hold", {"within_deg", "grace_ms"}},
        {"gaze_follow", {"show", "radius_deg", "edge_deg"}},
        {"counterbalance", {"method", "of"}},
        {"sequence_item", {"instructions", "questionnaire", "per", "do", "free_walk", "break"}},
        {"free_walk", {"duration_s", "prompt", "condition"}},
        {"break", {"min_s", "prompt"}},
        {"block",
         {"task",
          "prompt",
          "instructions",
          "cross",
          "nest",
          "only",
          "repeats",
          "shuffle",
          "constraints",
          "practice",
          "break_every",
          "break_s",
          "warmup_frames",
          "isi_ms",
          "iti_ms",
          "stimulus_ms",
          "timeout_ms",
          "min_response_ms",
          "max_response_ms",
          "expected_response_ms",
          "feedback_ms",
          "camera",
          "stimuli",
          "settings",
          "pairs",
          "ties",
          "presentation",
          "compare",
          "procedure",
          "interleave",
          "feedback",
          "catch",
          "rank",
          "scale",
          "modulus",
          "standard",
          "questionnaire",
          "duration_s",
          "gaze",
          "cues"}},
        {"pairs", {"factor", "omit", "list", "order", "sampling", "trials", "batch"}},
        {"rank", {"factor", "omit"}},
        {"compare", {"vary", "factor", "omit", "against", "with", "scale", "range", "harder", "also"}},
        {"also", {"name", "scale", "range", "usual"}},
        {"scale", {"min", "max", "step", "labels"}},
        {"nest", {"in", "levels"}},
        {"practice", {"trials", "feedback", "level"}},
        {"catch", {"every", "level", "better", "worse"}},
        {"constraint", {"no_repeat", "max_run", "min_gap", "of", "never_after", "not_first"}},
        {"constant", {"name", "method", "levels", "trials_per_level", "psychometric"}},
        {"staircase", {"name", "method", "up", "down", "target", "start", "steps", "psychometric", "stop"}},
        {"questplus",
         {"name", "method", "threshold", "slope", "guess", "lapse", "levels", "also", "parameters", "psychometric",
          "stop"}},
        {"adjustment", {"name", "method", "starts", "trials_per_level"}},
        {"stop", {"trials", "max_trials", "reversals"}},
        {"questionnaire", {"title", "instructions", "scale", "items", "scales"}},
        {"item",
         {"id", "text", "type", "required", "min", "max", "step", "labels", "reverse", "lines", "max_chars"}},
        {"subscale", {"items", "score", "weight", "offset", "at_least"}},
        {"record", {"dir", "head_pose_hz", "markers", "compress_frames", "gaze"}},
        {"resume", {"max_gap_min", "repeat"}},
    };
    return keys;
}

std::set<std::string> block_keys(Task task)
{
    std::set<std::string> keys{
        "task",    "prompt",      "instructions", "cross",   "nest",          "only",   "repeats",
        "shuffle", "constraints", "break_every",  "break_s", "warmup_frames", "iti_ms", "expected_response_ms",
        "camera",  "stimuli",     "settings"};
    TaskFacts const& f = facts(task);
    bool const is_preference = f.takes_pairs && !f.takes_compare;
    bool const shows_several = f.takes_pairs || task == Task::ranking || task == Task::two_interval;
    if (task == Task::questionnaire)
        keys.insert("questionnaire");
    else if (task == Task::free_walk)
        keys.insert("duration_s");
    else
        keys.insert(
            {"practice", "stimulus_ms", "timeout_ms", "min_response_ms", "max_response_ms", "gaze", "cues"});
    if (shows_several) keys.insert("isi_ms");
    if (shows_several && task != Task::two_interval) keys.insert("presentation"); // intervals follow each other
    if (f.takes_pairs) keys.insert({"pairs", "catch"});
    if (is_preference) keys.insert("ties");
    if (f.takes_compare) keys.insert({"compare", "procedure", "interleave", "catch"});
    if (!presented_orders(task, false).empty()) keys.insert({"feedback", "feedback_ms"});
    if (task == Task::adjustment) keys.erase("catch");
    if (task == Task::ranking) keys.insert("rank");
    if (task == Task::rating) keys.insert("scale");
    if (task == Task::magnitude) keys.insert({"modulus", "standard"});
    return keys;
}

} // namespace study
