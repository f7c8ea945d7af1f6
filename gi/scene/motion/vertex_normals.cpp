#include "gi/scene/motion/vertex_normals.h"

namespace gi {

std::vector<vec3> vertex_normals(std::vector<vec3> const& positions, std::vector<uvec3> const& triangles)
{
    std::vector<dvec3> sum(positions.size(), dvec3{0});
    for (uvec3 const t : triangles) {
        dvec3 const corner[3]{dvec3(positions[t.x]), dvec3(positions[t.y]), dvec3(positions[t.z])};
        dvec3 const area = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        double const length = glm::length(area);
        if (!(length > 0) || !std::isfinite(length)) continue;
        for (int k = 0; k < 3; ++k) {
            dvec3 const a = corner[(k + 1) % 3] - corner[k], b = corner[(k + 2) % 3] - corner[k];
            double const angle = std::atan2(length, glm::dot(a, b));
            sum[t[k]] += angle / length * area;
        }
    }
    std::vector<vec3> normals;
    normals.reserve(sum.size());
    for (dvec3 const& s : sum) {
        double const length = glm::length(s);
        normals.push_back(length > 1e-9 ? vec3(s / length) : vec3{0});
    }
    return normals;
}

} // namespace gi
