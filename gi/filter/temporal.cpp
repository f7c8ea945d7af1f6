#include "gi/filter/temporal.h"

#include "gi/core/catmull_rom.h"
#include "gi/core/error.h"
#include "gi/filter/filter_input.h"
#include "gi/filter/neighbourhoods.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
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
    place = (1 - share) * before.place;
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

/// How much light has changed: from 0, if the mean difference in a window is within its errors or small beside the
/// light, to 1.
struct LightChanged {
    int window;    ///< px
    vec2 errors;   ///< standard errors of the mean difference, from 0 to 1
    vec2 relative; ///< mean difference over the mean light, from 0 to 1

    /// @param difference  of direct and indirect light of a pixel, and their means; none where there is no surface
    /// @param changed  is given each pixel with a surface and how much its light has changed
    template <class Difference, class Changed>
    void find(int width, int height, Difference const& difference, Changed const& changed) const
    {
        // A quarter of a window's pixels are independent, since means are interpolated.
        constexpr float kIndependent = 0.25f;
        // Channels: differences of direct and indirect light, the means, number of pixels with a surface.
        using Values = cv::Vec<float, 5>;
        cv::Mat values(height, width, CV_32FC(5)), squares(height, width, CV_32FC2);
        tbb::parallel_for(0, height, [&](int y) {
            for (int x = 0; x < width; ++x) {
                std::optional<vec4> const d = difference(std::size_t(y) * std::size_t(width) + std::size_t(x));
                vec4 const v = d.value_or(vec4{0});
                values.at<Values>(y, x) = {v.x, v.y, v.z, v.w, float(d.has_value())};
                squares.at<cv::Vec2f>(y, x) = {v.x * v.x, v.y * v.y};
            }
        });
        cv::Size const size(window, window);
        cv::boxFilter(values, values, CV_32F, size, {-1, -1}, false, cv::BORDER_CONSTANT);
        cv::boxFilter(squares, squares, CV_32F, size, {-1, -1}, false, cv::BORDER_CONSTANT);
        tbb::parallel_for(0, height, [&](int y) {
            for (int x = 0; x < width; ++x) {
                Values const& v = values.at<Values>(y, x);
                float const n = v[4], whole = std::max(v[2] + v[3], 1e-20f);
                if (!(n > 0)) continue;
                float most = 0;
                for (int k = 0; k < 2; ++k) {
                    float const mean = v[k] / n,
                                variance = std::max(0.0f, squares.at<cv::Vec2f>(y, x)[k] / n - mean * mean),
                                error = std::sqrt(variance / std::max(1.0f, kIndependent * n));
                    most = std::max(most,
                                    glm::smoothstep(errors.x * error, errors.y * error + 1e-20f, std::abs(mean)) *
                                        glm::smoothstep(relative.x, relative.y, std::abs(v[k]) / whole));
                }
                changed(std::size_t(y) * std::size_t(width) + std::size_t(x), most);
            }
        });
    }
};

void TemporalReuse::renew_changed(int width, int height, TemporalCounts& total)
{
    constexpr LightChanged kChanged{7, {1.5f, 3}, {0.01f, 0.03f}};
    tbb::combinable<double> renewed;
    kChanged.find(
        width, height,
        [&](std::size_t i) -> std::optional<vec4> {
            if (!(surfaces_[i].depth > 0)) return {};
            Light const& l = lights_[i];
            return vec4{luminance(l.recent.direct - l.all.direct), luminance(l.recent.indirect - l.all.indirect),
                        luminance(l.all.direct), luminance(l.all.indirect)};
        },
        [&](std::size_t i, float changed) {
            Light& l = lights_[i];
            if (!(surfaces_[i].depth > 0) || !(l.frames > float(settings_.most_frames))) return;
            l.all.approach(l.recent, changed);
            l.frames =
                glm::mix(l.frames, 0.5f * float(settings_.most_frames), changed); // the shorter one lags, too
            renewed.local() += changed;
        });
    total.renewed += renewed.combine(std::plus<>());
}

void TemporalReuse::follow_sudden(int width, int height, TemporalCounts& total)
{
    constexpr LightChanged kSudden{15, {2, 4}, {0.2f, 0.5f}};
    tbb::combinable<double> sudden;
    kSudden.find(
        width, height,
        [&](std::size_t i) -> std::optional<vec4> {
            Light const& l = lights_[i];
            if (!(surfaces_[i].depth > 0) || !(l.frames > 1)) return {};
            float const of_earlier = l.frames / (l.frames - 1); // this frame is part of the mean
            return vec4{of_earlier * luminance(now_[i].direct - l.all.direct),
                        of_earlier * luminance(now_[i].indirect - l.all.indirect), luminance(l.all.direct),
                        luminance(l.all.indirect)};
        },
        [&](std::size_t i, float changed) {
            Light& l = lights_[i];
            if (!(surfaces_[i].depth > 0) || !(l.frames > 1)) return;
            l.all.approach(now_[i], changed);
            l.recent.approach(now_[i], changed);
            l.frames = glm::mix(l.frames, 1.0f, changed);
            l.variance *= 1 - changed; // divided by frames - 1 later
            sudden.local() += changed;
        });
    total.sudden += sudden.combine(std::plus<>());
}

