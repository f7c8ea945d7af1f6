#pragma once
// Pictures read back from windows, and their combination into one.

#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace viewer {

/// R, G, B bytes, rows from the top.
struct Snapshot {
    glm::ivec2 size_px{};
    std::vector<unsigned char> bytes;

    bool empty() const { return bytes.empty(); }
};

/// The pictures beside each other from left to right, their upper edges aligned, black where one is lower than
/// others: windows in their order, the eyes of a headset or of quad-buffers.
Snapshot side_by_side(std::span<Snapshot const> parts);

} // namespace viewer
