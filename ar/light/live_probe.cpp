#include "ar/light/live_probe.h"

#include "ar/light/lamps.h"
#include "gi/core/error.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace ar {
namespace {

constexpr float kPiF = std::numbers::pi_v<float>;
constexpr float kWellSeen = 0.5f; ///< share of a texel from which ratios and changes are read
constexpr double kLeastRatio = 1e-3, kMostRatio = 1e3;

/// Weighted median of ratios, clamped to a plausible range; 1 without any.
double middle_ratio(std::vector<std::pair<double, double>> ratios)
{
    double const middle = gi::weighted_median(std::move(ratios));
    return std::isnan(middle) ? 1 : std::clamp(middle, kLeastRatio, kMostRatio);
}

double light(cv::Vec3f const& v) { return luminance(cv::Vec3d(v)); }

} // namespace

LiveProbe::LiveProbe(cv::Mat const& prior, LiveProbeSettings const& settings)
    : settings_(settings), has_prior_(!prior.empty())
{
    auto const need = [](char const* name, double v) {
        if (!(v > 0 && std::isfinite(v)))
            throw gi::InputError(fmt::format("live probe: {} is {}", name, v), "it must be finite and more than 0",
                                 "leave it out for the default");
    };
    need("width", settings.size.width);
    need("height", settings.size.height);
    need("step_px", settings.step_px);
    need("memory_s", settings.memory_s);
    need("forget_s", settings.forget_s);
    need("changed", settings.changed);
    need("lamp_share", settings.lamp_share);
    if (has_prior_) check_map(prior, "prior of the live probe");
    prior_ = has_prior_ ? resampled(prior, settings.size) : cv::Mat(settings.size, CV_32FC3, cv::Scalar(1, 1, 1));
    for (int j = 0; j < settings.size.height; ++j) texel_sr_.push_back(float(texel_sr(settings.size, j)));
    texels_.resize(std::size_t(settings.size.area()));
    sums_.resize(texels_.size());
}

void LiveProbe::set_camera(CameraModel const& camera)
{
    if (camera_ == camera) return;
    camera_ = camera;
    samples_.clear();
    int const n = settings_.step_px;
    double const half = 0.5 * n;
    for (int y = n / 2; y < camera.size_px.y; y += n)
        for (int x = n / 2; x < camera.size_px.x; x += n) {
            auto const d = direction_of(camera, {x, y});
            auto const l = direction_of(camera, {x - half, y}), r = direction_of(camera, {x + half, y});
            auto const u = direction_of(camera, {x, y - half}), b = direction_of(camera, {x, y + half});
            if (!d || !l || !r || !u || !b) continue;
            double const sr = glm::length(glm::cross(*r - *l, *b - *u));
            samples_.push_back({y * camera.size_px.x + x, {float(d->x), float(d->y), float(d->z)}, float(sr)});
        }
}

void LiveProbe::gather(cv::Mat const& radiance, cv::Mat const& clipped, glm::dquat const& world_from_camera,
                       ProbeUpdate& update)
{
    std::fill(sums_.begin(), sums_.end(), Sum{});
    glm::mat3 const m(glm::mat3_cast(world_from_camera));
    int const w = settings_.size.width, h = settings_.size.height, width = radiance.cols;
    float const across = float(w) / (2 * kPiF), down = float(h) / kPiF;
    for (Sample const& s : samples_) {
        int const y = s.index / width, x = s.index - y * width;
        cv::Vec3f const& v = radiance.ptr<cv::Vec3f>(y)[x];
        float const sum = v[0] + v[1] + v[2];
        if (!(v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && sum < 1e30f)) {
            ++update.refused;
            continue;
        }
        glm::vec3 const d = m * glm::vec3(s.direction[0], s.direction[1], s.direction[2]);
        int const i = int((kPiF + std::atan2(d.x, -d.z)) * across);
        int const j = int(std::acos(std::clamp(d.y, -1.0f, 1.0f)) * down);
        Sum& to = sums_[std::size_t(std::min(j, h - 1) * w + std::clamp(i, 0, w - 1))];
        to.light += s.sr * v;
        to.sr += s.sr;
        if (!clipped.empty() && clipped.ptr<std::uint8_t>(y)[x]) {
            to.clipped_sr += s.sr;
            ++update.clipped;
        }
    }
    update.samples = samples_.size() - update.refused;
}

double LiveProbe::confidence_of(Texel const& t) const
{
    return t.confidence > 0 ? t.confidence * std::exp(-(now_s_ - t.seen_s) / settings_.forget_s) : 0;
}

/// Scale for this frame: matches known light of the same directions, else the scaled prior,
/// else the previous frame's scale.
double LiveProbe::frame_gain() const
{
    std::vector<std::pair<double, double>> known, prior;
    for (std::size_t k = 0; k < texels_.size(); ++k) {
        Sum const& s = sums_[k];
        float const sr = texel_sr_[k / std::size_t(settings_.size.width)];
        double const now = s.sr > 0 ? light(s.light / s.sr) : 0;
        if (s.sr < kWellSeen * sr || s.clipped_sr > 0 || !(now > 0)) continue;
        Texel const& t = texels_[k];
        cv::Vec3d const before = prior_.at<cv::Vec3f>(int(k) / prior_.cols, int(k) % prior_.cols);
        if (t.confidence > 0.3f) known.emplace_back(light(t.value) / now, sr);
        if (has_prior_) prior.emplace_back(luminance(before.mul(scale_)) / now, sr);
    }
    return known.size() >= 8 ? middle_ratio(known) : prior.size() >= 8 ? middle_ratio(prior) : gain_;
}

