// 1,000 designs by chance: each plan keeps the rules of its script, or the script is refused with the reason.

#include "study/numeric/random.h"
#include "tests/study_design/samples.h"

#include <map>
#include <set>

namespace study::test {
namespace {

struct Rule {
    std::string subject; ///< factor, pair or answer
    bool is_gap = false;
    int count = 1;
};
struct Design {
    std::string text;
    std::vector<Rule> rules;
    std::string task;
};

Design random_design(Random& random)
{
    Design d;
    std::vector<std::string> const tasks{"pair", "rating", "2ifc", "abx", "oddity", "same_different"};
    d.task = tasks[random.below(std::uint32_t(tasks.size()))];
    bool const is_rating = d.task == "rating";
    int const factors = 1 + int(random.below(3));
    std::string list, cross, comma;
    std::vector<std::string> subjects;
    for (int f = 0; f < factors; ++f) {
        int const levels = 1 + int(random.below(4)) + (f == 0);
        list += "  f" + std::to_string(f) + ": [";
        for (int l = 0; l < levels; ++l) list += (l ? ", " : "") + std::string(1, char('a' + l));
        list += "]\n";
        subjects.push_back("f" + std::to_string(f));
        if (f == 0 && !is_rating) continue;
        cross += comma + "f" + std::to_string(f);
        comma = ", ";
    }
    if (!is_rating) subjects.push_back("pair");
    if (!is_rating && d.task != "pair") subjects.push_back("answer");
    d.text =
        "schema: study/1\nid: r\nseed: " + std::to_string(random.next()) +
        "\nparticipants: {count: 8}\nfactors:\n" + list +
        "reference: {f0: a}\ndefaults: {stimulus_ms: 500}\nsequence: [b]\nblocks:\n  b:\n    task: " + d.task +
        "\n";
    if (is_rating) d.text += "    scale: {min: 1, max: 5}\n";
    if (d.task == "2ifc") d.text += "    compare: {factor: f0}\n";
    if (!is_rating && d.task != "2ifc") d.text += "    pairs: {factor: f0}\n";
    if (!cross.empty()) d.text += "    cross: [" + cross + "]\n";
    d.text += "    repeats: " + std::to_string(1 + random.below(6)) + "\n";
    if (random.below(3) == 0) d.text += "    shuffle: within_repeats\n";
    if (random.below(3) == 0) d.text += "    practice: {trials: 3}\n";
    if (random.below(4) == 0 && d.task == "pair") d.text += "    catch: {every: 5, better: a, worse: b}\n";
    d.text += "    constraints:\n";
    for (std::uint32_t i = 0, n = 1 + random.below(3); i < n; ++i) {
        Rule r{subjects[random.below(std::uint32_t(subjects.size()))], random.below(4) == 0,
               1 + int(random.below(3))};
        d.text += std::string("    - {") + (r.is_gap ? "min_gap: " : "max_run: ") + std::to_string(r.count) +
                  ", of: " + r.subject + "}\n";
        d.rules.push_back(r);
    }
    return d;
}

/// Value of a subject in a trial, looked up independently by names.
std::set<std::string> things(Script const& s, std::string const& task, Trial const& t, std::string const& subject)
{
    auto const level = [&](std::size_t stimulus, std::size_t factor) {
        return s.factors[factor].levels[std::size_t(t.stimuli[stimulus].levels[factor])].name;
    };
    bool const is_pair = task != "rating" && task != "2ifc";
    if (subject == "answer") return t.answer.empty() ? std::set<std::string>{} : std::set<std::string>{t.answer};
    if (subject == "pair") {
        if (!is_pair) return {level(0, 0)};
        std::string a = level(0, 0), b = level(1, 0);
        return {std::min(a, b) + std::max(a, b)};
    }
    std::size_t const factor = std::size_t(subject[1] - '0');
    if (factor == 0 && is_pair) return {level(0, 0), level(1, 0)};
    return {level(0, factor)};
}

/// Whether the run keeps the rule: for every thing, where it is in the run.
bool keeps(Script const& s, std::string const& task, std::vector<Trial> const& run, Rule const& rule)
{
    std::map<std::string, std::vector<int>> places;
    for (std::size_t i = 0; i < run.size(); ++i)
        for (std::string const& thing : things(s, task, run[i], rule.subject)) places[thing].push_back(int(i));
    for (auto const& [unused, at] : places) {
        int row = 1;
        for (std::size_t i = 1; i < at.size(); ++i) {
            int const distance = at[i] - at[i - 1];
            row = distance == 1 ? row + 1 : 1;
            if (rule.is_gap ? distance <= rule.count : row > rule.count) return false;
        }
    }
    return true;
}

TEST(RandomDesigns, KeepTheirRulesOrAreRefusedWithTheReason)
{
    Random random(20261122);
    int kept = 0, refused = 0, given_up = 0, without_rule = 0;
    for (int i = 0; i < 1000; ++i) {
        Design const d = random_design(random);
        try {
            Script const s = parse_script(d.text, "r.yaml");
            int const participant = 1 + int(random.below(8));
            Plan const plan = make_plan(s, participant);
            expect_same(read_plan(s, participant, plan_table(s, plan), "plan.tsv"), plan);
            for (std::vector<Trial> const& run : {run_of(plan), trials_of(plan, Phase::practice)})
                for (Rule const& rule : d.rules)
                    EXPECT_TRUE(keeps(s, d.task, run, rule)) << d.text << "participant " << participant;
            ++kept;
        } catch (gi::InputError const& e) {
            std::string const what = e.what();
            bool const is_about_rules = what.find("cannot be satisfied") != what.npos;
            bool const is_about_counts = what.find("a catch trial every") != what.npos ||
                                         what.find("practises") != what.npos ||
                                         what.find("is the same in all trials") != what.npos;
            EXPECT_TRUE(is_about_rules || is_about_counts) << what << "\n" << d.text;
            EXPECT_GT(e.where().line, 0) << what;
            ++(is_about_rules ? refused : without_rule);
            given_up += what.find("searches") != what.npos;
        }
    }
    EXPECT_GT(kept, 300);
    EXPECT_GT(refused, 100);
    RecordProperty("kept", kept);
    RecordProperty("refused", refused);
    std::printf("%d kept, %d refused for their rules (%d of them without proof), %d otherwise\n", kept, refused,
                given_up, without_rule);
}

} // namespace
} // namespace study::test
