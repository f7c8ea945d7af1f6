#pragma once
// Where a ray meets the surfaces that distance impostors hold: by iteration from a first guess (Szirmay-Kalos et
// al. 2005), in all impostors (Yao et al. 2010), from a guess by a search through the fan between the ray's origin
// and its direction as seen from the impostor (Fei and Wang), or by a walk through the texels (impostor_walk.h).

#include "gi/light_paths/impostor_maps.h"
#include "gi/light_paths/settings.h"
#include "gi/render/render_settings.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {

struct ImpostorSettings {
    ImpostorSearch search = ImpostorSearch::walk;
    int iterations = 8; ///< of the refinement
    // Of the fan:
    int intervals = 8, levels = 4;
    float energy_change = 0.05f; ///< relative; smaller ones end the subdivision
    /// Points nearer to the ray's origin than this many texels there are no candidates: a ray that leaves a
    /// surface has least energy at its own origin. 0 = the energy as printed.
    float skip_texels = 20;
    // Of the walk:
    int most_maps = 2; ///< impostors that a ray may use
    float jump = 3;    ///< texels; surfaces of neighbouring texels whose distances differ by more do not join
};

/// Data that kernels need to follow rays by impostors.
struct ImpostorScene {
    ImpostorsView maps;
    WorldView world;
    bool alpha_tests = false; ///< some surfaces are partly transparent
};

struct ImpostorHit {
    Hit hit{};
    std::uint32_t maps = 0; ///< cube maps that were used
    bool exact = false;     ///< the ray meets the triangle there, beyond the maps' resolution
};

