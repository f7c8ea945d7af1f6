#pragma once
// An experiment as its script says it (schema study/1, docs/study.md). Names are resolved: factors, levels, blocks
// and questionnaires are indices into the lists of the Script; -1 = none. Times are in milliseconds unless their
// names say otherwise.

#include "study/script/procedure.h"
#include "study/script/questionnaire.h"
#include "study/script/task.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace study {

/// Settings of the renderer: keys and values as they are written.
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
    std::vector<std::string> ask;
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
           max_deviation = 0.1; ///< deviation: of the mean period from the nominal one, as its share
};
struct Timing {
    Vsync vsync = Vsync::required;
    OnsetMethod onset = OnsetMethod::automatic;
    int max_dropped_frames = 0; ///< in a stimulus interval
    BadTrial on_bad_trial = BadTrial::repeat_at_end;
    std::optional<SyncPatch> sync_patch;
    Calibrate calibrate;
    double display_lag_ms = 0; ///< as measured by a photodiode: recorded, never subtracted
    double expected_hz = 60;   ///< for planning only
};

/// How a trial runs, from the end of the one before to its own.
struct TrialTiming {
    int warmup_frames = 0;                      ///< rendered before a trial's first stimulus is shown
    double isi_ms = 500;                        ///< between the stimuli of a trial
    double iti_ms = 500;                        ///< between trials
    std::optional<double> stimulus_ms;          ///< each; none = until the answer
    std::optional<double> timeout_ms;           ///< for the answer, from the last onset; none = waits
    std::optional<double> expected_response_ms; ///< for planning; none = what is usual for the task
    double feedback_ms = 500;
};
enum class Stimuli { live, prepared };
struct Defaults {
    TrialTiming timing;
    std::string camera; ///< a camera of the scene, or path:NAME
    Stimuli stimuli = Stimuli::live;
    Patch settings;
};

/// The inputs that give an answer: "key:left", "pad:x", "xr:left/trigger", "mouse:left".
struct Device {
    std::string answer;
    std::vector<std::string> inputs;
    Place place;
};

enum class Balance { fixed, alternate, latin, williams, random, between };
/// The order of a factor's levels, or of a group of blocks; or who sees which level.
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
    double seconds = 0;              ///< of free_walk; least of rest
    Choice choice;                   ///< of free_walk
    std::vector<SequenceItem> items; ///< of per
    Place place;
};

enum class PairOrder {
    balanced, ///< once a repeat; who comes first is balanced within and between participants
    both,     ///< twice a repeat, in both orders
    random,   ///< once, by chance
    fixed,    ///< once, as listed
};
struct Pairs {
    int factor = -1;
    std::vector<std::pair<int, int>> pairs; ///< levels
    PairOrder order = PairOrder::balanced;
};

/// What is compared with what in tasks that have a right answer, and what is set in adjustment.
struct Compare {
    std::string vary; ///< the setting whose level is varied; empty: the levels of a factor are compared
    int factor = -1;
    std::vector<int> levels; ///< of the factor
    Choice against;          ///< what of the other stimulus differs from the condition
    Patch with;              ///< of the stimulus that is varied, under the level
    Scale scale = Scale::linear;
    double low = 0, high = 0;
    bool harder_up = true; ///< a higher level is harder to tell from the other
};

struct RatingScale {
    double low = 1, high = 7, step = 1;
    std::vector<std::pair<double, std::string>> labels;
};
struct Magnitude {
    double modulus = 0; ///< the number of the standard; 0 = free
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
    std::optional<double> level; ///< of what is varied; none = the easiest
};
enum class CatchLevel { number, absent };
struct Catch {
    int every = 0; ///< one for so many trials; 0 = none
    CatchLevel kind = CatchLevel::number;
    double level = 0;            ///< of what is varied; absent: there is nothing to find
    int better = -1, worse = -1; ///< levels of the factor that is paired
    Place place;
};

enum class RuleKind { max_run, min_gap, never_after, not_first };
/// Of what trials must not be the same: a factor, the pair of levels, the right answer or the procedure.
enum class Subject { factor, pair, answer, procedure };
struct Constraint {
    RuleKind kind = RuleKind::max_run;
    Subject subject = Subject::factor;
    int factor = -1;
    int count = 1;          ///< max_run: so many in a row at most; min_gap: so many others in between at least
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
    std::vector<std::vector<int>> only; ///< by factor, levels that may be; empty = all
    int repeats = 1;
    Shuffle shuffle = Shuffle::all;
    std::vector<Constraint> constraints;

    Practice practice;
    bool has_feedback = false;
    bool may_tie = false; ///< of pairs: "neither" is an answer
    bool is_sequential = false;
    Catch catches;
    int break_every = 0; ///< trials; 0 = no breaks
    double break_s = 30;
    TrialTiming timing;
    std::string camera;
    Stimuli stimuli = Stimuli::live;
    Patch settings;
};

struct Record {
    std::string dir = "data";
    bool poses_by_frame = true;
    double head_pose_hz = 0; ///< where not by frame; 0 = none
    std::vector<std::string> markers;
    bool compress_frames = false;
};
struct Resume {
    double max_gap_min = 60; ///< longer: what `repeat` says comes again
    bool instructions = true, practice = true;
};

struct Script {
    std::string file; ///< as named in messages
    std::string id, title;
    std::uint64_t seed = 0;
    Participants participants;
    Timing timing;
    std::vector<Factor> factors;
    Choice reference;
    Defaults defaults;
    std::vector<Device> devices;
    std::vector<Questionnaire> questionnaires; ///< known ones first, then those of the script
    std::vector<Counterbalance> counterbalances;
    std::vector<Block> blocks;
    std::vector<SequenceItem> sequence;
    Record record;
    Resume resume;
};

/// Texts stand in the script, or in a Markdown file beside it.
bool is_text_file(std::string const& text);

} // namespace study
