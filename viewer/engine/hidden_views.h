#pragma once
// The hidden-area masks of a render session's views, and the pixels that they exclude.

#include "viewer/protocol/hidden_mask.h"

#include <map>
#include <memory>

namespace viewer {

/// One value per pixel of a view, rows from the top: 1 = not rendered. Null = all pixels are rendered.
using HiddenPixels = std::shared_ptr<std::vector<std::uint8_t> const>;

class HiddenViews {
public:
    /// Throws InputError as hidden_mask_of does, and if more views have masks than a frame command may hold.
    void apply(Change const& change);
    /// Hidden pixels of a view, cached until its mask, size or tangents change. Null for orthographic cameras.
    HiddenPixels pixels(ViewCommand const& view);

private:
    struct View {
        HiddenMask mask;
        gi::ViewTangents tangents;
        int width = 0, height = 0;
        HiddenPixels pixels;
    };
    std::map<std::string, View> views_;
};

} // namespace viewer
