#include "study/script/questionnaire.h"

#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace study {
namespace {

ItemScore score_item(QuestionnaireItem const& item, double answer)
{
    if (item.type == ItemType::text)
        throw std::invalid_argument(fmt::format("{} = {:g} (its answer is a text) give a text", item.id, answer));
    double const steps = (answer - item.low) / item.step;
    bool const is_within = answer >= item.low && answer <= item.high; // false for NaN
    if (!is_within || std::abs(steps - std::round(steps)) > 1e-9)
        throw std::invalid_argument(fmt::format("{} = {:g} (it is {:g} to {:g} in steps of {:g}) choose one",
                                                item.id, answer, item.low, item.high, item.step));
    return {answer, item.is_reversed ? item.low + item.high - answer : answer};
}

std::optional<double> combine(Subscale const& s, std::vector<std::optional<ItemScore>> const& items)
{
    double sum = 0;
    int at_least = 0;
    for (int const i : s.items) {
        auto const& item = items[std::size_t(i)];
        if (!item) return {};
        sum += item->scored;
        at_least += item->scored >= s.at_least;
    }
    double const combined = s.combine == Combine::count  ? at_least
                            : s.combine == Combine::mean ? sum / double(s.items.size())
                                                         : sum;
    return s.weight * combined + s.offset;
}

} // namespace

bool has_text_items(Questionnaire const& q)
{
    return std::any_of(q.items.begin(), q.items.end(),
                       [](QuestionnaireItem const& item) { return item.type == ItemType::text; });
}

std::string flaw_of_text(QuestionnaireItem const& item, std::string const& text)
{
    bool const is_empty = text.find_first_not_of(" \t\n\r") == std::string::npos;
    if (item.is_required && is_empty) return "write an answer";
    std::size_t const length = gi::characters(text);
    if (length > std::size_t(item.max_chars))
        return fmt::format("write at most {} characters, these are {}", item.max_chars, length);
    return {};
}

QuestionnaireScores score(Questionnaire const& q, std::span<std::optional<double> const> answers)
{
    if (answers.size() != q.items.size())
        throw std::invalid_argument(
            fmt::format("{} answers to the {} items of {} (each belongs to one) give one per "
                        "item, none if it was not answered",
                        answers.size(), q.items.size(), q.name));
    QuestionnaireScores scores;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        scores.items.emplace_back();
        if (answers[i]) scores.items.back() = score_item(q.items[i], *answers[i]);
    }
    for (Subscale const& s : q.subscales) scores.subscales.push_back({s.name, combine(s, scores.items)});
    return scores;
}

} // namespace study
