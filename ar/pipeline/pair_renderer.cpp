#include "ar/pipeline/pair_renderer.h"

#include "ar/pipeline/bridge.h"
#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/methods/registry.h"

namespace ar {

PairRenderer::PairRenderer(LocalScene local, gi::RenderSettings const& settings, gi::Report& report,
                           std::string method)
    : local_(std::move(local)),
      method_(std::move(method)),
      settings_(settings),
      report_(report),
      world_(local_.scene, 0, report)
{
    auto const& lights = world_.world().lights;
    virtual_lights_.assign(lights.begin() + std::ptrdiff_t(std::min(local_.first_virtual_light, lights.size())),
                           lights.end());
}

void PairRenderer::set_environment(std::shared_ptr<gi::EnvironmentMap const> map)
{
    light_changed_ = true;
    pending_.add(world_.set_environment(std::move(map)));
}

gi::Changes PairRenderer::turn(gi::PairSide side, gi::SceneTime time_s)
{
    gi::Changes changes = std::exchange(pending_, {});
    changes.add(world_.advance(local_pose(local_, time_s, side)));
    for (std::size_t k = 0; k < virtual_lights_.size(); ++k) {
        std::size_t const at = local_.first_virtual_light + k;
        gi::Light light = world_.world().lights[at];
        light.intensity = side == gi::PairSide::with ? virtual_lights_[k].intensity : gi::vec3{0};
        changes.add(world_.set_light(at, light));
    }
    return changes;
}

SceneChange PairRenderer::change_since_last(gi::SceneTime time_s)
{
    gi::Pose const pose = local_pose(local_, time_s, gi::PairSide::with);
    bool const same = !std::exchange(light_changed_, false) && last_pose_ &&
                      pose.world_from_node == last_pose_->world_from_node &&
                      pose.morph_weights == last_pose_->morph_weights;
    last_pose_ = pose;
    return same ? SceneChange::none : SceneChange::unknown;
}

std::vector<glm::dvec3> PairRenderer::virtual_corners(gi::SceneTime time_s) const
{
    gi::Scene const& scene = *local_.scene;
    gi::Pose const pose = local_pose(local_, time_s, gi::PairSide::with);
    std::vector<glm::dvec3> corners;
    for (std::size_t n = local_.first_virtual_node; n < scene.nodes.size(); ++n)
        for (std::int32_t const m : scene.nodes[n].meshes) {
            auto const& positions = scene.meshes[std::size_t(m)].positions;
            if (positions.empty()) continue;
            gi::vec3 low = positions.front(), high = low;
            for (gi::vec3 const& p : positions) {
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            for (int k = 0; k < 8; ++k)
                corners.emplace_back(pose.world_from_node[n] * glm::dvec4((k & 1) != 0 ? high.x : low.x,
                                                                          (k & 2) != 0 ? high.y : low.y,
                                                                          (k & 4) != 0 ? high.z : low.z, 1));
        }
    return corners;
}

gi::World const& PairRenderer::world_with(gi::SceneTime time_s)
{
    gi::Changes const changes = turn(gi::PairSide::with, time_s); // including pending ones
    pending_.add(changes);
    return world_.world();
}

std::string PairRenderer::choose(PairLight light)
{
    std::string const why = light == PairLight::paths ? "the session asks for them" : needs_paths(world_.world());
    if (light == PairLight::prefiltered && !why.empty())
        throw gi::InputError("prefiltered light cannot light these scenes", why,
                             "set light: auto or light: paths");
    prefiltered_ = why.empty();
    return why;
}

PairPictures PairRenderer::prefiltered(gi::Camera const& camera, int width, int height, gi::SceneTime time_s,
                                       gi::StopRequest const& stop)
{
    gi::Changes const changes = turn(gi::PairSide::with, time_s);
    if (!pairs_)
        pairs_ = std::make_unique<PrefilteredPairs>(world_.world(), report_, stop);
    else
        pairs_->update(changes, stop);
    PairPictures p = pairs_->render(camera, width, height, stop);
    p.change = change_since_last(time_s);
    return p;
}

PairPictures PairRenderer::render(gi::Camera const& camera, int width, int height, std::uint32_t paths,
                                  gi::SceneTime time_s, gi::DenoiseSettings filter, gi::StopRequest const& stop)
{
    if (prefiltered_) return prefiltered(camera, width, height, time_s, stop);
    if (!frames_) {
        // Start with all virtual objects in place, so that the bounds of the hit buffers include them.
        turn(gi::PairSide::with, time_s);
        settings_.width = width;
        settings_.height = height;
        frames_ = gi::find_method(method_).frames(world_, camera, settings_, report_);
    }
    filter.threads = settings_.threads;
    bool denoise = gi::can_filter(filter, paths);
    gi::PairSettings const pair{
        paths, virtual_lights_.empty() ? gi::PairDifference::vanishing : gi::PairDifference::anything,
        denoise ? gi::PictureLayers::all : gi::PictureLayers::color_and_depth};
    gi::PairResult both = gi::ask<gi::PairFrames>(*frames_)->pair(
        {camera, width, height}, pair, [&](gi::PairSide side) { return turn(side, time_s); }, stop);
    denoise = denoise && gi::can_filter(filter, both.with.paths);
    cv::Mat const raw = denoise ? matrix_of(both.with.picture, "color") : cv::Mat();
    if (denoise)
        for (gi::RenderResult* const r : {&both.with, &both.without})
            report_.lose("pixels that the filter could not use", gi::denoise(r->picture, filter).not_finite);
    PairPictures p;
    p.with = matrix_of(both.with.picture, "color");
    p.without = matrix_of(both.without.picture, "color");
    p.coverage = cv::Mat(height, width, CV_32FC1);
    std::copy(both.coverage.begin(), both.coverage.end(), p.coverage.begin<float>());
    p.direct = cv::Mat(height, width, CV_32FC3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            gi::vec3 const covered = both.covered[std::size_t(y) * std::size_t(width) + std::size_t(x)];
            cv::Vec3f direct(covered.x, covered.y, covered.z);
            if (denoise) // the same share of the smooth picture as of the noisy one
                for (int c = 0; c < 3; ++c)
                    if (float const all = raw.at<cv::Vec3f>(y, x)[c]; all > 0)
                        direct[c] *= p.with.at<cv::Vec3f>(y, x)[c] / all;
            p.direct.at<cv::Vec3f>(y, x) = direct;
        }
    p.real_depth_m = matrix_of(both.without.picture, "depth");
    p.depth_m = matrix_of(both.with.picture, "depth");
    p.paths = both.with.paths;
    p.change = change_since_last(time_s);
    return p;
}

} // namespace ar
