#include "gi/scene/motion/stretch.h"

namespace gi {
namespace {

glm::dmat3 cofactors(glm::dmat3 const& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

double size_of(glm::dmat3 const& m)
{
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

} // namespace

glm::dmat3 nearest_rotation(glm::dmat3 const& m)
{
    double const size = size_of(m);
    if (!(size > 1e-150) || !(size < 1e150)) return glm::dmat3(1);
    glm::dmat3 a = m / size;
    if (glm::dot(a[0], glm::cross(a[1], a[2])) < 0) a = -a;
    glm::dmat3 const other = cofactors(a);
    double const area = size_of(other);
    if (!(area > 1e-12)) return glm::dmat3(1);
    glm::dmat3 x = a + other / area;
    for (int i = 0; i < 60; ++i) {
        glm::dmat3 const c = cofactors(x);
        glm::dmat3 const next = 0.5 * (x + c / glm::dot(x[0], c[0]));
        double const step = size_of(next - x);
        x = next;
        if (step < 1e-14) break;
    }
    return x;
}

} // namespace gi
