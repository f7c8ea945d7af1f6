#pragma once
// Difference between two pixels' surfaces; from 1 on they count as different.
//   d^2 = (1 - cos) / (1 - cos 37 degrees) + (distance from the tangent plane / reach)^2
//         + (3 difference of albedos)^2

#include "gi/filter/filter_input.h"

namespace gi {

/// 1 / (1 - cosine) of the angle from which on surfaces count as different.
inline constexpr float kBySurfaceNormal = 5;
/// 1 / difference of albedo luminances from which on surfaces count as different.
inline constexpr float kBySurfaceAlbedo = 3;

/// 1 / reach^2: pixels of distance from the tangent plane. Larger for larger steps,
/// as surfaces curve more over a distance.
constexpr float plane_scale(int step)
{
    float const reach = 1.5f * (1 + 0.2f * float(step));
    return 1 / (reach * reach);
}

/// The guides of one row.
struct SurfaceRow {
    Row3<float const> normal, position;
    float const* albedo;

    SurfaceRow(Planes const& guides, int y)
        : normal(guides.row3(guide::normal, y)),
          position(guides.row3(guide::position, y)),
          albedo(guides.row(guide::albedo, y))
    {
    }
};

/// One pixel's surface, and the difference of other pixels from it.
class SurfacePoint {
public:
    /// @param by_plane  1 / (footprint * reach)^2
    SurfacePoint(SurfaceRow const& row, int x, float by_plane)
        : normal_(row.normal[x]),
          plane_(glm::dot(normal_, row.position[x])),
          by_plane_(by_plane),
          albedo_(row.albedo[x])
    {
    }
    float distance2(SurfaceRow const& row, int x) const
    {
        float const off_plane = glm::dot(normal_, row.position[x]) - plane_, da = row.albedo[x] - albedo_;
        return kBySurfaceNormal * (1 - glm::dot(normal_, row.normal[x])) + by_plane_ * off_plane * off_plane +
               kBySurfaceAlbedo * kBySurfaceAlbedo * da * da;
    }

private:
    vec3 normal_;
    float plane_, by_plane_, albedo_;
};

} // namespace gi
