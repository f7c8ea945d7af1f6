#include "gi/methods/slhb/lights/lamps.h"

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

Lamps::Lamps(World const& world, Bounds const& bounds, TriangleSoup const& soup, CutOuts const& cut_outs,
             LampSettings const& settings, DrawElsewhere elsewhere)
    : world_(world),
      settings_(settings),
      builder_(bounds, soup, cut_outs, settings.resolution),
      first_moving_(std::min(settings.first_moving, soup.count)),
      elsewhere_(std::move(elsewhere))
{
    if (world.light_select.empty()) return;
    std::size_t const lights = world.lights.size();
    fixed_ = world.emitters.empty() && world.environment_select.empty() && lights <= settings.count;
    if (!fixed_) {
        lamps_.resize(settings.count);
        // Points on lamps that move do not stay.
        if (std::ranges::any_of(world.emitters, [&](std::uint32_t t) { return t >= first_moving_; }))
            settings_.fresh = settings.count;
        return;
    }
    std::vector<float> weights;
    for (std::uint32_t k = 0; k < lights; ++k) {
        Lamp& lamp = lamps_.emplace_back();
        lamp.choice = {k, 0, view(world.light_select).probability(k)};
        lamp.view = view_from(world, lamp.choice, {});
        lamp.light = distant_light(world, lamp.choice, {});
        weights.push_back(lamp.choice.probability);
    }
    chances_ = make_alias_table(weights);
    std::vector<Lamp*> all;
    for (Lamp& lamp : lamps_) all.push_back(&lamp);
    build(all, 0);
}

void Lamps::take_point(Lamp& lamp, std::uint64_t number)
{
    // Stratified over the points of all passes.
    RqmcStream const stream{std::uint32_t(mix_bits(settings_.seed ^ 0x1a395)), std::uint32_t(number)};
    vec4 const u = stream.sample_together(0);
    lamp.number = number;
    lamp.choice = order_.choose(double(u.x) + double(stream.sample(4)) * 0x1p-24);
    lamp.u = {u.y, u.z};
    lamp.view = view_from(world_, lamp.choice, lamp.u);
    lamp.light = distant_light(world_, lamp.choice, lamp.u);
}

void Lamps::refresh(std::uint32_t pass)
{
    if (none()) return;
    if (fixed_) {
        if (moved_) build({}, pass);
        return;
    }
    order_.update(world_); // which may have moved
    // The points in use are successive ones.
    std::vector<Lamp*> fresh;
    std::uint64_t const first = std::uint64_t(pass) * settings_.fresh;
    for (std::uint64_t number = first; number < first + lamps_.size(); ++number) {
        Lamp& lamp = lamps_[number % lamps_.size()];
        if (lamp.number == number) continue;
        take_point(lamp, number);
        fresh.push_back(&lamp);
    }
    build(fresh, pass);
}

void Lamps::build(std::span<Lamp* const> fresh, std::uint32_t pass)
{
    Pcg32 rng = Pcg32::for_path(settings_.seed, 0x1a395, pass);
    for (Lamp* const lamp : fresh) {
        vec2 const jitter = rng.uniform2();
        builder_.start(lamp->view, jitter, 2 * kPi * rng.uniform(), lamp->shadow);
        for (auto& face : lamp->taken) face.clear();
    }
    std::uint32_t const seed = rng.next();
    if (elsewhere_) {
        std::vector<std::size_t> drawn;
        for (Lamp& lamp : lamps_)
            if (moved_ || std::ranges::find(fresh, &lamp) != fresh.end())
                drawn.push_back(std::size_t(&lamp - lamps_.data()));
        built_ += drawn.size();
        elsewhere_({lamps_, drawn, seed});
        moved_ = false;
        return;
    }
    built_ += fresh.size();
    tbb::parallel_for(std::size_t(0), 6 * fresh.size(), [&](std::size_t job) {
        Lamp& lamp = *fresh[job / 6];
        builder_.build(lamp.view, int(job % 6), first_moving_, seed, lamp.shadow);
        builder_.move(int(job % 6), first_moving_, seed, lamp.shadow, lamp.taken);
    });
    if (moved_)
        tbb::parallel_for(std::size_t(0), 6 * lamps_.size(), [&](std::size_t job) {
            Lamp& lamp = lamps_[job / 6];
            if (std::ranges::find(fresh, &lamp) == fresh.end())
                builder_.move(int(job % 6), first_moving_, seed, lamp.shadow, lamp.taken);
        });
    moved_ = false;
}

void Lamps::show_moving(bool shown)
{
    for (Lamp& lamp : lamps_)
        for (int face = 0; face < 6; ++face) ShadowMapBuilder::swap_moving(face, shown, lamp.shadow, lamp.taken);
}

} // namespace gi
