#pragma once
// Albedo of proxies from camera frames (inverse lighting; Yu et al. 1999 for the iteration, diffuse surfaces
// only). Of a diffuse surface,
//   radiance = albedo white,   white = irradiance / pi:
// what the pixel would show if only its surface were white. `white` contains direct light of the known
// lights and environment map, and indirect light from other proxies with the albedos found so far;
// so fitting and rendering alternate.

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace ar {

/// One frame; all pictures have the same size. Empty pictures are ignored.
struct AlbedoView {
    cv::Mat radiance; ///< CV_32FC3, the camera's (radiance_of), without virtual objects
    cv::Mat white;    ///< CV_32FC3, rendered
    cv::Mat surface;  ///< CV_32SC1: patch number from 0; negative: none
    cv::Mat clipped;  ///< CV_8UC1: nonzero pixels are left out (is_clipped)
    cv::Mat weight;   ///< CV_32FC1 >= 0: confidence (of pose, of noise); empty = 1
    cv::Mat place;    ///< CV_32FC2: texture coordinates 0..1, read by fit_texture
};

struct AlbedoSettings {
    float largest = 0.98f;         ///< upper limit of albedos: white proxies would reflect light forever
    float least_white = 0.02f;     ///< relative to the view's median white; darker pixels are left out
    int border_px = 1;             ///< pixels within this distance of another patch are left out
    float specular = 4;            ///< pixels this many robust standard deviations above the median are left out
    int samples_per_patch = 20000; ///< over all frames; larger sets are thinned evenly
};

struct PatchAlbedo {
    cv::Vec3f albedo{0, 0, 0};
    cv::Vec3f spread{0, 0, 0}; ///< robust standard deviation of single pixels (1.4826 MAD)
    std::size_t samples = 0;   ///< number of pixels used; 0 = albedo unknown
};

struct AlbedoFit {
    std::vector<PatchAlbedo> patches;
    std::size_t clipped = 0;    ///< pixels
    std::size_t dark = 0;       ///< pixels with too little light
    std::size_t border = 0;     ///< pixels next to other patches
    std::size_t specular = 0;   ///< samples
    std::size_t not_finite = 0; ///< pixels
    std::size_t clamped = 0;    ///< values clamped to [0, largest]
    std::size_t unseen = 0;     ///< patches without samples
};

/// Weighted median per patch and channel. Patches without samples get `unseen`.
/// @throws gi::InputError wrong types or sizes of pictures, patch numbers not below patch_count
AlbedoFit fit_albedo(std::span<AlbedoView const> views, int patch_count, AlbedoSettings const& settings = {},
                     cv::Vec3f unseen = {0.5f, 0.5f, 0.5f});

struct AlbedoSolution {
    AlbedoFit fit;
    int iterations = 0;
    float last_change = 0; ///< largest change of any channel of any patch
    bool converged = false;
};

/// Alternates rendering and fitting until no albedo changes by more than `tolerance`.
/// @param render  callback that returns the views with `white` rendered for the given albedos, one per patch; the
/// first call gets `start` for all patches
AlbedoSolution solve_albedo(std::function<std::vector<AlbedoView>(std::vector<cv::Vec3f> const&)> const& render,
                            int patch_count, AlbedoSettings const& settings = {},
                            cv::Vec3f start = {0.5f, 0.5f, 0.5f}, float tolerance = 1e-3f,
                            int most_iterations = 20);

struct AlbedoTexture {
    cv::Mat albedo;          ///< CV_32FC3, row 0 at place y = 0
    cv::Mat samples;         ///< CV_32SC1 per texel
    std::size_t filled = 0;  ///< texels without samples, set to the patch's albedo
    std::size_t clamped = 0; ///< values
    std::size_t outside = 0; ///< pixels whose place is not in 0..1
};

/// Texture of one patch: each texel is the weighted median of the pixels whose `place` falls into it.
AlbedoTexture fit_texture(std::span<AlbedoView const> views, int patch, cv::Size texels, PatchAlbedo const& whole,
                          AlbedoSettings const& settings = {});

} // namespace ar
