#include "ar/composite/albedo.h"

#include "ar/composite/albedo_samples.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ar {

AlbedoFit fit_albedo(std::span<AlbedoView const> views, int patch_count, AlbedoSettings const& settings,
                     cv::Vec3f unseen)
{
    AlbedoFit fit;
    std::vector<std::vector<AlbedoSample>> samples(std::size_t(std::max(patch_count, 0)));
    for (AlbedoView const& view : views) {
        check(view, patch_count, false);
        for_samples(view, settings, fit,
                    [&](int patch, int, int, AlbedoSample const& s) { samples[std::size_t(patch)].push_back(s); });
    }
    auto const most = std::size_t(std::max(settings.samples_per_patch, 1));
    for (std::vector<AlbedoSample>& of_patch : samples) {
        if (of_patch.size() > most) {
            for (std::size_t i = 0; i < most; ++i) of_patch[i] = of_patch[i * of_patch.size() / most];
            of_patch.resize(most);
        }
        PatchAlbedo patch = robust_albedo(of_patch, settings, fit.specular, fit.clamped);
        if (patch.samples == 0) {
            patch.albedo = unseen;
            ++fit.unseen;
        }
        fit.patches.push_back(patch);
    }
    return fit;
}

AlbedoSolution solve_albedo(std::function<std::vector<AlbedoView>(std::vector<cv::Vec3f> const&)> const& render,
                            int patch_count, AlbedoSettings const& settings, cv::Vec3f start, float tolerance,
                            int most_iterations)
{
    AlbedoSolution solution;
    std::vector<cv::Vec3f> albedos(std::size_t(std::max(patch_count, 0)), start);
    while (solution.iterations < most_iterations && !solution.converged) {
        std::vector<AlbedoView> const views = render(albedos);
        solution.fit = fit_albedo(views, patch_count, settings, start);
        ++solution.iterations;
        solution.last_change = 0;
        for (std::size_t i = 0; i < albedos.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                float const now = solution.fit.patches[i].albedo[c];
                solution.last_change = std::max(solution.last_change, std::abs(now - albedos[i][c]));
                albedos[i][c] = now;
            }
        solution.converged = solution.last_change <= tolerance;
    }
    return solution;
}

AlbedoTexture fit_texture(std::span<AlbedoView const> views, int patch, cv::Size texels, PatchAlbedo const& whole,
                          AlbedoSettings const& settings)
{
    if (texels.width < 1 || texels.height < 1 || texels.width > 16384 || texels.height > 16384)
        throw gi::InputError("an albedo texture without texels, or with more than 16384 each way",
                             "there is nothing to fit", "choose its size by how many pixels show the patch");
    AlbedoTexture texture{cv::Mat(texels, CV_32FC3), cv::Mat::zeros(texels, CV_32SC1)};
    AlbedoFit fit;
    std::vector<std::vector<AlbedoSample>> samples(std::size_t(texels.area()));
    for (AlbedoView const& view : views) {
        check(view, std::numeric_limits<int>::max(), true);
        for_samples(view, settings, fit, [&](int of, int y, int x, AlbedoSample const& s) {
            if (of != patch) return;
            cv::Vec2f const at = view.place.at<cv::Vec2f>(y, x);
            if (!(at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1)) {
                ++texture.outside;
                return;
            }
            int const i = std::min(int(at[0] * float(texels.width)), texels.width - 1);
            int const j = std::min(int(at[1] * float(texels.height)), texels.height - 1);
            samples[std::size_t(j * texels.width + i)].push_back(s);
        });
    }
    for (int j = 0; j < texels.height; ++j)
        for (int i = 0; i < texels.width; ++i) {
            PatchAlbedo const texel =
                robust_albedo(samples[std::size_t(j * texels.width + i)], settings, fit.specular, texture.clamped);
            texture.samples.at<int>(j, i) = int(texel.samples);
            texture.albedo.at<cv::Vec3f>(j, i) = texel.samples > 0 ? texel.albedo : whole.albedo;
            texture.filled += texel.samples == 0;
        }
    return texture;
}

} // namespace ar
