#include "gi/scene/shading/light_sampling.h"
#include "gi/scene/shading/world_tables.h"

#include <array>

namespace gi {
namespace {

enum LightClass : std::size_t { punctual, distant, area, environment, classes };

/// Minimum probability of each kind of light present, because power alone does not show which light reaches the
/// visible surfaces (e.g. a light inside a room under a bright sky).
constexpr double kLeastShare = 0.1;

/// Luminance of a light's power, W. @param disc cross-section area of the scene, m2
double power(Light const& light, double disc)
{
    double const intensity = double(luminance(light.intensity));
    switch (light.type) {
    case LightType::point:
        return intensity * 4 * double(kPi);
    case LightType::spot:
        return intensity * 2 * double(kPi) * (1 - 0.5 * double(light.cos_inner + light.cos_outer));
    case LightType::directional:
        return intensity * disc;
    }
    return 0;
}

/// Mean luminance of a triangle's emission; with an emissive texture, from 16 points. The result is at least 1/100
/// of the material's emission, because the texture may be bright between dark points.
double mean_emission(WorldView const& world, std::uint32_t triangle)
{
    Surface const& surface = world.surfaces[triangle];
    Material const& m = world.materials[surface.material];
    double const most = double(luminance(m.emission));
    if (m.emissive_map.texture < 0) return most;
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
        vec2 const u{(float(i % 4) + 0.5f) / 4, (float(i / 4) + 0.5f) / 4};
        shading_detail::SurfacePoint at{surface, square_to_triangle(u)};
        shading_detail::interpolate_uv(world, at);
        sum += double(luminance(shading_detail::look_up_emission(world, m, at)));
    }
    return std::max(sum / 16, 0.01 * most);
}

/// Returns solid angle times mean luminance of every texel; the mean of the bilinear map over one texel has the
/// weights 1/8, 6/8, 1/8 per axis.
std::vector<float> texel_weights(EnvironmentMap const& map, vec3 scale)
{
    std::uint32_t const w = map.width, h = map.height;
    std::vector<float> blurred(std::size_t(w) * h), weights(std::size_t(w) * h);
    for (std::uint32_t y = 0; y < h; ++y)
        for (std::uint32_t x = 0; x < w; ++x) {
            auto const at = [&](std::uint32_t column) {
                return luminance(map.radiance[std::size_t(y) * w + column] * scale);
            };
            blurred[std::size_t(y) * w + x] =
                0.125f * at((x + w - 1) % w) + 0.75f * at(x) + 0.125f * at((x + 1) % w);
        }
    for (std::uint32_t y = 0; y < h; ++y) {
        double const solid_angle =
            2 * std::sin(double(kPi) * (y + 0.5) / h) * std::sin(0.5 * double(kPi) / h) * 2 * double(kPi) / w;
        std::uint32_t const above = y > 0 ? y - 1 : 0, below = std::min(y + 1, h - 1);
        for (std::uint32_t x = 0; x < w; ++x) {
            auto const at = [&](std::uint32_t row) { return blurred[std::size_t(row) * w + x]; };
            weights[std::size_t(y) * w + x] =
                float(solid_angle * double(0.125f * at(above) + 0.75f * at(y) + 0.125f * at(below)));
        }
    }
    return weights;
}

} // namespace

void add_emitters(World const& world, std::size_t first, std::size_t end, EmitterPowers& to)
{
    WorldView const v = view(world);
    for (std::size_t i = first; i < end; ++i) {
        Surface const& surface = world.surfaces[i];
        if (!surface.is(Surface::kEmits)) continue;
        double const triangle_area = 0.5 * double(glm::length(light_detail::area_vector(surface)));
        double const faces = surface.is(Surface::kDoubleSided) ? 2 : 1;
        double const p = mean_emission(v, std::uint32_t(i)) * triangle_area * double(kPi) * faces;
        if (!(p > 0)) continue;
        to.triangles.push_back(std::uint32_t(i));
        to.powers_w.push_back(p);
    }
}

void build_environment_table(World& world)
{
    world.environment_select = {};
    if (world.environment)
        world.environment_select = make_alias_table(texel_weights(*world.environment, world.environment_scale));
}

void build_light_select(World& world, EmitterPowers const& fixed, EmitterPowers const& moving)
{
    if (!world.emitter_pdf.empty())
        for (std::uint32_t const t : world.emitters) world.emitter_pdf[t] = 0;
    world.emitters.clear();
    world.environment_pdf = 0;

    std::vector<double> powers;
    std::vector<LightClass> class_of;
    double const disc = double(kPi) * square(world.bounds.radius());
    for (Light const& light : world.lights) {
        powers.push_back(power(light, disc));
        class_of.push_back(light.type == LightType::directional ? distant : punctual);
    }
    for (EmitterPowers const* some : {&fixed, &moving}) {
        world.emitters.insert(world.emitters.end(), some->triangles.begin(), some->triangles.end());
        powers.insert(powers.end(), some->powers_w.begin(), some->powers_w.end());
    }
    class_of.resize(powers.size(), area);
    if (!world.environment_select.empty()) {
        powers.push_back(world.environment_select.total * std::max(disc, 1e-30));
        class_of.push_back(environment);
    }

    std::array<double, classes> total{};
    for (std::size_t i = 0; i < powers.size(); ++i) total[class_of[i]] += powers[i];
    double all = 0;
    int present = 0;
    for (double const t : total) {
        all += t;
        present += t > 0;
    }
    std::vector<float> weights(powers.size());
    for (std::size_t i = 0; i < powers.size(); ++i) {
        double const t = total[class_of[i]];
        weights[i] = t > 0 ? float(powers[i] / t * (kLeastShare + (1 - present * kLeastShare) * t / all)) : 0.0f;
    }
    world.light_select = make_alias_table(weights);
    if (world.light_select.empty()) world.emitters.clear();
    if (world.emitters.empty())
        world.emitter_pdf.clear();
    else
        world.emitter_pdf.resize(world.triangles.size(), 0.0f);
    for (std::size_t i = 0; i < world.emitters.size(); ++i)
        world.emitter_pdf[world.emitters[i]] = world.light_select.entries[world.lights.size() + i].probability;
    if (!world.light_select.empty() && !world.environment_select.empty())
        world.environment_pdf = world.light_select.entries.back().probability;
}

} // namespace gi
