#pragma once
// Settings and results common to all light-transport methods.

#include "gi/core/durable_file.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/image_io/picture_rows.h"
#include "gi/kernel/space.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace gi {

enum class PixelFilter : std::uint8_t {
    box,
    tent,  ///< a radius of one pixel
    centre ///< none: all paths pass the middle of their pixel
};

/// Where the axes of a pass come from.
enum class Schedule : std::uint8_t {
    automatic,
    stored,   ///< one set for all passes, built once
    streamed, ///< new axes for every pass
    temporal, ///< a set in which some axes are replaced in every pass
};

/// How paths of slhb that leave by a broad lobe find the next surface.
enum class LookUps : std::uint8_t {
    automatic,
    all, ///< by look-ups in hit buffers
    none ///< by exact rays, each path in its own direction; no hit buffers are built
};

/// How slhb tests the visibility of light samples.
enum class Shadows : std::uint8_t {
    automatic,
    maps, ///< with shadow maps of a few light samples shared by all paths of a pass
    rays, ///< with exact rays, each path to its own light samples
};

/// Whether paths of slhb may end in cells of a cache, see gi/methods/slhb/tracer/radiance_cache.h.
enum class RadianceCaching : std::uint8_t {
    automatic, ///< on for pictures with a budget, and for frames whose caller requests it
    on,
    off
};

/// Approximations of slhb that are replaced by exact rays, to measure their bias: two renders with one seed that
/// differ only in this setting share axes, light samples and random numbers, so that their difference has little
/// noise.
struct ExactParts {
    bool queries = false;    ///< instead of look-ups in hit buffers
    bool shadows = false;    ///< instead of look-ups in shadow maps
    bool directions = false; ///< cosine-distributed directions, one per path, instead of axes; needs `queries`

    bool any() const { return queries || shadows; }
};

/// Settings of the method slhb; 0 or empty = chosen by the scene plan.
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
    int memory_mib = 0;          ///< memory limit of hit buffers and shadow maps
    bool packed = false;         ///< layers of 32 bits: 12 of depth, 1 of facing, 19 of the triangle
    LookUps look_ups = LookUps::automatic;
    Shadows shadows = Shadows::automatic;
    RadianceCaching cache = RadianceCaching::automatic;
    float roulette = -1; ///< paths continue with a probability of this times their throughput; 0 = always up to
                         ///< the fourth scattering, then as in the reference; -1 = chosen by the plan
    float cone = 0;      ///< texels; radius of the disk of columns that a look-up may use (Yu 2012, fig. 5.6)
    int interleave = 0;  ///< n: compute indirect light for one pixel in each n x n block per pass, weighted by
                         ///< n^2; 1 = for all
    bool gather = false; ///< first bounce over all axes in turn instead of at random
    ExactParts exact;    ///< on the host; for bench accuracy
};

/// Maximum number of points in an imperfect shadow map.
inline constexpr int kMostPoints = 1 << 17;

/// Settings of the methods vpl_*, see gi/methods/vpl.
struct VirtualLightSettings {
    int light_paths = 256;     ///< light paths per pass; each surface point that one hits becomes a virtual light
    float near_m = 0;          ///< virtual lights nearer than about this are bounded, and camera paths add the
                               ///< rest; 0 = 2 % of the scene's radius
    int points = 1024;         ///< drawn into each imperfect shadow map
    double points_percent = 0; ///< if > 0: the points, as a share of the map's texels, %
    int point_map = 64;        ///< texels per side of an imperfect shadow map
    float ao_radius_m = 0.5f;  ///< ambient and directional occlusion ignore surfaces farther away

    int points_per_map() const
    {
        double const share = std::round(points_percent / 100 * point_map * point_map);
        return points_percent > 0 ? int(std::clamp(share, 0.0, 1e9)) : points;
    }
};

/// Settings of ray trees: the method whitted and those that add indirect light to it, see gi/methods/whitted.
struct WhittedSettings {
    int recursion = 8;         ///< mirrors and glass along a ray tree; rays beyond are cut and counted
    float cutoff = 1.0f / 256; ///< rays that would contribute less than this share are cut and counted
    int light_samples = 4;     ///< shadow rays at a surface seen directly; in mirrors and glass one
};

enum class Switch : std::uint8_t { on, off };
/// What the rays of the field go through.
enum class FieldRays : std::uint8_t { exact, voxels };