/// Interpolates the last frame's light by Catmull and Rom's cubics if all of 4 x 4 pixels showed the surface:
/// bilinear means would blur it in every frame. Returns false if not.
/// @param at  in the last frame, from the middle of its first pixel
/// @param shows  whether a Surface of the last frame is the one looked for
template <class Shows>
bool TemporalReuse::interpolate(vec2 at, int width, int height, Shows const& shows, Light& light) const
{
    vec2 const first = glm::floor(at) - 1.0f, t = at - first - 1.0f;
    if (first.x < 0 || first.y < 0 || first.x + 4 > float(width) || first.y + 4 > float(height)) return false;
    std::size_t const begin = std::size_t(first.y) * std::size_t(width) + std::size_t(first.x);
    auto const pixel = [&](std::size_t j, std::size_t k) { return begin + j * std::size_t(width) + k; };
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k)
            if (!shows(last_surfaces_[pixel(j, k)])) return false;
    std::array<float, 4> const across = catmull_rom(t.x), down = catmull_rom(t.y);
    light = {};
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) {
            Light const& l = last_lights_[pixel(j, k)];
            light.all.add(across[k] * down[j], l.all);
            light.recent.add(across[k] * down[j], l.recent);
        }
    for (std::size_t k = 0; k < 4; ++k) {
        Light const& l = last_lights_[pixel(1 + k / 2, 1 + k % 2)];
        float const w = (k % 2 ? t.x : 1 - t.x) * (k / 2 ? t.y : 1 - t.y);
        light.frames += w * l.frames;
        light.variance += w * l.variance;
    }
    for (Means* const m : {&light.all, &light.recent}) {
        m->direct = glm::max(m->direct, vec3{0});
        m->indirect = glm::max(m->indirect, vec3{0});
    }
    return true;
}

/// Takes the light that came from nearest to a place, of the last frame's 3 x 3 pixels there that showed the
/// surface. Returns false if none did.
template <class Shows>
bool TemporalReuse::take_nearest(vec2 at, int width, int height, Shows const& shows, Light& light) const
{
    int const x = int(std::floor(at.x + 0.5f)), y = int(std::floor(at.y + 0.5f));
    constexpr float kNear2 = 1; // squared distance, px, from which on it would be light of elsewhere
    float least = kNear2;
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
            std::size_t const k = std::size_t(v) * std::size_t(width) + std::size_t(u);
            vec2 const away = vec2{float(u), float(v)} + last_lights_[k].place - at;
            float const distance2 = glm::dot(away, away);
            if (!(distance2 < least) || !shows(last_surfaces_[k])) continue;
            least = distance2;
            light = last_lights_[k];
            light.place = away;
        }
    return least < kNear2;
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
            light.place = vec2{0};
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
    if (settings_.follow_sudden) {
        now_.resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) now_[i] = lights_[i].all;
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
            // Neither the surface seen now nor the one seen before moves: probably an edge,
            // seen through another subpixel position.
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
            bool known = false;
            if (still) {
                before = last_lights_[i];
                known = shows(last_surfaces_[i], slope) || (resting && is_beside(last_surfaces_[i], x, y));
            } else if (finite(was) && std::abs(was.x) < 1e6f && std::abs(was.y) < 1e6f) {
                vec2 const at = vec2{float(x), float(y)} + vec2(was);
                known = interpolate(
                            at, width, height, [&](Surface const& there) { return shows(there, 2 * slope); },
                            before) ||
                        take_nearest(
                            at, width, height, [&](Surface const& there) { return shows(there, slope); }, before);
            }
            if (!known) {
                local.started += !taken;
                continue;
            }
            Light& now = lights_[i];
            if (Light const& last = last_lights_[i]; still) {
                now.still_frames =
                    std::min(last.still_frames + 1, float(std::max(settings_.most_frames, still_ + 1)));
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
    if (settings_.follow_sudden) follow_sudden(width, height, total);
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
    if (settings_.can_undo) std::swap(mean_, last_mean_);
    mean_.resize(frame.pixels());
    std::vector<std::array<vec3, 4>> const& before = settings_.can_undo ? last_mean_ : mean_;
    tbb::combinable<double> frames;
    tbb::parallel_for(std::size_t(0), std::size_t(frame.height), [&](std::size_t y) {
        double& sum = frames.local();
        for (std::size_t i = y * std::size_t(frame.width); i < (y + 1) * std::size_t(frame.width); ++i) {
            std::array<vec3, 4> const now{rgb(l0, i), rgb(l1, i), rgb(l2, i), surfaces_[i].normal};
            std::array<vec3, 4>& mean = mean_[i];
            for (std::size_t k = 0; k < 4; ++k) mean[k] = first ? now[k] : glm::mix(before[i][k], now[k], 1 / n);
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
    last_still_ = still_;
    if (change != SceneChange::nothing || frames_ == 0) still_ = 0;
    TemporalCounts counts;
    follow(frame, partner, from, counts);
    rest(frame, counts);
    ++frames_;
    counts.still_frames = still_;
    return counts;
}

void TemporalReuse::undo()
{
    std::swap(surfaces_, last_surfaces_);
    std::swap(lights_, last_lights_);
    std::swap(mean_, last_mean_);
    still_ = last_still_;
    --frames_;
}

} // namespace gi
