#include "gi/filter/filter_area.h"

#include "gi/filter/filter_input.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <utility>

namespace gi {
namespace {

/// Channels that are too dark in the partner's picture have no known light.
bool tells(vec3 there, vec3 here)
{
    for (int c = 0; c < 3; ++c)
        if (there[c] < kDarkest && here[c] >= kDarkest) return false;
    return true;
}

RowSpans whole_rows(Picture const& picture)
{
    return RowSpans(std::size_t(picture.height),
                    picture.width > 0 ? std::vector<Span>{{0, picture.width}} : std::vector<Span>{});
}

} // namespace

RowSpans widened(RowSpans const& rows, int reach, int width)
{
    int const height = int(rows.size());
    RowSpans wide(rows.size());
    tbb::parallel_for(0, height, [&](int y) {
        thread_local std::vector<int> begun; // per pixel: number of spans that begin minus number that end there
        begun.assign(std::size_t(width) + 1, 0);
        for (int there = std::max(0, y - reach); there <= std::min(height - 1, y + reach); ++there)
            for (Span const& s : rows[std::size_t(there)]) {
                ++begun[std::size_t(std::max(0, s.first - reach))];
                --begun[std::size_t(std::min(width, s.end + reach))];
            }
        int inside = 0;
        for (int x = 0; x <= width; ++x) {
            int const before = std::exchange(inside, inside + begun[std::size_t(x)]);
            if (before == 0 && inside > 0) wide[std::size_t(y)].push_back({x, width});
            if (before > 0 && inside == 0) wide[std::size_t(y)].back().end = x;
        }
    });
    return wide;
}

FilterArea whole_area(Picture const& picture)
{
    Layer const& normal = needed_layer(picture, "normal");
    FilterArea area{RowSpans(std::size_t(picture.height)), whole_rows(picture)};
    for (int y = 0; y < picture.height; ++y) {
        std::size_t const row = std::size_t(y) * std::size_t(picture.width);
        Span s{0, picture.width};
        while (s.first < s.end && rgb(normal, row + std::size_t(s.first)) == vec3{0}) ++s.first;
        while (s.end > s.first && rgb(normal, row + std::size_t(s.end - 1)) == vec3{0}) --s.end;
        if (s.first < s.end) area.wanted[std::size_t(y)].push_back(s);
    }
    return area;
}

FilterArea own_area(Picture const& picture, ReusedLight const& taken, int reach)
{
    Layer const &albedo = needed_layer(picture, "albedo"), &normal = needed_layer(picture, "normal"),
                &other = needed_layer(*taken.partner, "albedo");
    FilterArea area{RowSpans(std::size_t(picture.height)), {}, true};
    tbb::parallel_for(0, picture.height, [&](int y) {
        std::vector<Span>& wanted = area.wanted[std::size_t(y)];
        for (int x = 0; x < picture.width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
            std::uint32_t const from = taken.from[i];
            if (rgb(normal, i) == vec3{0}) continue;
            if (from != kOwnLight && tells(rgb(other, from), rgb(albedo, i))) continue;
            if (!wanted.empty() && wanted.back().end == x)
                ++wanted.back().end;
            else
                wanted.push_back({x, x + 1});
        }
    });
    bool const all = reach >= std::max(picture.width, picture.height);
    area.near = all ? whole_rows(picture) : widened(area.wanted, std::max(1, reach), picture.width);
    return area;
}

} // namespace gi
