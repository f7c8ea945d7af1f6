#pragma once
// An experiment as its script describes it (schema study/2, docs/study/reference.md). Names are resolved: factors, levels,
// blocks and questionnaires are indices into the lists of the Script; -1 = none. Times are in milliseconds unless
// their names end in another unit.

#include "study/script/asked_question.h"
#include "study/script/procedure.h"
#include "study/script/questionnaire.h"
#include "study/script/sound.h"
#include "study/script/task.h"
#include "study/signals/gaze.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace study {

/// Renderer settings: keys and values as written in the script.
using Patch = std::vector<std::pair<std::string, std::string>>;

struct FactorLevel {
    std::string name;
    Patch settings;
};
struct Factor {
    std::string name;
    std::vector<FactorLevel> levels;
    Place place;
};
struct LevelChoice {
    int factor = 0, level = 0;
    bool operator==(LevelChoice const&) const = default;
};
/// Levels of some factors, each factor at most once.
using Choice = std::vector<LevelChoice>;

struct Participants {
    int count = 0;
    std::string id = "P{n:03}"; ///< {n} or {n:03}: the participant's number
    std::vector<AskedQuestion> ask;
    std::string consent; ///< a Markdown file, or the text; empty = none
    Place place;
};

enum class Vsync { required, record };
enum class OnsetMethod { automatic, oml, wp_presentation, openxr, swap_finish };
enum class BadTrial { keep, repeat_at_end };
enum class Corner { bottom_left, bottom_right, top_left, top_right };

struct SyncPatch {
    Corner corner = Corner::bottom_left;
    int px = 40;
};
struct Calibrate {
    int frames = 600;
    double max_sd_ms = 1,
           max_deviation = 0.1; ///< relative deviation of the mean period from the nominal one
};
struct Timing {
    Vsync vsync = Vsync::required;
    OnsetMethod onset = OnsetMethod::automatic;
    int max_dropped_frames = 0; ///< per stimulus interval
    BadTrial on_bad_trial = BadTrial::repeat_at_end;
    std::optional<SyncPatch> sync_patch;
    Calibrate calibrate;
    double display_lag_ms = 0;             ///< as measured by a photodiode: recorded, never subtracted
    double display_lag_uncertainty_ms = 0; ///< half the width of its 95 % interval
    double expected_hz = 60;               ///< for planning only
};

/// Timing of a trial, from the end of the previous one to its own end.
struct TrialTiming {
    int warmup_frames = 0;                 ///< rendered before a trial's first stimulus is shown
    double isi_ms = 500;                   ///< between the stimuli of a trial
    double iti_ms = 500;                   ///< between trials
    std::optional<double> stimulus_ms;     ///< of each stimulus; none = until the answer
    std::optional<double> timeout_ms;      ///< for the answer, from the last onset; none = no timeout
    double min_response_ms = 100;          ///< faster answers are anticipations: the trial is invalid; 0 = none
    std::optional<double> max_response_ms; ///< slower answers make it invalid; none = no limit
    std::optional<double> expected_response_ms; ///< for planning; none = the task's default
    double feedback_ms = 500;
};
enum class Stimuli { live, prepared };
struct Defaults {
    TrialTiming timing;
    std::string camera; ///< a camera of the scene, or path:NAME
    Stimuli stimuli = Stimuli::live;
    Patch settings;
    GazeRules gaze;
    std::vector<Cue> cues;
};

/// The inputs that give an answer: "key:left", "pad:x", "xr:left/trigger", "mouse:left".
struct Device {
    std::string answer;
    std::vector<std::string> inputs;
    Place place;
};

enum class Balance { fixed, alternate, latin, williams, random, between };
/// How the order of a factor's levels or of a group of blocks is counterbalanced,
/// or the level that a participant gets (between).
struct Counterbalance {
    std::string name;
    int factor = -1;
    std::vector<int> blocks; ///< of a group
    Balance method = Balance::fixed;
    Place place;
};

enum class SequenceKind { instructions, questionnaire, per, block, group, free_walk, rest };
struct SequenceItem {
    SequenceKind kind = SequenceKind::block;
    int index = -1;                  ///< questionnaire, factor of per, block, counterbalance
    std::string text;                ///< instructions: file or Markdown; prompt of free_walk and rest
    double seconds = 0;              ///< duration of free_walk; minimum of rest
    Choice choice;                   ///< of free_walk
    std::vector<SequenceItem> items; ///< of per
    Place place;
};

enum class PairOrder {
    balanced, ///< once per repeat; which item comes first is balanced within and between participants
    both,     ///< twice per repeat, in both orders
    random,   ///< once per repeat, in random order
    fixed,    ///< once per repeat, in the listed order
};
struct Pairs {
    int factor = -1;
    std::vector<std::pair<int, int>> pairs; ///< levels
    PairOrder order = PairOrder::balanced;
    int active_trials = 0; ///< of each cell, whose pairs are chosen during the session; 0 = the plan has all pairs
    bool is_tree = false;  ///< active: chosen for a spanning tree at a time; false: after each answer
    bool is_active() const { return active_trials > 0; }
};

