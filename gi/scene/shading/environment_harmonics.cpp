#include "gi/scene/shading/environment_harmonics.h"

#include "gi/scene/shading/light_sampling.h"
#include "gi/scene/shading/spherical_harmonics.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kDegrees = EnvironmentHarmonics::kMostDegree + 1;
constexpr double kCosineLobe[kDegrees] = {kPiD, 2 * kPiD / 3, kPiD / 4, 0, -kPiD / 24};

using Values = std::array<double, EnvironmentHarmonics::kMost>;

/// Theta-dependent factors of Y_lm, at index(l, m), m >= 0, orthonormal together with cos(m phi), sin(m phi).
Values polar_parts(double cos_theta, double sin_theta)
{
    auto const at = EnvironmentHarmonics::index;
    Values p{};
    for (int m = 0; m < kDegrees; ++m) {
        p[at(m, m)] =
            m == 0 ? std::sqrt(0.25 / kPiD) : std::sqrt((2 * m + 1) / (2.0 * m)) * sin_theta * p[at(m - 1, m - 1)];
        for (int l = m + 1; l < kDegrees; ++l) {
            double const two_below = l > m + 1 ? p[at(l - 2, m)] : 0, k = l - 1;
            p[at(l, m)] = std::sqrt((4.0 * l * l - 1) / (l * l - m * m)) *
                          (cos_theta * p[at(l - 1, m)] - std::sqrt((k * k - m * m) / (4 * k * k - 1)) * two_below);
        }
    }
    for (int m = 1; m < kDegrees; ++m)
        for (int l = m; l < kDegrees; ++l) p[at(l, m)] *= std::sqrt(2.0);
    return p;
}

/// Integrals of a map row along phi: times cos(m phi) at index [m], times sin(m phi) at [-m], counted from the
/// middle of the array; and products of the row with itself and the row below.
struct RowSums {
    std::array<dvec3, 2 * kDegrees - 1> fourier{};
    dvec3 squared{0}, with_next{0};
};

RowSums sum_row(EnvironmentMap const& map, std::uint32_t y, std::vector<double> const (&waves)[2 * kDegrees - 1])
{
    RowSums s;
    std::uint32_t const w = map.width;
    double const du = 2 * kPiD / w;
    vec3 const* const row = &map.radiance[std::size_t(y) * w];
    vec3 const* const next = &map.radiance[std::size_t(std::min(y + 1, map.height - 1)) * w];
    for (std::uint32_t x = 0; x < w; ++x) {
        std::uint32_t const beside = x + 1 < w ? x + 1 : 0;
        dvec3 const a(row[x]), a1(row[beside]), b(next[x]), b1(next[beside]);
        for (std::size_t m = 0; m < s.fourier.size(); ++m) s.fourier[m] += waves[m][x] * a;
        s.squared += du / 3 * (a * a + a * a1 + a1 * a1);
        s.with_next += du / 6 * (2.0 * a * b + a * b1 + a1 * b + 2.0 * a1 * b1);
    }
    return s;
}

/// Gauss-Legendre nodes on [-1, 1] and their weights, exact up to degree 15.
constexpr double kGauss[8][2] = {
    {-0.96028985649753623, 0.10122853629037626}, {-0.79666647741362674, 0.22238103445337447},
    {-0.52553240991632899, 0.31370664587788729}, {-0.18343464249564980, 0.36268378337836198},
    {0.18343464249564980, 0.36268378337836198},  {0.52553240991632899, 0.31370664587788729},
    {0.79666647741362674, 0.22238103445337447},  {0.96028985649753623, 0.10122853629037626}};

} // namespace

std::array<double, EnvironmentHarmonics::kMost> spherical_harmonics(dvec3 d)
{
    Values y{};
    spherical_harmonics(d, EnvironmentHarmonics::kMostDegree, y.data());
    return y;
}

double EnvironmentHarmonics::energy_share(int up_to) const
{
    dvec3 sum{0};
    for (std::size_t i = 0; i < count(std::clamp(up_to, 0, degree)); ++i) sum += coefficients[i] * coefficients[i];
    double const whole = squared.x + squared.y + squared.z;
    return whole > 0 ? (sum.x + sum.y + sum.z) / whole : 1;
}

