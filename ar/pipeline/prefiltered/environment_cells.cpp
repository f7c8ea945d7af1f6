#include "ar/pipeline/prefiltered/environment_cells.h"

#include "gi/scene/shading/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace ar {
namespace {

constexpr int kMostRows = 64;
constexpr double kRecut = 3; ///< times the mean weight of a part

} // namespace

EnvironmentTexels environment_texels(gi::World const& world)
{
    EnvironmentTexels out;
    if (!world.environment) return out;
    gi::EnvironmentMap const& map = *world.environment;
    gi::WorldView const view = gi::view(world);
    out.height = std::min(int(map.height), kMostRows);
    out.width = std::min(int(map.width), 2 * kMostRows);
    std::vector<gi::dvec3> light(std::size_t(out.width * out.height)), towards(light.size()), middle(light.size());
    std::vector<double> sr(light.size());
    std::vector<glm::dvec2> azimuth; // sine and cosine, by column
    for (std::uint32_t x = 0; x < map.width; ++x) {
        double const phi = ((x + 0.5) / map.width - 0.5) * 2 * gi::kPiD;
        azimuth.emplace_back(std::sin(phi), std::cos(phi));
    }
    for (std::uint32_t y = 0; y < map.height; ++y) {
        double const top = gi::kPiD * y / map.height, bottom = gi::kPiD * (y + 1) / map.height;
        double const theta = 0.5 * (top + bottom), sine = std::sin(theta), cosine = std::cos(theta);
        double const texel_sr = 2 * gi::kPiD / map.width * (std::cos(top) - std::cos(bottom));
        std::size_t const row = std::size_t(std::uint64_t(y) * std::uint64_t(out.height) / map.height);
        for (std::uint32_t x = 0; x < map.width; ++x) {
            gi::vec3 const d = gi::light_detail::from_map(
                view, gi::vec3(gi::dvec3(sine * azimuth[x].x, cosine, -sine * azimuth[x].y)));
            gi::vec3 const radiance = world.environment_scale * map.radiance[std::size_t(y) * map.width + x];
            std::size_t const column = std::size_t(std::uint64_t(x) * std::uint64_t(out.width) / map.width);
            std::size_t const at = row * std::size_t(out.width) + column;
            light[at] += texel_sr * gi::dvec3(radiance);
            towards[at] += texel_sr * double(gi::luminance(radiance)) * gi::dvec3(d);
            middle[at] += texel_sr * gi::dvec3(d);
            sr[at] += texel_sr;
        }
    }
    out.texels.resize(light.size());
    for (std::size_t k = 0; k < light.size(); ++k) {
        gi::dvec3 const d = glm::length(towards[k]) > 0 ? towards[k] : middle[k];
        out.texels[k] = {glm::length(d) > 0 ? gi::vec3(glm::normalize(d)) : gi::vec3(0, 1, 0), gi::vec3(light[k]),
                         float(sr[k])};
    }
    return out;
}

bool EnvironmentCells::update(EnvironmentTexels const& texels)
{
    if (texels.texels.empty()) {
        bool const had = !cells_.empty();
        parts_.clear();
        cells_.clear();
        return had;
    }
    double total = 0;
    for (auto const& t : texels.texels) total += double(gi::luminance(t.light));
    std::vector<double> weight;
    for (auto const& t : texels.texels) {
        double const even = double(t.solid_angle_sr) / (4 * gi::kPiD);
        weight.push_back(total > 0 ? std::lerp(double(gi::luminance(t.light)) / total, even, settings_.even_share)
                                   : even);
    }
    bool fits = !parts_.empty() && texels.width == width_ && texels.height == height_;
    for (std::size_t k = 0; fits && k < parts_.size(); ++k) {
        Part const& p = parts_[k];
        double sum = 0, sr = 0;
        for (int y = p.y0; y < p.y1; ++y)
            for (int x = p.x0; x < p.x1; ++x) {
                sum += weight[std::size_t(y * width_ + x)];
                sr += double(texels.texels[std::size_t(y * width_ + x)].solid_angle_sr);
            }
        fits = sum <= kRecut / double(parts_.size()) || !can_be_cut(p, sr);
    }
    if (!fits) {
        width_ = texels.width;
        height_ = texels.height;
        cut(texels, weight);
    }
    measure(texels, weight, fits);
    return !fits;
}

