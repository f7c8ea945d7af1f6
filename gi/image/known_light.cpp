#include "gi/image/known_light.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Of channels that are too dark in the partner's picture nothing is known.
bool tells(vec3 there, vec3 here)
{
    for (int c = 0; c < 3; ++c)
        if (there[c] < kDarkest && here[c] >= kDarkest) return false;
    return true;
}

} // namespace

KnownLight nothing_known(FilterInput const& input)
{
    int const width = input.guides.width();
    KnownLight known{{}, {}, width};
    for (int y = 0; y < input.guides.height(); ++y) {
        float const* const surface = input.guides.row(guide::surface, y);
        Span s{0, width};
        while (s.first < s.end && surface[s.first] == 0) ++s.first;
        while (s.end > s.first && surface[s.end - 1] == 0) --s.end;
        known.wanted.push_back({s});
    }
    return known;
}

KnownLight known_from(Picture const& picture, FilterInput const& input, TakenLight const& taken)
{
    int const width = picture.width, height = picture.height;
    Layer const &albedo = *picture.find("albedo"), &l1 = *taken.partner->find("L1"),
                &l2 = *taken.partner->find("L2"), &other = *taken.partner->find("albedo");
    KnownLight known{std::vector<std::vector<Span>>(std::size_t(height)), Planes(light::luminance, width, height),
                     width};
    tbb::parallel_for(0, height, [&](int y) {
        auto const direct = known.light->row3(light::direct, y), indirect = known.light->row3(light::indirect, y);
        float const* const surface = input.guides.row(guide::surface, y);
        std::vector<Span>& wanted = known.wanted[std::size_t(y)];
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (surface[x] == 0) { // keeps its values
                direct.set(x, vec3{0});
                indirect.set(x, vec3{0});
                continue;
            }
            std::uint32_t const from = taken.from[i];
            vec3 const a = from == kOwnLight ? vec3{0} : rgb(other, from);
            if (from == kOwnLight || !tells(a, rgb(albedo, i))) {
                if (!wanted.empty() && wanted.back().end == x)
                    ++wanted.back().end;
                else
                    wanted.push_back({x, x + 1});
                continue;
            }
            direct.set(x, over_albedo(rgb(l1, from), a));
            indirect.set(x, over_albedo(rgb(l2, from), a));
        }
    });
    return known;
}

} // namespace gi
