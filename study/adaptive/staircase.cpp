#include "study/adaptive/staircase.h"

#include "study/numeric/error.h"
#include "study/numeric/root.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace study {

Staircase::Staircase(StaircaseSettings settings) : settings_(std::move(settings)), level_(settings_.start)
{
    StaircaseSettings const& s = settings_;
    bool const steps_are_good = !s.steps.empty() && std::all_of(s.steps.begin(), s.steps.end(), [](double v) {
        return v > 0 && std::isfinite(v);
    });
    if (!steps_are_good || !(s.up_ratio > 0 && std::isfinite(s.up_ratio)))
        refuse("a staircase without steps, or with steps or a ratio that are not above 0", "it would not move",
               "give one step or more above 0");
    if (s.up < 1 || s.down < 1)
        refuse(std::to_string(s.up) + "-up-" + std::to_string(s.down) + "-down",
               "a step follows one response or more", "use 1 or more for both");
    if (!(s.low <= s.start && s.start <= s.high))
        refuse("start " + std::to_string(s.start), "it lies outside the limits", "start within them");
    if (s.kind != StepKind::linear && !(s.start > 0 && s.high > 0))
        refuse("start " + std::to_string(s.start), "multiplicative steps need levels above 0",
               "use linear steps or other levels");
    if (s.stop.reversals < 0 || s.stop.max_trials < 0 || s.stop.min_trials < 0 ||
        (s.stop.reversals == 0 && s.stop.max_trials == 0))
        refuse("a staircase that never stops", "neither reversals nor trials end it",
               "give a number of reversals, of trials, or both");
}

bool Staircase::finished() const
{
    int const trials = int(levels_.size());
    StopRule const& stop = settings_.stop;
    bool const enough =
        stop.reversals > 0 && int(reversals_.size()) >= stop.reversals && trials >= stop.min_trials;
    return enough || (stop.max_trials > 0 && trials >= stop.max_trials);
}

void Staircase::respond(bool correct)
{
    if (finished()) throw std::logic_error("a response to a staircase that has finished");
    levels_.push_back(level_);
    run_ = correct ? std::max(run_, 0) + 1 : std::min(run_, 0) - 1;
    bool const one_by_one = settings_.initial == InitialRule::one_by_one && reversals_.empty();
    if (correct && run_ >= (one_by_one ? 1 : settings_.down))
        move(-1);
    else if (!correct && -run_ >= (one_by_one ? 1 : settings_.up))
        move(1);
}

void Staircase::move(int direction)
{
    run_ = 0;
    if (direction_ != 0 && direction_ != direction) reversals_.push_back({int(levels_.size()) - 1, level_});
    direction_ = direction;
    double const step = settings_.steps[std::min(reversals_.size(), settings_.steps.size() - 1)] *
                        (direction > 0 ? settings_.up_ratio : 1) * direction;
    switch (settings_.kind) {
    case StepKind::linear:
        level_ += step;
        break;
    case StepKind::log10:
        level_ *= std::pow(10, step);
        break;
    case StepKind::db:
        level_ *= std::pow(10, step / 20);
        break;
    }
    level_ = std::clamp(level_, settings_.low, settings_.high);
}

double staircase_target(StaircaseSettings const& settings)
{
    double const wanted = settings.up_ratio / (1 + settings.up_ratio);
    int const u = settings.up, d = settings.down;
    return bisect(
        [&](double p) {
            double const q = 1 - p, pd = std::pow(p, d - 1), qu = std::pow(q, u - 1);
            // Runs of coin tosses (Feller 1968, XIII.8.6): probability that a run of heads comes first.
            return pd * (1 - qu * q) / (pd + qu - pd * qu) - wanted;
        },
        0, 1);
}

std::optional<double> mean_of_reversals(Staircase const& staircase, int last)
{
    std::size_t count = staircase.reversals().size();
    if (last > 0) count = std::min(count, std::size_t(last));
    if (count > 1) count -= count % 2;
    if (count == 0) return std::nullopt;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i)
        sum += staircase.reversals()[staircase.reversals().size() - 1 - i].level;
    return sum / double(count);
}

} // namespace study
