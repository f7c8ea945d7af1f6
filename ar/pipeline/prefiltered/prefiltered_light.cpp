#include "ar/pipeline/prefiltered/prefiltered_light.h"

#include "gi/core/rng.h"
#include "gi/scene/shading/shading_point.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

constexpr double kLampShare = 0.003; ///< of the light, in one texel: too much to interpolate its cosine
constexpr std::ptrdiff_t kMostLamps = 24;
constexpr float kSharpShare = 0.03f; ///< of the light, in one direction
constexpr std::uint32_t kMovingTexels = 64, kSharpMovingTexels = 256;
/// Estimated share of light that reaches moving surfaces in spite of each other.
constexpr float kOpenness = 0.8f;
constexpr int kBounces = 2; ///< between still surfaces

/// Diffuse albedo at the middle of a triangle.
gi::vec3 albedo_of(gi::WorldView const& world, std::uint32_t triangle)
{
    gi::vec3 const n = gi::shading_detail::triangle_normal(world.surfaces[triangle]);
    return gi::albedo(gi::shading_point(world, triangle, gi::vec2(1.0f / 3), -n).bsdf);
}

} // namespace

PrefilteredLight::PrefilteredLight(gi::World const& world, gi::StopRequest const& stop,
                                   PrefilteredSettings const& settings)
    : settings_(settings), world_(world), soup_(gi::make_soup(world)), cut_outs_(world), still_(world)
{
    gi::WorldView const view = gi::view(world);
    for (std::size_t t = world.static_triangles; t < world.triangles.size(); ++t)
        moving_albedo_.push_back(albedo_of(view, std::uint32_t(t)));
    std::vector<std::uint8_t> is_used(world.bsdfs.size());
    for (std::uint32_t const m : world.triangle_material) is_used[m] = 1;
    for (std::size_t m = 0; m < is_used.size(); ++m)
        has_glossy_ |= is_used[m] && gi::max_component(glossy_lobe_of(world.bsdfs[m], 1).reflectance) > 0;
    relight(stop);
    moved(stop);
}

void PrefilteredLight::relight(gi::StopRequest const& stop_request)
{
    gi::BuildStop const stop(&stop_request);
    EnvironmentTexels const texels = environment_texels(world_);
    bool const cut = cells_.update(texels);
    std::vector<EnvironmentTexels::Texel> rest = texels.texels;
    take_lamps(rest);
    tbb::parallel_for(0, smooth_irradiance_.nodes(), [&](int node) {
        gi::vec3 const n = smooth_irradiance_.direction(node);
        gi::vec3 sum(0);
        for (auto const& t : rest) sum += std::max(glm::dot(t.direction, n), 0.0f) * t.light;
        smooth_irradiance_[node] = sum;
    });
    if (has_glossy_) glossy_.update(texels);
    if (cut) directions_.resize(cells_.cells().size());
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        EnvironmentCell const& c = cells_.cells()[k];
        directions_[k] = {c.direction, c.light, c.solid_angle_sr, c.share > kSharpShare};
        for (int axis = 0; axis < 3; ++axis) towards_[std::size_t(axis)][k] = c.direction[axis];
    }
    tbb::parallel_for(0, light_sum_.nodes(), [&](int node) {
        gi::vec3 const n = light_sum_.direction(node);
        gi::vec3 light(0);
        float angle = 0;
        for (LightDirection const& d : directions_) {
            float const c = std::max(glm::dot(d.towards, n), 0.0f);
            light += c * d.light;
            angle += c * d.solid_angle_sr;
        }
        light_sum_[node] = light;
        angle_sum_[node] = angle;
    });
    if (cut) {
        moving_.assign(directions_.size(), {});
        moving_bounds_ = {};
        stale_.assign(directions_.size(), 0);
        still_.build(directions_, soup_, cut_outs_, stop);
        still_.fit_patches(directions_, present_bounds(), stop);
    }
    light_patches();
}