/// How sh_grid divides the light of a cell's surfaces.
enum class RadianceBy : std::uint8_t {
    normal,   ///< by the normals of the surfaces, which keeps apart what faces away from each other
    direction ///< by the directions of photons, as the paper does
};

/// What finds the surfaces that photons meet.
enum class PhotonRays : std::uint8_t { exact, look_ups, impostors };
/// How the light of lamps finds its first surfaces.
enum class FirstBounce : std::uint8_t { rays, map };
/// What the size of photons' kernels follows.
enum class KernelBy : std::uint8_t { density, footprint };
/// How flux through a face of a cell becomes light of the cell behind it, see propagation_kernels.h.
enum class Reprojection : std::uint8_t { beams, cosine_lobes };
/// What shows caustics at surfaces: a fine lattice, or kernels of photons.
enum class CausticsBy : std::uint8_t { lattice, kernels };
/// How irradiance follows from photons in a cell, see photon_lattice.h.
enum class IrradianceBy : std::uint8_t { normals, directions };
/// How rays are followed through distance impostors, see gi/light_paths/impostor_search.h.
enum class ImpostorSearch : std::uint8_t {
    first_guess, ///< iteration in the nearest impostor
    all,         ///< iteration in every impostor; the one of least energy counts
    cascaded,    ///< guess by the fan of the nearest impostor, then iteration in that nearest to the guess
    walk ///< along the ray through the texels of an impostor, and of others where the ray is hidden from it
};

/// Settings of light paths and photons: sh_grid and the methods of gi/methods/photons.
struct PhotonSettings {
    static constexpr int kMostPaths = 1 << 24;
    int paths = 262144;         ///< light paths per set of photons
    int caustic_paths = 65536;  ///< light paths per pass that begin on mirrors and glass; 0 = no caustics
    float caustic_radius_m = 0; ///< of the first kernels of caustics; 0 = by their density
    int reflections = 64;       ///< of a photon, at most
    PhotonRays rays = PhotonRays::exact;
    FirstBounce first_bounce = FirstBounce::rays;
    Switch frozen = Switch::off; ///< light is computed once and kept, whatever changes
    KernelBy kernel_by = KernelBy::density;
    float kernel_size = 1;        ///< factor of kernels' radii
    int propagation_cells = 16;   ///< of each lattice of lpv, along the scene's longest side
    int propagation_cascades = 0; ///< nested lattices of lpv; 0 = by what is shown
    int propagation_steps = 0;    ///< from cell to cell; 0 = twice the cells
    Reprojection reprojection = Reprojection::beams;
    int low_cells = 64, middle_cells = 128, high_cells = 128; ///< of the lattices of isllpm
    int lattice_cascades = 0; ///< nested ones of each of them, and of multi_image; 0 = by what is shown
    Switch lattice_smoothing = Switch::on; ///< of the low and the middle one
    IrradianceBy irradiance_by = IrradianceBy::normals;
    CausticsBy caustics_by = CausticsBy::lattice; ///< of isllpm
    int impostors = 32;                           ///< distance impostors, at most
    std::string impostor_places; ///< "x,y,z;x,y,z", m in the scene's coordinates; empty = automatic
    int impostor_texels = 128;   ///< along an edge of a face, rounded up to a multiple of 8
    ImpostorSearch impostor_search = ImpostorSearch::walk;
    int volume_cells = 64;  ///< of the light gathering volume of multi_image, along the scene's longest side
    int volume_gathers = 2; ///< steps that spread light over neighbouring cells of that volume
    int screen_gathers = 8; ///< steps that spread caustics over the pixels of multi_image
};

/// Settings of the method sh_grid, see gi/methods/sh_grid.
struct ShGridSettings {
    static constexpr int kMostVoxels = 1024;
    int voxels = 128;          ///< along the longest side; the field has a quarter of them
    int degree = 2;            ///< of the spherical harmonics
    int directions = 400;      ///< per cell of the field
    int gather_directions = 0; ///< samples of the diffuse lobe; 0 = convolution in closed form
    int glossy_directions = 8; ///< samples of glossy lobes
    float obscurance_m = 0;    ///< surfaces nearer than this darken diffuse light; 0 = off
    int field_shadow_rays = 4; ///< from a surface to cells of the field; 0 = none, weights alone
    int field_passes = 3;      ///< passes over which the field follows a change of the scene
    FieldRays field_rays = FieldRays::exact;
    RadianceBy radiance_by = RadianceBy::normal;
    Switch multilevel = Switch::off;   ///< read coarser grids of radiance where directions are sparse
    Switch leak_weights = Switch::on;  ///< weigh cells by what may lie between them and the surface
    Switch field_glyphs = Switch::off; ///< draw the field's cells
};

