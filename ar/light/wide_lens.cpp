#include "ar/light/wide_lens.h"

#include "ar/base/error.h"
#include "ar/light/picture_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ar {

PartialMap unwrap_lens(cv::Mat const& radiance, CameraModel const& camera, glm::dquat const& world_from_camera,
                       WideLensSettings const& settings)
{
    check_picture(radiance, camera, "picture of the surround");
    if (!(settings.largest_angle_rad > 0) || !(settings.fade_rad > 0))
        throw InputError("the largest angle of the lens, or the fade, is not positive", "no direction is left",
                         "give both in radians, or leave them out");
    glm::dquat const camera_from_world = glm::conjugate(world_from_camera);
    auto const look = [&](glm::dvec3 world) -> Look {
        glm::dvec3 const d = camera_from_world * world;
        double const left = settings.largest_angle_rad - std::acos(std::clamp(d.z, -1.0, 1.0));
        auto const pixel = left > 0 ? project(camera, d) : std::nullopt;
        if (!pixel) return {};
        // A lens model goes on beyond where it folds back: the pixel must see the direction, too.
        auto const back = direction_of(camera, *pixel);
        bool const same = back && glm::dot(*back, d) > 1 - 1e-8;
        return same ? Look{*pixel, std::min(1.0, left / settings.fade_rad)} : Look{};
    };
    double const pixels_per_texel = std::max(camera.fx, camera.fy) * 2 * std::numbers::pi / settings.size.width;
    return gather(radiance, settings.size, pixels_per_texel, look);
}

} // namespace ar