void PrefilteredLight::take_lamps(std::vector<EnvironmentTexels::Texel>& texels)
{
    auto const light = [](EnvironmentTexels::Texel const& t) { return gi::luminance(t.light); };
    double all = 0;
    for (auto const& t : texels) all += double(light(t));
    auto const end = std::partition(texels.begin(), texels.end(),
                                    [&](auto const& t) { return double(light(t)) > kLampShare * all; });
    auto const last = texels.begin() + std::min(end - texels.begin(), kMostLamps);
    std::partial_sort(texels.begin(), last, end,
                      [&](auto const& a, auto const& b) { return light(a) > light(b); });
    lamps_.assign(texels.begin(), last);
    texels.erase(texels.begin(), last);
}

gi::vec3 PrefilteredLight::open(gi::vec3 normal) const
{
    gi::vec3 sum = smooth_irradiance_.at(normal);
    for (auto const& lamp : lamps_) sum += std::max(glm::dot(lamp.direction, normal), 0.0f) * lamp.light;
    return sum;
}

gi::Bounds PrefilteredLight::present_bounds() const
{
    return bounds_of(world_, world_.static_triangles, world_.triangles.size());
}

void PrefilteredLight::light_patches()
{
    std::size_t const n = directions_.size();
    std::vector<SurfacePatch> const& patches = still_.patches();
    patch_light_.assign(patches.size(), gi::vec3(0));
    radiance_without_.assign(patches.size(), gi::vec3(0));
    mean_radiance_ = gi::vec3(0);
    for (int bounce = 0; bounce <= kBounces; ++bounce) {
        tbb::parallel_for(std::size_t(0), patches.size(), [&](std::size_t i) {
            SurfacePatch const& at = patches[i];
            Sums sums;
            for (std::size_t k = 0; k < n; ++k) {
                float const c = glm::dot(at.normal, directions_[k].towards);
                if (!(c > 0)) continue;
                std::uint32_t const there = still_.seen_from(i, k);
                if (there == StillSurfaces::kOpen)
                    sums.light += c * directions_[k].light;
                else
                    sums.radiance += c * directions_[k].solid_angle_sr * radiance(radiance_without_, there);
            }
            patch_light_[i] = arrived(open(at.normal), gi::vec3(gi::kPi), sums,
                                      {light_sum_.at(at.normal), angle_sum_.at(at.normal)});
        });
        gi::vec3 sum(0);
        for (std::size_t i = 0; i < patches.size(); ++i)
            sum += radiance_without_[i] = gi::kInvPi * patches[i].albedo * patch_light_[i];
        if (!patches.empty()) mean_radiance_ = sum / float(patches.size());
    }
    radiance_ = radiance_without_;
}

void PrefilteredLight::moved(gi::StopRequest const& stop)
{
    moving_radius_ = 0;
    if (world_.static_triangles == world_.triangles.size()) return;
    gi::update_soup(world_, world_.static_triangles, soup_);
    gi::Bounds const b = present_bounds();
    if (b.empty()) return;
    moving_centre_ = b.center();
    moving_radius_ = b.radius();
    // The maps stay as they are while the surfaces fit well, so that their texels do not swim.
    bool const fits = !moving_bounds_.empty() && glm::all(glm::greaterThanEqual(b.low, moving_bounds_.low)) &&
                      glm::all(glm::lessThanEqual(b.high, moving_bounds_.high)) &&
                      moving_bounds_.radius() < 1.5f * b.radius();
    if (!fits) {
        gi::vec3 const room = gi::vec3(0.15f * b.radius());
        moving_bounds_ = {b.low - room, b.high + room};
    }
    if (still_.fit_patches(directions_, b, gi::BuildStop(&stop))) light_patches();
    light_moving();
    stale_.assign(directions_.size(), 1);
    if (!fits)
        for (std::size_t k = 0; k < directions_.size(); ++k) {
            gi::Pcg32 rng = gi::Pcg32::for_path(0, 0x0cc2, std::uint32_t(k));
            gi::vec2 const jitter = rng.uniform2();
            moving_[k].start(moving_bounds_, directions_[k].towards,
                             directions_[k].sharp ? kSharpMovingTexels : kMovingTexels, jitter,
                             2 * gi::kPi * rng.uniform());
        }
    draw_stale(fits ? settings_.triangles_at_once : ~std::size_t(0));
}