void LiveProbe::follow(ProbeUpdate& update, double time_s)
{
    double const dt = begun_ ? std::max(0.0, time_s - now_s_) : 0;
    now_s_ = begun_ ? std::max(now_s_, time_s) : time_s;
    double all = 0, differ = 0, known = 0, changed_light = 0, solid = 0;
    for (std::size_t k = 0; k < texels_.size(); ++k) {
        float const sr = texel_sr_[k / std::size_t(settings_.size.width)];
        cv::Vec3f const& prior = prior_.at<cv::Vec3f>(int(k) / prior_.cols, int(k) % prior_.cols);
        all +=
            sr * (texels_[k].confidence > 0 ? light(texels_[k].value) : luminance(cv::Vec3d(prior).mul(scale_)));
        solid += sr;
    }
    double const noticeable = 0.05 * all / solid;
    for (std::size_t k = 0; k < texels_.size(); ++k) {
        Sum const& s = sums_[k];
        if (!(s.sr > 0)) continue;
        float const sr = texel_sr_[k / std::size_t(settings_.size.width)];
        float const share = std::min(1.0f, s.sr / sr);
        update.seen_share += double(share) * sr / (4 * std::numbers::pi);
        cv::Vec3f const mean = (1 / s.sr) * s.light;
        Texel& t = texels_[k];
        double const now = light(mean), then = light(t.value);
        bool const both = t.confidence >= kWellSeen && share >= kWellSeen;
        bool anew = false;
        if (both) {
            differ += sr * std::abs(now - then);
            known += sr * then;
            anew = std::abs(now - then) > settings_.changed * std::max(now, then) &&
                   std::abs(now - then) > noticeable;
        }
        if (anew) {
            ++update.changed_texels;
            changed_light += sr * std::abs(now - then);
            t.confidence = 0;
        }
        auto const old = float(t.confidence * std::exp(-dt / settings_.memory_s));
        t.value = (old * t.value + share * mean) / (old + share);
        t.confidence = std::min(1.0f, std::max(t.confidence, old + share));
        t.clipped = s.clipped_sr > 0.02f * s.sr;
        t.seen_s = now_s_;
    }
    update.change = known > 0 ? differ / known : 0;
    update.lamp_changed = changed_light > settings_.lamp_share * all;
    begun_ = true;
}

void LiveProbe::scale_prior()
{
    for (int c = 0; c < 3; ++c) {
        std::vector<std::pair<double, double>> ratios;
        double sum = 0, weights = 0;
        for (std::size_t k = 0; k < texels_.size(); ++k) {
            Texel const& t = texels_[k];
            double const w = texel_sr_[k / std::size_t(settings_.size.width)] * confidence_of(t);
            double const prior = prior_.at<cv::Vec3f>(int(k) / prior_.cols, int(k) % prior_.cols)[c];
            if (!(w > 0) || t.clipped) continue;
            sum += w * t.value[c];
            weights += w;
            if (prior > 0) ratios.emplace_back(t.value[c] / prior, w * prior);
        }
        if (has_prior_)
            scale_[c] = middle_ratio(std::move(ratios));
        else if (weights > 0)
            scale_[c] = sum / weights;
    }
}

ProbeUpdate LiveProbe::update(cv::Mat const& radiance, cv::Mat const& clipped, CameraModel const& camera,
                              glm::dquat const& world_from_camera, double time_s)
{
    bool const fits = radiance.type() == CV_32FC3 && radiance.cols == camera.size_px.x &&
                      radiance.rows == camera.size_px.y &&
                      (clipped.empty() || (clipped.type() == CV_8UC1 && clipped.size() == radiance.size()));
    if (!fits || !std::isfinite(time_s))
        throw gi::InputError(
            "live probe: picture, clipped pixels and camera are not of one size, or the time is not finite",
            "pixels would have the wrong rays", "give the radiance of the camera's whole picture");
    set_camera(camera);
    ProbeUpdate update;
    gather(radiance, clipped, world_from_camera, update);
    if (settings_.exposure == ExposureKnowledge::unknown) {
        update.gain = gain_ = frame_gain();
        for (Sum& s : sums_) s.light *= float(gain_);
    }
    follow(update, time_s);
    scale_prior();
    for (std::size_t k = 0; k < texels_.size(); ++k)
        update.known_share +=
            texel_sr_[k / std::size_t(settings_.size.width)] * confidence_of(texels_[k]) / (4 * std::numbers::pi);
    return update;
}

cv::Mat LiveProbe::map() const
{
    cv::Mat out(settings_.size, CV_32FC3);
    for (std::size_t k = 0; k < texels_.size(); ++k) {
        cv::Point const at(int(k) % out.cols, int(k) / out.cols);
        cv::Vec3d const stand_in = cv::Vec3d(prior_.at<cv::Vec3f>(at)).mul(scale_);
        Texel const& t = texels_[k];
        double const c = confidence_of(t);
        cv::Vec3d seen(t.value);
        for (int i = 0; t.clipped && i < 3; ++i) seen[i] = std::max(seen[i], stand_in[i]);
        out.at<cv::Vec3f>(at) = cv::Vec3f(c * seen + (1 - c) * stand_in);
    }
    return out;
}

cv::Mat LiveProbe::confidence() const
{
    cv::Mat out(settings_.size, CV_32FC1);
    for (std::size_t k = 0; k < texels_.size(); ++k) out.ptr<float>()[k] = float(confidence_of(texels_[k]));
    return out;
}

cv::Mat LiveProbe::age_s() const
{
    cv::Mat out(settings_.size, CV_32FC1);
    for (std::size_t k = 0; k < texels_.size(); ++k)
        out.ptr<float>()[k] =
            texels_[k].confidence > 0 ? float(now_s_ - texels_[k].seen_s) : std::numeric_limits<float>::infinity();
    return out;
}

} // namespace ar
