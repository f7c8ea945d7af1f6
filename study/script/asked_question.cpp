#include "study/script/asked_question.h"

#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {

std::string flaw_of_answer(AskedQuestion const& q, std::string const& answer)
{
    if (answer.empty() || q.type == AskedType::text) return {};
    if (q.type == AskedType::choice) {
        if (std::find(q.choices.begin(), q.choices.end(), answer) != q.choices.end()) return {};
        std::string all;
        for (std::string const& choice : q.choices) all += (all.empty() ? "" : ", ") + choice;
        return "choose one of: " + all;
    }
    auto const number = gi::parse_finite(answer);
    bool const is_answer =
        number && *number >= q.low && *number <= q.high && (!q.is_whole || *number == std::floor(*number));
    return is_answer
               ? ""
               : fmt::format("write a {}number from {:g} to {:g}", q.is_whole ? "whole " : "", q.low, q.high);
}

} // namespace study
