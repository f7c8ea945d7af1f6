#pragma once
// A view as used by passes, and its state kept between frames.

#include "gi/methods/paths/primary_map.h"
#include "gi/methods/paths/traced_world.h"

#include <deque>
#include <optional>

namespace gi {

struct SeenView : TracedView {
    int partner = -1;
    std::span<std::uint8_t const> hidden; ///< as in FrameView
    std::optional<PrimaryMap> primary;    ///< none for orthographic cameras
    std::size_t first = 0;                ///< index of its first pixel among the pixels of all views
};

/// Views of one moment; a partner precedes the views that reuse its light.
using SeenViews = std::deque<SeenView>;

} // namespace gi
