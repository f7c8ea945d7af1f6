#pragma once
// Albedo of proxies from camera frames (inverse lighting; Yu et al. 1999 for the iteration, diffuse surfaces
// only). Of a diffuse surface,
//   radiance = albedo white,   white = irradiance / pi:
// what the pixel would show if its surface alone were white. white has direct light of the known lamps and
// environment and the light that other proxies, with the albedos found so far, send there; so fitting and
// rendering take turns.

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace ar {

/// One frame, all pictures of one size. Empty pictures are not used.
struct AlbedoView {
    cv::Mat radiance; ///< CV_32FC3, the camera's (radiance_of), without virtual objects
    cv::Mat white;    ///< CV_32FC3, rendered
    cv::Mat surface;  ///< CV_32SC1: number of the patch from 0; below 0: none
    cv::Mat clipped;  ///< CV_8UC1: not 0 = left out (is_clipped)
    cv::Mat weight;   ///< CV_32FC1 >= 0: confidence (of pose, of noise); empty = 1
    cv::Mat place;    ///< CV_32FC2: texture coordinates 0..1, read by fit_texture
};

struct AlbedoSettings {
    float largest = 0.98f;         ///< clamped there: white proxies never stop sending light about
    float least_white = 0.02f;     ///< of the view's median white: darker pixels say little
    int border_px = 1;             ///< pixels this near another patch are left out
    float specular = 4;            ///< brighter than the median by so many robust standard deviations: left out
    int samples_per_patch = 20000; ///< of all frames together; more are thinned evenly
};

struct PatchAlbedo {
    cv::Vec3f albedo{0, 0, 0};
    cv::Vec3f spread{0, 0, 0}; ///< robust standard deviation of single pixels (1.4826 MAD)
    std::size_t samples = 0;   ///< pixels that count; 0 = nothing is known
};

struct AlbedoFit {
    std::vector<PatchAlbedo> patches;
    std::size_t clipped = 0;    ///< pixels
    std::size_t dark = 0;       ///< pixels with next to no light
    std::size_t border = 0;     ///< pixels beside other patches
    std::size_t specular = 0;   ///< samples
    std::size_t not_finite = 0; ///< pixels
    std::size_t clamped = 0;    ///< values outside of [0, largest], made so
    std::size_t unseen = 0;     ///< patches without samples
};

/// Weighted medians, patch by patch and channel by channel. Patches without samples keep `unseen`.
/// @throws gi::InputError pictures of other types or sizes, numbers of surfaces beyond patch_count
AlbedoFit fit_albedo(std::span<AlbedoView const> views, int patch_count, AlbedoSettings const& settings = {},
                     cv::Vec3f unseen = {0.5f, 0.5f, 0.5f});

struct AlbedoSolution {
    AlbedoFit fit;
    int iterations = 0;
    float last_change = 0; ///< of any channel of any patch
    bool converged = false;
};

/// Turns of rendering and fitting until no albedo changes by more than `tolerance`.
/// @param render  views with `white` for albedos, one per patch; the first call has `start` everywhere
AlbedoSolution solve_albedo(std::function<std::vector<AlbedoView>(std::vector<cv::Vec3f> const&)> const& render,
                            int patch_count, AlbedoSettings const& settings = {},
                            cv::Vec3f start = {0.5f, 0.5f, 0.5f}, float tolerance = 1e-3f,
                            int most_iterations = 20);

struct AlbedoTexture {
    cv::Mat albedo;          ///< CV_32FC3, row 0 at place y = 0
    cv::Mat samples;         ///< CV_32SC1 per texel
    std::size_t filled = 0;  ///< texels without samples: the patch's albedo
    std::size_t clamped = 0; ///< values
    std::size_t outside = 0; ///< pixels whose place is not in 0..1
};

/// One patch, texel by texel: weighted medians of the pixels whose place falls into it.
AlbedoTexture fit_texture(std::span<AlbedoView const> views, int patch, cv::Size texels, PatchAlbedo const& whole,
                          AlbedoSettings const& settings = {});

} // namespace ar
