#pragma once
// What is asked of any light-transport method, and what it gives back.

#include "gi/image_io/picture.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/kernel/space.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace gi {

enum class PixelFilter : std::uint8_t { box, tent };

/// Where the axes of a pass come from.
enum class Schedule : std::uint8_t {
    automatic,
    stored,   ///< one set for all passes, built once
    streamed, ///< fresh axes for every pass
    temporal, ///< a set of which some axes are replaced in every pass
};

/// How paths of slhb that leave a broad lobe find what they meet.
enum class LookUps : std::uint8_t {
    automatic,
    all, ///< by look-ups in hit buffers
    none ///< by exact rays in directions of their own: there are no hit buffers
};

/// What says whether light samples of slhb are seen.
enum class Shadows : std::uint8_t {
    automatic,
    maps, ///< shadow maps of a few light samples, which all paths of a pass share
    rays, ///< exact rays to light samples of each path's own
};

/// Whether paths of slhb may end in cells of a cache, see gi/methods/slhb/tracer/radiance_cache.h.
enum class RadianceCaching : std::uint8_t {
    automatic, ///< in pictures that time decides, and where who looks at frames asks for it
    on,
    off
};

/// What exact rays do in place of an approximation of slhb, to measure its bias: two renders of one seed that
/// differ in this alone share axes, lamps and random numbers, so that their difference has little noise.
struct ExactParts {
    bool queries = false;    ///< instead of look-ups in hit buffers
    bool shadows = false;    ///< instead of look-ups in shadow maps
    bool directions = false; ///< by the cosine, each path its own, instead of axes; needs `queries`

    bool any() const { return queries || shadows; }
};

/// For the method slhb; 0 or empty = what the scene plan chooses.
struct SlhbSettings {
    Schedule schedule = Schedule::automatic;
    std::string directions;    ///< "icosahedron:320", of the stored schedule
    int resolution = 0;        ///< texels of a hit buffer, about resolution x resolution
    int axes = 0;              ///< of a pass, streamed and temporal
    int fresh_axes = 0;        ///< of these, replaced in a pass, temporal
    int light_samples = 0;             ///< light samples with a shadow map per pass
    int fresh_light_samples = 0;       ///< of these, replaced in a pass
    int shadow_resolution = 0; ///< texels of a shadow map, squared
    int most_layers = 0;       ///< per texel; 0 = all
    int memory_mib = 0;        ///< that hit buffers and shadow maps may take
    bool packed = false;       ///< layers of 32 bits: 12 of depth, 1 of facing, 19 of the triangle
    LookUps look_ups = LookUps::automatic;
    Shadows shadows = Shadows::automatic;
    RadianceCaching cache = RadianceCaching::automatic;
    float roulette = -1; ///< paths go on with a chance of that times their throughput; 0 = all do up to the fourth
                         ///< scattering, then as in the reference; -1 = as the plan says
    float cone = 0;      ///< texels; radius of the disk of columns that a query may ask (Yu 2012, fig. 5.6)
    int interleave = 0;  ///< n: in a pass one pixel of n x n takes indirect light, n^2-fold; 1 = all do
    Space space = Space::host; ///< device: all by CUDA kernels, see gi/methods/slhb/kernels/kernel_render.h
    bool gather = false;       ///< first bounce over all axes in turn instead of at random
    ExactParts exact;          ///< on the host; for bench accuracy
};

/// Points that an imperfect shadow map can have.
inline constexpr int kMostPoints = 1 << 17;

/// For the methods vpl_*, see gi/methods/vpl.
struct VirtualLightSettings {
    int light_paths = 256;    ///< from the lamps in a pass; every surface that one meets becomes a virtual light
    float near_m = 0;         ///< virtual lights are bounded where they are about so near; 0 = 2 % of the scene's
                              ///< radius
    int points = 1024;        ///< drawn into an imperfect shadow map
    int point_map = 64;       ///< texels on a side of one
    float ao_radius_m = 0.5f; ///< farther surfaces occlude nothing, of ambient and directional occlusion
};

struct Accumulator; // gi/render/accumulator.h

/// What one of several processes traces of the paths of one picture. Every path has its own random numbers, so
/// that shares that make up 0 to RenderSettings::paths make up its picture, but for the order in which sums are
/// rounded.
struct PathShare {
    std::uint32_t first = 0, count = ~std::uint32_t(0); ///< of every pixel; no more than RenderSettings::paths
    /// Where it is not empty: called with the sums of this share before the picture is made of them, to add
    /// others.
    std::function<void(Accumulator&)> merge;
};

struct RenderSettings {
    int width = 512, height = 512; ///< pixels, >= 1
    std::uint32_t paths = 64;      ///< per pixel: the most that are traced
    double budget_s = 0;     ///< from the start of building structures; stop when a pass would end later; 0 = none
    double until_relmse = 0; ///< stop when the estimated relMSE of the picture is below; 0 = none
    int bounces = 64;        ///< indirect bounces: 0 = emitted and direct light only
    std::uint64_t seed = 0;
    int threads = 0;                       ///< 0 = all
    PixelFilter filter = PixelFilter::box; ///< by filter importance sampling; tent has a radius of one pixel
    std::filesystem::path checkpoint;      ///< exact state is kept here while unfinished, and where a
                                           ///< render that resumes stops early; empty = never. Whoever saves the
                                           ///< picture deletes it afterwards unless RenderResult::resumable
    SlhbSettings slhb;
    VirtualLightSettings vpl;
    bool resume = false; ///< start from the checkpoint if it is there and fits
    PathShare share;     ///< of one picture; frames that follow each other and checkpoints know all paths only
};

struct RenderStatus {
    double fraction = 0;
    std::uint32_t paths = 0; ///< per pixel so far
    double relmse = 0; ///< estimated from the variance: see Accumulator::relative_mse; 0 = not known yet
};

/// Called between passes.
using RenderProgress = std::function<void(RenderStatus const&)>;

/// Why a render ended.
enum class RenderEnd : std::uint8_t { paths, budget, error_target, interrupted };

/// Layers of `picture`: color, L0 (emitted, seen directly or through delta lobes), L1 (one scattering: direct
/// light), L2 (two or more: indirect), albedo, normal, depth, position, variance (of the mean of color, per
/// channel); alpha, one channel, where the background is transparent.
struct RenderResult {
    Picture picture;
    RenderEnd end = RenderEnd::paths;
    std::uint32_t paths = 0;
    double seconds = 0; ///< for all its paths, those before an interruption too
    double relmse = 0;
    std::string options;    ///< what the method chose for itself, as options of the command line
    bool resumable = false; ///< settings.checkpoint holds what is needed to go on
    double rays = 0;        ///< closest-hit and shadow rays, or look-ups
    /// Of a view with a partner: per pixel the partner's whose light all its paths took, to half a pixel, else
    /// kOwnLight (gi/filter/reused_light.h). Empty without one.
    std::vector<std::uint32_t> light_from;
};

} // namespace gi
