// Renders the generated Cornell box with 16 paths a pixel, prints the mean of its light, and the interval of a share of answers.
#include <cstdio>
#include <gi/methods/registry.h>
#include <gi/scene/generate/generate.h>
#include <gi/scene/model/world.h>
#include <memory>
#include <numeric>
#include <study/stats/binomial.h>

int main()
{
    gi::Report report; // counts what could not be computed
    auto const scene = std::make_shared<gi::Scene const>(gi::generate_cornell());
    gi::World const world = gi::build_world(scene, std::nullopt, report);
    gi::RenderSettings settings;
    settings.width = settings.height = 64;
    settings.paths = 16;
    gi::RenderResult const result =
        gi::find_method("paths").render(world, world.cameras.at(0), settings, {}, {}, report);
    auto const& color = result.picture.find("color")->data;
    std::printf("mean radiance %.3f\n", std::accumulate(color.begin(), color.end(), 0.0) / double(color.size()));
    study::Interval const share = study::wilson(16, 20);
    std::printf("16 of 20: %.2f to %.2f\n", share.low, share.high);
}
