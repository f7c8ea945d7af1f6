#include "study/adaptive/questplus_many.h"

#include "study/adaptive/grid_posterior.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

/// Product of the grids' sizes.
std::size_t size_of(std::vector<QuestGrid> const& grids)
{
    double size = 1;
    for (QuestGrid const& g : grids) {
        bool const are_numbers =
            std::all_of(g.values.begin(), g.values.end(), [](double v) { return std::isfinite(v); });
        if (g.values.empty() || !are_numbers)
            refuse("QUEST+ without a list of numbers for '" + g.name + "'", "its grid needs one value or more",
                   "give the values to consider");
        if (!g.prior.empty() && g.prior.size() != g.values.size())
            refuse("the prior of '" + g.name + "'", "it needs one weight for each value", "leave it out");
        size *= double(g.values.size());
    }
    constexpr double kMost = 1e7;
    if (size > kMost)
        refuse("a grid of " + std::to_string(size) + " points", "it would take too long", "make it coarser");
    return std::size_t(size);
}

double prior_of(std::vector<QuestGrid> const& grids, std::size_t index)
{
    double weight = 1;
    for (std::size_t g = grids.size(); g-- > 0;) {
        if (!grids[g].prior.empty()) weight *= grids[g].prior[index % grids[g].values.size()];
        index /= grids[g].values.size();
    }
    return weight;
}

} // namespace

std::vector<std::string> names_of(std::vector<QuestGrid> const& stimulus, std::vector<QuestGrid> const& parameters)
{
    std::vector<std::string> names;
    for (auto const* const grids : {&stimulus, &parameters})
        for (QuestGrid const& g : *grids) names.push_back(g.name);
    return names;
}

QuestPlusMany::QuestPlusMany(QuestManySettings settings) : settings_(std::move(settings))
{
    stimuli_ = size_of(settings_.stimulus);
    cells_ = size_of(settings_.parameters);
    if (double(stimuli_) * double(cells_) > 2e7)
        refuse(std::to_string(cells_) + " points of the prior times " + std::to_string(stimuli_) + " stimuli",
               "computing them would delay trials", "make the grids coarser");
    if (!settings_.formula || settings_.formula->names() != names_of(settings_.stimulus, settings_.parameters))
        refuse("QUEST+ with a formula of other values", "it must take the stimulus and the parameters",
               "make it of names_of()");
    for (std::size_t c = 0; c < cells_; ++c) posterior_.push_back(prior_of(settings_.parameters, c));
    normalise(posterior_);
    correct_ = noise_ = Matrix(stimuli_, cells_);
    for (std::size_t s = 0; s < stimuli_; ++s) {
        std::vector<double> values = stimulus(s);
        std::size_t const dimensions = values.size();
        for (std::size_t c = 0; c < cells_; ++c) {
            auto const parameters = point(settings_.parameters, c);
            values.resize(dimensions);
            values.insert(values.end(), parameters.begin(), parameters.end());
            double const p = (*settings_.formula)(values);
            if (!(p >= 0 && p <= 1))
                refuse("the formula gives " + std::to_string(p) + " at the stimulus " + std::to_string(values[0]),
                       "a proportion lies between 0 and 1", "correct the formula or the grids");
            correct_(s, c) = p;
            noise_(s, c) = entropy_of_event(p);
        }
    }
}

std::vector<double> QuestPlusMany::point(std::vector<QuestGrid> const& grids, std::size_t index) const
{
    std::vector<double> out(grids.size());
    for (std::size_t g = grids.size(); g-- > 0;) {
        out[g] = grids[g].values[index % grids[g].values.size()];
        index /= grids[g].values.size();
    }
    return out;
}

std::vector<double> QuestPlusMany::stimulus(std::size_t index) const { return point(settings_.stimulus, index); }

std::optional<std::size_t> QuestPlusMany::index_of(std::span<double const> wanted) const
{
    std::size_t index = 0;
    for (std::size_t g = 0; g < settings_.stimulus.size(); ++g) {
        auto const& values = settings_.stimulus[g].values;
        auto const found = std::find_if(values.begin(), values.end(), [&](double v) {
            return std::abs(v - wanted[g]) <= 1e-6 * std::max(std::abs(v), std::abs(wanted[g]));
        });
        if (found == values.end()) return {};
        index = index * values.size() + std::size_t(found - values.begin());
    }
    return index;
}

double QuestPlusMany::information(std::size_t stimulus) const
{
    double right = 0, noise = 0;
    for (std::size_t c = 0; c < cells_; ++c) {
        right += posterior_[c] * correct_(stimulus, c);
        noise += posterior_[c] * noise_(stimulus, c);
    }
    return entropy_of_event(right) - noise;
}

std::size_t QuestPlusMany::next() const
{
    std::vector<double> gain;
    for (std::size_t s = 0; s < stimuli_; ++s) gain.push_back(information(s));
    double const most = *std::max_element(gain.begin(), gain.end());
    return std::size_t(
        std::find_if(gain.begin(), gain.end(), [&](double g) { return g >= most - settings_.tie_tolerance; }) -
        gain.begin());
}

void QuestPlusMany::respond(std::size_t stimulus, bool correct)
{
    if (stimulus >= stimuli_)
        refuse("stimulus " + std::to_string(stimulus), "there are " + std::to_string(stimuli_) + " on the grid",
               "give an index of these");
    std::vector<double> updated = posterior_;
    for (std::size_t c = 0; c < cells_; ++c)
        updated[c] *= correct ? correct_(stimulus, c) : 1 - correct_(stimulus, c);
    normalise(updated);
    posterior_ = std::move(updated);
}

double QuestPlusMany::entropy() const
{
    double sum = 0;
    for (double const p : posterior_) sum -= p_log2_p(p);
    return sum;
}

std::vector<double> QuestPlusMany::mode() const
{
    return point(settings_.parameters,
                 std::size_t(std::max_element(posterior_.begin(), posterior_.end()) - posterior_.begin()));
}

std::vector<double> QuestPlusMany::marginal(std::size_t parameter) const
{
    auto const& grids = settings_.parameters;
    std::size_t stride = 1;
    for (std::size_t g = parameter + 1; g < grids.size(); ++g) stride *= grids[g].values.size();
    std::vector<double> sums(grids[parameter].values.size(), 0);
    for (std::size_t c = 0; c < cells_; ++c) sums[c / stride % sums.size()] += posterior_[c];
    return sums;
}

std::vector<double> QuestPlusMany::mean() const
{
    std::vector<double> out;
    for (std::size_t g = 0; g < settings_.parameters.size(); ++g) {
        auto const weights = marginal(g);
        double sum = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * settings_.parameters[g].values[i];
        out.push_back(sum);
    }
    return out;
}

std::vector<double> QuestPlusMany::standard_deviation() const
{
    std::vector<double> out, means = mean();
    for (std::size_t g = 0; g < settings_.parameters.size(); ++g) {
        auto const weights = marginal(g);
        double sum = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            double const away = settings_.parameters[g].values[i] - means[g];
            sum += weights[i] * away * away;
        }
        out.push_back(std::sqrt(sum));
    }
    return out;
}

} // namespace study
