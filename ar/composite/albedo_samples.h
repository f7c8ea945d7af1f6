#pragma once
// The pixels that say something of an albedo, for fit_albedo and fit_texture.

#include "ar/composite/albedo.h"

namespace ar {

struct AlbedoSample {
    cv::Vec3f ratio; ///< radiance / white
    float weight;    ///< confidence times how well lit: noise of the ratio is the camera's over white
};

/// @throws gi::InputError types or sizes
void check(AlbedoView const& view, int patch_count, bool with_places);

/// Calls back for each pixel that counts: (patch, y, x, sample). Others are counted in `fit`.
void for_samples(AlbedoView const& view, AlbedoSettings const& settings, AlbedoFit& fit,
                 std::function<void(int, int, int, AlbedoSample const&)> const& use);

/// Medians of the channels without specular samples, those taken out and counted. `samples` is reordered.
PatchAlbedo robust_albedo(std::vector<AlbedoSample>& samples, AlbedoSettings const& settings,
                          std::size_t& specular, std::size_t& clamped);

} // namespace ar
