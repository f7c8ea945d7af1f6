#include "viewer/displays/display.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {

char const* name_of(Eye eye) { return eye == Eye::left ? "left" : eye == Eye::right ? "right" : "middle"; }

std::vector<std::string> files_of(Wall const& wall)
{
    std::vector<std::string> files;
    auto const add = [&](std::string const& file) {
        if (!file.empty()) files.push_back(file);
    };
    add(wall.warp_file);
    if (wall.warp_map) add(wall.warp_map->file);
    if (wall.surface) add(wall.surface->points.file);
    for (auto const* picture : {&wall.blend_picture, &wall.black_level_picture})
        if (*picture) add((*picture)->light.file);
    return files;
}

gi::dmat4 world_from_room(RoomPlace const& place)
{
    return glm::translate(gi::dmat4(1), place.position_m) *
           glm::rotate(gi::dmat4(1), glm::radians(place.yaw_deg), gi::dvec3{0, 1, 0});
}

char const* name_of(DisplayTrackerType type)
{
    switch (type) {
    case DisplayTrackerType::osc:
        return "osc";
    case DisplayTrackerType::dtrack:
        return "dtrack";
    case DisplayTrackerType::vrpn:
        return "vrpn";
    case DisplayTrackerType::openxr:
        return "openxr";
    case DisplayTrackerType::file:
        return "file";
    case DisplayTrackerType::fake:
        break;
    }
    return "fake";
}

std::optional<DisplayTrackerType> tracker_type(std::string const& name)
{
    for (DisplayTrackerType const type :
         {DisplayTrackerType::osc, DisplayTrackerType::dtrack, DisplayTrackerType::vrpn,
          DisplayTrackerType::openxr, DisplayTrackerType::file, DisplayTrackerType::fake})
        if (name == name_of(type)) return type;
    return {};
}

PixelRectangle viewport_px(Wall const& wall, DisplayWindow const& window)
{
    Viewport const& v = wall.viewport;
    bool const in_px = v.unit == LengthUnit::px;
    double const sx = in_px ? 1 : window.width_px, sy = in_px ? 1 : window.height_px;
    int const left = int(std::lround(v.x * sx)), top = int(std::lround(v.y * sy));
    return {left, top, int(std::lround((v.x + v.width) * sx)) - left,
            int(std::lround((v.y + v.height) * sy)) - top};
}

} // namespace viewer