namespace impostor_detail {

/// Difference volume of Fei and Wang, (|v| - along)^2 (|v| + along), m^3: small if a point is near the ray and
/// near its origin. By the distance from the ray, because the difference cancels for points on it. @param v  the
/// point from the ray's origin
GI_FN inline float energy(vec3 v, vec3 direction, float least)
{
    float const along = glm::dot(v, direction), length = glm::length(v);
    if (!(along > least)) return kInf;
    vec3 const beside = glm::cross(v, direction);
    float const volume = square(glm::dot(beside, beside)) / (length + along);
    return volume < kInf ? volume : kInf;
}

/// The point of an impostor's surface in a direction; far away where there is none.
GI_FN inline vec3 surface_point(ImpostorsView const& maps, std::uint32_t impostor, vec3 to)
{
    float const length = glm::length(to);
    if (!(length > 0)) return maps.centres[impostor];
    float const distance = glm::min(maps.look(impostor, to).distance, kFarthest);
    return maps.centres[impostor] + (distance / length) * to;
}

/// Position on the ray where the distance to the centre is that of the impostor, by the secant rule between an
/// undershot and an overshot position (Szirmay-Kalos et al. 2005). Returns a distance along the ray, m, or kInf.
GI_FN inline float refine(ImpostorsView const& maps, std::uint32_t impostor, Ray const& ray, float guess,
                          int iterations)
{
    vec3 const from = ray.origin - maps.centres[impostor];
    float under = 0, under_ratio = 0, over = 0, over_ratio = 0, t = glm::max(guess, 0.0f);
    bool has_under = false, has_over = false;
    for (int k = 0; k < iterations; ++k) {
        vec3 const at = from + t * ray.direction;
        float const length = glm::length(at);
        if (!(length > 0)) return t;
        float const distance = maps.look(impostor, at).distance;
        if (!(distance < kFarthest)) {
            // The sky: only positions before it can meet something.
            if (!has_under) return kInf;
            t = 0.5f * (t + under);
            continue;
        }
        float const ratio = length / distance;
        if (std::abs(ratio - 1) < 1e-3f) break;
        if (ratio < 1) {
            under = t;
            under_ratio = ratio;
            has_under = true;
        } else {
            over = t;
            over_ratio = ratio;
            has_over = true;
        }
        float const next = has_under && has_over
                               ? under + (over - under) * (1 - under_ratio) / (over_ratio - under_ratio)
                               : t + distance * (1 - ratio);
        t = glm::max(next, 0.0f);
    }
    return t;
}

/// The triangle at a position of the ray, as an impostor holds it.
GI_FN inline Hit hit_at(ImpostorScene const& scene, std::uint32_t impostor, RayQuery const& q, float t)
{
    if (!(t < kFarthest) || t > q.reach) return {};
    vec3 const at = q.ray.origin + t * q.ray.direction, to = at - scene.maps.centres[impostor];
    if (!(glm::dot(to, to) > 0)) return {};
    ImpostorTexel const texel = scene.maps.look(impostor, to);
    if (texel.triangle == kNoTriangle) return {};
    return {texel.triangle, barycentric_at(scene.world.surfaces[texel.triangle], at), t};
}

/// First guess of Szirmay-Kalos et al.: the surface in the ray's direction from the centre is a plane across it.
GI_FN inline float first_guess(ImpostorsView const& maps, std::uint32_t impostor, Ray const& ray)
{
    float const distance = maps.look(impostor, ray.direction).distance;
    float const t = distance - glm::dot(ray.origin - maps.centres[impostor], ray.direction);
    // If the impostor shows the sky, the first guess is the origin.
    return distance < kFarthest ? glm::max(t, 0.0f) : glm::length(ray.origin - maps.centres[impostor]);
}

GI_FN inline ImpostorHit search_first_guess(ImpostorScene const& scene, RayQuery const& q,
                                            ImpostorSettings const& settings)
{
    std::uint32_t const k = nearest_impostor(scene.maps, q.ray.origin);
    float const t = refine(scene.maps, k, q.ray, first_guess(scene.maps, k, q.ray), settings.iterations);
    return {.hit = hit_at(scene, k, q, t), .maps = 1};
}

GI_FN inline float least_along(ImpostorsView const& maps, std::uint32_t impostor, vec3 origin, float texels)
{
    return texels * maps.texel_width() * glm::length(origin - maps.centres[impostor]);
}

GI_FN inline ImpostorHit search_all(ImpostorScene const& scene, RayQuery const& q,
                                    ImpostorSettings const& settings)
{
    ImpostorHit best{.maps = scene.maps.count()};
    float least = kInf;
    for (std::uint32_t k = 0; k < scene.maps.count(); ++k) {
        float const t = refine(scene.maps, k, q.ray, first_guess(scene.maps, k, q.ray), settings.iterations);
        if (!(t < kFarthest)) continue;
        vec3 const p = surface_point(scene.maps, k, q.ray.origin + t * q.ray.direction - scene.maps.centres[k]);
        constexpr float kSkip = 3; // texels; a longer one would lose what is near
        float const skip = least_along(scene.maps, k, q.ray.origin, kSkip);
        float const e = energy(p - q.ray.origin, q.ray.direction, skip);
        if (e < least) {
            least = e;
            best.hit = hit_at(scene, k, q, t);
        }
    }
    return best;
}

/// Distance along the ray of the point of least energy in the fan, or below 0 if there is none.
GI_FN inline float guess_by_fan(ImpostorsView const& maps, std::uint32_t impostor, Ray const& ray,
                                ImpostorSettings const& settings)
{
    vec3 const from = ray.origin - maps.centres[impostor];
    float const away = glm::length(from);
    if (!(away > 0)) return maps.look(impostor, ray.direction).distance;
    float const least = least_along(maps, impostor, ray.origin, settings.skip_texels);
    // Directions from -> ray.direction; equal steps of the share are nearly equal angles.
    vec3 const start = from / away;
    auto const point = [&](float share) {
        vec3 const to = (1 - share) * start + share * ray.direction;
        return surface_point(maps, impostor, to) - ray.origin;
    };
    float low = 0, high = 1, before = kInf, guess = -1;
    for (int level = 0; level < settings.levels; ++level) {
        float const step = (high - low) / float(settings.intervals);
        float best = kInf, best_along = -1, best_low = low;
        float along = 0, e = kInf;
        for (int k = 0; k <= settings.intervals; ++k) {
            vec3 const p = point(low + step * float(k));
            float const next_along = glm::dot(p, ray.direction), next = energy(p, ray.direction, least);
            if (k > 0) {
                // An end without a candidate leaves the other end's energy, twice.
                float const sum = e < kInf && next < kInf ? e + next : 2 * glm::min(e, next);
                if (sum < best) {
                    best = sum;
                    best_along = e < next ? along : next_along;
                    best_low = low + step * float(k - 1);
                }
            }
            e = next;
            along = next_along;
        }
        if (!(best < kInf)) break;
        guess = best_along;
        low = best_low;
        high = best_low + step;
        if (std::abs(before - best) <= settings.energy_change * best) break;
        before = best;
    }
    return guess;
}

GI_FN inline ImpostorHit search_cascaded(ImpostorScene const& scene, RayQuery const& q,
                                         ImpostorSettings const& settings)
{
    std::uint32_t const k = nearest_impostor(scene.maps, q.ray.origin);
    float guess = guess_by_fan(scene.maps, k, q.ray, settings);
    std::uint32_t at = k;
    if (guess >= 0 && guess < kFarthest)
        at = nearest_impostor(scene.maps, q.ray.origin + guess * q.ray.direction);
    else
        guess = first_guess(scene.maps, k, q.ray);
    float const t = refine(scene.maps, at, q.ray, guess, settings.iterations);
    return {.hit = hit_at(scene, at, q, t), .maps = at == k ? 1u : 2u};
}

} // namespace impostor_detail
} // namespace gi
