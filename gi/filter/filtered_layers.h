#pragma once
// The layers of a picture that filters replace, accessed as light over albedo.

#include "gi/filter/filter_input.h"

namespace gi {

struct FilteredLayers {
    Layer const &l0, &albedo;
    Layer &color, &l1, &l2;

    /// Throws InputError if one is missing.
    explicit FilteredLayers(Picture& picture)
        : l0(needed_layer(picture, "L0")),
          albedo(needed_layer(picture, "albedo")),
          color(needed_layer(picture, "color")),
          l1(needed_layer(picture, "L1")),
          l2(needed_layer(picture, "L2"))
    {
    }
    vec3 direct(std::size_t pixel) const { return over_albedo(rgb(l1, pixel), rgb(albedo, pixel)); }
    vec3 indirect(std::size_t pixel) const { return over_albedo(rgb(l2, pixel), rgb(albedo, pixel)); }
    /// Channels that are too dark keep their values.
    void put(std::size_t pixel, vec3 direct, vec3 indirect) const
    {
        vec3 const a = rgb(albedo, pixel), e1 = direct * a, e2 = indirect * a;
        for (int c = 0; c < 3; ++c) {
            std::size_t const k = 3 * pixel + std::size_t(c);
            if (a[c] < kDarkest) continue;
            l1.data[k] = e1[c];
            l2.data[k] = e2[c];
            color.data[k] = l0.data[k] + e1[c] + e2[c];
        }
    }
};

} // namespace gi
