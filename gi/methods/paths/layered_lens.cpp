#include "gi/methods/paths/layered_lens.h"

#include "gi/methods/paths/primary_map.h"
#include "gi/render/pass_samples.h"
#include "gi/render/path_random.h"
#include "gi/render/ray_path.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr std::size_t kPixelsOfTask = 2048;
constexpr int kMostRays = 8, kMargin = 64;   // margin: pixels around the picture that have layers
constexpr std::size_t kMostStarts = 1 << 24; ///< of about 130 bytes with their paths

constexpr std::uint32_t kAlone = 0xa10eu; ///< tells streams of random numbers from those of pixels

/// Radius of the circle of confusion of what is at this distance along the view, pixels.
float confusion_px(CameraRays const& eye, float depth_m)
{
    if (!eye.has_lens()) return 0;
    float const lens = std::max(glm::length(eye.lens_x), glm::length(eye.lens_y)),
                step = std::min(glm::length(eye.step_x), glm::length(eye.step_y));
    return lens * std::abs(1 / depth_m - 1 / eye.focus) / step;
}

/// A lens ray whose layer the lens' centre does not see.
struct Sight {
    std::size_t ray;
    std::uint32_t layer;
};

/// Whether a point is seen from where a lens ray starts. What is not, such as a floor within a column that stands on it,
/// has another light than what the ray met beside it.
RayQuery towards(vec3 point, RayQuery const& lens_ray)
{
    constexpr float kBefore = 1 - 1e-4f; // the surface itself is not in the way
    vec3 const way = point - lens_ray.ray.origin;
    float const length = glm::length(way);
    RayQuery query = lens_ray;
    query.ray.direction = way * (1 / length);
    query.reach = kBefore * length;
    return query;
}

/// Of the middle of the lens.
CameraRays pinhole(CameraRays const& eye) { return eye.has_lens() ? eye.at_lens(vec2{0}) : eye; }

} // namespace

std::vector<Camera> cameras_during(std::function<Camera(double)> const& camera_at, std::uint64_t seed,
                                   std::uint32_t pass)
{
    constexpr std::uint32_t kMoments = 32;
    std::vector<Camera> cameras;
    for (std::uint32_t k = 0; k < kMoments; ++k)
        cameras.push_back(camera_at(moment_in_part(seed, pass, k, kMoments)));
    return cameras;
}

int LayeredLens::rays_of(View const& view, std::size_t pixel) const
{
    std::size_t const x = pixel % std::size_t(view.width) + std::size_t(kMargin),
                      y = pixel / std::size_t(view.width) + std::size_t(kMargin);
    return rays_of_[y / ScreenLayers::kTile * layers_.tiles_across() + x / ScreenLayers::kTile];
}

/// The rays of a pixel are a rank-1 lattice over the lens, and spread over the moments by a third step, all shifted at
/// random in every pass.
Ray LayeredLens::lens_ray(View const& view, std::size_t pixel, int k, int rays) const
{
    constexpr std::uint32_t kLens = 0x1e450000, kMoment = kLens + 2; // dimensions beyond those of vertices
    RqmcStream const stream =
        pixel_stream(random_key(view.seed), std::uint32_t(pixel), std::uint32_t(view.width), view.pass);
    vec2 const shift = stream.sample2(kLens);
    vec2 const u{std::fmod(float(k) / float(rays) + shift.x, 1.0f),
                 std::fmod(float(k) * 0.618034f + shift.y, 1.0f)};
    vec2 const at = vec2{float(pixel % std::size_t(view.width)), float(pixel / std::size_t(view.width))} + at_;
    CameraRays const* eye = &view.rays;
    if (std::size_t const n = view.during.size(); n > 0) {
        float const moment = std::fmod(float(k) * 0.56984f + stream.sample(kMoment), 1.0f);
        eye = &view.during[std::min(n - 1, std::size_t(moment * float(n)))];
    }
    return eye->has_lens() ? eye->at_lens(square_to_disk(u)).through(at) : eye->through(at);
}

