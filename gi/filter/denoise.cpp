#include "gi/filter/denoise.h"

#include "gi/core/error.h"
#include "gi/core/threads.h"
#include "gi/filter/atrous.h"
#include "gi/filter/discontinuity.h"
#include "gi/filter/filtered_layers.h"
#include "gi/filter/oidn.h"

#include <algorithm>
#include <limits>
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

/// Radius of the filters' neighbourhood, pixels.
int reach_of(DenoiseSettings const& s)
{
    // a-trous estimates the split of the variance from the whole picture.
    return s.denoiser == Denoiser::atrous ? std::numeric_limits<int>::max()
                                          : std::max(s.window / 2, s.reach * s.window);
}

/// Multiplies by the albedo again in pixels that were filtered.
void store(Planes const& guides, Planes const& filtered, RowSpans const& wanted, Picture& picture)
{
    FilteredLayers const layers(picture);
    tbb::parallel_for(0, picture.height, [&](int y) {
        auto const direct = filtered.row3(light::direct, y), indirect = filtered.row3(light::indirect, y);
        float const* const surface = guides.row(guide::surface, y);
        for (Span const& s : wanted[std::size_t(y)])
            for (int x = s.first; x < s.end; ++x)
                if (surface[x] != 0)
                    layers.put(std::size_t(y) * std::size_t(picture.width) + std::size_t(x), direct[x],
                               indirect[x]);
    });
}

} // namespace

DenoiseReport denoise(Picture& picture, DenoiseSettings const& settings, ReusedLight const& taken)
{
    if (settings.denoiser == Denoiser::none) return {};
    check(picture, settings);
    if (settings.denoiser == Denoiser::oidn)
        return filter_oidn(picture, settings.oidn_quality, settings.threads, settings.stop);
    DenoiseReport report;
    on_threads(settings.threads, [&] {
        bool const atrous = settings.denoiser == Denoiser::atrous;
        FilteredLight known{taken.partner ? own_area(picture, taken, reach_of(settings)) : whole_area(picture),
                            {}};
        FilterInput input = make_filter_input(picture, atrous, known.area, settings.stop);
        if (taken.partner) known.light = take_filtered(picture, taken, known.area, input.report);
        store(input.guides,
              atrous ? filter_atrous(input, settings.iterations, known)
                     : filter_discontinuity(input, settings.window, settings.reach, known),
              known.area.wanted, picture);
        report = input.report;
    });
    return report;
}

} // namespace gi
