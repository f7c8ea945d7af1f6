#include "gi/image/denoise.h"

#include "gi/base/error.h"
#include "gi/base/threads.h"
#include "gi/image/atrous.h"
#include "gi/image/discontinuity.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

void check(Picture const& picture, DenoiseSettings const& s)
{
    if (s.iterations < 1 || s.iterations > kMaxIterations)
        throw InputError("an a-trous filter of " + std::to_string(s.iterations) + " iterations",
                         "there are 1 to " + std::to_string(kMaxIterations), "choose one of them");
    if (s.window < 1 || s.window > kMaxWindow)
        throw InputError("a discontinuity buffer of " + std::to_string(s.window) + " pixels",
                         "there are 1 to " + std::to_string(kMaxWindow), "choose one of them");
    if (s.reach < 0 || s.reach > kMaxReach / s.window)
        throw InputError("indirect light over " + std::to_string(s.reach) + " windows to each side",
                         "they may reach over " + std::to_string(kMaxReach) + " pixels", "choose fewer");
    for (char const* const name : {"color", "L0"})
        if (picture.find(name) == nullptr)
            throw InputError(std::string("the picture has no layer '") + name + "'",
                             "the filtered picture is L0 + L1 + L2", "keep all layers until it is filtered");
}

/// Multiplies the albedo back, where there was a surface to go by.
void store(Picture& picture, Planes const& guides, Planes const& filtered)
{
    Layer const &l0 = *picture.find("L0"), &albedo = *picture.find("albedo");
    Layer &color = *picture.find("color"), &l1 = *picture.find("L1"), &l2 = *picture.find("L2");
    tbb::parallel_for(0, picture.height, [&](int y) {
        auto const direct = filtered.row3(light::direct, y), indirect = filtered.row3(light::indirect, y);
        for (int x = 0; x < picture.width; ++x) {
            if (guides.row(guide::surface, y)[x] == 0) continue;
            std::size_t const i = std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
            vec3 const a = rgb(albedo, i), e1 = direct[x] * a, e2 = indirect[x] * a;
            for (int c = 0; c < 3; ++c) {
                std::size_t const k = 3 * i + std::size_t(c);
                if (a[c] < kDarkest) continue;
                l1.data[k] = e1[c];
                l2.data[k] = e2[c];
                color.data[k] = l0.data[k] + e1[c] + e2[c];
            }
        }
    });
}

} // namespace

DenoiseReport denoise(Picture& picture, DenoiseSettings const& settings, TakenLight const& taken)
{
    if (settings.denoiser == Denoiser::none) return {};
    check(picture, settings);
    DenoiseReport report;
    on_threads(settings.threads, [&] {
        bool const atrous = settings.denoiser == Denoiser::atrous;
        FilterInput input = make_filter_input(picture, atrous);
        KnownLight const known = taken.partner ? known_from(picture, input, taken) : nothing_known(input);
        store(picture, input.guides,
              atrous ? filter_atrous(input, settings.iterations, known)
                     : filter_discontinuity(input, settings.window, settings.reach, known));
        report = input.report;
    });
    return report;
}

} // namespace gi
