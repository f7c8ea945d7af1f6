#include "gi/metrics/neighbour_correlation.h"

#include "gi/filter/tone_map.h"

#include <cmath>

namespace gi {
namespace {

/// Sums over pairs (a, b); each pair is counted in both orders, so that a and b have the same mean.
struct PairMoments {
    double n = 0, sum = 0, squares = 0, products = 0;

    void add(double a, double b)
    {
        if (!std::isfinite(a) || !std::isfinite(b)) return;
        n += 2;
        sum += a + b;
        squares += a * a + b * b;
        products += 2 * a * b;
    }
};

} // namespace

float neighbour_correlation(std::vector<float> const& image, std::vector<float> const& reference, int width,
                            int height)
{
    std::size_t const w = std::size_t(width), h = std::size_t(height);
    std::vector<float> error(w * h);
    for (std::size_t i = 0; i < error.size(); ++i) {
        auto const y = [&](std::vector<float> const& v) {
            return luminance({v[3 * i], v[3 * i + 1], v[3 * i + 2]});
        };
        float const r = y(reference);
        error[i] = (y(image) - r) / (r + kErrorFloor);
    }
    PairMoments m;
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0; x < w; ++x) {
            double const e = double(error[y * w + x]);
            if (x + 1 < w) m.add(e, double(error[y * w + x + 1]));
            if (y + 1 < h) m.add(e, double(error[(y + 1) * w + x]));
        }
    if (m.n == 0) return std::nanf("");
    double const mean = m.sum / m.n, variance = m.squares / m.n - mean * mean;
    if (!(variance > 1e-12 * m.squares / m.n)) return std::nanf("");
    return float((m.products / m.n - mean * mean) / variance);
}

} // namespace gi
