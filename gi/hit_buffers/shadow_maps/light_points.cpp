#include "gi/hit_buffers/shadow_maps/light_points.h"

#include "gi/core/rng.h"
#include "gi/core/rqmc.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

ShadowView view_from(World const& world, LightChoice const& choice, vec2 u)
{
    WorldView const w = view(world);
    ShadowView v;
    if (choice.light < world.lights.size()) {
        Light const& light = world.lights[choice.light];
        v.parallel = light.type == LightType::directional;
        v.at = v.parallel ? -light.direction : light.position;
    } else if (light_detail::is_environment(w, choice)) {
        v.parallel = true;
        v.at = light_detail::sample_environment(w, choice.texel, w.environment_pdf, u).direction;
    } else {
        std::uint32_t const triangle = world.emitters[choice.light - world.lights.size()];
        Surface const& s = world.surfaces[triangle];
        v.at = shading_detail::SurfacePoint{s, square_to_triangle(u)}.position();
        if (!s.is(Surface::kDoubleSided)) v.facing = shading_detail::triangle_normal(s);
    }
    return v;
}

} // namespace

LightPoints::LightPoints(World const& world, Bounds const& bounds, TriangleSoup const& soup,
                         CutOuts const& cut_outs, LightPointSettings const& settings, DrawOnDevice elsewhere)
    : world_(world),
      settings_(settings),
      builder_(bounds, settings.windows, soup, cut_outs, settings.resolution),
      first_moving_(std::min(settings.first_moving, soup.count)),
      elsewhere_(std::move(elsewhere))
{
    if (world.light_select.empty()) return;
    std::size_t const lights = world.lights.size();
    fixed_ = world.emitters.empty() && world.environment_select.empty() && lights <= settings.count;
    if (!fixed_) {
        light_points_.resize(settings.count);
        // Points on moving lights are not kept.
        if (std::ranges::any_of(world.emitters, [&](std::uint32_t t) { return t >= first_moving_; }))
            settings_.fresh = settings.count;
        return;
    }
    std::vector<float> weights;
    for (std::uint32_t k = 0; k < lights; ++k) {
        LightPoint& light_point = light_points_.emplace_back();
        light_point.choice = {k, 0, view(world.light_select).probability(k)};
        light_point.view = view_from(world, light_point.choice, {});
        light_point.light = distant_light(world, light_point.choice, {});
        weights.push_back(light_point.choice.probability);
    }
    chances_ = make_alias_table(weights);
    std::vector<LightPoint*> all;
    for (LightPoint& light_point : light_points_) all.push_back(&light_point);
    build(all, 0, PassStop(settings.stop));
}

void LightPoints::take_point(LightPoint& light_point, std::uint64_t number)
{
    // Stratified over the points of all passes.
    RqmcStream const stream{std::uint32_t(mix_bits(settings_.seed ^ 0x1a395)), std::uint32_t(number)};
    vec4 const u = stream.sample_together(0);
    light_point.number = number;
    light_point.choice = order_.choose(double(u.x) + double(stream.sample(4)) * 0x1p-24);
    light_point.u = {u.y, u.z};
    light_point.view = view_from(world_, light_point.choice, light_point.u);
    light_point.light = distant_light(world_, light_point.choice, light_point.u);
}

void LightPoints::refresh(std::uint32_t pass, PassStop const& stop)
{
    if (none()) return;
    if (fixed_) {
        if (moved_) build({}, pass, stop);
        return;
    }
    order_.update(world_); // lights may have moved
    // The points in use have successive numbers.
    std::vector<LightPoint*> fresh;
    std::uint64_t const first = std::uint64_t(pass) * settings_.fresh;
    for (std::uint64_t number = first; number < first + light_points_.size(); ++number) {
        LightPoint& light_point = light_points_[number % light_points_.size()];
        if (light_point.number == number) continue;
        take_point(light_point, number);
        fresh.push_back(&light_point);
    }
    build(fresh, pass, stop);
}

void LightPoints::build(std::span<LightPoint* const> fresh, std::uint32_t pass, PassStop const& stop)
{
    Pcg32 rng = Pcg32::for_path(settings_.seed, 0x1a395, pass);
    for (LightPoint* const light_point : fresh) {
        vec2 const jitter = rng.uniform2();
        builder_.start(light_point->view, jitter, 2 * kPi * rng.uniform(), light_point->shadow);
        for (auto& face : light_point->taken) face.clear();
    }
    std::uint32_t const seed = rng.next();
    if (elsewhere_) {
        std::vector<std::size_t> drawn;
        for (LightPoint& light_point : light_points_)
            if (moved_ || std::ranges::find(fresh, &light_point) != fresh.end())
                drawn.push_back(std::size_t(&light_point - light_points_.data()));
        built_ += drawn.size();
        elsewhere_({light_points_, drawn, seed});
        moved_ = false;
        return;
    }
    built_ += fresh.size();
    tbb::parallel_for(std::size_t(0), 6 * fresh.size(), [&](std::size_t job) {
        if (stop.given_up()) return;
        LightPoint& light_point = *fresh[job / 6];
        builder_.build(light_point.view, int(job % 6), first_moving_, seed, light_point.shadow);
        builder_.move(int(job % 6), first_moving_, seed, light_point.shadow, light_point.taken);
    });
    if (moved_)
        tbb::parallel_for(std::size_t(0), 6 * light_points_.size(), [&](std::size_t job) {
            LightPoint& light_point = light_points_[job / 6];
            if (std::ranges::find(fresh, &light_point) == fresh.end())
                builder_.move(int(job % 6), first_moving_, seed, light_point.shadow, light_point.taken);
        });
    stop.check();
    moved_ = false;
}

void LightPoints::show_moving(bool shown)
{
    for (LightPoint& light_point : light_points_)
        for (int face = 0; face < 6; ++face)
            ShadowMapBuilder::swap_moving(face, shown, light_point.shadow, light_point.taken);
}

} // namespace gi
