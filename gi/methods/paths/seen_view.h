#pragma once
// A view as used by passes, and its state kept between frames.

#include "gi/methods/paths/primary_map.h"
#include "gi/render/frame_renderer.h"

#include <deque>
#include <optional>

namespace gi {

struct SeenView {
    CameraRays rays; ///< through the centre of the lens; motion vectors refer to these
    CameraRays earlier;
    int width = 0, height = 0, partner = -1;
    std::span<std::uint8_t const> hidden; ///< as in FrameView
    std::size_t hidden_pixels = 0;
    PixelFilter filter = PixelFilter::box;
    std::optional<PrimaryMap> primary; ///< none for orthographic cameras
    std::size_t first = 0;             ///< index of its first pixel among the pixels of all views
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};

/// Views of one moment; a partner precedes the views that reuse its light.
using SeenViews = std::deque<SeenView>;

} // namespace gi
