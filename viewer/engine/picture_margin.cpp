#include "viewer/engine/picture_margin.h"

#include <algorithm>
#include <cmath>

namespace viewer {

gi::Camera with_margin(gi::Camera const& camera, glm::ivec2 size_px, glm::ivec2 margin_px)
{
    if (margin_px == glm::ivec2(0)) return camera;
    gi::ViewTangents e = gi::view_edges(camera, size_px.x, size_px.y);
    double const x = margin_px.x * (e.right - e.left) / size_px.x,
                 y = margin_px.y * (e.top - e.bottom) / size_px.y;
    gi::Camera wide = camera;
    wide.off_axis = gi::ViewTangents{e.left - x, e.right + x, e.bottom - y, e.top + y};
    return wide;
}

glm::ivec2 margin_for(ViewCommand const& view, gi::Camera const& later)
{
    constexpr int kStep = 4, kShare = 12;
    if (view.camera.orthographic || later.orthographic) return glm::ivec2(0);
    glm::ivec2 const size(view.width, view.height);
    gi::ViewTangents const e = gi::view_edges(view.camera, size.x, size.y),
                           to = gi::view_edges(later, size.x, size.y);
    glm::dmat3 const turn =
        glm::transpose(glm::dmat3(view.camera.world_from_camera)) * glm::dmat3(later.world_from_camera);
    glm::dvec2 beyond(0); // px
    for (double const x : {to.left, to.right})
        for (double const y : {to.bottom, to.top}) {
            gi::dvec3 const seen = turn * gi::dvec3(x, y, -1);
            if (!(seen.z < 0)) continue;
            glm::dvec2 const at(seen.x / -seen.z, seen.y / -seen.z);
            beyond.x = std::max({beyond.x, (e.left - at.x) / (e.right - e.left) * size.x,
                                 (at.x - e.right) / (e.right - e.left) * size.x});
            beyond.y = std::max({beyond.y, (e.bottom - at.y) / (e.top - e.bottom) * size.y,
                                 (at.y - e.top) / (e.top - e.bottom) * size.y});
        }
    auto const margin = [](double px, int side) {
        int const most = side / kShare / kStep * kStep;
        return int(std::min(double(most), std::ceil(px / kStep) * kStep));
    };
    return {margin(beyond.x, size.x), margin(beyond.y, size.y)};
}

gi::Picture without_margin(gi::Picture const& picture, glm::ivec2 margin_px)
{
    if (margin_px == glm::ivec2(0)) return picture;
    gi::Picture out{picture.width - 2 * margin_px.x, picture.height - 2 * margin_px.y, {}, {}};
    for (gi::Layer const& from : picture.layers) {
        gi::Layer& to = out.add(from.name.c_str(), from.channels);
        auto const row = std::ptrdiff_t(out.width) * from.channels;
        for (int y = 0; y < out.height; ++y) {
            std::ptrdiff_t const at =
                (std::ptrdiff_t(y + margin_px.y) * picture.width + margin_px.x) * from.channels;
            std::copy_n(from.data.begin() + at, row, to.data.begin() + y * row);
        }
    }
    return out;
}

} // namespace viewer
