#include "gi/metrics/compare.h"
#include "gi/metrics/flip.h"
#include "gi/metrics/picture_pair.h"

#include <algorithm>
#include <array>

namespace gi {

std::vector<unsigned char> difference_image(Picture const& image, Picture const& reference,
                                            std::string const& layer, int& width, int& height)
{
    PicturePair const p = pair_up(image, reference, layer);
    width = p.width;
    height = p.height;
    // Control points of the magma scale, evenly spaced.
    static constexpr std::array<std::array<float, 3>, 6> kScale{{{0.001f, 0.000f, 0.014f},
                                                                 {0.232f, 0.060f, 0.438f},
                                                                 {0.550f, 0.161f, 0.506f},
                                                                 {0.868f, 0.288f, 0.409f},
                                                                 {0.995f, 0.624f, 0.427f},
                                                                 {0.987f, 0.991f, 0.750f}}};
    std::vector<unsigned char> out;
    for (float const v : flip(clipped(p.finite_image), clipped(p.finite_reference), width, height)) {
        float const at = std::clamp(v, 0.0f, 1.0f) * float(kScale.size() - 1);
        auto const i = std::min(std::size_t(at), kScale.size() - 2);
        for (std::size_t c = 0; c < 3; ++c)
            out.push_back(
                static_cast<unsigned char>(255 * glm::mix(kScale[i][c], kScale[i + 1][c], at - float(i)) + 0.5f));
    }
    return out;
}

} // namespace gi