bool PrefilteredLight::settle()
{
    bool const any = std::find(stale_.begin(), stale_.end(), 1) != stale_.end();
    if (any) draw_stale(settings_.triangles_at_once);
    return any;
}

void PrefilteredLight::draw_stale(std::size_t most_triangles)
{
    // Sharp shadows first, then the maps in turn.
    std::size_t const triangles = world_.triangles.size() - world_.static_triangles, n = directions_.size();
    std::vector<std::size_t> drawn;
    for (std::size_t k = 0; k < n; ++k)
        if (stale_[k] && directions_[k].sharp) drawn.push_back(k);
    std::size_t const sharp = drawn.size(); // one of the others follows in any case
    for (std::size_t i = 0; i < n && (drawn.size() == sharp || (drawn.size() + 1) * triangles <= most_triangles);
         ++i) {
        next_ = (next_ + 1) % n;
        if (stale_[next_] && !directions_[next_].sharp) drawn.push_back(next_);
    }
    tbb::parallel_for(std::size_t(0), drawn.size(), [&](std::size_t i) {
        moving_[drawn[i]].draw(soup_, cut_outs_, world_.static_triangles, world_.triangles.size(), 0);
        stale_[drawn[i]] = 0;
    });
    tbb::parallel_for(std::size_t(0), still_.patches().size(), [&](std::size_t i) {
        SurfacePatch const& p = still_.patches()[i];
        gi::vec3 const change = change_on_still({p.position, p.normal, p.normal, p.triangle, {}, {}}).irradiance;
        radiance_[i] = gi::kInvPi * p.albedo * glm::max(patch_light_[i] + change, gi::vec3(0));
    });
}

void PrefilteredLight::light_moving()
{
    // Radiance of a white matt ball amid the moving surfaces: the irradiance of its normals,
    // weighted by the area that they show the viewer.
    std::size_t const n = directions_.size();
    std::vector<gi::vec3> received(n);
    tbb::parallel_for(std::size_t(0), n, [&](std::size_t k) {
        gi::vec3 const normal = directions_[k].towards;
        received[k] = on_still({moving_centre_, normal, normal, gi::kNoPrimitive, {}, {}}).irradiance;
    });
    white_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        LightDirection const& seen = directions_[i];
        gi::vec3 sum(0);
        float area = 0;
        for (std::size_t k = 0; k < n; ++k) {
            float const a =
                std::max(-glm::dot(directions_[k].towards, seen.towards), 0.0f) * directions_[k].solid_angle_sr;
            sum += a * received[k];
            area += a;
        }
        white_[i] = area > 0 ? kOpenness * gi::kInvPi / area * sum : gi::vec3(0);
    }
}

float PrefilteredLight::moving_in_the_way(std::size_t k, LitPoint const& at, std::uint32_t& blocker) const
{
    gi::View<gi::Surface const> const surfaces(world_.surfaces);
    if (directions_[k].sharp) return moving_[k].hidden(surfaces, at.position, at.geometric, at.triangle, blocker);
    blocker = moving_[k].blocker(surfaces, at.position, at.geometric, at.triangle);
    return blocker == gi::kNoPrimitive ? 0.0f : 1.0f;
}

