#include "gi/image_io/primaries.h"

#include <cmath>

namespace gi {
namespace {

dvec3 xyz_of(glm::dvec2 xy) { return {xy, 1 - xy.x - xy.y}; }

/// Linear RGB to CIE XYZ, Y of white = 1.
std::optional<glm::dmat3> to_xyz(Primaries const& p)
{
    glm::dmat3 const columns(xyz_of(p.red), xyz_of(p.green), xyz_of(p.blue));
    if (!(std::abs(glm::determinant(columns)) > 1e-6) || !(std::abs(p.white.y) > 1e-6)) return std::nullopt;
    dvec3 const scales = glm::inverse(columns) * (xyz_of(p.white) / p.white.y);
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(scales[c]) || !(std::abs(scales[c]) > 1e-6)) return std::nullopt;
    return glm::dmat3(columns[0] * scales[0], columns[1] * scales[1], columns[2] * scales[2]);
}

} // namespace

bool Primaries::is_rec709() const
{
    Primaries const standard;
    auto const near = [](glm::dvec2 a, glm::dvec2 b) {
        return std::abs(a.x - b.x) < 1e-3 && std::abs(a.y - b.y) < 1e-3;
    };
    return near(red, standard.red) && near(green, standard.green) && near(blue, standard.blue) &&
           near(white, standard.white);
}

std::optional<dvec3> luminance_weights(Primaries const& primaries)
{
    auto const xyz = to_xyz(primaries);
    if (!xyz) return std::nullopt;
    return dvec3((*xyz)[0].y, (*xyz)[1].y, (*xyz)[2].y);
}

std::optional<glm::dmat3> to_rec709(Primaries const& primaries)
{
    glm::dmat3 const bradford(dvec3(0.8951, -0.7502, 0.0389), dvec3(0.2664, 1.7135, -0.0685),
                              dvec3(-0.1614, 0.0367, 1.0296)); // columns
    auto const from = to_xyz(primaries);
    if (!from) return std::nullopt;
    glm::dmat3 const to = *to_xyz(Primaries{});
    dvec3 const cones = bradford * (*from * dvec3(1)), wanted = bradford * (to * dvec3(1));
    glm::dmat3 adapted(0);
    for (int c = 0; c < 3; ++c) {
        if (!(std::abs(cones[c]) > 1e-6)) return std::nullopt;
        adapted[c][c] = wanted[c] / cones[c];
    }
    return glm::inverse(to) * glm::inverse(bradford) * adapted * bradford * *from;
}

} // namespace gi
