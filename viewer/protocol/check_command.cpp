#include "gi/core/error.h"
#include "viewer/protocol/frame_command.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

[[noreturn]] void refuse(std::string const& what, std::string const& why)
{
    throw gi::InputError("a frame command has " + what, why, "make it from a valid session");
}

void check_number(double v, char const* name)
{
    if (!std::isfinite(v)) refuse(fmt::format("{} for {}", v, name), "it is not a finite number");
}

void check_name(std::string const& name)
{
    if (name.size() > CommandLimits::name_bytes)
        refuse(fmt::format("a name of {} bytes", name.size()),
               fmt::format("the limit is {} bytes", CommandLimits::name_bytes));
}

void check_matrix(gi::dmat4 const& m, char const* name)
{
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) check_number(m[c][r], name);
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
        refuse(fmt::format("a {} that is not affine", name), "its last row is not 0 0 0 1");
    double const volume = glm::determinant(glm::dmat3(m));
    if (!std::isfinite(volume) || volume == 0)
        refuse(fmt::format("a {} that flattens", name), fmt::format("its determinant is {}", volume));
}

void check_pose(std::optional<RoomPose> const& pose, char const* name)
{
    if (!pose) return;
    for (int i = 0; i < 3; ++i) check_number(pose->position[i], name);
    double const length = glm::length(pose->rotation);
    if (!(std::abs(length - 1) <= 1e-6))
        refuse(fmt::format("a rotation for {} of length {}", name, length), "rotations are unit quaternions");
}

void check_tracked(Tracked const& t)
{
    for (std::size_t b = 0; b < kBodyMembers.size(); ++b) check_pose(t.*kBodyMembers[b], kBodyNames[b]);
}

int depth_of(nlohmann::json const& value, int most)
{
    if (!value.is_structured()) return 0;
    if (most == 0) return 1;
    int deepest = 0;
    for (auto const& v : value) deepest = std::max(deepest, depth_of(v, most - 1));
    return 1 + deepest;
}

bool is_finite(nlohmann::json const& value)
{
    if (value.is_number_float()) return std::isfinite(value.get<double>());
    if (!value.is_structured()) return true;
    return std::all_of(value.begin(), value.end(), [](auto const& v) { return is_finite(v); });
}

void check_change(Change const& c)
{
    check_name(c.key);
    if (c.key.empty()) refuse("a change without a key", "the key names what is set");
    if (depth_of(c.value, CommandLimits::value_depth) > CommandLimits::value_depth)
        refuse("a value of '" + c.key + "' nested too deep",
               fmt::format("at most {} levels", CommandLimits::value_depth));
    if (c.value.is_binary() || c.value.is_discarded())
        refuse("a value of '" + c.key + "' of a type that JSON text lacks", "it could not be read back");
    if (!is_finite(c.value)) refuse("a value of '" + c.key + "' that is no finite number", "JSON has none");
}

void check_camera(gi::Camera const& c)
{
    check_name(c.name);
    for (double const v : {c.yfov_rad, c.ymag_m, c.aspect, c.aperture_radius_m, c.focus_distance_m})
        check_number(v, "a camera");
    if (c.off_axis) {
        gi::ViewTangents const& t = *c.off_axis;
        for (double const v : {t.left, t.right, t.bottom, t.top}) check_number(v, "an off-axis view");
        if (!(t.left < t.right && t.bottom < t.top))
            refuse("an off-axis view without an inside", "left < right and bottom < top must hold");
    } else if (c.orthographic ? !(c.ymag_m > 0) : !(c.yfov_rad > 0 && c.yfov_rad < 3.14159265358979)) {
        refuse(fmt::format("a camera that opens {}", c.orthographic ? c.ymag_m : c.yfov_rad),
               "a field of view lies between 0 and pi rad, half a height above 0 m");
    }
    if (c.aspect < 0) refuse(fmt::format("an aspect of {}", c.aspect), "it is a width over a height, 0 = none");
    gi::check_lens(c);
    check_matrix(c.world_from_camera, "camera");
}

} // namespace

void check_command(FrameCommand const& o)
{
    for (double const t : {o.pose_s, o.display_s, o.scene_s}) check_number(t, "a time");
    check_matrix(o.world_from_room, "world from room");
    check_tracked(o.tracked);
    if (o.others.size() > CommandLimits::users)
        refuse(fmt::format("{} users", o.others.size()), fmt::format("the limit is {}", CommandLimits::users));
    for (Tracked const& t : o.others) check_tracked(t);
    if (o.paths < 1 || o.paths > CommandLimits::paths)
        refuse(fmt::format("{} paths per pixel", o.paths), fmt::format("allowed: 1 to {}", CommandLimits::paths));
    if (!(o.light_scale > 0 && o.light_scale <= 1))
        refuse(fmt::format("light at {} of the size of the views", o.light_scale),
               "it is more than 0 and at most 1");
    if (o.only_light && !(o.light_scale < 1))
        refuse("a picture of light alone that has the size of the view", "it shows surfaces, too");
    if (!(o.surface_scale >= o.light_scale && o.surface_scale <= 1))
        refuse(fmt::format("surfaces at {} of the size of the views", o.surface_scale),
               fmt::format("it is at least that of light, {}, and at most 1", o.light_scale));
    if (o.changes.size() > CommandLimits::changes)
        refuse(fmt::format("{} changes", o.changes.size()),
               fmt::format("the limit is {}", CommandLimits::changes));
    for (Change const& c : o.changes) check_change(c);
    if (o.views.size() > CommandLimits::views)
        refuse(fmt::format("{} views", o.views.size()), fmt::format("the limit is {}", CommandLimits::views));
    for (std::size_t i = 0; i < o.views.size(); ++i) {
        ViewCommand const& v = o.views[i];
        check_name(v.name);
        check_camera(v.camera);
        if (std::min(v.width, v.height) < 1 || std::max(v.width, v.height) > CommandLimits::size_px)
            refuse(fmt::format("a view of {}x{} pixels", v.width, v.height),
                   fmt::format("1 to {} per side are possible", CommandLimits::size_px));
        if (v.margin_x < 0 || v.margin_x > v.width / 4 || v.margin_y < 0 || v.margin_y > v.height / 4)
            refuse(fmt::format("a margin of {} and {} pixels", v.margin_x, v.margin_y),
                   fmt::format("0 to a quarter of its view, {}x{}, are possible", v.width, v.height));
        if ((v.margin_x > 0 || v.margin_y > 0) && !(o.light_scale < 1))
            refuse("a margin of a picture whose light has its size", "only pictures of surfaces have margins");
        if (v.partner < -1 || v.partner >= int(i))
            refuse(fmt::format("view {} with partner {}", i, v.partner), "a partner is an earlier view, or -1");
    }
}

} // namespace viewer
