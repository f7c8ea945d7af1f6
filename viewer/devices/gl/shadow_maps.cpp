#include "viewer/devices/gl/shadow_maps.h"

#include "gi/scene/shading/ggx_albedo.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/view_matrices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {
namespace {

constexpr std::size_t kMostFaces = 6; ///< maps of a light: surface_punctual.glsl
/// Beams whose texels would be wider get a second map for what is around the eye, so wide.
constexpr float kWidestTexel_m = 0.02f, kWindow_m = 40;
/// Of a light's cone for one map instead of six, and of what is before a map's plane, relative to the range.
constexpr float kWidestCone_cos = 0.6f, kNear = 1e-3f;

/// Of surface_punctual.glsl.
struct LightBlock {
    glm::vec4 position, direction, intensity, cone, map;
};
struct Block {
    std::array<LightBlock, 4> lights;
    std::array<glm::mat4, 4 * kMostFaces> map_from_world;
};

/// The tables of ggx_albedo.h: sums and grazing shares, x from left to right, roughness from the bottom up; in the last
/// column the means.
GlObject facets_texture()
{
    constexpr int kSide = gi::ggx_tables::kSide;
    std::vector<glm::vec2> texels;
    auto const add = [&](std::uint16_t red, std::uint16_t green) {
        texels.push_back(glm::vec2(red, green) / 65535.0f);
    };
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i)
            add(gi::ggx_tables::sums()[i * kSide + j], gi::ggx_tables::grazing_shares()[i * kSide + j]);
        add(gi::ggx_tables::means()[j], gi::ggx_tables::means()[kSide + j]);
    }
    GlObject texture = texture_2d(GL_RG32F, {kSide + 1, kSide}, GL_LINEAR);
    glTextureSubImage2D(texture.id(), 0, 0, 0, kSide + 1, kSide, GL_RG, GL_FLOAT, texels.data());
    return texture;
}

glm::mat4 facing(glm::vec3 from, glm::vec3 forward)
{
    glm::vec3 const up = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    return glm::lookAt(from, from + forward, up);
}

/// Depths from 0 to 1.
glm::mat4 beam(glm::vec3 direction, gi::Bounds const& all, gi::Bounds const& shown)
{
    glm::mat4 const view = facing(glm::vec3(0), direction);
    auto const seen = [&](gi::Bounds const& b) {
        gi::Bounds s;
        for (glm::vec3 const corner : corners_of(b)) {
            gi::vec3 const p(view * glm::vec4(corner, 1));
            s = gi::joined(s, {p, p});
        }
        return s;
    };
    gi::Bounds const w = seen(shown), d = seen(all);
    float const margin = 1e-3f * glm::length(d.high - d.low) + 1e-6f;
    return glm::orthoRH_ZO(w.low.x - margin, w.high.x + margin, w.low.y - margin, w.high.y + margin,
                           -d.high.z - margin, -d.low.z + margin) *
           view;
}

glm::mat4 cone(glm::vec3 from, glm::vec3 forward, float tangent, gi::Bounds const& all)
{
    float const range = glm::length(glm::max(glm::abs(all.low - from), glm::abs(all.high - from))) + 1e-6f,
                near = kNear * range;
    return glm::frustumRH_ZO(-near * tangent, near * tangent, -near * tangent, near * tangent, near, range) *
           facing(from, forward);
}

glm::vec3 axis(int face)
{
    return glm::vec3(face / 2 == 0, face / 2 == 1, face / 2 == 2) * (face % 2 ? -1.0f : 1.0f);
}

bool is_one_cone(gi::Light const& l) { return l.type == gi::LightType::spot && l.cos_outer > kWidestCone_cos; }

} // namespace

int ShadowMaps::maps_of(gi::Light const& l, bool windowed)
{
    if (l.type == gi::LightType::directional) return windowed ? 2 : 1;
    return is_one_cone(l) ? 1 : 6;
}

void ShadowMaps::take(gi::ShownScene const& scene)
{
    bool const has_others = world_ != scene.world || lights_.size() != scene.lights.size();
    if (!has_others && materials_ == scene.materials) return;
    if (has_others) lights_ = scene.lights;
    world_ = scene.world;
    materials_ = scene.materials;
    is_placed_ = false;
}

void ShadowMaps::light(std::vector<gi::Light> const& lights)
{
    if (lights_ == lights) return;
    bool const same_places = std::ranges::equal(lights_, lights, [](gi::Light a, gi::Light const& b) {
        a.intensity = b.intensity;
        return a == b;
    });
    lights_ = lights;
    if (!same_places || !is_placed_) {
        is_placed_ = false;
        return;
    }
    for (std::size_t k = 0; k < lights_.size(); ++k)
        glNamedBufferSubData(block_.id(), GLintptr(k * sizeof(LightBlock) + offsetof(LightBlock, intensity)),
                             sizeof(glm::vec3), &lights_[k].intensity);
}

