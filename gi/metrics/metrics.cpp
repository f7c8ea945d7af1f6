#include "gi/metrics/metrics.h"

#include <array>
#include <limits>

namespace gi {

ErrorSums measure_errors(std::vector<float> const& image, std::vector<float> const& reference, int channels)
{
    ErrorSums e;
    std::array<double, 3> sum_image{}, sum_reference{};
    double squares = 0, relative = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        double const x = double(image[i]), r = double(reference[i]);
        if (!std::isfinite(x) || !std::isfinite(r)) {
            ++e.not_finite;
            continue;
        }
        ++n;
        double const d = x - r;
        squares += d * d;
        relative += d * d / (r * r + kRelativeFloor);
        std::size_t const c = channels >= 3 ? i % std::size_t(channels) : 0;
        if (c > 2) continue;
        sum_image[c] += x;
        sum_reference[c] += r;
    }
    if (n == 0) {
        double const unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown, dvec3{unknown}, unknown, e.not_finite};
    }
    e.rmse = std::sqrt(squares / double(n));
    e.relmse = relative / double(n);
    auto const ratio = [](double a, double b) {
        return b != 0 ? a / b : (a == 0 ? 1 : std::numeric_limits<double>::infinity());
    };
    for (std::size_t c = 0; c < 3; ++c) {
        std::size_t const from = channels >= 3 ? c : 0;
        e.bias[int(c)] = ratio(sum_image[from], sum_reference[from]);
    }
    e.mean_bias =
        ratio(sum_image[0] + sum_image[1] + sum_image[2], sum_reference[0] + sum_reference[1] + sum_reference[2]);
    return e;
}

double psnr(std::vector<float> const& image, std::vector<float> const& reference)
{
    double squares = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        double const d = double(image[i]) - double(reference[i]);
        squares += d * d;
    }
    double const mse = squares / double(std::max<std::size_t>(1, image.size()));
    return mse > 0 ? -10 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

} // namespace gi
