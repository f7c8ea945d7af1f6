#pragma once
// Filters for noisy pictures of any light-transport method. They average the illumination, that is L1 and L2
// divided by the albedo, over neighbours that lie on the same surface; so textures and outlines stay as sharp as
// they were.

#include "gi/filter/reused_light.h"

namespace gi {

enum class Denoiser : std::uint8_t {
    none,
    atrous,        ///< edge-avoiding a-trous wavelet with variance (Dammertz et al. 2010, Schied et al. 2017)
    discontinuity, ///< mean over a window of one surface (Keller & Heidrich 2001, Wald et al. 2002)
    oidn           ///< Intel Open Image Denoise, where it is installed (gi/filter/oidn.h)
};

/// Of Denoiser::oidn: which of its networks.
enum class OidnQuality : std::uint8_t { fast, high };

inline constexpr int kMaxIterations = 5, kMaxWindow = 32, kMaxReach = 32; ///< pixels

struct DenoiseSettings {
    Denoiser denoiser = Denoiser::atrous;
    int iterations = 4; ///< of a-trous: 1 to 5; the last one reaches 2^iterations pixels to each side
    int window = 4;     ///< of discontinuity: pixels across, 1 to 32
    int reach = 0;      ///< of discontinuity: windows to each side for indirect light; window * reach <= kMaxReach
    int threads = 0;    ///< 0 = all
    OidnQuality oidn_quality = OidnQuality::fast;
};

/// Pixels that keep their values for want of something to go by; of a picture that takes light from a partner,
/// those that it finds for itself, and those that would take what is not finite.
struct DenoiseReport {
    std::size_t without_surface = 0; ///< nothing was hit, or something black
    std::size_t not_finite = 0;      ///< NaN, infinite or beyond 1e18 in a layer that is needed
    bool no_variance = false;        ///< a-trous had nothing to go by anywhere and changed next to nothing
};

/// Replaces L1, L2 and color = L0 + L1 + L2. Needs the layers color, L0, L1, L2, albedo, normal and position, and
/// a-trous variance too, or those that temporal reuse measured (oidn neither position nor variance); throws
/// InputError where one is missing. `variance` stays that of the unfiltered picture. The result does not depend on
/// the number of threads.
/// @param taken  of a partner that has been filtered: its light over its albedo is taken as it is, and only where
///               the picture takes none is filtered. oidn filters all of the picture instead
DenoiseReport denoise(Picture& picture, DenoiseSettings const& settings, ReusedLight const& taken = {});

} // namespace gi
