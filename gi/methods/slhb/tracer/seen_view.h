#pragma once
// A view as passes go through it, and what is kept of it from frame to frame.

#include "gi/methods/slhb/lights/primary_map.h"
#include "gi/render/frame_renderer.h"

#include <deque>
#include <optional>

namespace gi {

struct SeenView {
    CameraRays rays; ///< through the middle of the lens, where motion vectors are measured
    CameraRays earlier;
    int width = 0, height = 0, partner = -1;
    std::span<std::uint8_t const> hidden; ///< as FrameView has it
    std::size_t hidden_pixels = 0;
    std::optional<PrimaryMap> primary; ///< not of orthographic cameras
    std::size_t first = 0;             ///< of its pixels among those of all views
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};

/// Of one moment; a partner comes before those that take light from it.
using SeenViews = std::deque<SeenView>;

} // namespace gi
