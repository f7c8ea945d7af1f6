#include "gi/filter/temporal.h"

#include "gi/core/catmull_rom.h"
#include "gi/core/error.h"
#include "gi/filter/filter_input.h"
#include "gi/filter/neighbourhoods.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

// A pixel of the previous frame shows the same surface within these limits: cosine of normals, and relative
// difference of depths beyond what the surface's slope explains.
constexpr float kCosine = 0.9f, kDepth = 0.02f;
// Motion below this, in pixels, counts as static.
constexpr float kStill = 1e-3f;

Layer const& layer_of(Picture const& picture, char const* name)
{
    if (Layer const* const layer = picture.find(name)) return *layer;
    throw InputError(std::string("the picture has no layer '") + name + "'", "temporal reuse needs it",
                     "render frames with a method that provides it");
}

/// True if both albedos are usable, or both too dark, in each channel, so that light over albedo is comparable.
bool same_dark(vec3 a, vec3 b)
{
    return (a.x < kDarkest) == (b.x < kDarkest) && (a.y < kDarkest) == (b.y < kDarkest) &&
           (a.z < kDarkest) == (b.z < kDarkest);
}

bool finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

void TemporalReuse::Means::approach(Means const& other, float share)
{
    direct = glm::mix(direct, other.direct, share);
    indirect = glm::mix(indirect, other.indirect, share);
    normal = glm::mix(normal, other.normal, share);
}

/// Adds this frame's light to earlier means.
void TemporalReuse::Light::add_to(Light const& before, TemporalSettings const& settings)
{
    frames = std::min(before.frames + 1, float(std::max(settings.most_frames, settings.most_unchanged)));
    float const share = 1 / frames;
    Means const now = all;
    vec2 const step{luminance(now.direct - before.all.direct), luminance(now.indirect - before.all.indirect)};
    variance = (1 - share) * (before.variance + share * step * step);
    recent = before.recent;
    recent.approach(now, std::max(share, 1 / float(settings.most_frames)));
    all = before.all;
    all.approach(now, share);
}

void TemporalReuse::Light::take(Light const& there)
{
    all = there.all;
    recent = there.recent;
    frames = there.frames;
    variance = there.variance;
}

void TemporalReuse::renew_changed(int width, int height, TemporalCounts& total)
{
    // Standard errors of the mean difference in a window (a quarter of whose pixels are independent, since means
    // are interpolated), and relative difference: below the first, light is unchanged; from the second on, it is
    // new.
    constexpr int kWindow = 7;
    constexpr float kIndependent = 0.25f;
    constexpr vec2 kErrors{1.5f, 3}, kRelative{0.01f, 0.03f};
    // Channels: differences of direct and indirect light, the means, number of pixels with a surface.
    using Values = cv::Vec<float, 5>;
    cv::Mat values(height, width, CV_32FC(5)), squares(height, width, CV_32FC2);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            Light const& l = lights_[i];
            bool const is_surface = surfaces_[i].depth > 0;
            float const d1 = is_surface ? luminance(l.recent.direct - l.all.direct) : 0,
                        d2 = is_surface ? luminance(l.recent.indirect - l.all.indirect) : 0;
            values.at<Values>(y, x) = {d1, d2, is_surface ? luminance(l.all.direct) : 0,
                                       is_surface ? luminance(l.all.indirect) : 0, float(is_surface)};
            squares.at<cv::Vec2f>(y, x) = {d1 * d1, d2 * d2};
        }
    });
    cv::Size const size(kWindow, kWindow);
    cv::boxFilter(values, values, CV_32F, size, {-1, -1}, false, cv::BORDER_CONSTANT);
    cv::boxFilter(squares, squares, CV_32F, size, {-1, -1}, false, cv::BORDER_CONSTANT);
    tbb::combinable<double> renewed;
    tbb::parallel_for(0, height, [&](int y) {
        double& sum = renewed.local();
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            Light& l = lights_[i];
            if (!(surfaces_[i].depth > 0) || !(l.frames > float(settings_.most_frames))) continue;
            Values const& v = values.at<Values>(y, x);
            float const n = v[4], whole = std::max(v[2] + v[3], 1e-20f);
            float most = 0;
            for (int k = 0; k < 2; ++k) {
                float const mean = v[k] / n,
                            variance = std::max(0.0f, squares.at<cv::Vec2f>(y, x)[k] / n - mean * mean),
                            error = std::sqrt(variance / std::max(1.0f, kIndependent * n));
                most =
                    std::max(most, glm::smoothstep(kErrors.x * error, kErrors.y * error + 1e-20f, std::abs(mean)) *
                                       glm::smoothstep(kRelative.x, kRelative.y, std::abs(v[k]) / whole));
            }
            l.all.approach(l.recent, most);
            l.frames = glm::mix(l.frames, 0.5f * float(settings_.most_frames), most); // the shorter one lags, too
            sum += most;
        }
    });
    total.renewed += renewed.combine(std::plus<>());
}

