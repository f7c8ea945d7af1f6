#pragma once
// The shape that a luminous square leaves when it is out of focus or moves.

#include "gi/core/math.h"
#include "gi/hit_buffers/settings.h"
#include "gi/image_io/picture.h"
#include "gi/render/render_settings.h"

#include <cmath>

namespace gi::test {

inline constexpr int kBlurSize = 48; ///< pixels; the view is 30 degrees high

/// Of a pixel, at distance 1.
inline double pixel_tangent() { return 2 * std::tan(glm::radians(15.0)) / kBlurSize; }

inline RenderSettings blur_settings(std::uint32_t paths)
{
    RenderSettings s;
    s.width = s.height = kBlurSize;
    s.paths = paths;
    s.bounces = 0;
    s.seed = 5;
    s.of<SlhbSettings>().light_samples = 1;
    s.of<SlhbSettings>().shadow_resolution = 8;
    return s;
}

struct BlurShape {
    double sum = 0;                  ///< of the layer L0, red
    glm::dvec2 mean{0}, variance{0}; ///< px, px^2
};

inline BlurShape measure(Picture const& p)
{
    BlurShape s;
    glm::dvec2 squares{0};
    for (std::size_t i = 0; i < p.pixels(); ++i) {
        double const value = double(p.find("L0")->data[3 * i]);
        glm::dvec2 const at{double(i % std::size_t(p.width)) + 0.5, double(i / std::size_t(p.width)) + 0.5};
        s.sum += value;
        s.mean += value * at;
        squares += value * at * at;
    }
    s.mean /= s.sum;
    s.variance = squares / s.sum - s.mean * s.mean;
    return s;
}

/// Root mean square difference of the luminances of 4 x 4 pixels, averaged.
inline double block_distance(Picture const& a, Picture const& b)
{
    std::size_t const width = std::size_t(a.width), across = width / 4;
    std::vector<double> difference(across * std::size_t(a.height / 4));
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        vec3 const d = rgb(*a.find("color"), i) - rgb(*b.find("color"), i);
        difference[i / width / 4 * across + i % width / 4] += double(luminance(d)) / 16;
    }
    double sum = 0;
    for (double const d : difference) sum += d * d;
    return std::sqrt(sum / double(difference.size()));
}

} // namespace gi::test
