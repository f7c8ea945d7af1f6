#pragma once
// A walk along a ray through the texels of a distance impostor. Seen from the centre the ray covers an arc,
// from the direction of its origin to its own; the texels on the arc hold the surfaces that it can meet,
// as far as the centre sees them.
//  - The triangle of each texel is met exactly or not at all; the nearest one met ends the walk
//    when the walk has come so far. This is right even where the surface is hidden from the centre
//    at that place but seen at another.
//  - Triangles smaller than texels are passed by. So a crossing counts as well:
//    where the ray passes from before the surface to behind it, and neighbouring texels join.
//  - Where they do not join, the ray passes behind something. Then an impostor that sees this place continues.

#include "gi/bvh/triangle_test.h"
#include "gi/light_paths/impostor_arc.h"
#include "gi/light_paths/impostor_search.h"
#include "gi/light_paths/path_query.h"
#include "gi/render/coverage_test.h"

namespace gi {
namespace impostor_detail {

/// What a walk has found so far.
struct Walk {
    Hit exact;                              ///< nearest triangle met; its distance bounds the walk
    Hit crossing;                           ///< by distances alone
    Hit hidden;                             ///< a guess where the ray vanishes behind something
    bool to_sky = false;                    ///< where it vanished first the sky was behind
    std::uint32_t left = kNoTriangle;       ///< triangle that the ray leaves
    std::uint32_t tested = kNoTriangle;     ///< last triangle
    std::uint32_t tested_too = kNoTriangle; ///< the one before
};

/// Tests a triangle and keeps the hit if it is the nearest so far.
GI_FN inline void meet(ImpostorScene const& scene, RayQuery const& q, RayShear const& shear,
                       std::uint32_t triangle, Walk& walk)
{
    if (triangle == walk.tested || triangle == walk.tested_too || triangle == kNoTriangle) return;
    walk.tested_too = walk.tested;
    walk.tested = triangle;
    Surface const& s = scene.world.surfaces[triangle];
    vec3 const a = s.corner - q.ray.origin;
    float const reach = glm::min(q.reach, walk.exact.distance);
    TriangleHit const hit = meet_triangle(a, a + s.edge1, a + s.edge2, shear, 0, reach);
    if (!(hit.distance < reach) || (scene.alpha_tests && !covers(scene.world, triangle, hit.weights, q.seed)))
        return;
    walk.exact = {triangle, hit.weights, hit.distance};
}

/// Distance along the ray to a triangle's plane if it is within `around` of t, else t.
GI_FN inline float on_plane(Surface const& s, Ray const& ray, float t, float around)
{
    vec3 const normal = glm::cross(s.edge1, s.edge2);
    float const at = glm::dot(s.corner - ray.origin, normal) / glm::dot(ray.direction, normal);
    return std::abs(at - t) <= around ? at : t;
}

/// How far from a triangle the guessed hit may be for its surface to be assumed to continue there,
/// relative to the distance from the impostor's centre.
inline constexpr float kGoesOn = 0.3f;

/// True if a hit's point on its triangle and its point on the ray are close, m. Where a ray crosses the plane
/// of a triangle far from the triangle, a hit is uncertain.
GI_FN inline bool on_surface(ImpostorScene const& scene, Ray const& ray, Hit const& hit, float within)
{
    if (hit.triangle == kNoTriangle) return false;
    Surface const& s = scene.world.surfaces[hit.triangle];
    vec3 const there = s.corner + hit.barycentric.x * s.edge1 + hit.barycentric.y * s.edge2;
    vec3 const off = ray.origin + hit.distance * ray.direction - there;
    return glm::dot(off, off) <= square(within);
}

/// A walk through one impostor.
struct MapWalk {
    // A probe a little behind the edge of a texel lies in the next one.
    static constexpr float kProbe = 2e-6f;

    ImpostorScene const& scene;
    RayQuery const& q;
    RayShear const& shear;
    ImpostorSettings const& settings;
    std::uint32_t k; ///< the impostor
    bool may_change; ///< to another one
    Walk& found;

    Arc arc;
    float width;         ///< of a texel, m per m
    float s, length;     ///< how far it is, and the length of arc.at(s)
    float limit;         ///< s of the nearest triangle met, or of the ray's reach
    bool leaving;        ///< it is still where it starts, at a place that the centre sees
    bool before = false; ///< it is clearly before the surface
    int more = 2;        ///< texels to walk after a crossing, for a triangle that is met there exactly
    std::uint32_t next = kNoImpostor; ///< that continues the walk
    float next_from = 0;              ///< distance along the ray, m

