#pragma once
// Reports an estimate of light from frames, and how far it can be trusted, as text.

#include "ar/pipeline/frame_light.h"

namespace ar {

std::string describe(FrameLight const& light);
/// Warnings about numbers that are unreliable; empty = none.
std::vector<std::string> warnings_of(FrameLight const& light);
/// Writes the map as OpenEXR: R, G, B, and the layer "known" (1 = determined by the frames, 0 = a guess).
void write_light(std::filesystem::path const& file, FrameLight const& light, gi::Report& report);

} // namespace ar
