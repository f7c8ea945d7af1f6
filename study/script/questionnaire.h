#pragma once
// Questionnaires as data: items with their scales, and the subscales that combine them. Built-in questionnaires
// and those of scripts have the same form.
//
// ssq: Kennedy, Lane, Berbaum, Lilienthal 1993, Int. J. Aviation Psychology 3(3):203-220.
// sus_presence: Slater, Usoh, Steed 1994, Presence 3(2):130-144;
// as six items Usoh et al. 2000, Presence 9(5):497-503.
// sus_usability: Brooke 1996, in Usability Evaluation in Industry, 189-194 (not related to sus_presence).
// ipq: Schubert, Friedmann, Regenbrecht 2001, Presence 10(3):266-281; SP2, INV3 and REAL1 are reversed.
// nasa_tlx: Hart, Staveland 1988, Advances in Psychology 52:139-183; the score is raw (unweighted).

#include "study/script/script_error.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace study {

enum class ItemType {
    scale, ///< a value of a scale
    text,  ///< typed text, which no score uses
};

struct QuestionnaireItem {
    std::string id, text;
    // Of a scale:
    double low = 1, high = 7, step = 1;
    std::vector<std::string> labels; ///< of low and high, or of every step
    bool is_reversed = false;        ///< scored low + high - answer

    ItemType type = ItemType::scale;
    bool is_required = false; ///< the participant cannot continue without an answer
    // Of a text:
    int lines = 1;        ///< its height in the window; line ends can be typed if more than one
    int max_chars = 1000; ///< Unicode characters
};

enum class Combine {
    sum,
    mean,
    count, ///< number of scored answers that are at least `at_least`
};

/// A score of several items: weight * combine(scored answers) + offset.
struct Subscale {
    std::string name;
    std::vector<int> items; ///< indices; an item listed twice counts twice
    Combine combine = Combine::sum;
    double weight = 1, offset = 0, at_least = 0;
};

struct Questionnaire {
    std::string name, title, instructions;
    std::vector<QuestionnaireItem> items;
    std::vector<Subscale> subscales;
    Place place; ///< in the script; {0, 0} for built-in ones
};

bool has_text_items(Questionnaire const& questionnaire);
/// Why the text is no answer to an item of type text: "write an answer"; empty = it is one. An empty text, or one
/// of blanks, is no answer.
std::string flaw_of_text(QuestionnaireItem const& item, std::string const& text);

/// ssq, sus_presence, sus_usability, ipq, nasa_tlx.
std::span<Questionnaire const> known_questionnaires();

struct ItemScore {
    double raw = 0, scored = 0;
};
struct SubscaleScore {
    std::string subscale;
    std::optional<double> value; ///< none if one of its items was not answered
};
struct QuestionnaireScores {
    std::vector<std::optional<ItemScore>> items; ///< in the questionnaire's order
    std::vector<SubscaleScore> subscales;
};
/// @param answers one per item, within its range; none = not answered, and always for items of type text
/// Throws std::invalid_argument if the number of answers is wrong, or one is out of range or not on a step.
QuestionnaireScores score(Questionnaire const& questionnaire, std::span<std::optional<double> const> answers);

} // namespace study
