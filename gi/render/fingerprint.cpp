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
    if (m.absorption != vec3{0}) h.add(m.absorption); // else as before it was known
    h.add(std::uint64_t(m.model));
    h.add(std::uint64_t(m.alpha_mode));
    h.add(std::uint64_t(m.double_sided) * 2 + std::uint64_t(m.thin));
    for (TextureRef const* t : {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.emissive_map,
                                &m.specular_map, &m.specular_color_map, &m.transmission_map})
        add(h, *t);
}

} // namespace

std::uint64_t fingerprint(World const& world, Camera const& camera, RenderSettings const& s,
                          std::string_view method, std::string_view options)
{
    Hash h;
    for (char const c : method) h.add(std::uint64_t(c));
    h.add_array(world.positions);
    h.add_array(world.normals);
    h.add_array(world.tangents);
    h.add_array(world.uv0);
    h.add_array(world.uv1);
    h.add_array(world.colors);
    if (!world.alphas.empty()) h.add_array(world.alphas);
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
    for (char const c : options) h.add(std::uint64_t(c));
    for (std::uint64_t const v : {std::uint64_t(s.width), std::uint64_t(s.height), std::uint64_t(s.bounces),
                                  s.seed, std::uint64_t(s.filter)})
        h.add(v);
    return h.value();
}

} // namespace gi
