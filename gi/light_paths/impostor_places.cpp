#include "gi/light_paths/impostor_places.h"

#include "gi/core/rng.h"
#include "gi/core/text.h"
#include "gi/light_paths/reached_points.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

template <class T>
void keep_some(std::vector<T>& items, std::size_t most, Pcg32& rng)
{
    for (std::size_t k = 0; k + 1 < items.size() && k < most; ++k)
        std::swap(items[k], items[k + std::size_t(rng.uniform() * float(items.size() - k))]);
    if (items.size() > most) items.resize(most);
}

/// Distance to the nearest surface, estimated by rays in a few directions, m.
float clearance_about(ExactVisibility const& visibility, vec3 place, float farthest)
{
    constexpr int kRays = 26;
    RayQuery queries[kRays];
    for (int k = 0; k < kRays; ++k) {
        float const turn = 0.61803399f * float(k);
        float const z = 1 - 2 * (float(k) + 0.5f) / float(kRays), r = std::sqrt(1 - z * z);
        vec2 const around = azimuth(turn - std::floor(turn));
        vec3 const d{r * around.x, r * around.y, z};
        queries[k] = {.ray = {place, d}, .reach = farthest, .seed = std::uint32_t(k)};
    }
    Hit hits[kRays];
    visibility.nearest(queries, hits);
    float least = farthest;
    for (Hit const& h : hits) least = std::min(least, h.triangle == kNoTriangle ? farthest : h.distance);
    return least;
}

/// How well a place sees each point, 0 to 1. @param open  m, taken for the length of flights into the open
std::vector<float> worth_of(ExactVisibility const& visibility, vec3 place, std::span<ReachedPoint const> points,
                            float open)
{
    float const clearance = clearance_about(visibility, place, open);
    std::vector<RayQuery> queries;
    std::vector<std::uint8_t> blocked(points.size());
    std::vector<float> worth;
    for (ReachedPoint const& p : points) {
        vec3 const to = place - p.position;
        float const distance = glm::length(to), free = std::min(p.free, open);
        float const cosine = distance > 0 ? glm::dot(to, p.normal) / distance : 0;
        vec3 const direction = distance > 0 ? to / distance : p.normal;
        queries.push_back({.ray = {p.position + p.clearance * p.normal, direction}, .reach = distance});
        float const w = cosine / (1 + distance / free) * clearance / (clearance + free / 8);
        worth.push_back(w > 0 ? w : 0);
    }
    visibility.occluded(queries, blocked);
    for (std::size_t k = 0; k < worth.size(); ++k)
        if (blocked[k] != 0) worth[k] = 0;
    return worth;
}

} // namespace

std::vector<vec3> place_impostors(World const& world, ExactVisibility const& visibility,
                                  ImpostorPlacement const& settings, BuildStop const& stop)
{
    if (world.triangles.empty() || settings.count == 0) return {};
    constexpr std::size_t kWalks = 2048;
    Reached walks = reach(world, visibility, kWalks, 11, settings.focus);
    if (walks.points.empty()) return {};
    Pcg32 rng(11, 6);
    keep_some(walks.points, settings.points, rng);
    keep_some(walks.flights, settings.candidates, rng);
    float const open = settings.focus.empty() ? world.bounds.radius() : settings.focus.radius();
    std::vector<vec3> places;
    for (Flight const& f : walks.flights) {
        float const share = 0.25f + 0.5f * rng.uniform();
        places.push_back(f.from + share * std::min(f.length, open) * f.direction);
    }
    std::vector<std::vector<float>> worth(places.size());
    tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t k) {
        if (stop.given_up()) throw Interrupted();
        worth[k] = worth_of(visibility, places[k], walks.points, open);
    });

    std::vector<float> best(walks.points.size(), 0.0f);
    std::vector<vec3> chosen;
    double total = 0;
    while (chosen.size() < settings.count) {
        std::size_t most = places.size();
        double gain = 0;
        for (std::size_t c = 0; c < places.size(); ++c) {
            double more_worth = 0;
            for (std::size_t k = 0; k < best.size(); ++k)
                more_worth += double(std::max(worth[c][k] - best[k], 0.0f));
            if (more_worth > gain) {
                gain = more_worth;
                most = c;
            }
        }
        if (most == places.size() || gain < double(settings.least_gain) * total) break;
        total += gain;
        chosen.push_back(places[most]);
        for (std::size_t k = 0; k < best.size(); ++k) best[k] = std::max(best[k], worth[most][k]);
    }
    return chosen;
}

std::vector<dvec3> read_impostor_places(std::string const& text)
{
    constexpr char const* kHow = "write x,y,z for each place, in m, and ; between places: 0,1.5,2;4,1.5,2";
    std::vector<dvec3> places;
    std::string_view left = text;
    while (!trimmed(left).empty()) {
        std::string_view const place = trimmed(take_until(left, ';'));
        std::vector<std::string_view> const numbers = split_at_commas(place);
        if (numbers.size() != 3)
            throw InputError(fmt::format("impostor place '{}'", place), "a place has three coordinates", kHow);
        dvec3 at;
        for (int axis = 0; axis < 3; ++axis) {
            std::string_view const number = numbers[std::size_t(axis)];
            auto const value = parse_finite(number, double(kFarthest));
            if (!value)
                throw InputError(fmt::format("impostor place '{}'", place),
                                 fmt::format("'{}' is not a finite number", number), kHow);
            at[axis] = *value;
        }
        places.push_back(at);
    }
    if (places.empty() || places.size() > kMostImpostors)
        throw InputError(fmt::format("impostor places '{}'", shortened(text, 60)),
                         fmt::format("{} places; 1 to {} are supported", places.size(), kMostImpostors), kHow);
    return places;
}

int impostor_count(PhotonSettings const& s)
{
    return s.impostor_places.empty() ? s.impostors : int(read_impostor_places(s.impostor_places).size());
}

} // namespace gi
