#pragma once
// Settings of spherical layered hit buffers and shadow maps, for all methods that look up.

#include <cstdint>
#include <string>

namespace gi {

/// Where the axes of a pass come from.
enum class Schedule : std::uint8_t {
    automatic,
    stored,   ///< one set for all passes, built once
    streamed, ///< new axes for every pass
    temporal, ///< a set in which some axes are replaced in every pass
};

/// Approximations of look-ups that are replaced by exact rays, to measure their bias:
/// two renders with one seed that differ only in this setting share axes, light samples and random numbers,
/// so that their difference has little noise.
struct ExactParts {
    bool queries = false;    ///< instead of look-ups in hit buffers
    bool shadows = false;    ///< instead of look-ups in shadow maps
    bool directions = false; ///< cosine-distributed directions, one per path, instead of axes; needs `queries`

    bool any() const { return queries || shadows; }
};

/// Whether an exact ray decides where the texels around a look-up, or around a test by a shadow map, disagree.
enum class Confirming : std::uint8_t { automatic, on, off };

/// Settings of hit buffers, of look-ups in them and of shadow maps; 0 or empty = chosen by the scene plan.
struct SlhbSettings {
    Schedule schedule = Schedule::automatic;
    std::string directions;      ///< such as "icosahedron:320"; schedule stored
    int resolution = 0;          ///< texels per side of a hit buffer, about
    int axes = 0;                ///< per pass; schedules streamed and temporal
    int fresh_axes = 0;          ///< axes replaced per pass; schedule temporal
    int light_samples = 0;       ///< light samples with a shadow map per pass
    int fresh_light_samples = 0; ///< light samples replaced per pass
    int shadow_resolution = 0;   ///< texels per side of a shadow map
    int most_layers = 0;         ///< per texel; 0 = all
    int levels = 0; ///< most levels of grids, see windows.h; 1 = one grid of the whole; 0 = all that are worth it
    int memory_mib = 0;          ///< memory limit of hit buffers and shadow maps
    Confirming confirm = Confirming::automatic;
    bool packed = false;         ///< layers of 32 bits: 12 of depth, 1 of facing, 19 of the triangle
    float cone = 0;      ///< texels; radius of the disk of columns that a look-up may use (Yu 2012, fig. 5.6)
    bool gather = false; ///< first bounce over all axes in turn instead of at random
    ExactParts exact;    ///< on the host; for bench accuracy
};

} // namespace gi
