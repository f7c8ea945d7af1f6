#pragma once
// Selects the pixels that fit_albedo and fit_texture use.

#include "ar/composite/albedo.h"

namespace ar {

struct AlbedoSample {
    cv::Vec3f ratio; ///< radiance / white
    float weight;    ///< confidence times illumination: the noise of the ratio is the camera's over white
};

/// @throws gi::InputError wrong types or sizes
void check(AlbedoView const& view, int patch_count, bool with_places);

/// Calls use(patch, y, x, sample) for each usable pixel; counts the others in `fit`.
void for_samples(AlbedoView const& view, AlbedoSettings const& settings, AlbedoFit& fit,
                 std::function<void(int, int, int, AlbedoSample const&)> const& use);

/// Median per channel without specular samples, which are removed and counted. Reorders `samples`.
PatchAlbedo robust_albedo(std::vector<AlbedoSample>& samples, AlbedoSettings const& settings,
                          std::size_t& specular, std::size_t& clamped);

} // namespace ar