/// Replaces bilinear means of the last frame's light by Catmull and Rom's cubics over those of 4 x 4 pixels that
/// showed the surface: bilinear means would blur it in every frame.
/// @param place  in the last frame, from the middle of its first pixel   @param shows  of a Surface
template <class Shows>
void TemporalReuse::sharpen(vec2 place, int width, int height, Shows const& shows, Light& light) const
{
    constexpr float kMostly = 0.8f; // least sum of the weights of such pixels
    vec2 const first = glm::floor(place) - 1.0f;
    if (first.x < 0 || first.y < 0 || first.x + 4 > float(width) || first.y + 4 > float(height)) return;
    std::array<float, 4> const across = catmull_rom(place.x - first.x - 1),
                               down = catmull_rom(place.y - first.y - 1);
    Means all{}, recent{};
    float weights = 0;
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) {
            std::size_t const t = (std::size_t(first.y) + j) * std::size_t(width) + std::size_t(first.x) + k;
            if (!shows(last_surfaces_[t])) continue;
            float const w = across[k] * down[j];
            all.add(w, last_lights_[t].all);
            recent.add(w, last_lights_[t].recent);
            weights += w;
        }
    if (weights < kMostly) return;
    for (Means* const m : {&all, &recent}) {
        m->scale(1 / weights);
        m->direct = glm::max(m->direct, vec3{0});
        m->indirect = glm::max(m->indirect, vec3{0});
    }
    light.all = all;
    light.recent = recent;
}

