#include "viewer/engine/hidden_views.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

gi::ViewTangents tangents_of(ViewCommand const& view)
{
    double const y = std::tan(0.5 * view.camera.yfov_rad), x = y * view.width / view.height;
    return view.camera.off_axis.value_or(gi::ViewTangents{-x, x, -y, y});
}

} // namespace

void HiddenViews::apply(Change const& change)
{
    auto [name, mask] = hidden_mask_of(change);
    if (mask.triangles.empty()) {
        views_.erase(name);
        return;
    }
    if (views_.size() >= CommandLimits::views && !views_.contains(name))
        throw gi::InputError("'" + change.key + "'",
                             fmt::format("{} views have masks, the maximum", views_.size()),
                             "replace or empty one of these masks first");
    views_[name] = {std::move(mask), {}, 0, 0, nullptr};
}

HiddenPixels HiddenViews::pixels(ViewCommand const& view)
{
    auto const found = views_.find(view.name);
    if (found == views_.end() || view.camera.orthographic) return nullptr;
    View& v = found->second;
    gi::ViewTangents const tangents = tangents_of(view);
    if (v.width != view.width || v.height != view.height || !(v.tangents == tangents)) {
        v = {std::move(v.mask), tangents, view.width, view.height, nullptr};
        std::vector<std::uint8_t> hidden = pixels_to_leave_out(v.mask, tangents, view.width, view.height);
        if (std::ranges::find(hidden, 1) != hidden.end())
            v.pixels = std::make_shared<std::vector<std::uint8_t> const>(std::move(hidden));
    }
    return v.pixels;
}

} // namespace viewer