/// The layers are those of the lens' centre.
void LayeredLens::draw(View const& view, Place const& place, float near_m)
{
    during_.clear();
    for (CameraRays const& eye : view.during) during_.emplace_back(pinhole(eye));
    eye_ = pinhole(view.rays);
    eye_.corner -= float(kMargin) * (eye_.step_x + eye_.step_y);
    int const width = view.width + 2 * kMargin, height = view.height + 2 * kMargin;
    layers_.draw(place.soup, place.soup.count, place.cut_outs, eye_, width, height,
                 std::uint32_t(std::max(width, height)), at_, near_m,
                 std::uint32_t(mix_bits(view.seed) + view.pass), ScreenLayers::Tiles::with_depths);
}

/// Of a point in the middle of a tile, at a distance along the view.
LayeredLens::Blur LayeredLens::blur(View const& view, std::size_t tile, float depth_m) const
{
    auto const half = float(ScreenLayers::kTile / 2);
    vec2 const middle = float(ScreenLayers::kTile) *
                            vec2{float(tile % layers_.tiles_across()), float(tile / layers_.tiles_across())} +
                        half;
    vec3 const along = eye_.corner + middle.x * eye_.step_x + middle.y * eye_.step_y,
               point = eye_.origin + depth_m / glm::dot(eye_.forward, along) * along;
    float way = 0;
    vec3 last{0};
    for (Projection const& project : during_) {
        vec3 const now = project(point);
        if (!(now.z > 0)) return {kInf, kInf}; // behind that eye
        if (&project != during_.data()) way += glm::length(vec2(now) - vec2(last));
        last = now;
    }
    float const radius = confusion_px(view.rays, depth_m);
    return {kPi * radius * radius + (2 * radius + 1) * way, radius + way};
}

/// Two lens rays for every pixel of the largest blur that reaches a tile, from within the margin around.
void LayeredLens::choose_numbers(View const& view)
{
    blurs_.assign(layers_.tiles().size(), {});
    tbb::parallel_for(std::size_t(0), blurs_.size(), [&](std::size_t t) {
        ScreenLayers::Depths const& d = layers_.tiles()[t];
        if (!(d.farthest_m > 0)) return;
        Blur const near = blur(view, t, d.nearest_m), far = blur(view, t, d.farthest_m);
        blurs_[t] = {std::max(near.area_px2, far.area_px2), std::max(near.reach_px, far.reach_px)};
    });
    auto const across = int(layers_.tiles_across()), down = int(layers_.tiles().size()) / std::max(1, across),
               reach = (kMargin + int(ScreenLayers::kTile) - 1) / int(ScreenLayers::kTile);
    rays_of_.resize(layers_.tiles().size());
    tbb::parallel_for(0, down, [&](int y) {
        for (int x = 0; x < across; ++x) {
            float area_px2 = 0;
            for (int j = std::max(0, y - reach); j <= std::min(down - 1, y + reach); ++j)
                for (int i = std::max(0, x - reach); i <= std::min(across - 1, x + reach); ++i) {
                    Blur const& b = blurs_[std::size_t(j * across + i)];
                    int const tiles_between = std::max(std::abs(i - x), std::abs(j - y)) - 1;
                    if (float(tiles_between * int(ScreenLayers::kTile)) < b.reach_px)
                        area_px2 = std::max(area_px2, b.area_px2);
                }
            rays_of_[std::size_t(y * across + x)] =
                int(std::clamp(std::ceil(2 * area_px2), 1.0f, float(most_rays_)));
        }
    });
}

void LayeredLens::look(View const& view, Place const& place, float near_m, PassStop const& stop)
{
    at_ = place_in_pixel(view.filter, view.seed, view.pass);
    draw(view, place, near_m);
    for (most_rays_ = kMostRays; !follow_all(view, place, stop); most_rays_ /= 2) {
    }
}

