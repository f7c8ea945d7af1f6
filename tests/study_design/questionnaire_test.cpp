// QuestionnaireScores of the known questionnaires, and of own ones.

#include "tests/study_design/samples.h"

#include <map>

namespace study::test {
namespace {

Questionnaire const& known(std::string const& name)
{
    for (Questionnaire const& q : known_questionnaires())
        if (q.name == name) return q;
    throw std::runtime_error("no questionnaire " + name);
}

std::map<std::string, double> scores_of(Questionnaire const& q, std::vector<double> const& answers)
{
    std::vector<std::optional<double>> const given(answers.begin(), answers.end());
    std::map<std::string, double> out;
    for (SubscaleScore const& s : score(q, given).subscales) out[s.subscale] = s.value.value();
    return out;
}

TEST(Ssq, AllItemsThreeIsTheMaximumOfThePaper)
{
    auto const s = scores_of(known("ssq"), std::vector<double>(16, 3));
    EXPECT_NEAR(s.at("nausea"), 200.34, 1e-9);
    EXPECT_NEAR(s.at("oculomotor"), 159.18, 1e-9);
    EXPECT_NEAR(s.at("disorientation"), 292.32, 1e-9);
    EXPECT_NEAR(s.at("total"), 235.62, 1e-9);
    for (auto const& [unused, value] : scores_of(known("ssq"), std::vector<double>(16, 0))) EXPECT_EQ(value, 0);
}

TEST(Ssq, EverySymptomWeighsWhereThePaperSays)
{
    // Kennedy et al. 1993, table 4: crosses under N, O, D.
    char const* const kCrosses[16] = {"NO", "O", "O",  "O", "OD", "N", "N", "ND",
                                      "NO", "D", "OD", "D", "D",  "D", "N", "N"};
    for (std::size_t i = 0; i < 16; ++i) {
        std::vector<double> answers(16, 0);
        answers[i] = 1;
        auto const s = scores_of(known("ssq"), answers);
        std::string const in = kCrosses[i];
        EXPECT_NEAR(s.at("nausea"), in.find('N') != in.npos ? 9.54 : 0, 1e-12) << i + 1;
        EXPECT_NEAR(s.at("oculomotor"), in.find('O') != in.npos ? 7.58 : 0, 1e-12) << i + 1;
        EXPECT_NEAR(s.at("disorientation"), in.find('D') != in.npos ? 13.92 : 0, 1e-12) << i + 1;
        EXPECT_NEAR(s.at("total"), 3.74 * double(in.size()), 1e-12) << i + 1;
    }
}

TEST(Ipq, ReversesThreeItems)
{
    Questionnaire const& q = known("ipq");
    ASSERT_EQ(q.items.size(), 14u);
    std::vector<double> present;
    for (QuestionnaireItem const& item : q.items) present.push_back(item.is_reversed ? 0 : 6);
    for (auto const& [name, value] : scores_of(q, present)) EXPECT_DOUBLE_EQ(value, 6) << name;
    std::vector<std::string> reversed;
    for (QuestionnaireItem const& item : q.items)
        if (item.is_reversed) reversed.push_back(item.id);
    EXPECT_EQ(reversed, (std::vector<std::string>{"sp2", "inv3", "real1"}));
    auto const all_six = scores_of(q, std::vector<double>(14, 6));
    EXPECT_DOUBLE_EQ(all_six.at("spatial"), 24.0 / 5);
    EXPECT_DOUBLE_EQ(all_six.at("involvement"), 18.0 / 4);
    EXPECT_DOUBLE_EQ(all_six.at("realism"), 18.0 / 4);
}

TEST(SusPresence, CountsSixesAndSevens)
{
    auto const s = scores_of(known("sus_presence"), {7, 6, 5, 1, 6, 2});
    EXPECT_DOUBLE_EQ(s.at("count"), 3);
    EXPECT_DOUBLE_EQ(s.at("mean"), 27.0 / 6);
}

TEST(SusUsability, GoesFromZeroToOneHundred)
{
    Questionnaire const& q = known("sus_usability");
    EXPECT_DOUBLE_EQ(scores_of(q, {5, 1, 5, 1, 5, 1, 5, 1, 5, 1}).at("total"), 100);
    EXPECT_DOUBLE_EQ(scores_of(q, {1, 5, 1, 5, 1, 5, 1, 5, 1, 5}).at("total"), 0);
    EXPECT_DOUBLE_EQ(scores_of(q, std::vector<double>(10, 3)).at("total"), 50);
}

TEST(NasaTlx, IsTheMean)
{
    std::vector<double> const ratings{80, 20, 60, 40, 75, 5};
    EXPECT_DOUBLE_EQ(scores_of(known("nasa_tlx"), ratings).at("raw"), 280.0 / 6);
}

TEST(Scores, AreMissingWhereAnItemIs)
{
    std::vector<std::optional<double>> answers(16, 1.0);
    answers[5] = {}; // of nausea
    QuestionnaireScores const s = score(known("ssq"), answers);
    EXPECT_FALSE(s.subscales[0].value);
    EXPECT_TRUE(s.subscales[1].value);
    EXPECT_TRUE(s.subscales[2].value);
    EXPECT_FALSE(s.subscales[3].value);
    EXPECT_FALSE(s.items[5]);
}

TEST(Scores, RefuseAnswersThatCannotBe)
{
    for (double const bad : {-1.0, 4.0, 1.5, std::nan("")}) {
        std::vector<std::optional<double>> answers(16, 1.0);
        answers[2] = bad;
        EXPECT_THROW(score(known("ssq"), answers), std::invalid_argument) << bad;
    }
    EXPECT_THROW(score(known("ssq"), std::vector<std::optional<double>>(15, 1.0)), std::invalid_argument);
}

TEST(Scores, OfAnOwnQuestionnaire)
{
    Script const s = parse_script(example_text("pairs"), "pairs.yaml");
    Questionnaire const& own = s.questionnaires.back();
    ASSERT_EQ(own.name, "thoughts");
    EXPECT_DOUBLE_EQ(scores_of(own, {5, 2}).at("ease"), 4.5); // 2 is reversed: 4
}

constexpr char const* kWithText = R"(schema: study/1
id: x
seed: 1
participants: {count: 1}
sequence: [{questionnaire: q}]
blocks: {}
questionnaires:
  q:
    items:
      - {id: sure, text: "Sure?", required: true}
      - {id: why, text: "Why?", type: text, lines: 4, max_chars: 20, required: true}
      - {id: more, text: "More?", type: text}
    scales: {all: {items: [sure]}}
)";

TEST(TextItems, AreReadAndHaveNoScore)
{
    Script const s = parse_script(kWithText, "x.yaml");
    Questionnaire const& q = s.questionnaires.back();
    ASSERT_EQ(q.items.size(), 3u);
    EXPECT_EQ(q.items[0].type, ItemType::scale);
    EXPECT_TRUE(q.items[0].is_required);
    EXPECT_EQ(q.items[1].type, ItemType::text);
    EXPECT_EQ(q.items[1].lines, 4);
    EXPECT_EQ(q.items[1].max_chars, 20);
    EXPECT_TRUE(q.items[1].is_required);
    EXPECT_FALSE(q.items[2].is_required);
    EXPECT_TRUE(has_text_items(q));
    EXPECT_FALSE(has_text_items(known("ssq")));
    auto const scores = score(q, std::vector<std::optional<double>>{3.0, {}, {}});
    EXPECT_EQ(scores.subscales[0].value, 3);
    EXPECT_THROW(score(q, std::vector<std::optional<double>>{3.0, 1.0, {}}), std::invalid_argument);
}

TEST(TextItems, SayWhatIsNoAnswer)
{
    Script const script = parse_script(kWithText, "x.yaml");
    auto const& items = script.questionnaires.back().items;
    EXPECT_EQ(flaw_of_text(items[1], " \n"), "write an answer");
    EXPECT_EQ(flaw_of_text(items[2], ""), "");
    EXPECT_EQ(flaw_of_text(items[1], "éééééééééééééééééééé"), "") << "characters, not bytes";
    EXPECT_NE(flaw_of_text(items[1], "ééééééééééééééééééééé").find("at most 20"), std::string::npos);
}

TEST(TextItems, RefuseWhatOnlyScalesHave)
{
    struct Mistake {
        char const *from, *to, *message;
    };
    for (auto const& [from, to, message] :
         {Mistake{"max_chars: 20", "max: 20", "x.yaml:11:60: 'max' of the text 'why'"},
          {"lines: 4", "step: 4", "only scales have it"},
          {"lines: 4", "lines: 0", "lines"},
          {"type: text}", "type: words}", "type of item"},
          {"\"Sure?\",", "\"Sure?\", max_chars: 3,", "only texts have it"},
          {"items: [sure]", "items: [why]", "which has no score"}}) {
        std::string text = kWithText;
        text.replace(text.find(from), std::string(from).size(), to);
        try {
            parse_script(text, "x.yaml");
            ADD_FAILURE() << to;
        } catch (std::exception const& e) {
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
        }
    }
}

} // namespace
} // namespace study::test
