#include "viewer/devices/gl/surface_renderer.h"

#include "gi/scene/shading/bsdf.h"
#include "viewer/devices/gl/view_matrices.h"

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr float kNear = 1e-5f; // of the scene's radius, as SeenSurfaces

/// Of points relative to the eye, to x, y and w; the target's top row is its first.
glm::mat3 clip_from_world(gi::Camera const& camera, glm::ivec2 size_px)
{
    glm::dmat3 clip_from_pixel(1.0);
    clip_from_pixel[0][0] = 2.0 / size_px.x;
    clip_from_pixel[1][1] = 2.0 / size_px.y;
    clip_from_pixel[2] = gi::dvec3(-1, -1, 1);
    return glm::mat3(clip_from_pixel * pixel_from_world(camera, size_px));
}

/// Distance along the axis of the nearest place of a box that may be seen; infinite: none is.
float nearest_seen(gi::Bounds const& box, glm::vec3 eye, glm::mat3 const& clip)
{
    if (!(box.high.x < gi::kInf)) return 0;
    // Most that a linear function reaches in the box, relative to the eye.
    auto const most = [&](glm::vec3 f) {
        return glm::dot(glm::max(f * (box.low - eye), f * (box.high - eye)), glm::vec3(1));
    };
    auto const row = [&](int r) { return glm::vec3(clip[0][r], clip[1][r], clip[2][r]); };
    glm::vec3 const x = row(0), y = row(1), w = row(2);
    for (glm::vec3 const edge : {w, w - x, w + x, w - y, w + y})
        if (!(most(edge) > 0)) return gi::kInf;
    return std::max(0.0f, -most(-w));
}

/// Depths from 1 (near) to 0 (infinitely far), while it exists.
struct ReversedDepth {
    ReversedDepth()
    {
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glEnable(GL_DEPTH_TEST);
    }
    ~ReversedDepth()
    {
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
    }
    ReversedDepth(ReversedDepth const&) = delete;
    ReversedDepth& operator=(ReversedDepth const&) = delete;
};

} // namespace

void SurfaceRenderer::take(std::shared_ptr<gi::ShownScene const> scene)
{
    if (!has_scene_ || meshes_.scene().world != scene->world) {
        ring_.clear();
        is_ready_ = false;
    }
    if (has_scene_ && meshes_.scene().materials != scene->materials) is_ready_ = false;
    has_scene_ = true;
    meshes_.take(std::move(scene));
}

bool SurfaceRenderer::takes_part(SurfaceKind const& kind, Pass pass)
{
    bool const blended = kind.alpha == gi::AlphaMode::blend;
    return pass == Pass::described ? !blended : pass == Pass::blended ? blended : kind.mirror && !blended;
}

GlProgram& SurfaceRenderer::program(SurfaceKind const& kind, Pass pass)
{
    std::string const defines = fmt::format(
        "#define MASKED {}\n#define MAPS {}\n#define COLORS {}\n#define MIRROR {}\n#define EMITS {}\n#define "
        "MOVES {}\n"
        "#define SMOOTH_ALPHA {:.9e}\n#define SEARCHES 1\n#define TILE {}\n",
        int(kind.alpha == gi::AlphaMode::mask), kind.maps, int(meshes_.has_colors()), int(pass == Pass::mirrors),
        int(kind.emits), int(kind.moves && pass == Pass::described), gi::kSmoothAlpha, PictureTexture::kTile);
    std::string const key = std::to_string(int(pass)) + defines;
    auto const at = programs_.find(key);
    if (at != programs_.end()) return at->second;
    constexpr char const *kMaterial = "surface_material.glsl", *kShading = "surface_shading.glsl",
                         *kPacking = "surface_packing.glsl";
    GlProgram made =
        pass == Pass::described
            ? GlProgram({"surfaces.vert"}, {kMaterial, kShading, kPacking, "surface_described.frag"}, defines)
        : pass == Pass::mirrors
            ? GlProgram({"surfaces.vert"}, {kMaterial, kShading, "reprojection.glsl", "surface_mirror.frag"},
                        defines)
            : GlProgram({"surfaces.vert"},
                        {kMaterial, kShading, kPacking, "surface_light.glsl", "surface_blended.frag"}, defines);
    return programs_.emplace(key, std::move(made)).first->second;
}