/// @return false if what they met is too much for most_rays_ > 1
bool LayeredLens::follow_all(View const& view, Place const& place, PassStop const& stop)
{
    std::size_t const pixels = std::size_t(view.width) * std::size_t(view.height);
    choose_numbers(view);
    met_.assign(pixels * std::size_t(most_rays_), kBackground);
    slot_.assign(layers_.size(), 0);
    std::vector<std::vector<Alone>> alone((pixels + kPixelsOfTask - 1) / kPixelsOfTask);
    std::atomic<std::uint64_t> asked = 0, met_alone = 0;
    tbb::parallel_for(std::size_t(0), alone.size(), [&](std::size_t k) {
        if (stop.given_up() || (most_rays_ > 1 && met_alone > kMostStarts)) return;
        asked += follow(view, place, k * kPixelsOfTask, std::min(pixels, (k + 1) * kPixelsOfTask), alone[k]);
        met_alone += alone[k].size();
    });
    stop.check();
    std::size_t const starts = met_alone + std::size_t(std::ranges::count(slot_, 1u));
    if (most_rays_ > 1 && starts > kMostStarts) return false;
    asked_ = asked;
    alone_ = met_alone;
    make_starts(view);
    for (std::vector<Alone> const& some : alone)
        for (Alone const& a : some) {
            met_[a.at] = std::uint32_t(starts_.size());
            starts_.push_back(a.start);
        }
    return true;
}

/// Follows the lens rays of some pixels. @return how many
std::size_t LayeredLens::follow(View const& view, Place const& place, std::size_t first, std::size_t last,
                                std::vector<Alone>& alone)
{
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<Hit> hits;
    thread_local std::vector<std::size_t> places;
    rays.clear();
    places.clear();
    std::vector<Sight> sights;
    for (std::size_t p = first; p < last; ++p) {
        if (!view.hidden.empty() && view.hidden[p] != 0) continue;
        int const n = rays_of(view, p);
        for (int k = 0; k < n; ++k) {
            Ray const ray = lens_ray(view, p, k, n);
            places.push_back(p * std::size_t(most_rays_) + std::size_t(k));
            rays.push_back({.ray = ray,
                            .seed = hash_words(std::uint32_t(places.back()), view.pass),
                            .start = camera_clearance(ray.origin)});
        }
    }
    hits.resize(rays.size());
    place.exact.nearest(rays, hits);
    auto const leave_alone = [&](std::size_t k) {
        alone.push_back(
            {places[k], {hash_words(std::uint32_t(places[k]), kAlone), hits[k].triangle, rays[k].ray}});
    };
    auto const take = [&](std::size_t k, std::uint32_t layer) {
        met_[places[k]] = layer;
        std::atomic_ref(slot_[layer]).store(1, std::memory_order_relaxed);
    };
    thread_local std::vector<RayQuery> queries;
    thread_local std::vector<std::uint8_t> blocked;
    queries.clear();
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (hits[k].triangle == kNoTriangle) continue;
        Found const found = layer_of(place, hits[k], rays[k].ray.direction);
        if (found.layer == kBackground) {
            leave_alone(k);
        } else if (found.hidden) {
            sights.push_back({k, found.layer});
            queries.push_back(towards(found.position, rays[k]));
        } else {
            take(k, found.layer);
        }
    }
    blocked.resize(queries.size());
    place.exact.occluded(queries, blocked);
    for (std::size_t i = 0; i < sights.size(); ++i)
        blocked[i] != 0 ? leave_alone(sights[i].ray) : take(sights[i].ray, sights[i].layer);
    return rays.size();
}

/// Through the texel's place, from the lens' centre.
Ray LayeredLens::layer_ray(std::size_t texel) const
{
    std::size_t const width = layers_.columns();
    return eye_.through(vec2{float(texel % width), float(texel / width)} + at_);
}

