#include "study/stats/ssq.h"

#include "study/stats/error.h"

#include <array>

namespace study {
namespace {

double sum_of(std::span<double const> symptoms, std::array<int, 7> const& items)
{
    double sum = 0;
    for (int const item : items) sum += symptoms[std::size_t(item) - 1];
    return sum;
}

} // namespace

SimulatorSickness simulator_sickness(std::span<double const> symptoms)
{
    if (symptoms.size() != 16)
        refuse(std::to_string(symptoms.size()) + " symptoms", "the questionnaire has 16",
               "give all of them in order");
    for (double const s : symptoms)
        if (!(s >= 0 && s <= 3))
            refuse("a symptom of " + std::to_string(s), "they go from 0 (none) to 3 (severe)",
                   "check the answers");
    double const n = sum_of(symptoms, {1, 6, 7, 8, 9, 15, 16}), o = sum_of(symptoms, {1, 2, 3, 4, 5, 9, 11});
    double const d = sum_of(symptoms, {5, 8, 10, 11, 12, 13, 14});
    return {9.54 * n, 7.58 * o, 13.92 * d, 3.74 * (n + o + d)};
}

} // namespace study
