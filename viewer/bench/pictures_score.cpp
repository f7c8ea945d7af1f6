#include "viewer/bench/pictures_score.h"

#include "gi/metrics/compare.h"
#include "gi/metrics/neighbour_correlation.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

namespace viewer {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double layer_mean(gi::Picture const& picture, char const* layer)
{
    gi::Layer const* const l = picture.find(layer);
    if (l == nullptr || l->data.empty()) return kUnknown;
    return std::accumulate(l->data.begin(), l->data.end(), 0.0) / double(l->data.size());
}

double bias_of(gi::Picture const& picture, gi::Picture const& reference, char const* layer)
{
    if (picture.find(layer) == nullptr || reference.find(layer) == nullptr) return kUnknown;
    return gi::compare(picture, reference, {"bias"}, layer).values.front().value;
}

} // namespace

PictureScore score(gi::Picture const& picture, SweepReference const& reference)
{
    PictureScore s;
    for (gi::NamedValue const& v : gi::compare(picture, reference.picture, {"relmse", "flip"}, "color").values)
        (v.name == "relmse" ? s.relmse : s.flip) = v.value;
    if (std::isfinite(reference.relmse)) s.relmse -= reference.relmse;
    for (std::size_t k = 0; k < kJudgedLayers.size(); ++k)
        s.bias[k] = bias_of(picture, reference.picture, kJudgedLayers[k]);
    s.neighbour_correlation = double(gi::neighbour_correlation(
        picture.find("color")->data, reference.picture.find("color")->data, picture.width, picture.height));
    return s;
}

std::array<double, 3> bias_errors(gi::Picture const& reference)
{
    std::array<double, 3> errors{kUnknown, kUnknown, kUnknown};
    gi::Layer const* const variance = reference.find("variance");
    if (variance == nullptr) return errors;
    // Assumes independent pixels; the variance of a mean over channels is at most the mean of their variances.
    double sum = 0;
    for (float const v : variance->data) sum += double(v);
    double const pixels = double(reference.pixels()), channels = double(variance->channels);
    double const error = std::sqrt(sum / channels) / pixels;
    for (std::size_t k = 0; k < errors.size(); ++k) {
        double const mean = layer_mean(reference, kJudgedLayers[k]);
        if (mean > 0) errors[k] = error / mean;
    }
    return errors;
}

MeanOf mean_of(std::vector<double> const& values, double other_error)
{
    std::vector<double> finite;
    for (double const v : values)
        if (std::isfinite(v)) finite.push_back(v);
    if (finite.empty()) return {};
    double const n = double(finite.size());
    double const mean = std::accumulate(finite.begin(), finite.end(), 0.0) / n;
    if (finite.size() < 2) return {mean, {}};
    double squares = 0;
    for (double const v : finite) squares += (v - mean) * (v - mean);
    double const error = std::sqrt(squares / (n * (n - 1)));
    return {mean, std::isfinite(other_error) ? std::hypot(error, other_error) : error};
}

RenderSeconds seconds_by_part(gi::Report const& report)
{
    constexpr std::string_view kPaths = "paths", kFirst = "G-buffer", kTrace = "trace";
    constexpr std::array<std::string_view, 8> kStructures{
        "build (Embree BVH)", "build (hit buffers)", "build (visibility)",   "hit buffers of a pass",
        "layers that moved",  "shadow maps",         "visibility of a pass", "virtual lights"};
    RenderSeconds s;
    double trace = 0;
    for (auto const& [stage, seconds] : report.times()) {
        if (stage == kPaths || stage == kFirst) s.paths += seconds;
        if (stage == kTrace) trace += seconds;
        if (std::ranges::find(kStructures, stage) != kStructures.end()) s.structures += seconds;
    }
    if (s.paths == 0) s.paths = trace; // for methods whose passes consist only of paths
    return s;
}

} // namespace viewer