bool EnvironmentCells::can_be_cut(Part const& p, double sr) const
{
    return sr > settings_.smallest_sr && (p.x1 - p.x0 > 1 || p.y1 - p.y0 > 1);
}

void EnvironmentCells::cut(EnvironmentTexels const& texels, std::vector<double> const& weight)
{
    // Sums over [0, x) x [0, y), in a table with one more row and column.
    std::size_t const stride = std::size_t(width_) + 1;
    std::vector<double> weights(stride * (std::size_t(height_) + 1)), angles(weights.size());
    for (std::size_t y = 0; y < std::size_t(height_); ++y)
        for (std::size_t x = 0; x < std::size_t(width_); ++x) {
            std::size_t const at = y * std::size_t(width_) + x;
            auto const add = [&](std::vector<double>& s, double v) {
                s[(y + 1) * stride + x + 1] =
                    v + s[y * stride + x + 1] + s[(y + 1) * stride + x] - s[y * stride + x];
            };
            add(weights, weight[at]);
            add(angles, double(texels.texels[at].solid_angle_sr));
        }
    auto const sum = [&](std::vector<double> const& s, Part const& p) {
        auto const at = [&](int x, int y) { return s[std::size_t(y) * stride + std::size_t(x)]; };
        return at(p.x1, p.y1) - at(p.x0, p.y1) - at(p.x1, p.y0) + at(p.x0, p.y0);
    };
    struct Open {
        double weight;
        Part part;
        bool operator<(Open const& o) const { return weight < o.weight; }
    };
    std::priority_queue<Open> open;
    open.push({1, {0, 0, width_, height_}});
    parts_.clear();
    while (!open.empty() && int(parts_.size() + open.size()) < settings_.cells) {
        Part const p = open.top().part;
        open.pop();
        double const theta = gi::kPiD * 0.5 * (p.y0 + p.y1) / height_;
        double const wide = 2 * gi::kPiD * (p.x1 - p.x0) / width_ * std::sin(theta),
                     high = gi::kPiD * (p.y1 - p.y0) / height_;
        if (!can_be_cut(p, sum(angles, p))) {
            parts_.push_back(p);
            continue;
        }
        bool const across = p.x1 - p.x0 > 1 && (wide > high || p.y1 - p.y0 < 2);
        Part first = p, second = p;
        int& end = across ? first.x1 : first.y1;
        int const last = across ? p.x1 - 1 : p.y1 - 1;
        double const half = 0.5 * sum(weights, p);
        for (end = (across ? p.x0 : p.y0) + 1; end < last && sum(weights, first) < half; ++end) {
        }
        (across ? second.x0 : second.y0) = end;
        open.push({sum(weights, first), first});
        open.push({sum(weights, second), second});
    }
    for (; !open.empty(); open.pop()) parts_.push_back(open.top().part);
}

void EnvironmentCells::measure(EnvironmentTexels const& texels, std::vector<double> const& weight,
                               bool keep_directions)
{
    double total = 0;
    cells_.resize(parts_.size());
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        Part const& p = parts_[k];
        gi::dvec3 light(0), towards(0);
        double sr = 0;
        for (int y = p.y0; y < p.y1; ++y)
            for (int x = p.x0; x < p.x1; ++x) {
                std::size_t const at = std::size_t(y * width_ + x);
                light += gi::dvec3(texels.texels[at].light);
                towards += weight[at] * gi::dvec3(texels.texels[at].direction);
                sr += double(texels.texels[at].solid_angle_sr);
            }
        EnvironmentCell& c = cells_[k];
        if (!keep_directions)
            c.direction = glm::length(towards) > 0 ? gi::vec3(glm::normalize(towards)) : gi::vec3(0, 1, 0);
        c.light = gi::vec3(light);
        c.solid_angle_sr = float(sr);
        c.share = gi::luminance(c.light);
        total += double(c.share);
    }
    for (EnvironmentCell& c : cells_) c.share = total > 0 ? float(double(c.share) / total) : 0;
}

} // namespace ar
