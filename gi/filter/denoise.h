#pragma once
// Filters for noisy pictures of any light-transport method. They average illumination (L1 and L2 divided by the
// albedo) over neighbours on the same surface, so that textures and outlines stay sharp.

#include "gi/core/progress.h"
#include "gi/filter/reused_light.h"

namespace gi {

enum class Denoiser : std::uint8_t {
    none,
    atrous,        ///< edge-avoiding a-trous wavelet with variance (Dammertz et al. 2010, Schied et al. 2017)
    discontinuity, ///< mean over a window of one surface (Keller & Heidrich 2001, Wald et al. 2002)
    oidn           ///< Intel Open Image Denoise, if installed (gi/filter/oidn.h)
};

/// Which network Denoiser::oidn uses.
enum class OidnQuality : std::uint8_t { fast, high };

inline constexpr int kMaxIterations = 5, kMaxWindow = 32, kMaxReach = 32; ///< pixels

struct DenoiseSettings {
    Denoiser denoiser = Denoiser::atrous;
    int iterations = 4; ///< atrous: 1 to 5; the last one reaches 2^iterations pixels to each side
    int window = 4;     ///< discontinuity: width of the window in pixels, 1 to 32
    /// Discontinuity: windows averaged to each side for indirect light; window * reach <= kMaxReach.
    int reach = 0;
    int threads = 0; ///< 0 = all
    OidnQuality oidn_quality = OidnQuality::fast;
    StopRequest const* stop = nullptr; ///< once it is requested, denoise() throws Interrupted
};

/// Pixels left unfiltered for lack of valid data. If the picture takes light from a partner, this counts only
/// pixels with light of their own, and pixels whose reused light is not finite.
struct DenoiseReport {
    std::size_t without_surface = 0; ///< nothing was hit, or the surface is black
    std::size_t not_finite = 0;      ///< NaN, infinite or beyond 1e18 in a required layer
    bool no_variance = false;        ///< a-trous found no variance anywhere and changed almost nothing
};

/// Replaces L1, L2 and color = L0 + L1 + L2. Needs the layers color, L0, L1, L2, albedo, normal and position (not
/// position for oidn); a-trous also needs variance, or the variances measured by temporal reuse. Throws
/// InputError if one is missing. `variance` keeps the variance of the unfiltered picture. The result does not
/// depend on the number of threads. After an exception the picture may be half filtered.
/// @param taken  light of a partner that has been filtered: its light over albedo is taken unchanged, and only
///   the other pixels are filtered. oidn filters the whole picture instead
DenoiseReport denoise(Picture& picture, DenoiseSettings const& settings, ReusedLight const& taken = {});

} // namespace gi
