#include "viewer/displays/cube_faces.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr int kProbes = 33;          ///< along each side of the viewport
constexpr double kQuantum = 1.0 / 8; ///< tangents of a part's edges are rounded outward to it
constexpr double kMargin_px = 2;     ///< beyond each edge, for filtering
constexpr int kLeastFace_px = 16, kMostFace_px = 8192;

glm::dvec2 probe(int i, int j) { return {double(i) / (kProbes - 1), double(j) / (kProbes - 1)}; }

std::size_t index_of(CubeFace face) { return std::size_t(face); }

CubeFace face_of(gi::dvec3 d)
{
    gi::dvec3 const a = glm::abs(d);
    if (a.z >= a.x && a.z >= a.y) return d.z < 0 ? CubeFace::front : CubeFace::back;
    if (a.x >= a.y) return d.x < 0 ? CubeFace::left : CubeFace::right;
    return d.y > 0 ? CubeFace::up : CubeFace::down;
}

glm::dvec2 tangents_in(CubeFace face, gi::dvec3 in_cube)
{
    gi::dvec3 const d = glm::transpose(cube_from_face(face)) * in_cube;
    return {d.x / -d.z, d.y / -d.z};
}

/// Median angle between neighbouring pixels, radians; 0 if nothing is lit.
double pixel_angle(Surface const& s, glm::ivec2 px, gi::dvec3 eye)
{
    double const aspect = double(px.x) / px.y;
    std::vector<double> angles;
    for (int j = 0; j < kProbes; ++j)
        for (int i = 0; i < kProbes; ++i) {
            glm::dvec2 const at = probe(i, j) * (1 - 2.0 / std::max(2, std::min(px.x, px.y)));
            auto const a = surface_point(s, aspect, at),
                       b = surface_point(s, aspect, at + glm::dvec2(1.0 / px.x, 0)),
                       c = surface_point(s, aspect, at + glm::dvec2(0, 1.0 / px.y));
            if (!a || !b || !c) continue;
            gi::dvec3 const d = direction_to(*a, eye);
            angles.push_back(0.5 *
                             (glm::length(direction_to(*b, eye) - d) + glm::length(direction_to(*c, eye) - d)));
        }
    if (angles.empty()) return 0;
    auto const middle = angles.begin() + std::ptrdiff_t(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    return *middle;
}

} // namespace

char const* name_of(CubeFace face)
{
    static constexpr std::array kNames{"front", "left", "right", "up", "down", "back"};
    return kNames[index_of(face)];
}

glm::dmat3 cube_from_face(CubeFace face)
{
    // Columns: the camera's right, up and backward axes.
    switch (face) {
    case CubeFace::left:
        return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
    case CubeFace::right:
        return {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
    case CubeFace::up:
        return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    case CubeFace::down:
        return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    case CubeFace::back:
        return {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    case CubeFace::front:
        break;
    }
    return glm::dmat3(1);
}

std::vector<FaceView> faces_for(Surface const& s, glm::ivec2 px, std::span<gi::dvec3 const> eyes, int face_px)
{
    if (px.x < 1 || px.y < 1 || eyes.empty()) return {};
    double const aspect = double(px.x) / px.y;
    glm::dmat3 const cube_from_room = glm::transpose(glm::mat3_cast(pose_of(s.place).rotation));
    struct Bounds {
        glm::dvec2 low{2}, high{-2};
    };
    std::array<Bounds, 6> bounds;
    for (int j = 0; j < kProbes; ++j)
        for (int i = 0; i < kProbes; ++i) {
            auto const point = surface_point(s, aspect, probe(i, j));
            if (!point) continue;
            for (gi::dvec3 const& eye : eyes) {
                gi::dvec3 const d = cube_from_room * direction_to(*point, eye);
                if (!(glm::dot(d, d) > 0.5)) continue;
                Bounds& b = bounds[index_of(face_of(d))];
                glm::dvec2 const t = tangents_in(face_of(d), d);
                b.low = glm::min(b.low, t);
                b.high = glm::max(b.high, t);
            }
        }
    if (face_px <= 0) {
        double const angle = pixel_angle(s, px, eyes[0]);
        face_px = angle > 0 ? int(std::clamp(std::round(2 / angle), double(kLeastFace_px), double(kMostFace_px)))
                            : kLeastFace_px;
    }
    double const margin = kMargin_px * 2 / face_px;
    std::vector<FaceView> out;
    for (CubeFace const face : kCubeFaces) {
        Bounds const& b = bounds[index_of(face)];
        if (b.low.x > b.high.x) continue;
        // One more quantum, because the probes may miss the outermost pixels.
        auto const down = [&](double t) {
            return std::max(-1.0, std::floor(t / kQuantum - 1) * kQuantum) - margin;
        };
        auto const up = [&](double t) { return std::min(1.0, std::ceil(t / kQuantum + 1) * kQuantum) + margin; };
        FaceView v{face, {down(b.low.x), up(b.high.x), down(b.low.y), up(b.high.y)}, 0, 0};
        v.width_px = std::max(1, int(std::lround((v.tangents.right - v.tangents.left) * face_px / 2)));
        v.height_px = std::max(1, int(std::lround((v.tangents.top - v.tangents.bottom) * face_px / 2)));
        out.push_back(v);
    }
    return out;
}

gi::Camera face_camera(Surface const& s, FaceView const& face, gi::dvec3 eye)
{
    glm::dmat3 const m = glm::mat3_cast(pose_of(s.place).rotation) * cube_from_face(face.face);
    gi::Camera camera;
    camera.off_axis = face.tangents;
    camera.yfov_rad = std::atan(face.tangents.top) - std::atan(face.tangents.bottom);
    camera.aspect = (face.tangents.right - face.tangents.left) / (face.tangents.top - face.tangents.bottom);
    camera.world_from_camera =
        gi::dmat4(glm::dvec4(m[0], 0), glm::dvec4(m[1], 0), glm::dvec4(m[2], 0), glm::dvec4(eye, 1));
    return camera;
}

} // namespace viewer
