#include "ar/pipeline/visibility.h"

#include <algorithm>
#include <array>
#include <limits>

namespace ar {

std::string name_of(Visibility v)
{
    constexpr std::array<char const*, 6> names{"",
                                               "",
                                               "behind the camera",
                                               "outside of the picture",
                                               "smaller than 4 pixels",
                                               "hidden by the real scene"};
    return names[std::size_t(v)];
}

Visibility visibility_of(CameraModel const& c, gi::RigidPose const& world_from_camera,
                         std::vector<glm::dvec3> const& corners_m, bool covers_pixels)
{
    if (corners_m.empty()) return Visibility::unknown;
    gi::RigidPose const camera_from_world = inverse(world_from_camera);
    double const inf = std::numeric_limits<double>::infinity();
    glm::dvec2 low(inf), high(-inf);
    bool some_behind = false, some_ahead = false;
    for (glm::dvec3 const& corner : corners_m) {
        glm::dvec3 const p = camera_from_world * corner;
        auto const px = p.z > 0 ? project(c, p) : std::nullopt;
        some_behind |= !(p.z > 0);
        some_ahead |= p.z > 0;
        if (!px) continue;
        low = glm::min(low, *px);
        high = glm::max(high, *px);
    }
    bool const is_small = !some_behind && low.x <= high.x && std::max(high.x - low.x, high.y - low.y) < kSmall_px;
    if (covers_pixels) return is_small ? Visibility::small : Visibility::seen;
    if (!some_ahead) return Visibility::behind;
    // A box that reaches behind the camera may be anywhere in its picture.
    bool const is_outside =
        high.x < -0.5 || high.y < -0.5 || low.x > c.size_px.x - 0.5 || low.y > c.size_px.y - 0.5;
    if (low.x > high.x || is_outside) return Visibility::outside;
    if (is_small) return Visibility::small;
    return Visibility::hidden;
}

} // namespace ar
