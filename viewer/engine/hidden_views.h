#pragma once
// The masks of a session's views, and the pixels that they leave out.

#include "viewer/protocol/hidden_mask.h"

#include <map>
#include <memory>

namespace viewer {

/// 1 per pixel of a view that is not rendered, rows from the top; null = all are. Another pointer = other pixels.
using HiddenPixels = std::shared_ptr<std::vector<std::uint8_t> const>;

class HiddenViews {
public:
    /// Throws InputError as hidden_mask_of, and on masks of more views than an order may hold.
    void apply(Change const& change);
    /// Kept until the mask, the size of the view or its tangents change. Null of orthographic cameras.
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
