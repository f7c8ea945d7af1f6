#include "gi/surfaces/mirror_boxes.h"

namespace gi {

std::vector<Bounds> mirror_boxes(World const& world, std::span<char const> wanted)
{
    std::vector<Bounds> boxes;
    for (std::size_t k = 0; k < world.placed.size(); ++k) {
        std::size_t const first = world.placed[k].first_triangle, end = k + 1 < world.placed.size()
                                                                            ? world.placed[k + 1].first_triangle
                                                                            : world.triangle_material.size();
        Bounds box;
        for (std::size_t t = first; t < end; ++t) {
            if (wanted[world.triangle_material[t]] == 0) continue;
            if (t >= world.static_triangles) {
                box = {vec3(-kInf), vec3(kInf)};
                break;
            }
            for (int corner = 0; corner < 3; ++corner) {
                vec3 const p = world.positions[world.triangles[t][corner]];
                box = joined(box, {p, p});
            }
        }
        if (!box.empty()) boxes.push_back(box);
    }
    return boxes;
}

PixelBox pixels_of(Bounds const& box, CameraRays const& camera, int width, int height)
{
    PixelBox const all{{0, 0}, {width, height}};
    if (camera.orthographic || !(box.high.x < kInf)) return all;
    // Pixel positions times the depth, and the depth, are linear functions of the place.
    glm::dmat3 const pixel_from_world =
        glm::inverse(glm::dmat3(dvec3(camera.step_x), dvec3(camera.step_y), dvec3(camera.corner)));
    auto const row = [&](int r) {
        return dvec3(pixel_from_world[0][r], pixel_from_world[1][r], pixel_from_world[2][r]);
    };
    dvec3 const x = row(0), y = row(1), w = row(2), low = dvec3(box.low) - dvec3(camera.origin),
                high = dvec3(box.high) - dvec3(camera.origin);
    for (dvec3 const f : {w, x, double(width) * w - x, y, double(height) * w - y})
        if (glm::dot(glm::max(f * low, f * high), dvec3(1)) < 0) return {};
    glm::dvec2 first(width, height), last(0);
    for (int k = 0; k < 8; ++k) {
        dvec3 const corner(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z),
            at = pixel_from_world * corner;
        if (!(at.z > 0)) return all;
        first = glm::min(first, glm::dvec2(at) / at.z);
        last = glm::max(last, glm::dvec2(at) / at.z);
    }
    glm::dvec2 const size(width, height), none(0);
    return {glm::ivec2(glm::clamp(glm::floor(first), none, size)),
            glm::ivec2(glm::clamp(glm::ceil(last), none, size))};
}

} // namespace gi
