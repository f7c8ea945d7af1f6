#include "viewer/app/screenshot.h"

#include <algorithm>

namespace viewer {

Snapshot side_by_side(std::span<Snapshot const> parts)
{
    if (parts.size() == 1) return parts[0];
    Snapshot whole;
    for (Snapshot const& p : parts) {
        whole.size_px.x += p.size_px.x;
        whole.size_px.y = std::max(whole.size_px.y, p.size_px.y);
    }
    std::size_t const row = 3 * std::size_t(whole.size_px.x);
    whole.bytes.assign(row * std::size_t(whole.size_px.y), 0);
    std::size_t corner = 0;
    for (Snapshot const& p : parts) {
        std::size_t const part = 3 * std::size_t(p.size_px.x);
        for (std::size_t y = 0; y < std::size_t(p.size_px.y); ++y)
            std::copy_n(p.bytes.data() + y * part, part, whole.bytes.data() + y * row + corner);
        corner += part;
    }
    return whole;
}

} // namespace viewer
