#include "study/stats/rankings.h"

#include "study/numeric/error.h"
#include "study/stats/pairs.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

void check(std::span<ChoiceAmong const> choices, int items)
{
    if (items < 1) refuse("rankings of no items", "there is nothing to scale", "give one item or more");
    for (ChoiceAmong const& c : choices) {
        std::vector<int> all = c.rejected;
        all.push_back(c.chosen);
        std::sort(all.begin(), all.end());
        if (all.front() < 0 || all.back() >= items)
            refuse("item " + std::to_string(all.front() < 0 ? all.front() : all.back()),
                   "items are numbered from 0 to " + std::to_string(items - 1), "check the item numbers");
        if (std::adjacent_find(all.begin(), all.end()) != all.end())
            refuse("item " + std::to_string(*std::adjacent_find(all.begin(), all.end())) +
                       " comes twice in a choice or ranking",
                   "each has one place", "check the item numbers");
    }
}

/// wins(i, j) = how often i was chosen and j was not.
Matrix wins_over(std::span<ChoiceAmong const> choices, int items)
{
    auto const n = std::size_t(items);
    Matrix wins(n, n);
    for (ChoiceAmong const& c : choices)
        for (int const r : c.rejected) wins(std::size_t(c.chosen), std::size_t(r)) += 1;
    return wins;
}

void add_choice(ChoiceAmong const& choice, std::span<double const> at, Likelihood& l)
{
    auto const score = [&](int item) { return item == 0 ? 0 : at[std::size_t(item) - 1]; };
    std::vector<int> among = choice.rejected;
    among.push_back(choice.chosen);
    double largest = score(choice.chosen), sum = 0;
    for (int const i : among) largest = std::max(largest, score(i));
    for (int const i : among) sum += std::exp(score(i) - largest);
    l.log_likelihood += score(choice.chosen) - largest - std::log(sum);
    if (choice.chosen > 0) l.gradient[std::size_t(choice.chosen) - 1] += 1;
    for (int const i : among) {
        if (i == 0) continue;
        auto const a = std::size_t(i) - 1;
        double const pa = std::exp(score(i) - largest) / sum;
        l.gradient[a] -= pa;
        l.information(a, a) += pa;
        for (int const j : among)
            if (j != 0) l.information(a, std::size_t(j) - 1) -= pa * std::exp(score(j) - largest) / sum;
    }
}

} // namespace

std::vector<ChoiceAmong> choices_of(std::span<int const> ranking)
{
    std::vector<ChoiceAmong> choices;
    for (std::size_t i = 0; i + 1 < ranking.size(); ++i)
        choices.push_back({ranking[i], {ranking.begin() + std::ptrdiff_t(i) + 1, ranking.end()}});
    return choices;
}

PlackettLuce fit_plackett_luce(std::span<ChoiceAmong const> choices, int items)
{
    check(choices, items);
    Matrix const wins = wins_over(choices, items);
    std::vector<int> const part = connected_parts(wins);
    if (*std::max_element(part.begin(), part.end()) > 0)
        refuse("items that no chain of choices connects", "the distance between them is unknown",
               "scale the connected items separately, or add rankings across them");
    std::size_t const parameters = std::size_t(items) - 1;
    LikelihoodAt const model = [&](std::span<double const> at, Likelihood& l) {
        l.clear(parameters);
        for (ChoiceAmong const& c : choices) add_choice(c, at, l);
    };

    PlackettLuce result;
    MaximumLikelihood fit;
    bool const finite = each_beats_each(wins);
    if (finite) fit = maximise(model, std::vector<double>(parameters, 0));
    if (!finite || runs_off(fit)) {
        fit = maximise(with_jeffreys_prior(model), std::vector<double>(parameters, 0));
        result.regularised = true;
        result.note =
            "some items were always ranked before all others, so that maximum likelihood would be infinite: "
            "regularised by Jeffreys' prior";
    }
    if (!fit.converged) result.note += std::string(result.note.empty() ? "" : "; ") + "the fit did not converge";
    Scores scores = centred(fit, std::size_t(items));
    result.score = std::move(scores.score);
    result.standard_error = std::move(scores.standard_error);
    result.covariance = std::move(scores.covariance);
    Likelihood at_fit;
    model(fit.estimate, at_fit);
    result.log_likelihood = at_fit.log_likelihood;
    return result;
}

} // namespace study
