// What is wrong with a script is said with its place, and what to do.

#include "tests/study_design/samples.h"

namespace study::test {
namespace {

/// A sound script; the tests spoil it. Line numbers count from here.
std::string const kSound = R"(schema: study/1
id: sound
seed: 5
participants: {count: 12}
factors:
  scene: [arches, atrium]
  quality:
    best: {paths: 4096}
    fair: {paths: 64}
    poor: {paths: 4}
  light: {day: {exposure: 0}, night: {exposure: -3}}
reference: {quality: best}
defaults: {stimulus_ms: 2000}
devices: {first: [key:left], second: [key:right]}
counterbalance:
  light: {method: alternate}
  tasks: {method: latin, of: [pairs, rate]}
sequence:
  - {questionnaire: ssq}
  - {per: light, do: [tasks]}
blocks:
  pairs:
    task: pair
    pairs: {factor: quality}
    cross: [scene]
    repeats: 2
    constraints: [{no_repeat: scene, max_run: 2}]
  rate:
    task: rating
    scale: {min: 1, max: 7}
    cross: [scene, quality]
)";

std::string spoiled(std::string const& what, std::string const& by)
{
    std::string text = kSound;
    std::size_t const at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    if (at != std::string::npos) text.replace(at, what.size(), by);
    return text;
}

struct Case {
    char const *what, *by, *place, *mentions;
};

/// Parsing continues after a mistake; values that the mistake left unknown must not be used.
TEST(ScriptErrors, WhatAMistakeLeavesUnknownIsNotUsed)
{
    // A factor without levels, which the reference names.
    std::string const empty =
        message_of(spoiled("  light: {day: {exposure: 0}, night: {exposure: -3}}\nreference: "
                           "{quality: best}",
                           "  light: {}\nreference: {quality: best, light: day}"));
    EXPECT_NE(empty.find("factor 'light' has 0 levels"), std::string::npos) << empty;
    // A misspelt key of QUEST+: its grid is missing.
    std::string const grid =
        message_of(spoiled("  rate:\n    task: rating\n    scale: {min: 1, max: 7}\n    cross: "
                           "[scene, quality]",
                           "  rate:\n    task: 2ifc\n    compare: {vary: exposure, range: [1, 64], harder: up}\n"
                           "    procedure: {method: questplus, threshold: 1..64/9, slope: 3, "
                           "gess: 0.5, lapse: 0.02, stop: {trials: 9}}"));
    EXPECT_NE(grid.find("did you mean 'guess'?"), std::string::npos) << "\n" << grid;
    // The mistake in what is compared is reported first, not that nothing is varied.
    std::string const compare =
        message_of(spoiled("  rate:\n    task: rating\n    scale: {min: 1, max: 7}\n    cross: "
                           "[scene, quality]",
                           "  rate:\n    task: 2ifc\n    compare: {vary: exposure, range: 5, harder: up}\n"
                           "    practice: {trials: 4, level: 2}\n"
                           "    procedure: {method: constant, levels: [1, 2]}"));
    EXPECT_NE(compare.find("range"), std::string::npos) << "\n" << compare;
}

TEST(ScriptErrors, NameTheirPlaceAndWhatToDo)
{
    ASSERT_EQ(message_of(kSound), "");
    for (Case const& c : {
             Case{"schema: study/1", "schema: study/3", "t.yaml:1:9: ", "did you mean 'study/2'?"},
             {"seed: 5", "sede: 5", "t.yaml:3:1: ",
              "unknown key 'sede' in script (it would be ignored) did you mean "
              "'seed'?"},
             {"seed: 5", "seed: many", "t.yaml:3:7: ", "no seed"},
             {"seed: 5", "seed: 5\nseed: 6", "t.yaml:4:1: ", "'seed' twice"},
             {"{count: 12}", "{count: 12.5}", "t.yaml:4:23: ", "not whole"},
             {"{count: 12}", "{count: 0}", "t.yaml:4:23: ", "between 1 and 100000"},
             {"{count: 12}", "{count: 12, id: Anna}", "t.yaml:4:31: ", "write \"P{n:03}\""},
             {"{count: 12}", "{count: 12, id: \"P_{n}\"}", "t.yaml:4:31: ", "is no pattern for participants' ids"},
             {"participants: {count: 12}\n", "", "t.yaml:1:1: ", "script has no 'participants'"},
             {"[arches, atrium]", "[arches, arches]", "t.yaml:6:10: ", "'arches' twice in scene"},
             {"{paths: 64}", "{paths: [64]}", "t.yaml:9:19: ", "not text"},
             {"{paths: 64}", "64", "t.yaml:9:11: ", "not a map"},
             {"reference: {quality: best}", "reference: {quality: bset}",
              "t.yaml:12:22: ", "did you mean 'best'?"},
             {"reference: {quality: best}", "reference: {qualty: best}",
              "t.yaml:12:13: ", "did you mean 'quality'?"},
             {"stimulus_ms: 2000", "stimulus_ms: soon", "t.yaml:13:25: ", "neither a number nor until_response"},
             {"stimulus_ms: 2000", "stimulus_ms: -1", "t.yaml:13:25: ", "between 1 and"},
             {"[key:left]", "[left]", "t.yaml:14:", "write key:left"},
             {"second: [key:right]", "second: [key:left]",
              "t.yaml:14:30: ", "both first and second in block 'pairs'"},
             {"second: [key:right]", "third: [key:right]", "t.yaml:14:30: ", "the answer 'third' is not used"},
             {"second: [key:right]", "scond: [key:right]", "t.yaml:14:30: ", "did you mean 'second'?"},
             {"{method: alternate}", "{method: alternating}", "t.yaml:16:19: ", "did you mean 'alternate'?"},
             {"{method: alternate}", "{method: between}", "t.yaml:20:5: ", "fixed already"},
             {"of: [pairs, rate]", "of: [pairs]", "t.yaml:17:10: ", "fewer than two blocks"},
             {"of: [pairs, rate]", "of: [pairs, rating]", "t.yaml:17:38: ", "did you mean 'rate'?"},
             {"tasks: {method: latin, of", "rate: {method: latin, of",
              "t.yaml:17:3: ", "named as the block 'rate'"},
             {"{questionnaire: ssq}", "{questionnaire: sqs}", "t.yaml:19:21: ", "did you mean 'ssq'?"},
             {"{questionnaire: ssq}", "{questionaire: ssq}", "t.yaml:19:6: ", "did you mean 'questionnaire'?"},
             {"do: [tasks]", "do: [task]", "t.yaml:20:23: ", "did you mean 'tasks'?"},
             {"do: [tasks]", "do: [pairs]", "t.yaml:17:3: ", "the order 'tasks' is not used"},
             {"{per: light, do: [tasks]}", "tasks", "t.yaml:11:3: ", "factor 'light' is not used"},
             {"task: pair\n", "task: pairs\n", "t.yaml:23:11: ", "did you mean 'pair'?"},
             {"    cross: [scene]\n", "", "t.yaml:22:3: ", "factor 'scene' has no level in block 'pairs'"},
             {"cross: [scene, quality]", "cross: [quality]",
              "t.yaml:28:3: ", "factor 'scene' has no level in block 'rate'"},
             {"    cross: [scene]\n", "    cross: [scene, light]\n",
              "t.yaml:22:3: ", "fixed where it runs (line 20)"},
             {"    cross: [scene]\n", "    cross: [scene, quality]\n", "t.yaml:22:3: ", "levels are already"},
             {"    cross: [scene]\n", "    cross: [scene, scene]\n", "t.yaml:25:20: ", "crossed twice"},
             {"    cross: [scene]\n", "    only: {scene: [arches, atrium]}\n",
              "t.yaml:22:3: ", "add scene to cross"},
             {"    pairs: {factor: quality}\n", "", "t.yaml:23:5: ", "block 'pairs' needs pairs"},
             {"{factor: quality}", "{factor: quality, omit: [fair, poor]}",
              "t.yaml:24:12: ", "at least 2 are needed"},
             {"{factor: quality}", "{factor: quality, list: [[fair, fair]]}", "t.yaml:24:", "paired with itself"},
             {"repeats: 2", "repeats: 2\n    scale: {min: 1, max: 7}",
              "t.yaml:27:5: ", "'scale' does nothing in a block with task pair"},
             {"repeats: 2", "repeats: 2\n    presentation: sequential\n    stimulus_ms: until_response",
              "t.yaml:23:5: ", "add stimulus_ms"},
             {"repeats: 2", "repeats: 2\n    practice: {trials: 99}",
              "t.yaml:22:3: ", "practises 99 of its 12 trials"},
             {"repeats: 2", "repeats: 2\n    practice: {trials: 2, feedback: true}",
              "t.yaml:27:37: ", "no answer is right"},
             {"repeats: 2", "repeats: 2\n    catch: {every: 12}",
              "t.yaml:27:12: ", "write better: LEVEL, worse: LEVEL"},
             {"repeats: 2", "repeats: 2\n    catch: {every: 13, better: best, worse: poor}",
              "t.yaml:27:12: ", "write a smaller number"},
             {"repeats: 2", "repeats: 2\n    repeats: 3", "t.yaml:27:5: ", "twice"},
             {"repeats: 2", "repeats:", "t.yaml:26:5: ", "has no value"},
             {"repeats: 2", "repeats: 9999", "t.yaml:22:3: ", "at most 5000 are planned"},
             {"{no_repeat: scene, max_run: 2}", "{no_repeat: scnee}", "t.yaml:27:31: ", "did you mean 'scene'?"},
             {"{no_repeat: scene, max_run: 2}", "{no_repeat: answer}",
              "t.yaml:27:19: ", "is the same in all trials"},
             {"{no_repeat: scene, max_run: 2}", "{max_run: 2}", "t.yaml:27:19: ", "this is no constraint"},
             {"{no_repeat: scene, max_run: 2}", "{min_gap: 2, of: scene}",
              "t.yaml:27:19: ", "the constraints of block 'pairs' cannot be satisfied"},
             {"{no_repeat: scene, max_run: 2}", "{never_after: {quality: [best, poor]}}",
              "t.yaml:27:19: ", "only no_repeat, max_run and min_gap are defined"},
             {"{min: 1, max: 7}", "{min: 1, max: 7, step: 4}", "t.yaml:30:12: ", "2 to 100001 values"},
             {"{min: 1, max: 7}", "{min: 1, max: 7, labels: {9: much}}", "t.yaml:30:38: ", "between 1 and 7"},
             {"cross: [scene, quality]", "cross: [scene, quality", "t.yaml:32:1: ", "not YAML"},
             {"  scene: [arches, atrium]\n", "  scene: [arches, atrium]\n  time: [early, late]\n",
              "t.yaml:7:3: ", "factor 'time' is not used"},
             {"blocks:\n", "blocks:\n  idle: {task: rating, scale: {min: 1, max: 7}, cross: [scene]}\n",
              "t.yaml:22:3: ", "block 'idle' is not used"},
             {"blocks:\n", "questionnaires: {own: {items: [{id: a, text: b}]}}\nblocks:\n",
              "t.yaml:21:18: ", "questionnaire 'own' is not used"},
             {"blocks:\n", "questionnaires: {ssq: {items: [{id: a, text: b}]}}\nblocks:\n",
              "t.yaml:21:18: ", "known already"},
             {"blocks:\n", "timing: {vsync: maybe}\nblocks:\n", "t.yaml:21:17: ", "there are: required, record"},
             {"blocks:\n", "record: {markers: [lls]}\nblocks:\n", "t.yaml:21:20: ", "did you mean 'lsl'?"},
             {"blocks:\n", "resume: {repeat: [practise]}\nblocks:\n",
              "t.yaml:21:19: ", "did you mean 'practice'?"},
         }) {
        std::string const message = message_of(spoiled(c.what, c.by));
        EXPECT_TRUE(message.starts_with(c.place)) << c.by << "\n" << message << "\nexpected at " << c.place;
        EXPECT_NE(message.find(c.mentions), std::string::npos) << c.by << "\n" << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

std::string const kVaried = "factors: {q: {best: {paths: 4096}}}\nreference: {q: best}\n"
                            "defaults: {stimulus_ms: 1000}\nsequence: [b]\nblocks:\n  b:\n    task: 2ifc\n"
                            "    compare: {vary: paths, scale: log2, range: [1, 1024], harder: up}\n";

TEST(ScriptErrors, OfProceduresSayWhy)
{
    for (auto const& [procedure, mentions] : {
             std::pair{"procedure: {method: constant, levels: 1..2048/5}", "it must lie between 1 and 1024"},
             {"procedure: {method: constant, levels: 8..1/5}", "rising numbers"},
             {"procedure: {method: constant, levels: [4, 2]}", "grids rise"},
             {"procedure: {method: constant, levels: 1..8}", "64..16384/33"},
             {"procedure: {method: constnat, levels: 1..8/2}", "did you mean 'constant'?"},
             {"procedure: {method: adjustment, starts: 4}", "no method of this task"},
             {"procedure: {method: staircase, start: 2, steps: [1], stop: {reversals: 8}}", "may never end"},
             {"procedure: {method: staircase, start: 2000, steps: [1], stop: {trials: 8}}", "start within"},
             {"procedure: {method: staircase, start: 2, steps: [], stop: {trials: 8}}", "could not move"},
             {"procedure: {method: staircase, start: 2, up: 1, target: 0.7, steps: [1], stop: {trials: 8}}",
              "keep one"},
             {"procedure: {method: questplus, threshold: 4, slope: 1, guess: 0.5, lapse: 0, stop: {trials: 8}}",
              "only one level to present"},
             {"procedure: {method: questplus, threshold: 1..9/5, slope: 1, guess: 0.5, lapse: 0, stop: "
              "{reversals: 8}}",
              "no reversals"},
             {"repeats: 2", "no procedure varies"},
             {"interleave: []", "no procedure varies, or nothing to interleave"},
             {"interleave: [{method: constant, levels: 4}, {method: constant, levels: 8}]",
              "two procedures named"},
         }) {
        std::string const message = message_of(kHead + kVaried + "    " + procedure + "\n");
        bool const is_either = std::string(mentions).find(" or nothing") != std::string::npos;
        EXPECT_NE(message.find(is_either ? "nothing to interleave" : mentions), std::string::npos)
            << procedure << "\n"
            << message;
        EXPECT_TRUE(message.starts_with("t.yaml:")) << message;
    }
}

/// All mistakes as `study check` reports them, without the name of the file: "8:5: problem (why) suggestion".
std::vector<std::string> mistakes_of(std::string const& text)
{
    std::vector<std::string> all;
    ReadScript const read = read_script(text, "t.yaml");
    for (ScriptError const& e : read.mistakes.in_order()) all.push_back(std::string(e.what()).substr(7));
    return all;
}

/// Each mistake of a script is reported at its place, and nothing else.
struct Told {
    std::string body;
    std::vector<std::string> begin;
};

void expect_told(std::vector<Told> const& all)
{
    for (Told const& t : all) {
        auto const told = mistakes_of(kHead + t.body);
        bool is_equal = told.size() == t.begin.size();
        for (std::size_t i = 0; is_equal && i < told.size(); ++i) is_equal = told[i].starts_with(t.begin[i]);
        std::string text;
        for (std::string const& message : told) text += message + "\n";
        EXPECT_TRUE(is_equal) << t.body << "\n" << text;
    }
}

std::string const kBlock = "factors: {q: [a, b]}\nsequence: [b]\nblocks:\n  b: ";

TEST(ScriptErrors, OfOneMapAreToldTogether)
{
    std::string const sound = "sounds: {beep: {tone_hz: 900, duration_ms: 5, ramp_ms: 50}}\n" + kBlock +
                              "{task: pair, pairs: {factor: q}";
    std::string const varied = kVaried + "    procedure: {method: ";
    expect_told({
        {sound + ", cues: [{sound: bep, at: onset, offset_ms: -1e9}]}\n",
         {"5:16: two ramps of 50 ms", "9:54: 'bep' is no sound", "9:63: 'onset' is no moment", "9:81: "}},
        {"questionnaires:\n  aft:\n    items: [{id: a, texte: x, type: scal}, {txt: y, min: z}]\n"
         "    scales: {s: {items: [b, a], score: avg}, t: {items: a, wight: 2}}\n" +
             kBlock + "{task: pair, pairs: {factor: q}}\n",
         {"6:3: questionnaire 'aft' is not used", "7:21: unknown key 'texte'", "7:37: 'scal' is no type of item",
          "7:44: script.questionnaires.aft.items[1] has no 'id'", "7:45: unknown key 'txt'",
          "7:58: script.questionnaires.aft.items[1].min is not", "8:40: 'avg' is no way",
          "8:60: unknown key 'wight'"}},
        {kBlock + "{task: pair, pairs: {factor: q, order: up}, catch: {every: 0, better: hi, worse: lo},\n"
                  "    constraints: [{max_run: 0, of: pairs}, {never_after: {q: [c, d]}}]}\n",
         {"8:45: 'up' is no order", "8:65: script.blocks.b.catch.every is 0", "8:76: 'hi' is no level",
          "8:87: 'lo' is no level", "9:29: script.blocks.b.constraints[0].max_run is 0",
          "9:36: 'pairs' is no subject", "9:63: 'c' is no level", "9:66: 'd' is no level"}},
        {kBlock +
             "{task: rating, scale: {min: 7, max: 1, step: 0}, cross: q, nest: {n: {in: r, levels: {a: b}}}}\n",
         {"8:28: a scale from 7 to 1", "8:51: script.blocks.b.scale.step is 0", "8:72: 'n' is no factor",
          "8:80: 'r' is no factor"}},
        {kBlock + "{task: rating, scale: {min: 1, max: 7}, cross: q, catch: {every: 2}}\n",
         {"8:56: 'catch' does nothing in a block with task rating"}},
        {varied + "staircase, target: 2, up: 0, start: 4, steps: 1, stop: {trials: 0, reversals: 0}}\n",
         {"13:16: both target and up or down", "13:44: ", "13:51: ", "13:89: ", "13:103: "}},
        {varied + "questplus, threshold: [0, 4], slope: 1, guess: 0.8, lapse: 0.3, stop: {trials: 5}}\n",
         {"13:47: script.blocks.b.procedure.threshold has 0",
          "13:72: guess 0.8 with lapse 0.3 (together they reach 1"}},
        {varied +
             "constant, levels: 4}\n    practice: {trials: 0, level: esy}\n    catch: {every: 1, level: eazy}\n",
         {"14:24: ", "14:34: 'esy' is neither a number nor easiest, hardest, min, max",
          "15:20: ", "15:30: 'eazy' is neither"}},
        {"devices: {first: [key:a, key:a]}\n" + kBlock + "{task: pair, pairs: {factor: q}}\n",
         {"5:26: 'key:a' twice"}},
    });
}

TEST(ScriptErrors, OfProceduresThatCannotFindAThreshold)
{
    std::string const staircase =
        kVaried + "    procedure: {method: staircase, start: 4, steps: 1, stop: {trials: 9}";
    std::string const quest = kVaried + "    procedure: {method: questplus, threshold: 1..1024/9, slope: [1, 2], "
                                        "guess: 0.5, lapse: 0.02, stop: {trials: 9}";
    std::string const constant = kVaried + "    procedure: {method: constant, levels: 1..1024/9";
    std::string const falls = "guess + (1 - guess - lapse) * normal(slope * (log2(threshold) - log2(x)))",
                      rises = "guess + (1 - guess - lapse) * normal(slope * (log2(x) - log2(threshold)))";
    std::string const psychometric = ", psychometric: \"", end = "\"}\n";
    expect_told({
        {staircase + "}\n", {"13:16: the staircase converges to 50.00 % correct (guessing gives 50.00 % in 2ifc"}},
        {staircase + ", target: 0.5}\n", {"13:16: the staircase converges to 50.00 % correct"}},
        {staircase + ", down: 2}\n", {}},
        {quest + psychometric + falls + end, {}},
        {quest + psychometric + rises + end, {"13:131: the formula rises with x (P(correct) must fall"}},
        {constant + psychometric + falls + end, {}},
        {constant + psychometric + rises + end, {"13:68: the formula rises with x"}},
        {staircase + ", down: 2" + psychometric + rises + end, {"13:98: the formula rises with x"}},
        {constant + psychometric + "guess + 0.2 * normal(log2(threshold / x))" + end,
         {"13:68: the formula gives 0.5 to 0.7 over the range of levels (the threshold is where it gives 0.75"}},
        {quest + ", parameters: {width: [1, 2]}" + psychometric + falls + end,
         {"13:160: the formula does not use the parameter 'width'"}},
    });
    std::string yes_no = staircase + "}\n";
    yes_no.replace(yes_no.find("2ifc"), 4, "yes_no");
    EXPECT_TRUE(mistakes_of(kHead + yes_no).empty()) << "where half of the answers are yes";
}

TEST(ScriptErrors, OfATabNameItsLine)
{
    EXPECT_EQ(message_of(kHead + "blocks:\n  r:\n\ttask: rating\n"),
              "t.yaml:7:1: this line is indented by a tab (YAML takes only blanks) write blanks");
}

TEST(ScriptErrors, OfCharactersAndQuotesNameTheirPlace)
{
    EXPECT_EQ(message_of(kHead + "title: sch\xf6n\n"),
              "t.yaml:5:11: the byte f6 is no UTF-8 (texts would be unreadable) save the file as UTF-8");
    EXPECT_EQ(message_of(kHead + "title: sch\xc3\xb6n\x07\n"),
              "t.yaml:5:14: the control character 07 (it cannot be seen) remove it");
    std::string const rest = kBlock + "{task: pair, pairs: {factor: q}}\n";
    EXPECT_EQ(message_of("\xef\xbb\xbf" + kHead + rest), "") << "a byte order mark";
    expect_told({
        {rest + "title: \"A study\ntiming: {vsync: record}\ndevices: {confirm: [key:enter]}\"\n",
         {"9:8: a quote that its line does not close (line 10, which is not indented further"}},
        {rest + "title: 'It''s \\'\ntiming: {vsync: record}\n", {}},
        {rest + "title: \"A \\\" \n  study\"\n", {}},
        {rest + "title: \"A\n\n  study\"\n", {"9:8: a title of several lines"}},
    });
}

TEST(ScriptErrors, OfNamesThatTablesCannotHold)
{
    std::string const rest =
        "sequence: [b]\nblocks: {b: {task: rating, scale: {min: 1, max: 7}, cross: [level]}}\n";
    expect_told({
        {"factors: {level: [a, b], factor_level: [c]}\nreference: {factor_level: c}\n" + rest,
         {"5:26: factors 'level' and 'factor_level'"}},
        {"factors: {level: [NA, n.a, nan, \"true\"]}\n" + rest,
         {"5:18: a level named 'NA'", "5:18: a level named 'nan'"}},
        {"factors: {level: {None: {paths: 1}, n: {paths: 2}}}\n" + rest, {"5:18: a level named 'None'"}},
    });
    EXPECT_EQ(
        message_of("schema: study/1\nid: t\nseed: 5\nparticipants: {count: 12, ask: [number, asked_number]}\n"
                   "factors: {level: [a]}\n" +
                   rest),
        "t.yaml:4:41: questions 'number' and 'asked_number' (tables could not distinguish them) rename one");
    EXPECT_NE(message_of("schema: study/1\nid: t\nseed: 5\nparticipants: {count: 12, ask: [eye.l, eye_l]}\n"
                         "factors: {level: [a]}\n" +
                         rest)
                  .find("questions 'eye.l' and 'eye_l'"),
              std::string::npos);
}

TEST(ScriptErrors, OfSettingsThatOverrideEachOther)
{
    std::string const rest =
        "sequence: [b]\nblocks: {b: {task: rating, scale: {min: 1, max: 7}, cross: [p, e]}}\n";
    expect_told({
        {"factors: {p: {a: {gi.paths: 1}, b: {paths: 2}}, e: {a: {paths: 4, reuse: 1}, b: {gi.paths: 5}}}\n" +
             rest,
         {"5:11: nothing of factor 'p' is shown: factor 'e' sets 'paths' too"}},
        {"factors: {p: {a: {paths: 1}, b: {paths: 2, reuse: 2}}, e: {a: {paths: 4}, b: {paths: 5}}}\n" + rest, {}},
        {"factors: {p: {a: {paths: 1}, b: {paths: 2}}, e: {a: {paths: 4}, b: {reuse: 5}}}\n" + rest, {}},
        {"factors: {p: [1, 2], e: [3, 4]}\ndefaults: {settings: {gi.paths: 3, paths: 5}}\n" + rest,
         {"6:36: 'gi.paths' and 'paths' are one setting"}},
        {"factors: {q: {best: {paths: 4096}}}\nreference: {q: best}\ndefaults: {stimulus_ms: 1000}\nsequence: "
         "[b]\nblocks:\n  b:\n    task: "
         "2ifc\n"
         "    compare: {vary: paths, with: {gi.paths: 5, reuse: 1}, range: [1, 9], harder: up}\n"
         "    procedure: {method: constant, levels: [1, 9]}\n",
         {"12:35: 'with' sets 'gi.paths', whose level a procedure chooses"}},
    });
}

TEST(ScriptErrors, OfPairListsThatMakeNoScale)
{
    std::string const head =
        "factors: {q: [a, b, c, d]}\nsequence: [b]\nblocks:\n  b: {task: pair, pairs: {factor: q, ";
    expect_told({
        {head + "list: [[a, b], [b, a]]}}\n",
         {"8:53: this pair is in the list before (a list selects pairs) remove it; order"}},
        {head + "order: fixed, list: [[a, b], [b, a]]}}\n", {}},
        {head + "order: fixed, list: [[a, b], [a, b]]}}\n", {"8:67: this pair is in the list before"}},
        {head + "sampling: active, trials: 9, list: [[a, b], [c, d]]}}\n", {"8:73: no pairs connect 'a' and 'c'"}},
        {head + "sampling: active, trials: 9, list: [[a, b], [c, d], [d, b]]}}\n", {}},
        {head + "list: [[a, b], [c, d]]}}\n", {}},
    });
}

TEST(ScriptErrors, OfUnknownWordsNameAllThatThereAre)
{
    std::string const told =
        message_of(kHead + kBlock + "{task: rating, scale: {min: 1, max: 7}, cross: q, zzz: 1}\n");
    EXPECT_NE(told.find(", ties, timeout_ms, warmup_frames"), std::string::npos) << told;
}

TEST(ScriptErrors, OfRankingsThatDigitsCannotGive)
{
    std::string const nine = "factors: {n: [a, b, c, d, e, f, g, h, i";
    std::string const rest = "]}\nsequence: [b]\nblocks:\n  b: {task: ranking, rank: {factor: n}}\n";
    EXPECT_EQ(message_of(kHead + nine + rest), "");
    EXPECT_EQ(message_of(kHead + nine + ", j" + rest),
              "t.yaml:8:28: 10 to rank (the order is typed as digits 1 to 9) omit some");
}

TEST(ScriptErrors, OfInputsThatGiveTwoAnswersToAQuestionnaire)
{
    EXPECT_NE(message_of(spoiled("second: [key:right]", "up: [key:a], down: [key:a]"))
                  .find("'key:a' is both up and down in block 'rate'"),
              std::string::npos);
    std::string const script =
        "factors: {q: [a, b]}\ndevices: {up: key:up, down: key:KEY}\n"
        "sequence: [{questionnaire: ssq}, b]\nblocks: {b: {task: pair, pairs: {factor: q}}}\n";
    auto const with = [&](std::string const& key) {
        std::string text = kHead + script;
        return text.replace(text.find("KEY"), 3, key);
    };
    EXPECT_EQ(message_of(with("down")), "");
    EXPECT_EQ(message_of(with("up")),
              "t.yaml:6:23: 'key:up' is both up and down in questionnaire 'ssq' (the answer "
              "would be ambiguous) choose another input");
}

TEST(ScriptErrors, OfASecondDocumentNameItsLine)
{
    EXPECT_EQ(message_of("---\n" + kSound), "");
    EXPECT_EQ(message_of("# first\n\n---  # here\n" + kSound + "...\n# last\n"), "");
    std::string const second = "a second document begins here (it would be ignored) one file has one: check the "
                               "indentation, or remove it";
    EXPECT_EQ(message_of(kSound + "---\nid: other\n"), "t.yaml:32:1: " + second);
    EXPECT_EQ(message_of("- id\nseed: 1\n"), "t.yaml:2:1: " + second);
    EXPECT_NE(message_of(","), "") << "where YAML::LoadAll never ends";
}

TEST(ScriptErrors, OfYamlThatNestsWithoutEndComeBeforeTheParser)
{
    EXPECT_NE(message_of(std::string(100000, '[')).find("nests deeper"), std::string::npos);
    EXPECT_NE(message_of(std::string(2 << 20, ' ')).find("larger than 1 MiB"), std::string::npos);
    EXPECT_NE(message_of("").find("not a map"), std::string::npos);
    EXPECT_NE(message_of("\x01\xff").size(), 0u);
}

TEST(ScriptErrors, OfTextFilesThatAreNotThere)
{
    Script const s = parse("factors: {scene: [a, b]}\nsequence:\n  - {instructions: nowhere.md}\n  - b\n"
                           "blocks: {b: {task: rating, scale: {min: 1, max: 7}, cross: scene}}\n");
    try {
        check_text_files(s, "/tmp");
        FAIL() << "nowhere.md was found";
    } catch (gi::InputError const& e) {
        EXPECT_EQ(e.where().line, 7);
        EXPECT_EQ(e.where().column, 5);
        EXPECT_EQ(e.problem(), "there is no file 'nowhere.md'");
        EXPECT_EQ(e.where().file, "t.yaml");
    }
}

} // namespace
} // namespace study::test
