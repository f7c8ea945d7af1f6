#include "viewer/protocol/hidden_mask.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace viewer {
namespace {

constexpr std::string_view kKey = "hidden.";

double side(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Range of pixels whose centres may lie between two positions: first, and one past the last.
std::pair<int, int> middles(double from, double to, int size)
{
    auto const clamped = [&](double v) { return int(std::clamp(v, 0.0, double(size))); };
    return {clamped(std::ceil(from - 0.5)), clamped(std::floor(to - 0.5) + 1)};
}

/// Distance from each pixel of a row to the nearest visible one in the row, pixels.
void measure_row(std::uint8_t const* hidden, int width, int* distance)
{
    int since = width; // the maximum
    for (int x = 0; x < width; ++x) distance[x] = since = hidden[x] == 0 ? 0 : std::min(width, since + 1);
    since = width;
    for (int x = width - 1; x >= 0; --x) {
        since = hidden[x] == 0 ? 0 : std::min(width, since + 1);
        distance[x] = std::min(distance[x], since);
    }
}

[[noreturn]] void refuse(Change const& c, std::string const& why)
{
    throw gi::InputError(fmt::format("'{}' is no mask of a view", c.key), why,
                         "set {\"points\": [[x, y], ...], \"triangles\": [i, j, k, ...]}");
}

/// A list of at most `most` entries.
nlohmann::json const& list(Change const& c, char const* name, std::size_t most)
{
    auto const found = c.value.is_object() ? c.value.find(name) : c.value.end();
    if (found == c.value.end() || !found->is_array()) refuse(c, fmt::format("it has no list '{}'", name));
    if (found->size() > most)
        refuse(c, fmt::format("its list '{1}' has {0} entries, limit {2}", found->size(), name, most));
    return *found;
}

} // namespace

std::vector<std::uint8_t> hidden_pixels(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                        int height)
{
    std::vector<std::uint8_t> hidden(std::size_t(width) * std::size_t(height), 0);
    auto const pixel = [&](gi::vec2 tangent) {
        return glm::dvec2((tangent.x - view.left) / (view.right - view.left) * width,
                          (view.top - tangent.y) / (view.top - view.bottom) * height);
    };
    for (std::size_t i = 0; i + 2 < mask.triangles.size(); i += 3) {
        glm::dvec2 corner[3];
        bool is_whole = true;
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const index = mask.triangles[i + k];
            is_whole = is_whole && index < mask.points.size();
            if (is_whole) corner[k] = pixel(mask.points[index]);
        }
        double const area = is_whole ? side(corner[0], corner[1], corner[2]) : 0;
        if (!std::isfinite(area) || area == 0) continue;
        if (area < 0) std::swap(corner[1], corner[2]);
        auto const [x0, x1] = middles(std::min({corner[0].x, corner[1].x, corner[2].x}),
                                      std::max({corner[0].x, corner[1].x, corner[2].x}), width);
        auto const [y0, y1] = middles(std::min({corner[0].y, corner[1].y, corner[2].y}),
                                      std::max({corner[0].y, corner[1].y, corner[2].y}), height);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                glm::dvec2 const p(x + 0.5, y + 0.5);
                if (side(corner[0], corner[1], p) >= 0 && side(corner[1], corner[2], p) >= 0 &&
                    side(corner[2], corner[0], p) >= 0)
                    hidden[std::size_t(y) * std::size_t(width) + std::size_t(x)] = 1;
            }
    }
    return hidden;
}

std::vector<std::uint8_t> pixels_to_leave_out(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                              int height)
{
    std::vector<std::uint8_t> hidden = hidden_pixels(mask, view, width, height);
    if (std::ranges::find(hidden, 1) == hidden.end()) return hidden;
    auto const row = [&](int y) { return std::size_t(y) * std::size_t(width); };
    std::vector<int> distance(hidden.size());
    tbb::parallel_for(0, height, [&](int y) { measure_row(&hidden[row(y)], width, &distance[row(y)]); });
    double const across = std::max(double(kHiddenGuard_px), kHiddenGuard * width / (view.right - view.left)),
                 along = std::max(double(kHiddenGuard_px), kHiddenGuard * height / (view.top - view.bottom));
    int const rows = int(std::min(double(height), along));
    tbb::parallel_for(0, height, [&](int y) { // test an ellipse around each pixel, row by row
        std::uint8_t* const to = &hidden[row(y)];
        for (int there = std::max(0, y - rows); there <= std::min(height - 1, y + rows); ++there) {
            double const dy = there - y;
            int const reach =
                int(std::min(double(width), across * std::sqrt(std::max(0.0, 1 - dy * dy / (along * along)))));
            int const* const from = &distance[row(there)];
            for (int x = 0; x < width; ++x) to[x] &= std::uint8_t(from[x] > reach);
        }
    });
    return hidden;
}

bool is_hidden_mask(std::string const& key) { return key.starts_with(kKey); }

Change hidden_change(std::string const& view, HiddenMask const& mask)
{
    nlohmann::json points = nlohmann::json::array();
    for (gi::vec2 const p : mask.points) points.push_back({p.x, p.y});
    return {std::string(kKey) + view, {{"points", std::move(points)}, {"triangles", mask.triangles}}};
}

std::pair<std::string, HiddenMask> hidden_mask_of(Change const& c)
{
    HiddenMask mask;
    if (c.key.size() <= kKey.size()) refuse(c, "it names no view");
    for (nlohmann::json const& p : list(c, "points", HiddenMaskLimits::points)) {
        auto const tangent = [&](std::size_t i) {
            double const v = p.is_array() && p.size() == 2 && p[i].is_number() ? p[i].get<double>() : std::nan("");
            if (!(std::abs(v) <= HiddenMaskLimits::tangent))
                refuse(c, fmt::format("point {} is no pair of tangents up to {:g}", mask.points.size(),
                                      HiddenMaskLimits::tangent));
            return float(v);
        };
        mask.points.push_back({tangent(0), tangent(1)});
    }
    nlohmann::json const& triangles = list(c, "triangles", 3 * HiddenMaskLimits::triangles);
    if (triangles.size() % 3 != 0) refuse(c, fmt::format("{} indices are no whole triangles", triangles.size()));
    for (nlohmann::json const& i : triangles) {
        std::int64_t const index = i.is_number_integer() ? i.get<std::int64_t>() : -1;
        if (index < 0 || index >= std::int64_t(mask.points.size()))
            refuse(c, fmt::format("index {} is none of its {} points", mask.triangles.size(), mask.points.size()));
        mask.triangles.push_back(std::uint32_t(index));
    }
    return {c.key.substr(kKey.size()), std::move(mask)};
}

} // namespace viewer
