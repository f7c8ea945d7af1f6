#pragma once
// Pictures of a surface that is not flat, on the CPU: what the shader's are compared with.

#include "viewer/displays/cube_faces.h"

#include <algorithm>
#include <cmath>

namespace viewer::test {

/// Where a direction is seen: index of the face, and the position in its picture, 0..1 from the lower left corner.
struct FacePlace {
    std::size_t index = 0;
    glm::dvec2 picture{0};
};
/// @param in_cube  not zero. None: its face is not rendered.
inline std::optional<FacePlace> place_in(std::span<FaceView const> faces, gi::dvec3 in_cube)
{
    gi::dvec3 const a = glm::abs(in_cube);
    double const most = std::max({a.x, a.y, a.z});
    for (std::size_t i = 0; i < faces.size(); ++i) {
        gi::dvec3 const d = glm::transpose(cube_from_face(faces[i].face)) * in_cube;
        if (-d.z < most) continue;
        gi::ViewTangents const& t = faces[i].tangents;
        glm::dvec2 const at{d.x / -d.z, d.y / -d.z};
        glm::dvec2 const picture{(at.x - t.left) / (t.right - t.left), (at.y - t.bottom) / (t.top - t.bottom)};
        if (!(picture.x >= 0 && picture.x <= 1 && picture.y >= 0 && picture.y <= 1)) continue;
        return FacePlace{i, picture};
    }
    return {};
}

/// Bytes R, G, B, rows from the top.
struct BytePicture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};
/// The surface's picture from those of the faces: bilinear, black where nothing is lit.
inline BytePicture resample(Surface const& s, glm::ivec2 px, gi::dvec3 eye, std::span<FaceView const> faces,
                            std::span<BytePicture const> pictures)
{
    BytePicture out{px.x, px.y, std::vector<unsigned char>(std::size_t(px.x) * std::size_t(px.y) * 3)};
    glm::dmat3 const cube_from_room = glm::transpose(glm::mat3_cast(pose_of(s.place).rotation));
    for (int y = 0; y < px.y; ++y)
        for (int x = 0; x < px.x; ++x) {
            auto const point = surface_point(s, double(px.x) / px.y, {(x + 0.5) / px.x, 1 - (y + 0.5) / px.y});
            if (!point) continue;
            gi::dvec3 const d = cube_from_room * direction_to(*point, eye);
            auto const place = glm::dot(d, d) > 0.5 ? place_in(faces, d) : std::nullopt;
            if (!place) continue;
            BytePicture const& from = pictures[place->index];
            double const u = place->picture.x * from.width - 0.5, v = (1 - place->picture.y) * from.height - 0.5;
            int const left = int(std::floor(u)), top = int(std::floor(v));
            for (int c = 0; c < 3; ++c) {
                auto const at = [&](int i, int j) {
                    i = std::clamp(i, 0, from.width - 1);
                    j = std::clamp(j, 0, from.height - 1);
                    return double(from.rgb[(std::size_t(j) * std::size_t(from.width) + std::size_t(i)) * 3 +
                                           std::size_t(c)]);
                };
                double const above = glm::mix(at(left, top), at(left + 1, top), u - left),
                             below = glm::mix(at(left, top + 1), at(left + 1, top + 1), u - left);
                out.rgb[(std::size_t(y) * std::size_t(px.x) + std::size_t(x)) * 3 + std::size_t(c)] =
                    static_cast<unsigned char>(glm::mix(above, below, v - top) + 0.5);
            }
        }
    return out;
}

} // namespace viewer::test
