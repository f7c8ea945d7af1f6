#include "ar/pipeline/pair_finish.h"

#include "ar/composite/blur.h"
#include "ar/pipeline/bridge.h"

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

/// The pinhole at the frame's size, with exactly the view of the rendered one.
CameraModel full_pinhole(CameraModel const& rendered, Session const& s)
{
    if (!s.finish.upsample || *s.render.resolution >= 1) return rendered;
    return scaled(rendered, glm::ivec2(glm::round(glm::dvec2(rendered.size_px) / *s.render.resolution)));
}

/// Blur of a rendered pixel's mean and of the bilinear lookup through the lens:
/// 1/12 and on average 1/6 square pixels.
constexpr double kRenderedSigma_px = 0.5;

} // namespace

PairFinish::PairFinish(Session const& session, CameraModel const& camera, MarkerMap const& markers,
                       PixelPoints points)
    : session_(session),
      camera_(camera),
      pinhole_(covering_pinhole(camera, session.render.resolution.value())),
      warp_(camera, full_pinhole(pinhole_, session))
{
    if (*session.render.resolution >= 1 && points == PixelPoints::many) session_.finish.upsample = false;
    if (session.smoothing < 1) {
        TemporalSettings smooth;
        smooth.weight = float(session.smoothing);
        filter_.emplace(pinhole_, smooth);
    }
    if (session.finish.match_blur) blur_.emplace(markers, camera);
}

void PairFinish::forget()
{
    if (filter_) filter_->forget();
    if (blur_) blur_->forget();
}

RenderedPair PairFinish::smoothed(PairPictures const& p, gi::RigidPose const& world_from_camera)
{
    RenderedPair pair{p.with, p.without, p.coverage, p.direct};
    if (!filter_) return pair;
    pair = (*filter_)(pair, p.depth_m, world_from_camera, p.change);
    pair.direct = p.direct.clone();
    pair.direct.forEach<cv::Vec3f>([&](cv::Vec3f& direct, int const* at) {
        float const a = p.coverage.at<float>(at[0], at[1]);
        if (!(a > 0)) return;
        // The same share of the smooth picture as of the noisy one; of black, by area.
        cv::Vec3f const smooth = pair.with.at<cv::Vec3f>(at[0], at[1]), noisy = p.with.at<cv::Vec3f>(at[0], at[1]);
        for (int c = 0; c < 3; ++c)
            if (smooth[c] != noisy[c])
                direct[c] = std::max(smooth[c], 0.0f) * (noisy[c] > 0 ? direct[c] / noisy[c] : std::min(a, 1.0f));
    });
    return pair;
}

RenderedPair PairFinish::upsampled(RenderedPair const& low, SharpSurfaces const& sharp, gi::Camera const& camera)
{
    // Guides are needed near changed pixels and near visible virtual objects.
    cv::Size const low_size = low.with.size();
    cv::resize(sharp.seen.coverage, wanted_coverage_, low_size, 0, 0, cv::INTER_AREA);
    wanted_.create(low_size, CV_8UC1);
    tbb::parallel_for(0, low_size.height, [&](int y) {
        for (int x = 0; x < low_size.width; ++x)
            wanted_.at<uchar>(y, x) = wanted_coverage_.at<float>(y, x) > 0 || low.coverage.at<float>(y, x) > 0 ||
                                              low.with.at<cv::Vec3f>(y, x) != low.without.at<cv::Vec3f>(y, x)
                                          ? 255
                                          : 0;
    });
    cv::dilate(wanted_, wanted_, cv::getStructuringElement(cv::MORPH_RECT, {9, 9}));
    real_->look(camera, sharp.seen.coverage.size(), wanted_);
    UpsampleCounts counts;
    RenderedPair pair = ar::upsampled(low, real_->low_guides(), sharp.seen, real_->guides(), {}, {}, &counts);
    counts_.upsample.without_guide += counts.without_guide;
    counts_.upsample.no_sample += counts.no_sample;
    return pair;
}

RenderedPair PairFinish::blurred(RenderedPair pair, FinishFrame const& frame, cv::Mat const& depth_m)
{
    blur_->follow(frame.radiance, frame.world_from_camera, frame.time_s, frame.exposure_s);
    counts_.blur = blur_->counts();
    counts_.added_sigma_px = 0;
    CameraModel const& pinhole = warp_.from();
    double const pixels = pinhole.fx / camera_.fx; // of the pair per pixel of the camera
    if (auto const sigma_px = blur_->sigma_px()) {
        counts_.camera_sigma_px = *sigma_px;
        double const missing_px = missing_blur_px(*sigma_px, kRenderedSigma_px / pixels);
        if (missing_px > 0.05) {
            counts_.added_sigma_px = missing_px;
            pair = defocused(pair, std::min(missing_px * pixels, 20.0));
        }
    }
    if (auto const opened = blur_->shutter_opened()) {
        cv::Mat depth = depth_m;
        if (depth.size() != pair.with.size())
            cv::resize(depth_m, depth, pair.with.size(), 0, 0, cv::INTER_NEAREST);
        pair = motion_blurred(pair, image_velocity(pinhole, depth, *opened, frame.world_from_camera));
    }
    return pair;
}

SeenDepth PairFinish::depth_of(PairPictures const& rendered) const
{
    cv::Size const size(warp_.from().size_px.x, warp_.from().size_px.y);
    auto const in_lens = [&](cv::Mat depth_m) {
        if (depth_m.size() != size) cv::resize(depth_m, depth_m, size, 0, 0, cv::INTER_NEAREST);
        return warp_.nearest(depth_m);
    };
    return {in_lens(rendered.depth_m), in_lens(rendered.real_depth_m)};
}

RenderedPair PairFinish::operator()(PairPictures const& rendered, FinishFrame const& frame, gi::World const& world)
{
    RenderedPair pair = smoothed(rendered, frame.world_from_camera);
    SharpSurfaces sharp;
    gi::Camera const camera = gi_camera(pinhole_, frame.world_from_camera);
    glm::ivec2 const size = warp_.from().size_px;
    if (needs_world()) {
        if (!virtual_) {
            virtual_.emplace(world);
            real_.emplace(world);
        } else
            virtual_->moved();
        PairPictures low = rendered;
        low.direct = pair.direct;
        sharp = virtual_->at_size(low, camera, {size.x, size.y}, session_.finish.mattes);
        counts_.unlit += sharp.unlit;
    }
    if (session_.finish.upsample) pair = upsampled(pair, sharp, camera);
    if (blur_) pair = blurred(std::move(pair), frame, rendered.depth_m);
    pair = warp_(pair);
    if (!session_.finish.mattes) return pair;
    DirectlySeen const unoccluded{warp_.smooth(sharp.unoccluded.radiance),
                                  warp_.smooth(sharp.unoccluded.coverage)};
    MatteCounts counts;
    cv::Mat const coverage = refined_coverage(pair.coverage, unoccluded.coverage, frame.radiance, {}, &counts);
    counts_.matte.band += counts.band;
    counts_.matte.refined += counts.refined;
    return with_coverage(pair, coverage, {pair.direct, pair.coverage}, unoccluded);
}

} // namespace ar
