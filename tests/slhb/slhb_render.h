#pragma once
// Rendering small scenes with the method slhb.

#include "gi/slhb/slhb.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {

struct SlhbRun {
    RenderResult result;
    std::map<std::string, Report::Loss> losses;
    std::map<std::string, double> counts;
};

inline RenderSettings small_settings(int size, std::uint32_t paths, int bounces)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.bounces = bounces;
    s.seed = 5;
    return s;
}

inline SlhbRun render_with_slhb(World const& world, Camera const& camera, RenderSettings const& settings)
{
    StopRequest stop;
    Report report;
    SlhbRun run{render_slhb(world, camera, settings, stop, {}, report), {}, {}};
    run.losses = report.losses();
    run.counts = report.counts();
    EXPECT_EQ(run.losses.count("path terms that were not finite, dropped"), 0u);
    for (Layer const& layer : run.result.picture.layers)
        for (float const v : layer.data) EXPECT_TRUE(std::isfinite(v)) << layer.name;
    return run;
}

} // namespace gi::test
