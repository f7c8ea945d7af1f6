#include "ar/composite/edge_spread.h"

#include "gi/core/error.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ar {
namespace {

struct Sample {
    double d, t, value;
};

/// Pixels around the edge, by their distance and their place along it (-1..1).
std::vector<Sample> samples_of(cv::Mat const& light, EdgeSegment const& edge, SpreadSettings const& settings)
{
    glm::dvec2 const along = edge.to - edge.from;
    double const length = glm::length(along);
    std::vector<Sample> samples;
    if (!(length >= 6) || !(length < 1e5)) return samples;
    glm::dvec2 const u = along / length, across(-u.y, u.x), middle = 0.5 * (edge.from + edge.to);
    double const reach = std::min(settings.reach_px, length / 2), half = length * (0.5 - settings.ends);
    glm::dvec2 const box = half * glm::abs(u) + reach * glm::abs(across);
    int const x0 = std::max(0, int(std::floor(middle.x - box.x))),
              y0 = std::max(0, int(std::floor(middle.y - box.y)));
    int const x1 = std::min(light.cols - 1, int(std::ceil(middle.x + box.x)));
    int const y1 = std::min(light.rows - 1, int(std::ceil(middle.y + box.y)));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            glm::dvec2 const p = glm::dvec2(x, y) - middle;
            double const d = glm::dot(p, across), t = glm::dot(p, u);
            double const value = light.at<float>(y, x);
            if (std::abs(d) <= reach && std::abs(t) <= half && std::isfinite(value))
                samples.push_back({d, t / half, value});
        }
    return samples;
}

using Parameters = cv::Vec<double, 5>; // dark, step, offset, tilt, log sigma

double residual_of(Parameters const& p, Sample const& s, Parameters* gradient = nullptr)
{
    double const sigma = std::exp(p[4]), x = (s.d - p[2] - p[3] * s.t) / sigma;
    double const phi = 0.5 * std::erfc(-x / std::numbers::sqrt2);
    if (gradient) {
        double const density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi), slope = p[1] * density;
        *gradient = {1, phi, -slope / sigma, -slope * s.t / sigma, -slope * x};
    }
    return p[0] + p[1] * phi - s.value;
}

double sum_of_squares(Parameters const& p, std::vector<Sample> const& samples)
{
    double sum = 0;
    for (Sample const& s : samples) sum += std::pow(residual_of(p, s), 2);
    return sum;
}

/// Levenberg-Marquardt.
Parameters minimised(Parameters p, std::vector<Sample> const& samples)
{
    double damping = 1e-3, error = sum_of_squares(p, samples);
    for (int i = 0; i < 60; ++i) {
        cv::Matx<double, 5, 5> a = cv::Matx<double, 5, 5>::zeros();
        cv::Matx<double, 5, 1> b = cv::Matx<double, 5, 1>::zeros();
        for (Sample const& s : samples) {
            Parameters g;
            double const r = residual_of(p, s, &g);
            a += g * g.t();
            b += g * r;
        }
        for (int k = 0; k < 5; ++k) a(k, k) *= 1 + damping;
        cv::Matx<double, 5, 1> step;
        if (!cv::solve(a, b, step, cv::DECOMP_CHOLESKY)) break;
        Parameters next = p;
        for (int k = 0; k < 5; ++k) next[k] -= step(k);
        next[4] = std::clamp(next[4], std::log(0.05), std::log(50.0));
        double const now = sum_of_squares(next, samples);
        if (!(now < error)) {
            damping *= 10;
            if (damping > 1e8) break;
            continue;
        }
        bool const done = error - now < 1e-10 * error;
        p = next;
        error = now;
        damping = std::max(damping / 10, 1e-9);
        if (done) break;
    }
    return p;
}

} // namespace

std::optional<EdgeSpread> fit_edge(cv::Mat const& light, EdgeSegment const& edge, SpreadSettings const& settings)
{
    if (light.type() != CV_32FC1)
        throw gi::InputError("edges are measured in pictures of one channel of floats", "the spread acts on light",
                             "give a channel of radiance_of()");
    std::vector<Sample> const samples = samples_of(light, edge, settings);
    if (samples.size() < 30) return std::nullopt;
    double side[2] = {0, 0};
    int count[2] = {0, 0};
    for (Sample const& s : samples)
        if (std::abs(s.d) > 0.5 * settings.reach_px || samples.size() < 60) {
            side[s.d > 0] += s.value;
            ++count[s.d > 0];
        }
    if (count[0] == 0 || count[1] == 0) return std::nullopt;
    double const low = side[0] / count[0], high = side[1] / count[1];
    if (std::abs(high - low) < settings.least_contrast) return std::nullopt;
    Parameters const p = minimised({low, high - low, 0, 0, std::log(0.8)}, samples);
    EdgeSpread e{std::exp(p[4]), p[2], std::abs(p[1]), 0};
    e.residual = std::sqrt(sum_of_squares(p, samples) / double(samples.size())) / e.contrast;
    bool const edge_like = e.contrast >= settings.least_contrast && e.residual <= settings.largest_residual &&
                           std::abs(e.offset_px) < settings.reach_px && e.sigma_px < 0.6 * settings.reach_px;
    return edge_like ? std::optional(e) : std::nullopt;
}

std::optional<Sharpness> estimate_sharpness(cv::Mat const& light, std::span<EdgeSegment const> edges,
                                            SpreadSettings const& settings)
{
    Sharpness found;
    std::vector<double> sigmas;
    for (EdgeSegment const& edge : edges) {
        if (auto const e = fit_edge(light, edge, settings))
            sigmas.push_back(e->sigma_px);
        else
            ++found.refused;
    }
    if (sigmas.empty()) return std::nullopt;
    found.edges = int(sigmas.size());
    found.sigma_px = gi::median(sigmas);
    for (double& s : sigmas) s = std::abs(s - found.sigma_px);
    found.spread_px = 1.4826 * gi::median(std::move(sigmas));
    return found;
}

} // namespace ar