/// Averages the light of this frame with the surface's earlier light.
void TemporalReuse::follow(Picture const& frame, TemporalReuse const* partner, std::span<std::uint32_t const> from,
                           TemporalCounts& total)
{
    Layer const &l0 = layer_of(frame, "L0"), &l1 = layer_of(frame, "L1"), &l2 = layer_of(frame, "L2"),
                &albedo = layer_of(frame, "albedo"), &normal = layer_of(frame, "normal"),
                &depth = layer_of(frame, "depth"), &motion = layer_of(frame, "motion");
    int const width = frame.width, height = frame.height;
    std::size_t const pixels = frame.pixels();
    std::swap(surfaces_, last_surfaces_);
    std::swap(lights_, last_lights_);
    surfaces_.resize(pixels);
    lights_.resize(pixels);
    std::vector<std::uint8_t> takes(partner ? pixels : 0);
    tbb::parallel_for(std::size_t(0), std::size_t(height), [&](std::size_t y) {
        for (std::size_t i = y * std::size_t(width); i < (y + 1) * std::size_t(width); ++i) {
            vec3 const a = rgb(albedo, i);
            surfaces_[i] = {rgb(normal, i), depth.data[i]};
            Light& light = lights_[i];
            if (partner && from[i] != kOwnLight) takes[i] = same_dark(a, partner->lights_[from[i]].albedo);
            if (partner && takes[i]) {
                light.take(partner->lights_[from[i]]);
            } else {
                light.all = {light_over(rgb(l1, i), a), light_over(rgb(l2, i), a), surfaces_[i].normal};
                light.recent = light.all;
                light.frames = 1;
                light.variance = vec2{0};
            }
            light.l0 = rgb(l0, i);
            light.albedo = a;
            light.still_frames = 1;
            light.still = false;
        }
    });
    if (frames_ == 0) {
        for (std::size_t i = 0; i < known_.size() && i < pixels; ++i)
            if (KnownLight const& k = known_[i]; k.frames > 0) {
                Light before{};
                before.all = before.recent = {k.direct, k.indirect, surfaces_[i].normal};
                before.frames = k.frames;
                lights_[i].add_to(before, settings_);
            }
        known_.clear();
        total.surfaces = total.started =
            std::size_t(std::ranges::count_if(surfaces_, [](Surface const& s) { return s.depth > 0; }));
        return;
    }
    bool const few = std::size_t(std::ranges::count(takes, 1)) > 3 * pixels / 4;
    Neighbourhoods const neighbourhoods(l1, albedo, width, height, few, settings_);
    // True if a surface still shows now, in a pixel next to this one.
    auto const is_beside = [&](Surface const& s, int x, int y) {
        for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j)
            for (int k = std::max(0, x - 1); k <= std::min(width - 1, x + 1); ++k) {
                Surface const& n = surfaces_[std::size_t(j) * std::size_t(width) + std::size_t(k)];
                if (std::abs(n.depth - s.depth) <= kDepth * s.depth && glm::dot(n.normal, s.normal) >= kCosine)
                    return true;
            }
        return false;
    };
    tbb::combinable<TemporalCounts> counts;
    tbb::parallel_for(0, height, [&](int y) {
        TemporalCounts& local = counts.local();
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            Surface const& here = surfaces_[i];
            if (!(here.depth > 0)) continue;
            ++local.surfaces;
            vec3 const was = rgb(motion, i);
            // Neither the surface seen now nor the one seen before moves: probably an edge, seen through another
            // subpixel position.
            bool const still = glm::length(vec2(was)) < kStill, taken = partner && takes[i];
            lights_[i].still = still;
            if (taken && !still) continue;
            bool const resting = still && last_lights_[i].still;
            // Change of depth across a pixel, as frames sample different subpixel positions.
            auto const change = [&](bool there, std::ptrdiff_t step) {
                return there ? std::abs(surfaces_[std::size_t(std::ptrdiff_t(i) + step)].depth - here.depth)
                             : kInf;
            };
            float const slope = std::min(change(x > 0, -1), change(x + 1 < width, 1)) +
                                std::min(change(y > 0, -width), change(y + 1 < height, width));
            auto const shows = [&](Surface const& there, float tolerance) {
                return std::abs(there.depth - was.z) < kDepth * was.z + tolerance &&
                       glm::dot(there.normal, here.normal) >= kCosine;
            };
            Light before{};
            float weight = 0;
            if (finite(was) && std::abs(was.x) < 1e6f && std::abs(was.y) < 1e6f) {
                float const u = float(x) + was.x, v = float(y) + was.y, left = std::floor(u), top = std::floor(v);
                for (int k = 0; k < 4; ++k) {
                    int const tx = int(left) + (k & 1), ty = int(top) + (k >> 1);
                    float const w = (1 - std::abs(u - float(tx))) * (1 - std::abs(v - float(ty)));
                    if (tx < 0 || ty < 0 || tx >= width || ty >= height || !(w > 0)) continue;
                    std::size_t const t = std::size_t(ty) * std::size_t(width) + std::size_t(tx);
                    Surface const& there = last_surfaces_[t];
                    if (!shows(there, slope) && !(resting && is_beside(there, x, y))) continue;
                    Light const& l = last_lights_[t];
                    before.all.add(w, l.all);
                    before.recent.add(w, l.recent);
                    before.frames += w * l.frames;
                    before.variance += w * l.variance;
                    weight += w;
                }
            }
            // A smaller sum of weights is negligible and only adds noise.
            constexpr float kLeast = 0.05f;
            if (!(weight > kLeast)) {
                local.started += !taken;
                continue;
            }
            before.all.scale(1 / weight);
            before.recent.scale(1 / weight);
            before.frames /= weight;
            before.variance /= weight;
            if (!still)
                sharpen(
                    vec2{float(x), float(y)} + vec2(was), width, height,
                    [&](Surface const& there) { return shows(there, 2 * slope); }, before);
            Light& now = lights_[i];
            if (Light const& last = last_lights_[i]; still && weight > 1 - kStill) {
                now.still_frames = std::min(last.still_frames + 1, float(settings_.most_frames));
                now.l0 = glm::mix(last.l0, now.l0, 1 / now.still_frames);
                now.albedo = glm::mix(last.albedo, now.albedo, 1 / now.still_frames);
            }
            if (taken) continue;
            auto const [low, high] = neighbourhoods.around(x, y);
            vec3 const held = glm::clamp(before.all.direct, low, high);
            local.held += held != before.all.direct;
            before.all.direct = held;
            before.recent.direct = glm::clamp(before.recent.direct, low, high);
            now.add_to(before, settings_);
        }
    });
    counts.combine_each([&](TemporalCounts const& c) {
        total.surfaces += c.surfaces;
        total.started += c.started;
        total.held += c.held;
    });
    if (settings_.most_unchanged > settings_.most_frames) renew_changed(width, height, total);
}

