#include "viewer/app/replayed_eyes.h"

#include "gi/core/error.h"
#include "viewer/displays/compose.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewer {
namespace {

/// Eyes that share a window differ by a factor of 2, those of headsets and walls by a few percent.
constexpr double kSqueezed = 1.5;
bool is_squeezed(double pixel_aspect) { return pixel_aspect > kSqueezed || pixel_aspect < 1 / kSqueezed; }

/// True if the size has the aspect, up to rounding to pixels and 2 %.
bool has_aspect(glm::ivec2 size, double aspect)
{
    double const most = std::max(1.0, 0.02 * size.x);
    return std::abs(size.x - aspect * size.y) <= most || std::abs(size.y - size.x / aspect) <= 1;
}

/// Of the window whose part the eye's view has: it sees all of it.
glm::ivec2 window_of(RecordedViews const& v)
{
    if (!v.is_fixed || v.is_wall || !is_squeezed(v.pixel_aspect)) return v.eye_px;
    if (v.pixel_aspect > 1) return {int(std::lround(v.eye_px.x * v.pixel_aspect)), v.eye_px.y};
    return {v.eye_px.x, int(std::lround(v.eye_px.y / v.pixel_aspect))};
}

} // namespace

ReplayedEyes parse_replayed_eyes(std::string const& name)
{
    if (name == "window") return ReplayedEyes::window;
    if (name == "left") return ReplayedEyes::left;
    if (name == "right") return ReplayedEyes::right;
    if (name == "both") return ReplayedEyes::both;
    throw gi::InputError("--eye " + name, "there is no such choice", "choose window, left, right or both");
}

RecordedViews recorded_views(FrameCommand const& command)
{
    RecordedViews v;
    if (command.views.empty()) return v;
    ViewCommand const& first = command.views[0];
    v.left = 0;
    v.is_wall = first.name != "window" && first.name != "left eye" && first.name != "right eye";
    for (std::size_t k = 1; k < command.views.size() && v.right < 0; ++k)
        if (command.views[k].partner == 0) v.right = int(k);
    if (v.right >= 0 && first.name.find("right eye") != std::string::npos) std::swap(v.left, v.right);
    v.eye_px = {first.width, first.height};
    if (first.camera.off_axis && first.width > 0 && first.height > 0) {
        gi::ViewTangents const& e = *first.camera.off_axis;
        v.is_fixed = true;
        v.pixel_aspect = (e.right - e.left) / (e.top - e.bottom) * first.height / first.width;
    }
    return v;
}

Arrangement arrange(RecordedViews const& v, ReplayedEyes eyes, StereoMode mode)
{
    Arrangement a{StereoMode::off, v.left, v.right, v.eye_px};
    bool const two = v.right >= 0;
    auto const pair_of = [&](glm::ivec2 one) {
        a.mode = StereoMode::side_by_side;
        a.size_px = {2 * one.x, one.y};
        return a;
    };
    if (eyes == ReplayedEyes::right && two) a.left = v.right;
    if (eyes == ReplayedEyes::both && two) return pair_of(v.eye_px);
    if (eyes != ReplayedEyes::window || v.is_wall) return a;
    a.size_px = window_of(v);
    // A window without quad buffers shows both eyes side by side.
    if (mode == StereoMode::quad_buffer && v.pixel_aspect > kSqueezed) mode = StereoMode::side_by_side;
    if (mode == StereoMode::quad_buffer || mode == StereoMode::two_windows) return two ? pair_of(a.size_px) : a;
    a.mode = mode;
    return a;
}

bool shows_square_pixels(RecordedViews const& v, ReplayedEyes eyes, Arrangement const& whole, glm::ivec2 size)
{
    // In a window's stereo mode its aspect is already that of what it shows.
    if (!v.is_fixed || eyes == ReplayedEyes::window || !is_squeezed(v.pixel_aspect)) return false;
    double const aspect = double(whole.size_px.x) / whole.size_px.y;
    return !has_aspect(size, aspect) && has_aspect(size, aspect * v.pixel_aspect);
}

glm::ivec2 fitted(double aspect, glm::ivec2 room)
{
    if (!(aspect > 0) || has_aspect(room, aspect)) return room;
    if (room.x > aspect * room.y) return {std::max(1, int(std::lround(aspect * room.y))), room.y};
    return {room.x, std::max(1, int(std::lround(room.x / aspect)))};
}

} // namespace viewer