    GI_FN MapWalk(ImpostorScene const& scene_, RayQuery const& q_, RayShear const& shear_,
                  ImpostorSettings const& settings_, std::uint32_t k_, bool sees_start, bool may_change_, float t,
                  Walk& found_)
        : scene(scene_),
          q(q_),
          shear(shear_),
          settings(settings_),
          k(k_),
          may_change(may_change_),
          found(found_),
          arc(q.ray.origin - scene.maps.centres[k], q.ray.direction),
          width(scene.maps.texel_width()),
          s(arc.share(t)),
          length(glm::length(arc.at(s))),
          leaving(sees_start)
    {
        set_limit();
    }

    GI_FN void run()
    {
        ImpostorsView const& maps = scene.maps;
        if (!(arc.away > 0)) {
            ImpostorTexel const texel = maps.look(k, q.ray.direction);
            meet(scene, q, shear, texel.triangle, found);
            found.crossing = hit_at(scene, k, q, texel.distance);
            return;
        }
        constexpr int kMostFaces = 12; // an arc of at most half a turn crosses fewer
        for (int faces = 0; faces < kMostFaces && s < 1; ++faces) {
            float const start = s + kProbe;
            FaceArc const face(arc, maps.cube_texel(arc.at(start)).face);
            int const across = maps.blocks_across();
            for (CellSteps blocks(face, start, across, 0, 0, across); blocks.inside() && s < 1; blocks.step())
                if (!pass_block(face, blocks, glm::max(blocks.end(), s))) return;
            s = glm::max(s, start);
        }
    }

private:
    GI_FN void set_limit() { limit = arc.share(glm::min(found.exact.distance, q.reach)); }

    /// False if the walk has ended.
    GI_FN bool pass_block(FaceArc const& face, CellSteps const& at, float end)
    {
        ImpostorsView const& maps = scene.maps;
        ImpostorBlock const block = maps.blocks[maps.block(k, face.face, at.i, at.j)];
        float const end_length = glm::length(arc.at(end)), near = block.nearest * (1 - width);
        bool const in_front =
            !(block.nearest < kFarthest) || (length < near * (1 - s) && end_length < near * (1 - end));
        bool const behind = !before && !leaving && length > block.farthest * (1 - s) &&
                            end_length > block.farthest * (1 - end) && !passes_within(block.farthest, end);
        if (in_front || behind) {
            if (found.crossing.triangle != kNoTriangle) return false;
            if (behind) { // one of the triangles that hide it may continue here
                meet(scene, q, shear, maps.look(k, arc.at(0.5f * (s + end))).triangle, found);
                set_limit();
            }
            before = in_front;
            leaving = false;
            s = end;
            length = end_length;
            return s < limit;
        }
        constexpr int kBlock = ImpostorsView::kBlock;
        int const i = at.i * kBlock, j = at.j * kBlock;
        CellSteps texels(face, s + kProbe, int(maps.resolution), i, j, kBlock);
        for (; texels.i >= i && texels.j >= j && texels.i < i + kBlock && texels.j < j + kBlock && s < end;
             texels.step())
            if (!pass_texel({face.face, texels.i, texels.j}, glm::clamp(texels.end(), s, end))) return false;
        s = end;
        length = end_length;
        return s < limit;
    }

    /// Whether the ray comes nearer to the centre than this, between s and end.
    GI_FN bool passes_within(float distance, float end) const
    {
        float const along = -glm::dot(arc.from, q.ray.direction);
        if (!(along > 0)) return false;
        float const nearest = arc.share(along);
        return nearest > s && nearest < end && square(arc.away) - square(along) < square(distance);
    }

