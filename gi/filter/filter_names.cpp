#include "gi/filter/filter_names.h"

#include "gi/core/error.h"
#include "gi/filter/oidn.h"

#include <array>

namespace gi {
namespace {

constexpr std::array kFilters{
    NamedFilter{"none", "", {.denoiser = Denoiser::none}},
    NamedFilter{"discontinuity", "mean over 4 x 4 pixels of one surface", {.denoiser = Denoiser::discontinuity}},
    NamedFilter{"wide",
                "the same, and once more over 20 x 20 for indirect light",
                {.denoiser = Denoiser::discontinuity, .reach = 2}},
    NamedFilter{"atrous", "wavelet guided by the variance, 2 paths or more", {.denoiser = Denoiser::atrous}},
    NamedFilter{
        "oidn", "Intel Open Image Denoise, where installed (scripts/setup --oidn)", {.denoiser = Denoiser::oidn}},
    NamedFilter{"oidn-high",
                "the same with its larger network, slower",
                {.denoiser = Denoiser::oidn, .oidn_quality = OidnQuality::high}}};

} // namespace

std::span<NamedFilter const> named_filters() { return kFilters; }

std::vector<std::string> filter_names()
{
    std::vector<std::string> names;
    for (NamedFilter const& f : kFilters) names.emplace_back(f.name);
    return names;
}

DenoiseSettings find_filter(std::string_view name)
{
    std::string known;
    for (NamedFilter const& f : kFilters) {
        if (name == f.name) return f.settings;
        known += (known.empty() ? "" : ", ") + std::string(f.name);
    }
    throw InputError("filter '" + std::string(name) + "'", "it is not known here", "choose one of: " + known);
}

void check_filter(DenoiseSettings const& settings)
{
    if (settings.denoiser == Denoiser::oidn) check_oidn();
}

void check_filter(DenoiseSettings const& settings, std::uint32_t paths, bool has_reuse)
{
    check_filter(settings);
    if (settings.denoiser != Denoiser::none && !can_filter(settings, paths, has_reuse))
        throw InputError("--denoise atrous with --paths 1", "it needs the variance, which one path does not give",
                         "trace two paths or more, add --reuse to frames, or choose --denoise discontinuity");
}

bool can_filter(DenoiseSettings const& settings, std::uint32_t paths, bool has_reuse)
{
    return settings.denoiser != Denoiser::none &&
           (settings.denoiser != Denoiser::atrous || paths > 1 || has_reuse);
}

} // namespace gi