bool SurfaceRenderer::prepare(double most_s)
{
    if (!has_scene_) return false;
    if (is_ready_) return true;
    if (!meshes_.upload(most_s)) return false;
    std::size_t const compiled = programs_.size();
    for (std::size_t m = 0; m < meshes_.meshes(); ++m)
        for (SurfaceBatch const& b : meshes_.batches(m)) {
            for (Pass const pass : {Pass::described, Pass::mirrors, Pass::blended})
                if (takes_part(b.kind, pass) && programs_.size() == compiled) program(b.kind, pass); // one a step
        }
    if (programs_.size() > compiled) return false;
    if (!lit_)
        lit_.emplace(GlProgram({"full_screen.vert"},
                               {"surface_packing.glsl", "surface_light.glsl", "surface_lit.frag"},
                               "#define EMITS 1\n"));
    if (!sky_) sky_.emplace(GlProgram({"full_screen.vert"}, {"sky.frag"}));
    is_ready_ = true;
    return true;
}

void SurfaceRenderer::draw_batches(Pass pass, int view, gi::Camera const& camera, glm::ivec2 size_px)
{
    gi::ShownScene const& scene = meshes_.scene();
    glm::mat3 const clip = clip_from_world(camera, size_px);
    glm::vec3 const eye(gi::dvec3(camera.world_from_camera[3]) - scene.world->origin);
    struct Seen {
        float depth;
        SurfaceCluster const* cluster;
    };
    struct SeenBatch {
        float depth; ///< of the nearest cluster
        SurfaceBatch const* batch;
        std::vector<Seen> clusters;
    };
    GlProgram const* last = nullptr;
    for (std::size_t m = 0; m < meshes_.meshes(); ++m) {
        std::vector<SeenBatch> batches;
        for (SurfaceBatch const& b : meshes_.batches(m)) {
            if (!takes_part(b.kind, pass)) continue;
            SeenBatch seen{gi::kInf, &b, {}};
            for (SurfaceCluster const& c : b.clusters)
                if (float const depth = nearest_seen(c.bounds, eye, clip); depth < gi::kInf) {
                    seen.clusters.push_back({depth, &c});
                    seen.depth = std::min(seen.depth, depth);
                }
            // What is near is drawn first, for it hides much; what is blended, last.
            std::ranges::sort(seen.clusters, [&](Seen const& p, Seen const& q) {
                return pass == Pass::blended ? p.depth > q.depth : p.depth < q.depth;
            });
            if (!seen.clusters.empty()) batches.push_back(std::move(seen));
        }
        std::ranges::stable_sort(batches, [&](SeenBatch const& p, SeenBatch const& q) {
            return pass == Pass::blended ? p.depth > q.depth : p.depth < q.depth;
        });
        if (!batches.empty()) meshes_.bind_mesh(m);
        for (SeenBatch const& seen : batches) {
            GlProgram const& p = program(seen.batch->kind, pass);
            if (&p != last) {
                last = &p;
                p.use();
                p.set("clip_from_world", clip);
                p.set("eye", eye);
                p.set("nearest_m", kNear * std::max(scene.radius_m, 1e-30f));
                if (pass == Pass::described) set_moved_box(p);
                if (pass == Pass::blended) ring_.bind(p, view);
                if (pass == Pass::mirrors) {
                    p.set("a_from_b", maps_.a_from_b);
                    p.set("b_in_a", maps_.b_in_a);
                    p.set("nearest", nearest_);
                }
            }
            meshes_.bind_material(seen.batch->material);
            for (Seen const& s : seen.clusters) {
                glDrawElements(
                    GL_TRIANGLES, GLsizei(3 * s.cluster->count), GL_UNSIGNED_INT,
                    reinterpret_cast<void const*>(std::uintptr_t(s.cluster->first) * 3 * sizeof(std::uint32_t)));
            }
        }
    }
}