EnvironmentHarmonics project(EnvironmentMap const& map, double rotation_rad, dvec3 scale, int degree)
{
    if (degree < 0 || degree >= kDegrees)
        throw std::invalid_argument(
            fmt::format("harmonics of degree {} (0 to {} are supported)", degree, kDegrees - 1));
    EnvironmentHarmonics h;
    h.degree = degree;
    std::uint32_t const width = map.width, height = map.height;
    if (width == 0 || height == 0) return h;

    // A texel is a hat function along phi. Its integral times a wave is the hat's area times the wave's value at
    // the texel centre times sinc^2.
    std::vector<double> waves[2 * kDegrees - 1];
    double const du = 2 * kPiD / width;
    for (int m = -degree; m <= degree; ++m) {
        double const half = 0.5 * std::abs(m) * du, sinc = half > 0 ? std::sin(half) / half : 1;
        std::vector<double>& wave = waves[m + kDegrees - 1];
        for (std::uint32_t x = 0; x < width; ++x) {
            double const phi = -(x + 0.5) * du; // the map's columns run clockwise, from +Z
            wave.push_back(du * sinc * sinc * (m < 0 ? std::sin(-m * phi) : std::cos(m * phi)));
        }
    }
    for (std::vector<double>& wave : waves) wave.resize(width, 0.0);
    std::vector<RowSums> rows(height);
    tbb::parallel_for(std::uint32_t(0), height, [&](std::uint32_t y) { rows[y] = sum_row(map, y, waves); });

    double const quarter = 0.25 * kPiD / height;
    for (std::uint32_t half_row = 0; half_row < 2 * height; ++half_row)
        for (auto const& [offset, gauss] : kGauss) {
            double const theta = (2 * half_row + 1 + offset) * quarter;
            double const weight = gauss * quarter * std::sin(theta);
            double const y = std::clamp(theta * height / kPiD - 0.5, 0.0, height - 1.0);
            auto const above = std::min(std::uint32_t(y), height > 1 ? height - 2 : 0);
            RowSums const &a = rows[above], &b = rows[std::min(above + 1, height - 1)];
            double const t = y - above;
            h.squared +=
                weight * ((1 - t) * (1 - t) * a.squared + 2 * t * (1 - t) * a.with_next + t * t * b.squared);
            Values const p = polar_parts(std::cos(theta), std::sin(theta));
            for (int l = 0; l <= degree; ++l)
                for (int m = -l; m <= l; ++m) {
                    std::size_t const k = std::size_t(m + kDegrees - 1);
                    h.coefficients[EnvironmentHarmonics::index(l, m)] +=
                        weight * p[EnvironmentHarmonics::index(l, std::abs(m))] *
                        ((1 - t) * a.fourier[k] + t * b.fourier[k]);
                }
        }
    for (dvec3& c : h.coefficients) c *= scale;
    h.squared *= scale * scale;
    return rotated(h, rotation_rad);
}

EnvironmentHarmonics project(World const& world, int degree)
{
    if (!world.environment) return project({}, 0, dvec3{1}, degree);
    return project(*world.environment, double(world.environment_rotation_rad), dvec3(world.environment_scale),
                   degree);
}

EnvironmentHarmonics rotated(EnvironmentHarmonics const& h, double angle_rad)
{
    EnvironmentHarmonics r = h;
    for (int l = 0; l <= h.degree; ++l)
        for (int m = 1; m <= l; ++m) {
            double const c = std::cos(m * angle_rad), s = std::sin(m * angle_rad);
            std::size_t const cosine = EnvironmentHarmonics::index(l, m),
                              sine = EnvironmentHarmonics::index(l, -m);
            r.coefficients[cosine] = c * h.coefficients[cosine] - s * h.coefficients[sine];
            r.coefficients[sine] = s * h.coefficients[cosine] + c * h.coefficients[sine];
        }
    return r;
}

dvec3 irradiance(EnvironmentHarmonics const& h, dvec3 normal)
{
    Values const y = spherical_harmonics(normal);
    dvec3 sum{0};
    for (int l = 0; l <= h.degree; ++l)
        for (int m = -l; m <= l; ++m) {
            std::size_t const i = EnvironmentHarmonics::index(l, m);
            sum += kCosineLobe[l] * y[i] * h.coefficients[i];
        }
    return sum;
}

dvec3 brightest_normal(EnvironmentHarmonics const& h)
{
    dvec3 best{0, 1, 0};
    double most = -1e300;
    for (int i = 0; i <= 180; ++i)
        for (int k = 0; k < 360; ++k) {
            double const theta = i * kPiD / 180, phi = k * kPiD / 180;
            dvec3 const n{std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
            dvec3 const e = irradiance(h, n);
            double const bright = 0.2126 * e.x + 0.7152 * e.y + 0.0722 * e.z;
            if (bright <= most) continue;
            most = bright;
            best = n;
        }
    return best;
}

std::vector<dvec3> integrate_irradiance(World const& world, std::span<dvec3 const> normals)
{
    std::vector<dvec3> sums(normals.size(), dvec3{0});
    if (!world.environment) return sums;
    WorldView const v = view(world);
    // Midpoint rule on equal parts of texels.
    auto const parts = [](std::uint32_t texels, std::uint32_t least) {
        return (least + texels - 1) / texels * texels;
    };
    std::uint32_t const width = parts(world.environment->width, 1024),
                        height = parts(world.environment->height, 512);
    std::vector<dvec3> of_rows(normals.size() * height, dvec3{0});
    tbb::parallel_for(std::uint32_t(0), height, [&](std::uint32_t y) {
        double const top = y * kPiD / height, theta = (y + 0.5) * kPiD / height;
        double const solid_angle = (std::cos(top) - std::cos(top + kPiD / height)) * 2 * kPiD / width;
        for (std::uint32_t x = 0; x < width; ++x) {
            vec2 const at{(float(x) + 0.5f) * float(v.environment_width) / float(width),
                          (float(y) + 0.5f) * float(v.environment_height) / float(height)};
            double const phi = 2 * kPiD * ((x + 0.5) / width - 0.5);
            dvec3 const d(light_detail::from_map(v, vec3(dvec3{std::sin(theta) * std::sin(phi), std::cos(theta),
                                                               -std::sin(theta) * std::cos(phi)})));
            dvec3 const light = solid_angle * dvec3(light_detail::map_radiance(v, at));
            for (std::size_t k = 0; k < normals.size(); ++k)
                of_rows[k * height + y] += std::max(0.0, glm::dot(d, normals[k])) * light;
        }
    });
    for (std::size_t k = 0; k < normals.size(); ++k)
        for (std::uint32_t y = 0; y < height; ++y) sums[k] += of_rows[k * height + y];
    return sums;
}

} // namespace gi
