#include "ar/light/light_basis.h"

#include "gi/core/error.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace ar {

LightBasis::LightBasis(int count)
{
    if (count < 16)
        throw gi::InputError(fmt::format("an environment of {} directions", count), "it has no sides",
                             "give at least 16");
    double const golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int k = 0; k < count; ++k) {
        double const y = 1 - (2 * k + 1.0) / count, r = std::sqrt(1 - y * y);
        directions_.emplace_back(r * std::cos(golden * k), y, r * std::sin(golden * k));
    }
    // Cells of a hexagonal grid are 1.9 radii of a cap of their area apart, next ones but one 3.3.
    double const reach = std::cos(2.5 * cell_radius_rad());
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            if (glm::dot(direction(a), direction(b)) > reach) neighbours_.emplace_back(a, b);
    nearest_.create(90, 180, CV_32SC1);
    for (int j = 0; j < nearest_.rows; ++j)
        for (int i = 0; i < nearest_.cols; ++i) {
            glm::dvec3 const d = texel_direction(nearest_.size(), i, j);
            int best = 0;
            for (int k = 1; k < count; ++k)
                if (glm::dot(d, direction(k)) > glm::dot(d, direction(best))) best = k;
            nearest_.at<int>(j, i) = best;
        }
}

double LightBasis::cell_sr() const { return 4 * std::numbers::pi / count(); }

double LightBasis::cell_radius_rad() const { return std::acos(1 - 2.0 / count()); }

int LightBasis::nearest(glm::dvec3 direction) const
{
    glm::dvec2 const uv = uv_of(direction);
    return nearest_.at<int>(std::clamp(int(uv.y * nearest_.rows), 0, nearest_.rows - 1),
                            std::clamp(int(uv.x * nearest_.cols), 0, nearest_.cols - 1));
}

cv::Mat LightBasis::spread(cv::Mat const& values, cv::Size size) const
{
    double const sigma = cell_radius_rad(), reach = std::cos(3 * sigma);
    int const channels = values.channels();
    cv::Mat out(size, values.type());
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        std::vector<double> sum(static_cast<std::size_t>(channels));
        for (int j = rows.start; j < rows.end; ++j)
            for (int i = 0; i < size.width; ++i) {
                glm::dvec3 const d = texel_direction(size, i, j);
                std::fill(sum.begin(), sum.end(), 0.0);
                double weights = 0;
                for (int k = 0; k < count(); ++k) {
                    double const cosine = glm::dot(d, direction(k));
                    if (cosine < reach) continue;
                    double const weight = std::exp((cosine - 1) / (sigma * sigma)); // of a normal distribution
                    weights += weight;
                    for (int c = 0; c < channels; ++c) sum[std::size_t(c)] += weight * values.ptr<float>(k)[c];
                }
                for (int c = 0; c < channels; ++c)
                    out.ptr<float>(j)[i * channels + c] = float(sum[std::size_t(c)] / weights);
            }
    });
    return out;
}

} // namespace ar