/// Adds one more picture of a static scene, and replaces it by a combination of both means.
void TemporalReuse::rest(Picture& frame, TemporalCounts& counts)
{
    for (char const* const name : {"variance_direct", "variance_indirect"})
        if (frame.find(name) == nullptr) frame.add(name, 1);
    if (settings_.keep_normals && frame.find("light_normal") == nullptr) frame.add("light_normal", 3);
    Layer* const normals = settings_.keep_normals ? frame.find("light_normal") : nullptr;
    Layer &albedo = *frame.find("albedo"), &l0 = *frame.find("L0"), &l1 = *frame.find("L1"),
          &l2 = *frame.find("L2"), &color = *frame.find("color"),
          &direct_variance = *frame.find("variance_direct"), &indirect_variance = *frame.find("variance_indirect");
    bool const first = still_++ == 0;
    float const n = float(still_);
    mean_.resize(frame.pixels());
    tbb::combinable<double> frames;
    tbb::parallel_for(std::size_t(0), std::size_t(frame.height), [&](std::size_t y) {
        double& sum = frames.local();
        for (std::size_t i = y * std::size_t(frame.width); i < (y + 1) * std::size_t(frame.width); ++i) {
            std::array<vec3, 4> const now{rgb(l0, i), rgb(l1, i), rgb(l2, i), surfaces_[i].normal};
            std::array<vec3, 4>& mean = mean_[i];
            for (std::size_t k = 0; k < 4; ++k) mean[k] = first ? now[k] : glm::mix(mean[k], now[k], 1 / n);
            Light const& light = lights_[i];
            // Frames since the last motion are in both means; earlier ones count while they are many in
            // comparison, those of long means for as many frames as those of others.
            float const most = float(settings_.most_frames), surplus = std::max(0.0f, light.frames - most),
                        earlier = std::max(0.0f, std::min(light.frames, most) - n) +
                                  surplus * std::max(0.0f, 1 - n / most),
                        share = first ? 1 : earlier / (earlier + n);
            vec3 const e0 = glm::mix(mean[0], light.l0, share),
                       e1 = glm::mix(mean[1], light_times(light.all.direct, light.albedo), share),
                       e2 = glm::mix(mean[2], light_times(light.all.indirect, light.albedo), share);
            for (int c = 0; c < 3; ++c) {
                std::size_t const k = 3 * i + std::size_t(c);
                l0.data[k] = e0[c];
                albedo.data[k] = light.albedo[c];
                l1.data[k] = e1[c];
                l2.data[k] = e2[c];
                color.data[k] = e0[c] + e1[c] + e2[c];
                if (normals) normals->data[k] = glm::mix(mean[3][c], light.all.normal[c], share);
            }
            // Variance of one frame, corrected for the bias of a mean that contains the frame; then variance of
            // the mean of all frames.
            float const of_mean = light.frames > 1 ? light.frames / ((light.frames - 1) * (earlier + n)) : -1;
            direct_variance.data[i] = of_mean > 0 ? of_mean * light.variance.x : -1;
            indirect_variance.data[i] = of_mean > 0 ? of_mean * light.variance.y : -1;
            sum += double(earlier + n);
        }
    });
    counts.frames = frames.combine(std::plus<>()) / double(frame.pixels());
}

TemporalCounts TemporalReuse::add(Picture& frame, SceneChange change, TemporalReuse const* partner,
                                  std::span<std::uint32_t const> from)
{
    if (frames_ > 0 && surfaces_.size() != frame.pixels())
        throw InputError("frames of different sizes", "temporal reuse works pixel by pixel", "start afresh");
    layer_of(frame, "color");
    if (change == SceneChange::light) {
        frames_ = 0;
        known_.clear();
    }
    if (change != SceneChange::nothing || frames_ == 0) still_ = 0;
    TemporalCounts counts;
    follow(frame, partner, from, counts);
    rest(frame, counts);
    ++frames_;
    counts.still_frames = still_;
    return counts;
}

} // namespace gi
