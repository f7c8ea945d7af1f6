#include "gi/scene/model/sky.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

dvec3 direction_to(double theta, double phi)
{
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

/// Contribution of a texel of each row to the bilinear map: a hat function over the row and its neighbours,
/// constant at the poles.
struct RowHats {
    std::vector<double> solid_angle; ///< integral, sr
    std::vector<double> cosine;      ///< mean of max(cos theta, 0); falls from row to row down to the horizon

    RowHats(std::uint32_t width, std::uint32_t height)
    {
        constexpr int kParts = 64; // per half row
        double const row = kPiD / height;
        for (std::uint32_t y = 0; y < height; ++y) {
            double sum = 0, cosines = 0;
            for (int k = -2 * kParts; k < 2 * kParts; ++k) {
                double const off = (k + 0.5) / (2 * kParts), theta = (y + 0.5 + off) * row;
                if (theta < 0 || theta > kPiD) continue;
                bool const level = theta < 0.5 * row || theta > kPiD - 0.5 * row;
                double const weight = (level ? 1 : 1 - std::abs(off)) * std::sin(theta) * row / (2 * kParts);
                sum += weight;
                cosines += weight * std::max(std::cos(theta), 0.0);
            }
            solid_angle.push_back(sum * 2 * kPiD / width);
            cosine.push_back(cosines / sum);
        }
    }
    /// Returns the row and the fraction towards the next row at which the interpolated mean cosine is `cos_theta`.
    std::pair<std::uint32_t, double> place(double cos_theta) const
    {
        auto const below = std::lower_bound(cosine.begin(), cosine.end(), cos_theta, std::greater<>());
        if (below == cosine.begin()) return {0, 0};
        auto const first = std::uint32_t(below - cosine.begin() - 1);
        if (below == cosine.end()) return {first, 0};
        return {first, (cosine[first] - cos_theta) / (cosine[first] - *below)};
    }
};

void add_sun(Sky const& sky, double azimuth, EnvironmentMap& map)
{
    RowHats const hats(map.width, map.height);
    double const r = kSunRadiusRad, sun = std::acos(glm::clamp(sky.to_sun().y, -1.0, 1.0));
    double const row = kPiD / map.height, column = 2 * kPiD / map.width;
    auto const strips = int(std::clamp(std::ceil(8 * r / row), 32.0, 4096.0));
    dvec3 const radiance = sky.sun_radiance();
    // The disc is divided into strips of equal theta and these into pieces,
    // each smaller than an eighth of a texel.
    struct Piece {
        double theta, phi, solid_angle;
    };
    std::vector<Piece> pieces;
    double whole = 0;
    double const top = std::max(0.0, sun - r), bottom = sun + r;
    for (int i = 0; i < strips; ++i) {
        double const width = (bottom - top) / strips, theta = top + (i + 0.5) * width;
        double const across = std::sin(theta) * std::sin(sun);
        double const cosine = across > 0 ? (std::cos(r) - std::cos(theta) * std::cos(sun)) / across : -1;
        double const half = std::acos(glm::clamp(cosine, -1.0, 1.0));
        auto const n = int(std::clamp(std::ceil(16 * half / column), 8.0, 1e6));
        for (int k = 0; k < n; ++k) {
            double const solid_angle = 2 * half / n * std::sin(theta) * width;
            whole += solid_angle;
            pieces.push_back({theta, azimuth + half * ((2 * k + 1.0) / n - 1), solid_angle});
        }
    }
    double const scale = 2 * kPiD * (1 - std::cos(r)) / whole;
    std::vector<double> share(std::size_t(map.width) * map.height, 0.0); // per texel: fraction covered by the disc
    for (Piece const& p : pieces) {
        if (p.theta > kPiD / 2) continue;
        auto const [y, next_row] = hats.place(std::cos(p.theta));
        double const x = (p.phi / (2 * kPiD) + 0.5) * map.width - 0.5, left = std::floor(x), next = x - left;
        auto const column_of = [&](double c) {
            auto const w = double(map.width);
            return std::uint32_t(c - w * std::floor(c / w)) % map.width;
        };
        auto const add = [&](std::uint32_t at_row, double at_column, double weight) {
            if (!(weight > 0)) return;
            share[std::size_t(at_row) * map.width + column_of(at_column)] +=
                weight * p.solid_angle * scale / hats.solid_angle[at_row];
        };
        for (int k = 0; k < 2; ++k) {
            double const beside = k == 0 ? 1 - next : next;
            add(y, left + k, beside * (1 - next_row));
            add(y + 1, left + k, beside * next_row);
        }
    }
    for (std::size_t i = 0; i < share.size(); ++i)
        if (share[i] > 0) map.radiance[i] += vec3(radiance * share[i]);
}

} // namespace

EnvironmentMap sky_map(SkyOptions const& o)
{
    Sky const sky(o);
    EnvironmentMap map;
    map.width = o.width;
    map.height = o.height;
    map.radiance.resize(std::size_t(o.width) * o.height);
    auto const points = std::clamp(int(1024 / o.height), 1, 8); // per side of a texel
    tbb::parallel_for(std::uint32_t(0), o.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < o.width; ++x) {
            dvec3 sum{0};
            double weights = 0;
            for (int k = 0; k < points * points; ++k) {
                double const theta = (y + (k / points + 0.5) / points) * kPiD / o.height;
                double const phi = ((x + (k % points + 0.5) / points) / o.width - 0.5) * 2 * kPiD;
                sum += std::sin(theta) * dvec3(sky.radiance(direction_to(theta, phi)));
                weights += std::sin(theta);
            }
            map.radiance[std::size_t(y) * o.width + x] = vec3(sum / weights);
        }
    });
    if (o.sun) add_sun(sky, glm::radians(o.sun_azimuth_deg), map);
    return map;
}

} // namespace gi