    GI_FN bool pass_texel(CubeTexel at, float end)
    {
        ImpostorTexel const texel = scene.maps.at(k, at);
        float const end_length = glm::length(arc.at(end));
        // How far it is beyond the surface, scaled by 1 - s as lengths are:
        float const depth = length - texel.distance * (1 - s), end_depth = end_length - texel.distance * (1 - end);
        float const join = settings.jump * width * texel.distance;
        if (!(texel.distance < kFarthest)) {
            before = true;
            leaving = false;
        } else {
            if (depth > -join * (1 - s) || end_depth > -join * (1 - end)) {
                meet(scene, q, shear, texel.triangle, found);
                set_limit();
            }
            bool const behind = end_depth > 0 && texel.triangle != found.left && passed(texel.triangle, end);
            if (before && behind && found.crossing.triangle == kNoTriangle) {
                if (depth <= 0 || !passed(texel.triangle, s))
                    cross(texel, depth < 0 ? s + depth / (depth - end_depth) * (end - s) : s, join);
                else if (!enter_behind(texel, join))
                    return false;
            } else if (end_depth < -width * end_length) {
                before = true;
            } else if (leaving && !before && behind && depth > join * (1 - s) && !vanish()) {
                return false;
            }
        }
        s = end;
        length = end_length;
        if (s >= limit) return false;
        return found.crossing.triangle == kNoTriangle || more-- > 0;
    }

    /// True if the ray at s is beyond the plane of a triangle as seen from the centre:
    /// for surfaces seen at a small angle, this is more accurate than the distance at the middle of the texel.
    GI_FN bool passed(std::uint32_t triangle, float at) const
    {
        Surface const& surface = scene.world.surfaces[triangle];
        vec3 const normal = glm::cross(surface.edge1, surface.edge2);
        float const plane = glm::dot(normal, surface.corner - scene.maps.centres[k]);
        float const beyond = glm::dot(normal, arc.at(at)) - plane * (1 - at);
        return plane > 0 ? beyond > 0 : beyond < 0;
    }

    /// A crossing at share `where`.
    GI_FN void cross(ImpostorTexel const& texel, float where, float join)
    {
        // Neighbours of the texel hold the small triangles about it.
        CubeTexel const at = scene.maps.cube_texel(arc.at(where));
        int const last = int(scene.maps.resolution) - 1;
        for (int j = glm::max(at.j - 1, 0); j <= glm::min(at.j + 1, last); ++j)
            for (int i = glm::max(at.i - 1, 0); i <= glm::min(at.i + 1, last); ++i)
                meet(scene, q, shear, scene.maps.at(k, {at.face, i, j}).triangle, found);
        set_limit();
        found.crossing = on_triangle(texel.triangle, arc.distance(where), join);
    }

    /// The ray is in front of the last texel's surface and behind this one's.
    /// Returns false if another impostor is to continue the walk.
    GI_FN bool enter_behind(ImpostorTexel const& texel, float join)
    {
        ImpostorTexel const last = scene.maps.look(k, arc.at(s - kProbe));
        if (last.distance - texel.distance <= join) {
            cross(texel, s, join);
            return true;
        }
        return vanish();
    }

    /// The ray is hidden from here on. Returns false if another impostor is to continue the walk.
    GI_FN bool vanish()
    {
        before = leaving = false;
        float const here = arc.distance(s);
        ImpostorTexel const last = scene.maps.look(k, arc.at(s - kProbe));
        // The surface that was behind the ray may continue here.
        meet(scene, q, shear, last.triangle, found);
        set_limit();
        if (may_change) {
            next = nearest_seeing(scene.maps, q.ray.origin + here * q.ray.direction, k);
            next_from = here;
            if (next != kNoImpostor) return false;
        }
        if (found.hidden.triangle != kNoTriangle || found.to_sky) return true;
        if (last.triangle == kNoTriangle) {
            found.to_sky = true;
        } else {
            // On the continued plane of its triangle. A ray that leads away from the plane hits it nowhere.
            Hit const on = on_triangle(last.triangle, here, kFarthest);
            if (on.distance >= here && on_surface(scene, q.ray, on, goes_on_at(on.distance))) found.hidden = on;
        }
        return true;
    }

    /// See kGoesOn, m.
    GI_FN float goes_on_at(float t) const
    {
        return kGoesOn * glm::length(q.ray.origin + t * q.ray.direction - scene.maps.centres[k]);
    }

