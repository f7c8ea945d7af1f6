#pragma once
// Settings and results common to all light-transport methods.

#include "gi/core/durable_file.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/image_io/picture_rows.h"
#include "gi/kernel/space.h"
#include "gi/render/look_up_bias.h"
#include "gi/render/method_settings.h"

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

struct Accumulator; // gi/render/accumulator.h

/// The part of a picture's paths that one of several processes traces. Every path has its own random numbers, so
/// shares that together cover 0 to RenderSettings::paths give the same picture, up to rounding of the sums.
struct PathShare {
    /// Paths of every pixel; limited to RenderSettings::paths.
    std::uint32_t first = 0, count = ~std::uint32_t(0);
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
    Space space = Space::host; ///< that traces the paths; device: by CUDA kernels, of the methods that have them
    MethodSettings methods{};  ///< what only some methods have
    bool resume = false; ///< continue from the checkpoint if it exists and fits
    PathShare share{};   ///< for single pictures only; frame sequences and checkpoints need all paths

    template <class T>
    T& of()
    {
        return methods.of<T>();
    }
    template <class T>
    T const& of() const
    {
        return methods.of<T>();
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
    std::optional<LookUpBias> look_up_bias; ///< of a method that looks up, if it was measured
    std::string options;    ///< settings chosen by the method, as command-line options
    std::string method, why_method; ///< of a method that chooses another: its name, and why it was chosen
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