void ShadowMaps::place(SceneMeshes const& meshes, glm::vec3 eye)
{
    bool const leaves = window_m_ > 0 && glm::length(eye - middle_) > 0.25f * window_m_;
    if (is_placed_ && !leaves) return;
    is_placed_ = true;
    if (facets_.id() == 0) facets_ = facets_texture();
    gi::Bounds const all = gi::joined(meshes.still_bounds(), meshes.moving_bounds());
    constexpr int kSide_px = 2048;
    bool const wide = glm::length(all.high - all.low) > kWidestTexel_m * float(kSide_px);
    window_m_ = wide && std::ranges::any_of(
                            lights_, [](gi::Light const& l) { return l.type == gi::LightType::directional; })
                    ? kWindow_m
                    : 0;
    middle_ = eye;
    std::size_t count = 0;
    for (gi::Light const& l : lights_) count += std::size_t(maps_of(l, wide));
    int const side = count <= 2 ? kSide_px : count <= 8 ? kSide_px / 2 : kSide_px / 4;
    maps_.assign(count, {});
    if (bool const moves = !meshes.moving_bounds().empty();
        side != side_px_ || int(count) != layers_ || still_.id() == 0 || moves != (shown_.id() != 0)) {
        side_px_ = side;
        layers_ = int(count);
        for (GlObject* const to : {&still_, &shown_}) {
            *to = {};
            if (to == &shown_ && !moves) continue;
            *to = GlObject(GlObject::Kind::texture, GL_TEXTURE_2D_ARRAY);
            glTextureStorage3D(to->id(), 1, GL_DEPTH_COMPONENT32F, side, side, GLsizei(count));
            glTextureParameteri(to->id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            glTextureParameteri(to->id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
            glTextureParameteri(to->id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
            glTextureParameteri(to->id(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
            for (GLenum const wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
                glTextureParameteri(to->id(), wrap, GL_CLAMP_TO_EDGE);
        }
        framebuffer_ = GlObject(GlObject::Kind::framebuffer);
        glNamedFramebufferDrawBuffer(framebuffer_.id(), GL_NONE);
    }
    Block block{};
    std::size_t next = 0;
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        gi::Light const& l = lights_[k];
        int const faces = maps_of(l, wide);
        float texel = 2 / float(side), widest = 0; // of perspective maps, at a distance of 1 m
        for (int f = 0; f < faces; ++f) {
            glm::mat4& m = maps_[next + std::size_t(f)].clip_from_world;
            if (l.type == gi::LightType::directional) {
                gi::Bounds shown = all;
                if (wide && f == 0)
                    shown = {glm::max(all.low, eye - 0.5f * kWindow_m),
                             glm::min(all.high, eye + 0.5f * kWindow_m)};
                if (!glm::all(glm::lessThanEqual(shown.low, shown.high))) shown = all; // the eye is far outside
                m = beam(l.direction, all, shown);
                (f == 0 ? texel : widest) =
                    2 / (float(side) * std::min(glm::length(glm::vec3(m[0][0], m[1][0], m[2][0])),
                                                glm::length(glm::vec3(m[0][1], m[1][1], m[2][1]))));
            } else if (faces == 1) {
                float const tangent = std::sqrt(1 / gi::square(l.cos_outer) - 1) + 1e-3f;
                m = cone(l.position, l.direction, tangent, all);
                texel *= tangent;
            } else {
                m = cone(l.position, axis(f), 1 + 4 / float(side), all);
            }
            block.map_from_world[kMostFaces * k + std::size_t(f)] = m;
        }
        block.lights[k] = {{l.position, float(l.type == gi::LightType::directional)},
                           {l.direction, float(l.type == gi::LightType::spot)},
                           {l.intensity, l.range},
                           {l.cos_inner, l.cos_outer, widest, 0},
                           {float(next), float(faces), texel, 0}};
        next += std::size_t(faces);
    }
    block_ = GlObject(GlObject::Kind::buffer);
    glNamedBufferStorage(block_.id(), GLsizeiptr(sizeof block), &block, GL_DYNAMIC_STORAGE_BIT);
}

bool ShadowMaps::prepare(SceneMeshes const& meshes, glm::vec3 eye)
{
    if (lights_.empty()) return true;
    place(meshes, eye);
    auto const next = std::ranges::find(maps_, false, &Map::is_drawn);
    if (next == maps_.end()) return true;
    draw_still(meshes, std::size_t(next - maps_.begin()));
    return false;
}

void ShadowMaps::update(SceneMeshes const& meshes, glm::vec3 eye)
{
    while (!prepare(meshes, eye)) {
    }
    if (!lights_.empty() && shown_.id() != 0 && (copies_are_old_ || moves_ != meshes.moves_so_far()))
        draw_moving(meshes);
}

void ShadowMaps::draw_still(SceneMeshes const& meshes, std::size_t map)
{
    draw(meshes, map, still_, Part::still);
    maps_[map].is_drawn = true;
    copies_are_old_ = true;
    maps_[map].low_px = glm::ivec2(0); // all of shown_ is to be copied
    maps_[map].high_px = glm::ivec2(side_px_);
}

void ShadowMaps::draw_moving(SceneMeshes const& meshes)
{
    moves_ = meshes.moves_so_far();
    copies_are_old_ = false;
    gi::Bounds const& box = meshes.moving_bounds();
    for (std::size_t k = 0; k < maps_.size(); ++k) {
        Map& map = maps_[k];
        glm::vec2 low(1e9f), high(-1e9f);
        bool behind = false, before = false;
        for (glm::vec3 const corner : corners_of(box)) {
            glm::vec4 const p = map.clip_from_world * glm::vec4(corner, 1);
            (p.w > 1e-6f ? before : behind) = true;
            if (p.w > 1e-6f) {
                glm::vec2 const at = (glm::vec2(p) / p.w * 0.5f + 0.5f) * float(side_px_);
                low = glm::min(low, at);
                high = glm::max(high, at);
            }
        }
        if (behind) {
            low = glm::vec2(0);
            high = glm::vec2(before ? float(side_px_) : 0);
        }
        glm::ivec2 const first = glm::clamp(glm::ivec2(glm::floor(glm::clamp(low, -1e6f, 1e6f))) - 1, 0, side_px_),
                         end = glm::clamp(glm::ivec2(glm::ceil(glm::clamp(high, -1e6f, 1e6f))) + 1, 0, side_px_);
        glm::ivec2 const size = map.high_px - map.low_px;
        if (size.x > 0 && size.y > 0)
            glCopyImageSubData(still_.id(), GL_TEXTURE_2D_ARRAY, 0, map.low_px.x, map.low_px.y, GLint(k),
                               shown_.id(), GL_TEXTURE_2D_ARRAY, 0, map.low_px.x, map.low_px.y, GLint(k), size.x,
                               size.y, 1);
        map.low_px = first;
        map.high_px = end;
        if (end.x > first.x && end.y > first.y) draw(meshes, k, shown_, Part::moving);
    }
}

GlProgram& ShadowMaps::program(SurfaceKind const& kind, bool has_alphas)
{
    bool const tests = kind.alpha != gi::AlphaMode::opaque;
    std::string const defines = fmt::format("#define MASKED {}\n#define MAPS {}\n#define ALPHAS {}\n", int(tests),
                                            tests ? kind.maps & 1u : 0u, int(tests && has_alphas));
    auto const at = programs_.find(defines);
    if (at != programs_.end()) return at->second;
    return programs_
        .emplace(defines, GlProgram({"shadow.vert"}, {"surface_material.glsl", "shadow.frag"}, defines))
        .first->second;
}

void ShadowMaps::draw(SceneMeshes const& meshes, std::size_t map, GlObject const& into, Part part)
{
    glNamedFramebufferTextureLayer(framebuffer_.id(), GL_DEPTH_ATTACHMENT, into.id(), 0, GLint(map));
    viewer::bind(DrawTarget{framebuffer_.id(), {0, 0}, glm::ivec2(side_px_)});
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5f, 2);
    float const far = 1;
    if (part == Part::still) glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &far);
    GlProgram const* last = nullptr;
    for (std::size_t m = 0; m < meshes.meshes(); ++m) {
        if (meshes.moves(m) != (part == Part::moving)) continue;
        meshes.bind_mesh(m);
        for (SurfaceBatch const& b : meshes.batches(m)) {
            GlProgram const& p = program(b.kind, meshes.has_alphas());
            if (&p != last) {
                last = &p;
                p.use();
                p.set("clip_from_world", maps_[map].clip_from_world);
            }
            if (b.kind.alpha != gi::AlphaMode::opaque) meshes.bind_material(b.part->material);
            meshes.draw(b.part->triangles);
        }
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_CLAMP);
    glDisable(GL_DEPTH_TEST);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

void ShadowMaps::bind() const
{
    if (lights_.empty()) return;
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, block_.id());
    glBindTextureUnit(1, facets_.id());
    glBindTextureUnit(13, shown_.id() != 0 ? shown_.id() : still_.id());
}

} // namespace viewer