gi::vec3 PrefilteredLight::arrived(gi::vec3 open, gi::vec3 by_radiance, Sums const& sums, All const& all)
{
    gi::vec3 out(0);
    for (int c = 0; c < 3; ++c)
        if (all.light[c] > 0) out[c] = open[c] * (sums.light[c] / all.light[c]);
    return all.solid_angle > 0 ? out + by_radiance / all.solid_angle * sums.radiance : out;
}

/// Sums what a point receives from the directions that are added, by its cosine and by its lobe.
class PrefilteredLight::Gather {
public:
    Gather(PrefilteredLight const& light, LitPoint const& at)
        : light_(light), at_(at), has_lobe_(gi::max_component(at.lobe.reflectance) > 0)
    {
        // Directions are some 18 degrees apart: lobes narrower than that take the shadows of a wider one.
        constexpr float kWidestGap = 0.35f;
        inverse_alpha2_ = 1 / gi::square(std::max(at.lobe.alpha, kWidestGap));
    }

    /// Counts a direction among all. @param c  its cosine, > 0
    void include(LightDirection const& d, float c)
    {
        all_.light += c * d.light;
        all_.solid_angle += c * d.solid_angle_sr;
        include_in_lobe(d, c);
    }
    void include_in_lobe(LightDirection const& d, float c)
    {
        if (!has_lobe_) return;
        float const w = lobe(d, c);
        lobe_all_.light += w * d.light;
        lobe_all_.solid_angle += w * d.solid_angle_sr;
    }
    /// A share of a direction's light arrives.
    void add_light(LightDirection const& d, float c, float share)
    {
        sums_.light += share * c * d.light;
        if (has_lobe_) lobe_sums_.light += share * lobe(d, c) * d.light;
    }
    /// A share of its solid angle shows a surface.
    void add_radiance(LightDirection const& d, float c, float share, gi::vec3 radiance)
    {
        radiance *= share * d.solid_angle_sr;
        sums_.radiance += c * radiance;
        if (has_lobe_) lobe_sums_.radiance += lobe(d, c) * radiance;
    }
    bool has_lobe() const { return has_lobe_; }
    /// @param all  nothing: those that were included
    ReceivedLight result(All const* all = nullptr) const
    {
        ReceivedLight r;
        r.irradiance = arrived(light_.open(at_.normal), gi::vec3(gi::kPi), sums_, all ? *all : all_);
        if (has_lobe_) {
            gi::vec3 const mirror = glm::reflect(-at_.to_viewer, at_.normal);
            gi::vec3 const open = at_.lobe.reflectance * light_.glossy_.radiance(mirror, at_.lobe.alpha);
            r.glossy = arrived(open, at_.lobe.reflectance, lobe_sums_, lobe_all_);
        }
        return r;
    }

private:
    float lobe(LightDirection const& d, float c) const
    {
        gi::vec3 const h = glm::normalize(at_.to_viewer + d.towards);
        float const cosine = glm::dot(h, at_.normal), squared = cosine * cosine;
        return c / gi::square((1 - squared) * inverse_alpha2_ + squared);
    }

    PrefilteredLight const& light_;
    LitPoint const& at_;
    bool has_lobe_;
    float inverse_alpha2_;
    All all_, lobe_all_;
    Sums sums_, lobe_sums_;
};

/// Calls visit(k, cosine) for each direction before the surface and towards `way` by more than `least`.
template <class Visit>
void PrefilteredLight::for_directions(gi::vec3 normal, gi::vec3 way, float least, Visit const& visit) const
{
    std::size_t const n = directions_.size();
    std::array<float, kMostDirections> cosine;
    std::array<std::uint8_t, kMostDirections> visited;
    float const* const x = towards_[0].data();
    float const* const y = towards_[1].data();
    float const* const z = towards_[2].data();
    for (std::size_t k = 0; k < n; ++k) { // as vectors
        cosine[k] = normal.x * x[k] + normal.y * y[k] + normal.z * z[k];
        visited[k] = (cosine[k] > 0) & (way.x * x[k] + way.y * y[k] + way.z * z[k] > least);
    }
    for (std::size_t k = 0; k < n; ++k)
        if (visited[k]) visit(k, cosine[k]);
}