struct Accumulator; // gi/render/accumulator.h

/// The part of a picture's paths that one of several processes traces. Every path has its own random numbers, so
/// shares that together cover 0 to RenderSettings::paths give the same picture, up to rounding of the sums.
struct PathShare {
    std::uint32_t first = 0, count = ~std::uint32_t(0); ///< paths of every pixel; limited to
                                                        ///< RenderSettings::paths
    /// If set, called with the sums of this share before the picture is made, to add the sums of other shares.
    std::function<void(Accumulator&)> merge;
};

struct RenderSettings {
    int width = 512, height = 512; ///< pixels, >= 1
    std::uint32_t paths = 64;      ///< per pixel: upper limit
    double budget_s = 0;     ///< from the start of building structures; stop when a pass would end later; 0 = none
    double until_relmse = 0; ///< stop when the estimated relMSE of the picture is below; 0 = none
    int bounces = 64;        ///< indirect bounces: 0 = emitted and direct light only
    std::uint64_t seed = 0;
    int threads = 0;                       ///< 0 = all
    PixelFilter filter = PixelFilter::box; ///< sampled by filter importance sampling
    std::filesystem::path checkpoint{};    ///< file for the exact state of an unfinished render, or of a resuming
                                           ///< one that stops early; empty = none. The caller deletes it after
                                           ///< saving the picture unless RenderResult::resumable
    double checkpoint_s = 30; ///< time between checkpoints; longer where writing them would take more than 2 % of
                              ///< the time. 0 = only when a render is interrupted
    std::function<void(std::uint64_t bytes)> before_checkpoint{}; ///< called once, before the first is written
    bool by_rows = false;      ///< give a single picture by RenderResult::rows, which needs half of its memory
    Space space = Space::host; ///< that traces the paths; device: slhb and reference, by CUDA kernels
    SlhbSettings slhb{};
    VirtualLightSettings vpl{};
    WhittedSettings whitted{};
    PhotonSettings photons{};
    ShGridSettings sh_grid{};
    bool resume = false; ///< continue from the checkpoint if it exists and fits
    PathShare share{};   ///< for single pictures only; frame sequences and checkpoints need all paths

    /// True if options are set that only look-ups in hit buffers have: slhb then takes them.
    bool has_look_up_options() const
    {
        return slhb.schedule != Schedule::automatic || !slhb.directions.empty() || slhb.resolution > 0 ||
               slhb.axes > 0 || slhb.fresh_axes > 0 || slhb.most_layers > 0 || slhb.packed || slhb.cone > 0 ||
               slhb.gather || slhb.exact.any() || space == Space::device;
    }
};

struct RenderStatus {
    double fraction = 0;
    std::uint32_t paths = 0; ///< per pixel so far
    double relmse = 0;       ///< estimated from the variance, see Accumulator::relative_mse; 0 = not known yet
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
    PictureRows rows;       ///< instead of `picture`, with RenderSettings::by_rows
    PictureRows color_rows; ///< only color, alpha and depth of it, in less time
    RenderEnd end = RenderEnd::paths;
    std::uint32_t paths = 0;
    double seconds = 0; ///< for all paths, including those before an interruption
    double relmse = 0;
    std::string options;    ///< settings chosen by the method, as command-line options
    bool resumable = false; ///< settings.checkpoint holds the state needed to continue
    /// With RenderSettings::by_rows and a checkpoint: saves the state, on any thread, also while `rows` are read.
    /// It is for the caller to do so where the render is unfinished. Throws InputError. By then the memory of the method is free, and the picture need not wait for it. The state is of
    /// the sums after PathShare::merge: of all shares, so that no single one could go on from it. The command line
    /// has no checkpoint where several processes share a picture.
    std::function<void(DiskWait)> save_state;
    double rays = 0; ///< closest-hit and shadow rays, or look-ups
    /// For a view with a partner: per pixel, the partner's pixel (to half a pixel) if all its paths took its
    /// light from there, else kOwnLight (gi/filter/reused_light.h). Empty without a partner.
    std::vector<std::uint32_t> light_from;
};

} // namespace gi
