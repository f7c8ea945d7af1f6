#pragma once
// Inverse of CameraRays::through, precomputed in double for many points.

#include "gi/scene/model/camera.h"

namespace gi {

class Projection {
public:
    explicit Projection(CameraRays const& camera);

    /// Returns the pixel position (x, y) and the depth along forward (m) of a point in the same frame.
    vec3 operator()(vec3 point) const
    {
        dvec3 const to = dvec3(point) - origin_;
        double const depth = glm::dot(to, forward_), scale = orthographic_ ? 1 : 1 / depth;
        return {float(scale * glm::dot(to, across_) - corner_x_), float(scale * glm::dot(to, down_) - corner_y_),
                float(depth)};
    }

private:
    dvec3 origin_, forward_;
    dvec3 across_, down_; ///< pixels per m at a depth of 1 m
    double corner_x_, corner_y_;
    bool orthographic_;
};

} // namespace gi
