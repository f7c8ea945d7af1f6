#include "study/analysis/own_fit.h"

#include "study/numeric/special.h"
#include "study/script/procedure_settings.h"
#include "study/stats/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace study {

ThresholdEstimate maximum_likelihood_estimate(ThresholdRun const& run, Block const& b,
                                              PsychometricChoice const& function, std::optional<double> guess,
                                              double proportion, AnalysisSettings const& settings)
{
    ThresholdEstimate e{"maximum likelihood", proportion, {}, {}};
    try {
        PsychometricSettings s;
        s.shape = shape_of(b.compare->scale, b.compare->harder_up, function);
        s.guess.value = guess.value_or(0);
        s.lapse.value = settings.lapse.value_or(0.02);
        auto const fit = fit_psychometric(count_levels(run.levels, run.correct), s);
        auto const on_u = [&](double level) { return transformed(fit.shape, level); };
        double const level = level_at(fit.shape, fit.parameters, proportion);
        e.note = fit.note;
        if (e.note.empty() && !guess) e.note = "no trials without a signal: a false alarm rate of 0 is assumed";
        double const error = standard_error_at(fit, proportion);
        if (std::isfinite(level)) {
            e.level = {level, {kUnknown, kUnknown}, 1};
            if (error > 0 && std::isfinite(error)) {
                double const half = normal_quantile((1 + settings.confidence) / 2) * error, u = on_u(level);
                auto const back = [&](double v) {
                    double const x = fit.shape.direction == Direction::falling ? -v : v;
                    return fit.shape.axis == Axis::log10 ? std::pow(10.0, x) : x;
                };
                e.level.interval = {std::min(back(u - half), back(u + half)),
                                    std::max(back(u - half), back(u + half))};
            }
        } else if (fit.note.empty())
            e.note = "the fitted function never reaches this proportion";
    } catch (std::invalid_argument const& error) {
        e.note = error.what();
    }
    return e;
}

void fit_pooled(CurveResult& r, Block const& b, std::vector<std::vector<LevelCount>> const& observers,
                double guess, AnalysisSettings const& settings)
{
    Scale const scale = b.compare->scale;
    PsychometricSettings s;
    s.shape = r.shape;
    s.guess.value = guess;
    if (guess == 0 && !settings.guess) s.guess.limit = 0.5;
    s.lapse = {0.01, 0.06};
    if (settings.lapse) s.lapse = {*settings.lapse, 0};
    auto const pooled = [&](std::span<int const> chosen) {
        std::vector<LevelCount> all;
        for (int const o : chosen)
            all.insert(all.end(), observers[std::size_t(o)].begin(), observers[std::size_t(o)].end());
        return all;
    };
    auto const level = [&](std::span<int const> chosen) {
        auto const fit = fit_psychometric(pooled(chosen), s);
        double const at = level_at(fit.shape, fit.parameters, r.proportion);
        if (!std::isfinite(at)) throw std::invalid_argument("the function never reaches this proportion");
        return std::vector<double>{to_scale(scale, at)};
    };
    try {
        std::vector<int> everyone;
        for (int o = 0; o < int(observers.size()); ++o) everyone.push_back(o);
        r.pooled = fit_psychometric(pooled(everyone), s);
        r.parameters = r.pooled.parameters;
        r.note = r.pooled.note;
        r.threshold = {level_at(r.shape, r.parameters, r.proportion), {kUnknown, kUnknown}, r.observers};
        BootstrapSettings const bs{std::min(settings.replicates, 400), settings.confidence, settings.seed};
        Interval const i = bootstrap(r.observers, level, bs).interval.front();
        r.threshold.interval = {from_scale(scale, i.low), from_scale(scale, i.high)};
    } catch (std::invalid_argument const& e) {
        r.refused = e.what();
    }
}

} // namespace study
