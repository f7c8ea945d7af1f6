#include "gi/metrics/flip.h"

#include "gi/core/math.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr float kDistanceExponent = 0.7f, kFeatureExponent = 0.5f; // q_c, q_f
constexpr float kKnee = 0.4f, kKneeValue = 0.95f;                  // p_c, p_t
constexpr float kFeatureWidth_deg = 0.082f;

using Plane = std::vector<float>;
struct OpponentPlanes {
    std::array<Plane, 3> c;
};
struct Size {
    int width, height;
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};

constexpr vec3 kWhite{0.950428545f, 1.0f, 1.088900371f}; // of D65, XYZ

vec3 linear_to_xyz(vec3 c)
{
    return {10135552.0f / 24577794 * c.x + 8788810.0f / 24577794 * c.y + 4435075.0f / 24577794 * c.z,
            2613072.0f / 12288897 * c.x + 8788810.0f / 12288897 * c.y + 887015.0f / 12288897 * c.z,
            1425312.0f / 73733382.0f * c.x + 8788810.0f / 73733382.0f * c.y + 70074185.0f / 73733382.0f * c.z};
}
vec3 xyz_to_linear(vec3 c)
{
    return {3.241003275f * c.x - 1.537398934f * c.y - 0.498615861f * c.z,
            -0.969224334f * c.x + 1.875930071f * c.y + 0.041554224f * c.z,
            0.055639423f * c.x - 0.204011202f * c.y + 1.057148933f * c.z};
}
vec3 xyz_to_ycxcz(vec3 c)
{
    c /= kWhite;
    return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}