ReceivedLight PrefilteredLight::open_light(LitPoint const& at) const
{
    ReceivedLight r{open(at.normal)};
    if (gi::max_component(at.lobe.reflectance) > 0)
        r.glossy = at.lobe.reflectance * glossy_.radiance(glm::reflect(-at.to_viewer, at.normal), at.lobe.alpha);
    return r;
}

ReceivedLight PrefilteredLight::on_moving(LitPoint const& at) const
{
    Gather gather(*this, at);
    for_directions(at.normal, gi::vec3(0), -1, [&](std::size_t k, float c) {
        LightDirection const& d = directions_[k];
        gather.include(d, c);
        // Behind the triangle but not behind the smooth surface: counts as not hidden.
        std::uint32_t blocker = gi::kNoPrimitive;
        float const hidden = glm::dot(at.geometric, d.towards) > 0 ? moving_in_the_way(k, at, blocker) : 0;
        if (hidden > 0) gather.add_radiance(d, c, hidden, moving_radiance(k, blocker));
        if (!(hidden < 1)) return;
        std::uint32_t const there = still_.in_the_way(k, at.position, at.geometric, at.triangle);
        if (there == StillSurfaces::kOpen)
            gather.add_light(d, c, 1 - hidden);
        else
            gather.add_radiance(d, c, 1 - hidden, radiance(radiance_, there));
    });
    return gather.result();
}

ReceivedLight PrefilteredLight::change_on_still(LitPoint const& at) const
{
    if (!(moving_radius_ > 0)) return {};
    // Directions that can meet the sphere around the moving surfaces.
    gi::vec3 const way = moving_centre_ - at.position;
    float const squared = glm::dot(way, way), distance = std::sqrt(squared);
    if (glm::dot(way, at.normal) < -moving_radius_) return {};
    float const least =
        distance > moving_radius_ ? std::sqrt(squared - gi::square(moving_radius_)) : -2 * distance;
    Gather gather(*this, at);
    bool changed = false;
    for_directions(at.normal, way, least, [&](std::size_t k, float c) {
        LightDirection const& d = directions_[k];
        std::uint32_t blocker = gi::kNoPrimitive;
        float const hidden = moving_in_the_way(k, at, blocker);
        if (!(hidden > 0)) return;
        changed = true;
        gather.add_radiance(d, c, hidden, moving_radiance(k, blocker));
        std::uint32_t const there = still_.in_the_way(k, at.position, at.geometric, at.triangle);
        if (there == StillSurfaces::kOpen)
            gather.add_light(d, c, -hidden);
        else
            gather.add_radiance(d, c, -hidden, radiance(radiance_without_, there));
    });
    if (!changed) return {};
    if (gather.has_lobe())
        for (LightDirection const& d : directions_)
            if (float const c = glm::dot(at.normal, d.towards); c > 0) gather.include_in_lobe(d, c);
    All const all{light_sum_.at(at.normal), angle_sum_.at(at.normal)};
    return gather.result(&all);
}

ReceivedLight PrefilteredLight::on_still(LitPoint const& at, std::size_t every, std::size_t first) const
{
    Gather gather(*this, at);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        LightDirection const& d = directions_[k];
        bool const in_all = d.sharp || every == 1;
        if (!in_all && k % every != first) continue;
        float const c = (in_all ? 1.0f : float(every)) * glm::dot(at.normal, d.towards);
        if (!(c > 0)) continue;
        gather.include(d, c);
        std::uint32_t const there = still_.in_the_way(k, at.position, at.geometric, at.triangle);
        if (there == StillSurfaces::kOpen)
            gather.add_light(d, c, 1);
        else
            gather.add_radiance(d, c, 1, radiance(radiance_without_, there));
    }
    return gather.result();
}

} // namespace ar