void SurfaceRenderer::set_moved_box(GlProgram const& program) const
{
    gi::Bounds const& box = meshes_.moved_bounds();
    if (box.empty()) return;
    program.set("moved_low", box.low);
    program.set("moved_size", glm::max(box.high - box.low, glm::vec3(1e-30f)));
}

/// Where a surface is.
void SurfaceRenderer::light(int view, gi::Camera const& camera, glm::ivec2 size_px, TextureTarget const& described)
{
    lit_->use();
    ring_.bind(*lit_, view);
    lit_->set("eye", glm::vec3(gi::dvec3(camera.world_from_camera[3]) - meshes_.scene().world->origin));
    lit_->set("world_from_pixel", glm::mat3(axes_of(camera) * frame_from_pixel(camera, size_px)));
    set_moved_box(*lit_);
    glBindTextureUnit(4, described.shown().texture);
    glBindVertexArray(no_vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void SurfaceRenderer::draw_sky(gi::Camera const& camera, glm::ivec2 size_px)
{
    gi::ShownScene const& scene = meshes_.scene();
    if (scene.background.kind != gi::BackgroundKind::map || meshes_.environment() == 0) return;
    float const c = scene.environment_cos, s = scene.environment_sin;
    glm::dmat3 const map_from_world(gi::dvec3(c, 0, s), gi::dvec3(0, 1, 0), gi::dvec3(-s, 0, c));
    sky_->use();
    sky_->set("map_from_pixel", glm::mat3(map_from_world * axes_of(camera) * frame_from_pixel(camera, size_px)));
    sky_->set("scale", scene.environment_scale);
    glBindTextureUnit(3, meshes_.environment());
    glBindVertexArray(no_vertices_.id());
    glDepthFunc(GL_EQUAL);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

ShownPicture SurfaceRenderer::draw(int view, gi::Camera const& camera, glm::ivec2 size_px,
                                   PictureTexture const& picture, gi::Camera const& of)
{
    Target& to = targets_[view];
    if (!to.color || to.color->shown().size_px != size_px) {
        to.described.emplace(TextureTarget::Format::words, size_px);
        to.color.emplace(TextureTarget::Format::linear, size_px);
        to.depth = texture_2d(GL_DEPTH_COMPONENT32F, size_px, GL_NEAREST);
        for (auto const* target : {&to.described, &to.color})
            glNamedFramebufferTexture((*target)->target().framebuffer, GL_DEPTH_ATTACHMENT, to.depth.id(), 0);
    }
    gi::ShownScene const& scene = meshes_.scene();
    maps_ = reprojection_maps(of, picture.shown().size_px, camera, size_px);
    bool const searches = picture.around() != 0 && std::isfinite(picture.nearest_m());
    if (!searches) maps_.b_in_a = glm::vec3(0);
    nearest_ = searches ? 1 / picture.nearest_m() : 0;
    bind(to.described->target());
    ReversedDepth const state;
    float const far = 0;
    glClearNamedFramebufferfv(to.described->target().framebuffer, GL_DEPTH, 0, &far);
    glDepthFunc(GL_GREATER);
    draw_batches(Pass::described, view, camera, size_px);
    glBindFramebuffer(GL_FRAMEBUFFER, to.color->target().framebuffer);
    glm::vec4 const behind(
        scene.background.kind == gi::BackgroundKind::color ? scene.background.color : glm::vec3(0), 1);
    glClearNamedFramebufferfv(to.color->target().framebuffer, GL_COLOR, 0, &behind.x);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LESS); // than where a surface is
    light(view, camera, size_px, *to.described);
    draw_sky(camera, size_px);
    glBindTextureUnit(0, picture.shown().texture);
    glBindTextureUnit(1, searches ? picture.around() : picture.shown().texture);
    glDepthFunc(GL_EQUAL);
    draw_batches(Pass::mirrors, view, camera, size_px);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthFunc(GL_GREATER);
    draw_batches(Pass::blended, view, camera, size_px);
    return to.color->shown();
}

} // namespace viewer