/// A setting that QUEST+ varies besides the one of `vary`, in all stimuli of a trial alike.
struct FurtherSetting {
    std::string setting, name; ///< name: in formulas
    Scale scale = Scale::linear;
    double low = 0, high = 0;
    double usual = 0; ///< level in practice and catch trials
};

/// What is compared in tasks that have a correct answer, and what is adjusted in adjustment.
struct Compare {
    std::string vary; ///< the setting whose level is varied; empty: the levels of a factor are compared
    int factor = -1;
    std::vector<int> levels; ///< of the factor
    Choice against;          ///< levels of the other stimulus that differ from the condition
    Patch with;              ///< settings of the varied stimulus, overridden by the level
    Scale scale = Scale::linear;
    double low = 0, high = 0;
    std::vector<FurtherSetting> also;
    bool harder_up = true; ///< a higher level is harder to distinguish from the other stimulus
};

struct RatingScale {
    double low = 1, high = 7, step = 1;
    std::vector<std::pair<double, std::string>> labels;
};
struct Magnitude {
    double modulus = 0; ///< number assigned to the standard; 0 = free modulus
    Choice standard;
};

struct Nest {
    int factor = -1, within = -1;
    std::vector<std::vector<int>> levels; ///< of factor, by the level of `within`
};
enum class Shuffle { all, within_repeats, none };
struct Practice {
    int trials = 0;
    bool has_feedback = true;
    std::optional<double> level; ///< of the varied setting; none = the easiest
};
enum class CatchLevel { number, absent };
struct Catch {
    int every = 0; ///< one catch trial per `every` trials; 0 = none
    CatchLevel kind = CatchLevel::number;
    double level = 0;            ///< of the varied setting; unused by `absent`, where there is nothing to find
    int better = -1, worse = -1; ///< levels of the paired factor
    Place place;
};

enum class RuleKind { max_run, min_gap, never_after, not_first };
/// What a constraint on the trial order applies to: a factor, the pair of levels,
/// the correct answer, the procedure.
enum class Subject { factor, pair, answer, procedure };
struct Constraint {
    RuleKind kind = RuleKind::max_run;
    Subject subject = Subject::factor;
    int factor = -1;
    int count = 1;          ///< max_run: most equal trials in a row; min_gap: fewest other trials in between
    int from = -1, to = -1; ///< never_after: level `to` directly after `from`; not_first: level `to`
    Place place;
};

struct Block {
    std::string name;
    Task task = Task::pair;
    Place place;
    std::string prompt, instructions;
    std::optional<Pairs> pairs;
    std::optional<Compare> compare;
    int rank = -1; ///< factor
    std::vector<int> rank_levels;
    RatingScale scale;
    Magnitude magnitude;
    std::vector<Procedure> procedures;
    int questionnaire = -1;
    double duration_s = 60; ///< of free_walk

    std::vector<int> cross;
    std::vector<Nest> nest;
    std::vector<std::vector<int>> only; ///< by factor, allowed levels; empty = all
    int repeats = 1;
    Shuffle shuffle = Shuffle::all;
    std::vector<Constraint> constraints;

    Practice practice;
    bool has_feedback = false;
    bool may_tie = false; ///< of pairs: "neither" is an allowed answer
    bool is_sequential = false;
    Catch catches;
    int break_every = 0; ///< trials; 0 = no breaks
    double break_s = 30;
    TrialTiming timing;
    std::string camera;
    Stimuli stimuli = Stimuli::live;
    Patch settings;
    GazeRules gaze;
    std::vector<Cue> cues;
    bool knows_task = true; ///< false: its task is none
    bool is_broken = false; ///< read with mistakes: it cannot be planned
};

struct Record {
    std::string dir = "data";
    bool poses_by_frame = true;
    double head_pose_hz = 0; ///< used if poses are not recorded per frame; 0 = none
    std::vector<std::string> markers;
    bool compress_frames = false;
    std::string gaze; ///< where it comes from: lsl, lsl:NAME, openxr; empty = none
};
struct Resume {
    double max_gap_min = 60; ///< after a longer gap, the steps listed in `repeat` are shown again
    bool instructions = true, practice = true;
};

struct Script {
    std::string file; ///< name in messages
    int schema = 2;   ///< 1: written for version 0.1 of the program
    std::string id, title;
    std::uint64_t seed = 0;
    Participants participants;
    Timing timing;
    std::vector<Factor> factors;
    Choice reference;
    std::vector<Sound> sounds;
    Defaults defaults;
    std::vector<Device> devices;
    std::vector<Questionnaire> questionnaires; ///< built-in ones first, then those of the script
    std::vector<Counterbalance> counterbalances;
    std::vector<Block> blocks;
    std::vector<SequenceItem> sequence;
    Record record;
    Resume resume;
};

/// True if the text is the name of a Markdown file beside the script, not the text itself.
bool is_text_file(std::string const& text);

} // namespace study
