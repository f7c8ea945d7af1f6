#include "gi/render/fingerprint.h"

#include "gi/core/rng.h"

#include <bit>
#include <cstring>

namespace gi {
namespace {

class Hash {
public:
    void add(std::uint64_t v) { state_ = mix_bits(state_ ^ (v + 0x9e3779b97f4a7c15ULL)); }
    void add(double v) { add(std::bit_cast<std::uint64_t>(v)); }
    void add(float v) { add(double(v)); }
    void add(vec3 v)
    {
        for (int i = 0; i < 3; ++i) add(v[i]);
    }
    /// Hashes the elements' bytes; only for types without padding.
    template <class T>
    void add_array(std::vector<T> const& v)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        add(std::uint64_t(v.size()));
        auto const* bytes = reinterpret_cast<unsigned char const*>(v.data());
        std::size_t const n = v.size() * sizeof(T);
        for (std::size_t i = 0; i < n; i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + i, std::min<std::size_t>(8, n - i));
            add(word);
        }
    }
    std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0;
};

void add(Hash& h, TextureRef const& t)
{
    h.add(std::uint64_t(std::uint32_t(t.texture)) * 2 + t.uv_set);
    for (vec2 const v : {t.row_u, t.row_v, t.offset}) {
        h.add(v.x);
        h.add(v.y);
    }
}

void add(Hash& h, Texture const& t)
{
    for (std::uint64_t const v :
         {t.first, std::uint64_t(t.width), std::uint64_t(t.height), std::uint64_t(t.wrap_u),
          std::uint64_t(t.wrap_v), std::uint64_t(t.nearest) * 2 + std::uint64_t(t.srgb)})
        h.add(v);
}

void add(Hash& h, Material const& m)
{
    for (vec3 const v : {m.base_color, m.specular_color, m.phong_specular, m.emission}) h.add(v);
    for (float const v : {m.alpha, m.alpha_cutoff, m.metallic, m.roughness, m.specular, m.ior, m.transmission,
                          m.phong_exponent, m.normal_scale})
        h.add(v);
    h.add(std::uint64_t(m.model));
    h.add(std::uint64_t(m.alpha_mode));
    h.add(std::uint64_t(m.double_sided) * 2 + std::uint64_t(m.thin));
    for (TextureRef const* t : {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.emissive_map,
                                &m.specular_map, &m.specular_color_map, &m.transmission_map})
        add(h, *t);
}

} // namespace

std::uint64_t fingerprint(World const& world, Camera const& camera, RenderSettings const& s,
                          std::string_view method)
{
    Hash h;
    for (char const c : method) h.add(std::uint64_t(c));
    h.add_array(world.positions);
    h.add_array(world.normals);
    h.add_array(world.tangents);
    h.add_array(world.uv0);
    h.add_array(world.uv1);
    h.add_array(world.colors);
    for (int i = 0; i < 3; ++i) h.add(world.origin[i]);
    h.add_array(world.triangles);
    h.add_array(world.triangle_material);
    h.add_array(world.scene->textures.texels);
    for (Texture const& t : world.scene->textures.textures) add(h, t);
    for (Material const& m : world.materials) add(h, m);
    for (Light const& l : world.lights) {
        h.add(std::uint64_t(l.type));
        for (vec3 const v : {l.position, l.direction, l.intensity}) h.add(v);
        for (float const v : {l.cos_inner, l.cos_outer, l.range}) h.add(v);
    }
    if (auto const& e = world.environment) {
        h.add(std::uint64_t(e->width));
        h.add_array(e->radiance);
        h.add(world.environment_rotation_rad);
        h.add(world.environment_scale);
    }
    if (Background const& b = world.scene->background; b.kind != BackgroundKind::map) {
        h.add(std::uint64_t(b.kind));
        h.add(b.color);
    }
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) h.add(camera.world_from_camera[c][r]);
    for (double const v : {camera.yfov_rad, camera.ymag_m, double(camera.orthographic)}) h.add(v);
    if (auto const& edge = camera.off_axis)
        for (double const v : {edge->left, edge->right, edge->bottom, edge->top}) h.add(v);
    if (camera.aperture_radius_m > 0)
        for (double const v : {camera.aperture_radius_m, camera.focus_distance_m}) h.add(v);
    if (method.starts_with("slhb")) {
        SlhbSettings const& o = s.slhb;
        for (char const c : o.directions) h.add(std::uint64_t(c));
        for (int const v :
             {int(o.schedule), o.resolution, o.axes, o.fresh_axes, o.light_samples, o.fresh_light_samples,
              o.shadow_resolution, o.most_layers, int(o.packed), o.interleave, int(o.gather), int(o.look_ups),
              int(o.shadows), int(o.cache), int(o.exact.queries), int(o.exact.shadows), int(o.exact.directions)})
            h.add(std::uint64_t(v));
        h.add(o.cone);
        h.add(o.roulette);
    }
    if (method.starts_with("vpl_")) {
        VirtualLightSettings const& o = s.vpl;
        for (char const c : s.slhb.directions) h.add(std::uint64_t(c));
        for (int const v : {s.slhb.resolution, s.slhb.most_layers, o.light_paths, o.points_per_map(), o.point_map})
            h.add(std::uint64_t(v));
        h.add(o.near_m);
        h.add(o.ao_radius_m);
    }
    if (method == "sh_grid") {
        ShGridSettings const& o = s.sh_grid;
        for (int const v : {o.voxels, o.degree, o.directions, o.gather_directions, o.glossy_directions,
                            o.field_shadow_rays, o.field_passes, int(o.field_rays), int(o.radiance_by),
                            int(o.multilevel), int(o.leak_weights), int(o.field_glyphs)})
            h.add(std::uint64_t(v));
        h.add(o.obscurance_m);
    }
    if (!method.starts_with("vpl_") && method != "slhb" && method != "reference") {
        PhotonSettings const& o = s.photons;
        for (char const c : o.impostor_places) h.add(std::uint64_t(c));
        h.add(std::uint64_t(o.impostor_places.size()));
        for (int const v : {o.paths,
                            o.caustic_paths,
                            o.reflections,
                            int(o.rays),
                            int(o.first_bounce),
                            int(o.frozen),
                            int(o.kernel_by),
                            o.propagation_cells,
                            o.propagation_cascades,
                            o.propagation_steps,
                            int(o.reprojection),
                            o.low_cells,
                            o.middle_cells,
                            o.high_cells,
                            o.lattice_cascades,
                            int(o.lattice_smoothing),
                            int(o.irradiance_by),
                            int(o.caustics_by),
                            o.impostors,
                            o.impostor_texels,
                            int(o.impostor_search),
                            o.volume_cells,
                            o.volume_gathers,
                            o.screen_gathers})
            h.add(std::uint64_t(v));
        h.add(o.caustic_radius_m);
        h.add(o.kernel_size);
        if (o.rays == PhotonRays::look_ups) {
            for (char const c : s.slhb.directions) h.add(std::uint64_t(c));
            for (int const v : {s.slhb.resolution, s.slhb.most_layers}) h.add(std::uint64_t(v));
        }
        for (int const v : {s.whitted.recursion, s.whitted.light_samples}) h.add(std::uint64_t(v));
        h.add(s.whitted.cutoff);
    }
    for (std::uint64_t const v : {std::uint64_t(s.width), std::uint64_t(s.height), std::uint64_t(s.bounces),
                                  s.seed, std::uint64_t(s.filter)})
        h.add(v);
    return h.value();
}

} // namespace gi
