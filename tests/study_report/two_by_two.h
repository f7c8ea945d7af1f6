#pragma once
// A design whose power is known.

#include "study/power/power_study.h"
#include "study/script/script_file.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {

/// Two groups, two conditions, two ratings of each: the interaction is a t test of two groups' differences.
inline Script two_by_two()
{
    return parse_script(R"(schema: study/1
id: two
seed: 3
participants: {count: 12}
factors: {light: {day: {exposure: 0}, dusk: {exposure: -2}}, method: [exact, good]}
reference: {method: exact}
defaults: {stimulus_ms: 500}
counterbalance: {light: {method: between}}
sequence: [rated]
blocks:
  rated: {task: rating, cross: [method], repeats: 2, scale: {min: 0, max: 1000}}
)",
                        "two.yaml");
}
inline ObserverModel interacting(Script const& s)
{
    return read_observers(R"(quality: {method: {good: -0.5}, light: {dusk: -0.3}}
interactions: [{levels: {light: dusk, method: good}, jod: -1}]
between_sd: 0.2
lapse: 0
rating: {best: 0.5, span_jod: 20, between_sd: 0.02}
)",
                          "o.yaml", s);
}

/// The power of its interaction is that of the t test, by the noncentral t distribution (scipy): variance
/// 2 (1.0484^2 / 2 + 0.2^2), groups of half the participants each.
inline PowerStudy power_of_t_test(Script const& s, PowerSettings& p, std::vector<double> const& exact)
{
    p.test = "light x method";
    int calls = 0;
    PowerStudy study = study_power(s, interacting(s), p, [&](double) { return ++calls > 0; });
    EXPECT_TRUE(study.is_complete);
    EXPECT_EQ(study.points.size(), exact.size());
    for (std::size_t i = 0; i < std::min(exact.size(), study.points.size()); ++i) {
        PowerPoint const& point = study.points[i];
        EXPECT_EQ(point.simulations, p.simulations);
        EXPECT_EQ(point.refused, 0);
        EXPECT_NEAR(point.power, exact[i], 3.5 * std::sqrt(exact[i] * (1 - exact[i]) / p.simulations))
            << point.effect << ", " << point.participants;
        EXPECT_LE(point.interval.low, point.power);
    }
    return study;
}

} // namespace study::test
