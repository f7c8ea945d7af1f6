#include "gi/filter/filtered_light.h"

#include "gi/filter/filtered_layers.h"

#include <atomic>
#include <tbb/parallel_for.h>

namespace gi {

Planes take_filtered(Picture& picture, ReusedLight const& taken, FilterArea const& area, DenoiseReport& report)
{
    int const width = picture.width;
    Layer const &l1 = needed_layer(*taken.partner, "L1"), &l2 = needed_layer(*taken.partner, "L2"),
                &other = needed_layer(*taken.partner, "albedo"), &normal = needed_layer(picture, "normal");
    Planes near(light::luminance, width, picture.height);
    FilteredLayers const layers(picture);
    std::atomic<std::size_t> not_finite = 0;
    tbb::parallel_for(0, picture.height, [&](int y) {
        std::size_t const row = std::size_t(y) * std::size_t(width);
        std::size_t bad = 0;
        Span const whole{0, width};
        for_between({&whole, 1}, area.wanted[std::size_t(y)], [&](Span span) {
            for (int x = span.first; x < span.end; ++x) {
                std::size_t const i = row + std::size_t(x);
                std::uint32_t const from = taken.from[i];
                if (from == kOwnLight || rgb(normal, i) == vec3{0}) continue; // no reused light or no surface
                vec3 const a = rgb(other, from), e1 = over_albedo(rgb(l1, from), a),
                           e2 = over_albedo(rgb(l2, from), a);
                if (in_range(e1) && in_range(e2) && in_range(rgb(layers.albedo, i)))
                    layers.put(i, e1, e2);
                else
                    ++bad;
            }
        });
        not_finite += bad;
        auto const direct = near.row3(light::direct, y), indirect = near.row3(light::indirect, y);
        area.for_known(y, [&](Span span) {
            for (int x = span.first; x < span.end; ++x) {
                vec3 const e1 = layers.direct(row + std::size_t(x)), e2 = layers.indirect(row + std::size_t(x));
                bool const finite = in_range(e1) && in_range(e2);
                direct.set(x, finite ? e1 : vec3{0});
                indirect.set(x, finite ? e2 : vec3{0});
            }
        });
    });
    report.not_finite += not_finite;
    return near;
}

} // namespace gi