vec3 ycxcz_to_xyz(vec3 c)
{
    float const y = (c.x + 16) / 116;
    return vec3{y + c.y / 500, y, y - c.z / 200} * kWhite;
}
vec3 xyz_to_lab(vec3 c)
{
    auto const f = [](float t) {
        constexpr float kDelta = 6.0f / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
    };
    c /= kWhite;
    return {116 * f(c.y) - 16, 500 * (f(c.x) - f(c.y)), 200 * (f(c.y) - f(c.z))};
}
/// Hunt effect: colours look less saturated at low luminance.
vec3 hunt(vec3 lab) { return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z}; }
float hyab(vec3 a, vec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

vec3 seen_color(vec3 linear) { return hunt(xyz_to_lab(linear_to_xyz(linear))); }

/// A one-dimensional kernel, centre in the middle.
using Kernel = std::vector<float>;

/// Convolution along one axis with repeated border pixels.
Plane convolve(Plane const& in, Size size, Kernel const& kernel, bool along_x)
{
    Plane out(in.size());
    int const radius = int(kernel.size() / 2), w = size.width, h = size.height;
    tbb::parallel_for(0, h, [&](int y) {
        float* const row = out.data() + std::size_t(y) * std::size_t(w);
        for (int k = -radius; k <= radius; ++k) {
            float const weight = kernel[std::size_t(k + radius)];
            if (along_x) {
                float const* const from = in.data() + std::size_t(y) * std::size_t(w);
                for (int x = 0; x < w; ++x) row[x] += weight * from[std::clamp(x + k, 0, w - 1)];
            } else {
                float const* const from = in.data() + std::size_t(std::clamp(y + k, 0, h - 1)) * std::size_t(w);
                for (int x = 0; x < w; ++x) row[x] += weight * from[x];
            }
        }
    });
    return out;
}
Plane convolve(Plane const& in, Size size, Kernel const& x, Kernel const& y)
{
    return convolve(convolve(in, size, x, true), size, y, false);
}

/// Contrast sensitivity of one channel: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees.
struct Sensitivity {
    float a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivity{
    {{1, 0.0047f, 0, 1e-5f}, {1, 0.0053f, 0, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}}};

Kernel gaussian(float b, int radius, float pixels_per_degree, double& sum)
{
    Kernel kernel;
    sum = 0;
    for (int i = -radius; i <= radius; ++i) {
        float const degrees = float(i) / pixels_per_degree;
        kernel.push_back(std::exp(-kPi * kPi * degrees * degrees / b));
        sum += double(kernel.back());
    }
    for (float& k : kernel) k /= float(sum);
    return kernel;
}

Plane filter(Plane const& in, Size size, Sensitivity const& s, float pixels_per_degree)
{
    int const radius = int(std::ceil(3 * std::sqrt(0.04f / (2 * kPi * kPi)) * pixels_per_degree));
    double sum1, sum2;
    Kernel const g1 = gaussian(s.b1, radius, pixels_per_degree, sum1);
    Plane out = convolve(in, size, g1, g1);
    if (s.a2 == 0) return out;
    Kernel const g2 = gaussian(s.b2, radius, pixels_per_degree, sum2);
    Plane const second = convolve(in, size, g2, g2);
    double const w1 = double(s.a1) * std::sqrt(double(kPi / s.b1)) * sum1 * sum1;
    double const w2 = double(s.a2) * std::sqrt(double(kPi / s.b2)) * sum2 * sum2;
    auto const share = float(w1 / (w1 + w2));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = share * out[i] + (1 - share) * second[i];
    return out;
}

OpponentPlanes to_ycxcz(std::vector<float> const& linear, Size size)
{
    OpponentPlanes out;
    for (Plane& p : out.c) p.resize(size.pixels());
    for (std::size_t i = 0; i < size.pixels(); ++i) {
        vec3 const c = xyz_to_ycxcz(linear_to_xyz({linear[3 * i], linear[3 * i + 1], linear[3 * i + 2]}));
        for (std::size_t k = 0; k < 3; ++k) out.c[k][i] = c[int(k)];
    }
    return out;
}

/// Colours filtered by contrast sensitivity, in Hunt-adjusted CIELAB.
std::vector<vec3> perceived(OpponentPlanes const& ycxcz, Size size, float pixels_per_degree)
{
    OpponentPlanes blurred;
    for (std::size_t k = 0; k < 3; ++k)
        blurred.c[k] = filter(ycxcz.c[k], size, kSensitivity[k], pixels_per_degree);
    std::vector<vec3> out(size.pixels());
    tbb::parallel_for(std::size_t(0), out.size(), [&](std::size_t i) {
        vec3 const linear = xyz_to_linear(ycxcz_to_xyz({blurred.c[0][i], blurred.c[1][i], blurred.c[2][i]}));
        out[i] = seen_color(glm::clamp(linear, vec3{0}, vec3{1}));
    });
    return out;
}

struct Features {
    Plane edges, points;
};

/// Gradient and second derivative of a Gaussian, with positive and negative parts each normalised to one.
Features detect_features(Plane const& luminance, Size size, float pixels_per_degree)
{
    float const sigma = 0.5f * kFeatureWidth_deg * pixels_per_degree;
    int const radius = int(std::ceil(3 * sigma));
    Kernel blur, edge, point;
    for (int i = -radius; i <= radius; ++i) {
        float const x = float(i), g = std::exp(-x * x / (2 * sigma * sigma));
        blur.push_back(g);
        edge.push_back(-x * g);
        point.push_back((x * x / (sigma * sigma) - 1) * g);
    }
    auto const normalize = [](Kernel& k) {
        float positive = 0, negative = 0;
        for (float const v : k) (v > 0 ? positive : negative) += v;
        for (float& v : k) v /= v > 0 ? positive : -negative;
    };
    for (Kernel* k : {&blur, &edge, &point}) normalize(*k);

    Plane y(luminance.size());
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = (luminance[i] + 16) / 116;
    auto const magnitude = [&](Kernel const& derivative) {
        Plane const dx = convolve(y, size, derivative, blur), dy = convolve(y, size, blur, derivative);
        Plane out(y.size());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(dx[i], dy[i]);
        return out;
    };
    return {magnitude(edge), magnitude(point)};
}

float aces(float x)
{
    return std::clamp((0.6f * 0.6f * 2.51f * x * x + 0.6f * 0.03f * x) /
                          (0.6f * 0.6f * 2.43f * x * x + 0.6f * 0.59f * x + 0.14f),
                      0.0f, 1.0f);
}

} // namespace

std::vector<float> flip(std::vector<float> const& image, std::vector<float> const& reference, int width,
                        int height, float pixels_per_degree)
{
    Size const size{width, height};
    OpponentPlanes const a = to_ycxcz(image, size), b = to_ycxcz(reference, size);
    std::vector<vec3> const seen_a = perceived(a, size, pixels_per_degree);
    std::vector<vec3> const seen_b = perceived(b, size, pixels_per_degree);
    Features const fa = detect_features(a.c[0], size, pixels_per_degree);
    Features const fb = detect_features(b.c[0], size, pixels_per_degree);

    float const largest = std::pow(hyab(seen_color({0, 1, 0}), seen_color({0, 0, 1})), kDistanceExponent);
    float const knee = kKnee * largest;
    std::vector<float> out(size.pixels());
    tbb::parallel_for(std::size_t(0), out.size(), [&](std::size_t i) {
        float const distance = std::pow(hyab(seen_a[i], seen_b[i]), kDistanceExponent);
        float const color = distance < knee ? kKneeValue / knee * distance
                                            : kKneeValue + (distance - knee) / (largest - knee) * (1 - kKneeValue);
        float const feature = std::max(std::abs(fa.edges[i] - fb.edges[i]), std::abs(fa.points[i] - fb.points[i]));
        out[i] = std::pow(color, 1 - std::pow(feature / std::sqrt(2.0f), kFeatureExponent));
    });
    return out;
}

FlipExposures flip_exposures(std::vector<float> const& reference)
{
    std::vector<float> y;
    for (std::size_t i = 0; i + 2 < reference.size(); i += 3)
        y.push_back(luminance({reference[i], reference[i + 1], reference[i + 2]}));
    if (y.empty()) return {0, 0, 1};
    float const largest = std::max(*std::max_element(y.begin(), y.end()), 1e-4f);
    float const median = std::max(1e-4f, float(gi::median(std::move(y))));
    // Solves for the input at which ACES reaches 0.85.
    constexpr double kLevel = 0.85;
    double const a = 0.36 * 2.51 - kLevel * 0.36 * 2.43, b = 0.6 * 0.03 - kLevel * 0.6 * 0.59, c = -kLevel * 0.14;
    double const white = -0.5 * b / a + std::sqrt(square(float(0.5 * b / a)) - c / a);
    auto const first = float(std::log2(white / double(largest))), last = float(std::log2(white / double(median)));
    return {first, last, std::max(2, int(std::ceil(last - first)))};
}

std::vector<float> hdr_flip(std::vector<float> const& image, std::vector<float> const& reference, int width,
                            int height, float pixels_per_degree)
{
    FlipExposures const e = flip_exposures(reference);
    auto const exposed = [](std::vector<float> v, float ev) {
        for (float& x : v) x = aces(std::max(x, 0.0f) * std::exp2(ev));
        return v;
    };
    std::vector<float> out(std::size_t(width) * std::size_t(height), 0.0f);
    for (int i = 0; i < e.count; ++i) {
        float const ev = e.first_ev + (e.last_ev - e.first_ev) * float(i) / float(std::max(1, e.count - 1));
        std::vector<float> const one =
            flip(exposed(image, ev), exposed(reference, ev), width, height, pixels_per_degree);
        for (std::size_t p = 0; p < out.size(); ++p) out[p] = std::max(out[p], one[p]);
    }
    return out;
}

} // namespace gi
