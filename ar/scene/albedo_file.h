#pragma once
// File of estimated albedos:
//   schema: ar-albedo/1
//   albedos:
//     - {name: table, albedo: [0.41, 0.3, 0.19], spread: [0.05, 0.04, 0.03], samples: 20000}
//     - {name: rug, albedo: [0.2, 0.1, 0.1], spread: [0.1, 0.1, 0.1], samples: 8000, texture: albedo-rug.png}

#include "gi/core/math.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ar {

struct AlbedoEntry {
    std::string name;              ///< the proxy's name, or "scene:" and the material's name
    gi::dvec3 albedo{0};           ///< linear, 0 to 1
    gi::dvec3 spread{0};           ///< robust standard deviation of single pixels
    std::uint64_t samples = 0;     ///< pixels; 0 = never seen
    std::filesystem::path texture; ///< sRGB, over texture coordinates 0 to 1; empty = none
};

/// Paths in the file are relative to it. @throws gi::InputError with file:line:column
std::vector<AlbedoEntry> read_albedos(std::filesystem::path const& file);
std::vector<AlbedoEntry> parse_albedos(std::string const& text, std::filesystem::path const& file);
/// Textures are written relative to the file's folder and must be in it.
std::string format_albedos(std::vector<AlbedoEntry> const& entries);

} // namespace ar