    /// The hit on the triangle at distance t, or on its plane if that is within `around`, m.
    GI_FN Hit on_triangle(std::uint32_t triangle, float t, float around) const
    {
        Surface const& surface = scene.world.surfaces[triangle];
        float const on = glm::max(on_plane(surface, q.ray, t, around), 0.0f);
        return {triangle, barycentric_at(surface, q.ray.origin + on * q.ray.direction), on};
    }
};

/// For a ray that was hidden all along, or stayed too near to the surface it left:
/// its hit on the plane of the surface that the impostor shows in its direction.
GI_FN inline Hit at_end(ImpostorScene const& scene, std::uint32_t k, RayQuery const& q)
{
    ImpostorTexel const texel = scene.maps.look(k, q.ray.direction);
    if (texel.triangle == kNoTriangle) return {};
    Surface const& surface = scene.world.surfaces[texel.triangle];
    float const guess = first_guess(scene.maps, k, q.ray), on = on_plane(surface, q.ray, guess, texel.distance);
    if (!(on > 0)) return {};
    Hit const hit{texel.triangle, barycentric_at(surface, q.ray.origin + on * q.ray.direction), on};
    return on_surface(scene, q.ray, hit, kGoesOn * texel.distance) ? hit : Hit{};
}

GI_FN inline ImpostorHit search_walk(ImpostorScene const& scene, RayQuery const& q, std::uint32_t left, vec3 side,
                                     bool known, ImpostorSettings const& settings)
{
    ImpostorsView const& maps = scene.maps;
    std::uint32_t k = nearest_seeing(maps, q.ray.origin, kNoImpostor, side);
    bool const seen = k != kNoImpostor;
    if (!seen) k = nearest_impostor(maps, q.ray.origin);
    RayShear const shear(q.ray.direction);
    Walk walk;
    walk.left = left;
    ImpostorHit found{.maps = 1};
    for (float t = 0;;) {
        MapWalk one(scene, q, shear, settings, k, seen || found.maps > 1, int(found.maps) < settings.most_maps, t,
                    walk);
        one.run();
        if (one.next == kNoImpostor) break;
        k = one.next;
        t = one.next_from;
        ++found.maps;
    }
    vec3 const centre = maps.centres[k];
    // A crossing and a triangle hit close to it are the same surface.
    float const same =
        2 * maps.texel_width() *
        glm::length(q.ray.origin + glm::min(walk.crossing.distance, kFarthest) * q.ray.direction - centre);
    found.exact = walk.exact.triangle != kNoTriangle && !(walk.crossing.distance + same < walk.exact.distance);
    found.hit = found.exact                             ? walk.exact
                : walk.crossing.triangle != kNoTriangle ? walk.crossing
                : walk.hidden.triangle != kNoTriangle   ? walk.hidden
                : walk.to_sky || !known                 ? Hit{}
                                                        : at_end(scene, k, q);
    if (found.hit.distance > q.reach) found.hit = {};
    return found;
}

/// The normal of the triangle that a ray leaves, on the side on which it leaves it,
/// of any length; 0 = it leaves none.
GI_FN inline vec3 side_left(WorldView const& world, PathQuery const& path)
{
    if (path.triangle == kNoTriangle) return vec3{0};
    Surface const& surface = world.surfaces[path.triangle];
    vec3 const normal = glm::cross(surface.edge1, surface.edge2);
    return glm::dot(normal, path.ray.ray.direction) > 0 ? normal : -normal;
}

/// True if the centre of some impostor is on this side of a point. If none is, as on the outside of a closed room,
/// no impostor shows what is there.
GI_FN inline bool any_on_side(ImpostorsView const& maps, vec3 point, vec3 side)
{
    for (vec3 const& centre : maps.centres)
        if (glm::dot(centre - point, side) >= 0) return true;
    return false;
}

} // namespace impostor_detail

/// Follows a ray. @param path  of finite coordinates
GI_FN inline ImpostorHit follow(ImpostorScene const& scene, PathQuery const& path,
                                ImpostorSettings const& settings)
{
    using namespace impostor_detail;
    if (scene.maps.centres.empty()) return {};
    RayQuery q = path.ray;
    vec3 const side = side_left(scene.world, path);
    bool const known = path.triangle == kNoTriangle || any_on_side(scene.maps, q.ray.origin, side);
    // A walk may start hidden and become visible later; the other searches cannot detect that.
    if (!known && settings.search != ImpostorSearch::walk) return {};
    float const start = q.start;
    q.ray.origin += start * q.ray.direction;
    q.reach -= start;
    ImpostorHit found = settings.search == ImpostorSearch::walk
                            ? search_walk(scene, q, path.triangle, side, known, settings)
                        : settings.search == ImpostorSearch::cascaded ? search_cascaded(scene, q, settings)
                        : settings.search == ImpostorSearch::all      ? search_all(scene, q, settings)
                                                                      : search_first_guess(scene, q, settings);
    if (found.hit.triangle != kNoTriangle) found.hit.distance += start;
    return found;
}

} // namespace gi
