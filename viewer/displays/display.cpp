#include "viewer/displays/display.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {

RoomPose pose_of(Placement const& p)
{
    gi::dvec3 const a = glm::radians(p.rotation_deg);
    gi::dquat const rotation = glm::angleAxis(a.z, gi::dvec3{0, 0, 1}) * glm::angleAxis(a.y, gi::dvec3{0, 1, 0}) *
                               glm::angleAxis(a.x, gi::dvec3{1, 0, 0});
    return {p.translation_m, glm::normalize(rotation)};
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