/// The layer, under the texel that shows a hit, of its triangle; or of one that goes on there in the same way, as of a
/// mesh finer than texels. kBackground if there is none of which the lens' centre sees the same side.
LayeredLens::Found LayeredLens::layer_of(Place const& place, Hit const& hit, vec3 direction) const
{
    constexpr float kAlike = 0.95f; // cosine
    Surface const& s = place.world.surfaces[hit.triangle];
    vec3 const position = s.corner + hit.barycentric.x * s.edge1 + hit.barycentric.y * s.edge2,
               normal = shading_detail::triangle_normal(s);
    std::optional<ScreenLayers::Texel> const texel = layers_.texel_at(position);
    bool const front = glm::dot(normal, direction) < 0;
    if (!texel || (glm::dot(normal, position - eye_.origin) < 0) != front) return {};
    std::uint32_t best = kBackground;
    float nearest_m = texel->width_m;
    for (std::uint32_t l = layers_.first(texel->index); l < layers_.first(texel->index + 1); ++l) {
        if (layers_.triangle(l) == hit.triangle) {
            best = l;
            break;
        }
        Surface const& other = place.world.surfaces[layers_.triangle(l)];
        vec3 const n = shading_detail::triangle_normal(other);
        float const off = std::abs(glm::dot(n, position - other.corner));
        if (other.material != s.material || !(glm::dot(n, normal) > kAlike) || !(off < nearest_m)) continue;
        if ((glm::dot(n, other.corner - eye_.origin) < 0) != front) continue;
        nearest_m = off;
        best = l;
    }
    if (best == kBackground || best == layers_.front(texel->index)) return {best};
    Surface const& met = place.world.surfaces[layers_.triangle(best)];
    vec3 const n = shading_detail::triangle_normal(met);
    Ray const ray = layer_ray(texel->index);
    float const t = glm::dot(n, met.corner - ray.origin) / glm::dot(n, ray.direction);
    return {best, true, ray.origin + t * ray.direction};
}

/// A path for every layer that was met: of a texel within the picture the first has its pixel's random numbers.
void LayeredLens::make_starts(View const& view)
{
    starts_.clear();
    std::size_t const width = std::size_t(view.width) + 2 * std::size_t(kMargin),
                      texels = width * (std::size_t(view.height) + 2 * std::size_t(kMargin));
    for (std::size_t t = 0; t < texels; ++t) {
        bool first = true;
        int const x = int(t % width) - kMargin, y = int(t / width) - kMargin;
        bool const within = x >= 0 && y >= 0 && x < view.width && y < view.height;
        for (std::uint32_t l = layers_.first(t); l < layers_.first(t + 1); ++l) {
            if (slot_[l] == 0) continue;
            slot_[l] = std::uint32_t(starts_.size());
            std::uint32_t const stream = within && first
                                             ? std::uint32_t(y * view.width + x)
                                             : hash_words(layers_.triangle(l), std::uint32_t(t) ^ kAlone);
            starts_.push_back({stream, layers_.triangle(l), layer_ray(t)});
            first = false;
        }
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, met_.size(), 16 * kPixelsOfTask), [&](auto const& range) {
        for (std::size_t k = range.begin(); k != range.end(); ++k)
            if (met_[k] != kBackground) met_[k] = slot_[met_[k]];
    });
}

PathSample LayeredLens::gather(View const& view, WorldView const& world, std::size_t pixel,
                               std::span<PathSample const> samples) const
{
    PathSample mean;
    if (!view.hidden.empty() && view.hidden[pixel] != 0) return mean;
    int const rays = rays_of(view, pixel);
    int met = 0;
    for (int k = 0; k < rays; ++k) {
        std::uint32_t const start = met_[pixel * std::size_t(most_rays_) + std::size_t(k)];
        if (start == kBackground) {
            mean.radiance[0] += background_radiance(world, lens_ray(view, pixel, k, rays).direction);
            continue;
        }
        PathSample const& s = samples[start];
        for (std::size_t part = 0; part < mean.radiance.size(); ++part) mean.radiance[part] += s.radiance[part];
        mean.albedo += s.albedo;
        mean.normal += s.normal;
        ++met;
        if (k > 0) continue;
        mean.hit = s.hit;
        mean.position = s.position;
        mean.depth = s.depth;
    }
    float const share = 1 / float(rays);
    for (vec3& part : mean.radiance) part *= share;
    // These are means over passes whose first ray met something.
    mean.albedo *= 1 / float(std::max(1, met));
    mean.normal *= 1 / float(std::max(1, met));
    return mean;
}

} // namespace gi
