#include "viewer/devices/gl/surface_renderer.h"

#include "gi/scene/shading/bsdf.h"
#include "viewer/devices/gl/view_matrices.h"

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace viewer {
namespace {

/// Of the scene's radius: what is nearer to a flat mirror is not seen in it.
constexpr float kApart = 1e-4f;

/// Of points relative to the eye, to x, y and w; the target's top row is its first.
glm::mat3 clip_from_world(gi::Camera const& camera, glm::ivec2 size_px)
{
    glm::dmat3 clip_from_pixel(1.0);
    clip_from_pixel[0][0] = 2.0 / size_px.x;
    clip_from_pixel[1][1] = 2.0 / size_px.y;
    clip_from_pixel[2] = gi::dvec3(-1, -1, 1);
    return glm::mat3(clip_from_pixel * pixel_from_world(camera, size_px));
}

/// Corners in clip space of the rectangle that a box covers; none: a part of it is behind the eye.
std::optional<std::pair<glm::vec2, glm::vec2>> box_on(gi::Bounds const& box, glm::vec3 eye, glm::mat3 const& clip)
{
    glm::vec2 low(gi::kInf), high(-gi::kInf);
    for (glm::vec3 const corner : corners_of(box)) {
        glm::vec3 const c = clip * (corner - eye);
        if (!(c.z > 0)) return std::nullopt;
        low = glm::min(low, glm::vec2(c) / c.z);
        high = glm::max(high, glm::vec2(c) / c.z);
    }
    return std::pair(glm::clamp(low, -1.0f, 1.0f), glm::clamp(high, -1.0f, 1.0f));
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
    if (has_scene_ &&
        (meshes_.scene().materials != scene->materials || meshes_.scene().lights.size() != scene->lights.size()))
        is_ready_ = false;
    if (!has_scene_ || meshes_.scene().world != scene->world || meshes_.scene().materials != scene->materials) {
        planar_.take(*scene);
        has_drawn_mirrors_ = false;
    }
    has_scene_ = true;
    shadows_.take(*scene);
    meshes_.take(std::move(scene));
}

void SurfaceRenderer::move(gi::Pose const& pose)
{
    auto const now = gi::moved_to(meshes_.scene(), pose);
    meshes_.move(*now);
    planar_.move(*now);
}

bool SurfaceRenderer::takes_part(SurfaceKind const& kind, Pass pass)
{
    bool const blended = kind.alpha == gi::AlphaMode::blend;
    return pass == Pass::described ? !blended : pass == Pass::blended ? blended : kind.mirror && !blended;
}

GlProgram& SurfaceRenderer::program(SurfaceKind const& kind, Pass pass)
{
    std::string const defines = fmt::format(
        "#define MASKED {}\n#define MAPS {}\n#define COLORS {}\n#define ALPHAS {}\n#define MIRROR {}\n#define "
        "EMITS {}\n#define "
        "MOVES {}\n"
        "#define SMOOTH_ALPHA {:.9e}\n#define SHADOW_MAPS 0\n#define SEARCHES 1\n#define TILE {}\n#define "
        "PUNCTUAL {}\n#define PLANAR "
        "{}\n",
        int(kind.alpha == gi::AlphaMode::mask), kind.maps, int(meshes_.has_colors()),
        int(kind.alpha != gi::AlphaMode::opaque && meshes_.has_alphas()),
        int(pass == Pass::mirrors || pass == Pass::planar || (pass == Pass::described && kind.mirror)),
        int(kind.emits), int(kind.moves && pass == Pass::described), gi::kSmoothAlpha, PictureTexture::kTile,
        pass == Pass::blended ? shadows_.lights().size() : 0, int(pass == Pass::planar));
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
        : pass == Pass::planar
            ? GlProgram({"surfaces.vert"}, {kMaterial, kShading, "surface_mirror.frag"}, defines)
            : GlProgram({"surfaces.vert"},
                        {kMaterial, kShading, kPacking, "surface_light.glsl", "surface_punctual.glsl",
                         "surface_blended.frag"},
                        defines);
    return programs_.emplace(key, std::move(made)).first->second;
}

GlProgram const& SurfaceRenderer::punctual(std::size_t light)
{
    std::pair const key(light, shadows_.maps(light));
    auto const at = punctual_.find(key);
    if (at != punctual_.end()) return at->second;
    std::string const defines =
        fmt::format("#define EMITS 1\n#define PUNCTUAL 0\n#define LIGHT {}\n#define SHADOW_MAPS {}\n"
                    "#define SMOOTH_ALPHA {:.9e}\n",
                    light, key.second, gi::kSmoothAlpha);
    return punctual_
        .emplace(key,
                 GlProgram({"full_screen.vert"},
                           {"surface_packing.glsl", "surface_punctual.glsl", "surface_punctual.frag"}, defines))
        .first->second;
}

bool SurfaceRenderer::prepare(double most_s)
{
    if (!has_scene_) return false;
    if (is_ready_) return true;
    if (!meshes_.upload(most_s)) return false;
    if (!shadows_.prepare(meshes_, eye_)) return false;
    std::size_t const compiled = programs_.size();
    for (std::size_t m = 0; m < meshes_.meshes(); ++m)
        for (SurfaceBatch const& b : meshes_.batches(m)) {
            for (Pass const pass : {Pass::described, Pass::mirrors, Pass::planar, Pass::blended})
                if (takes_part(b.kind, pass) && programs_.size() == compiled) program(b.kind, pass); // one a step
        }
    if (programs_.size() > compiled) return false;
    constexpr char const *kPlace = "full_screen.vert", *kPacking = "surface_packing.glsl",
                         *kLight = "surface_light.glsl", *kEmits = "#define EMITS 1\n";
    if (found_.empty())
        for (char const* step : {"#define STEP 0\n#define FADES 0\n", "#define STEP 1\n#define FADES 0\n",
                                 "#define STEP 0\n#define FADES 1\n"})
            found_.emplace_back(
                GlProgram({kPlace}, {kPacking, kLight, "surface_found.frag"}, std::string(kEmits) + step));
    for (int step = 0; lit_.size() < 2; ++step)
        lit_.emplace_back(GlProgram({kPlace}, {kPacking, kLight, "surface_lit.frag"},
                                    kEmits + fmt::format("#define STEP {}\n", step)));
    for (std::size_t k = 0; k < shadows_.lights().size(); ++k) punctual(k);
    if (!sky_) sky_.emplace(GlProgram({"full_screen.vert"}, {"sky.frag"}));
    is_ready_ = true;
    return true;
}

/// Distances along the axis of the places of a box; none: no place is seen. 0 where it is infinite.
std::optional<SurfaceRenderer::DepthRange> SurfaceRenderer::seen_depths(gi::Bounds const& box, Eye const& eye)
{
    if (!(box.high.x < gi::kInf)) return DepthRange{};
    // Most that a linear function reaches in the box, relative to the eye.
    auto const most = [&](glm::vec3 f) {
        return glm::dot(glm::max(f * (box.low - eye.at), f * (box.high - eye.at)), glm::vec3(1));
    };
    glm::mat3 const rows = glm::transpose(eye.clip_from_world);
    glm::vec3 const x = rows[0], y = rows[1], w = rows[2], kept(eye.kept);
    for (glm::vec3 const edge : {w, x - eye.low.x * w, eye.high.x * w - x, y - eye.low.y * w, eye.high.y * w - y})
        if (!(most(edge) > 0)) return std::nullopt;
    if (kept != glm::vec3(0) && !(most(kept) > eye.kept.w - glm::dot(kept, eye.at))) return std::nullopt;
    return DepthRange{std::max(0.0f, -most(-w)), most(w)};
}

/// Clusters that may be seen. What is near is drawn first, for it hides much; what is blended, last.
std::vector<SurfaceRenderer::Seen> SurfaceRenderer::seen_clusters(Pass pass, Eye const& eye) const
{
    std::vector<Seen> seen;
    for (std::size_t m = 0; m < meshes_.meshes(); ++m)
        for (SurfaceBatch const& b : meshes_.batches(m)) {
            if (!takes_part(b.kind, pass)) continue;
            for (SurfaceCluster const& c : b.part->clusters) {
                auto const depths = seen_depths(c.bounds, eye);
                if (!depths) continue;
                // Layers a quarter as deep as they are far away, of which each has surfaces of one material together.
                float const layer = std::floor(3 * std::log2(std::max(depths->farthest, 1e-30f)));
                seen.push_back({pass == Pass::blended ? -depths->nearest : layer, m, &b, c.triangles});
            }
        }
    std::ranges::stable_sort(seen, {}, &Seen::order);
    return seen;
}

void SurfaceRenderer::draw_batches(Pass pass, Eye const& eye)
{
    GlProgram const* last = nullptr;
    Seen const* before = nullptr;
    for (Seen const& seen : seen_clusters(pass, eye)) {
        GlProgram const& p = program(seen.batch->kind, pass);
        if (&p != last) {
            last = &p;
            p.use();
            p.set("clip_from_world", eye.clip_from_world);
            p.set("eye", eye.at);
            p.set("kept", eye.kept);
            p.set("nearest_m", nearest_m());
            if (pass == Pass::described) {
                set_moved_box(p);
                p.set("in_mirror", eye.in_mirror ? 1.0f : 0.0f);
            }
            if (pass == Pass::blended) {
                bind_light(p, eye);
                shadows_.bind();
            }
            if (pass == Pass::mirrors) {
                p.set("a_from_b", maps_.a_from_b);
                p.set("b_in_a", maps_.b_in_a);
                p.set("nearest", nearest_);
            }
            if (pass == Pass::planar) {
                p.set("mirror_plane", plane_);
                p.set("mirror_tolerance", gi::PlanarMirrors::kFlat * meshes_.scene().radius_m);
            }
        }
        if (before == nullptr || before->mesh != seen.mesh) meshes_.bind_mesh(seen.mesh);
        if (before == nullptr || before->batch != seen.batch) meshes_.bind_material(seen.batch->part->material);
        SceneMeshes::draw(seen.triangles);
        before = &seen;
    }
}

/// Of depths, as SeenSurfaces.
float SurfaceRenderer::nearest_m() const
{
    constexpr float kShare = 1e-5f; // of the scene's radius
    return kShare * std::max(meshes_.scene().radius_m, 1e-30f);
}

void SurfaceRenderer::bind_light(GlProgram const& program, Eye const& eye) const
{
    glm::mat3 const world_from_clip = glm::inverse(eye.clip_from_world);
    SeenPart seen{eye.at, {}, meshes_.moved_bounds(), eye.in_mirror};
    for (std::size_t k = 0; k < seen.edges.size(); ++k)
        seen.edges[k] = world_from_clip * glm::vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, 1);
    ring_.bind(program, eye.head, seen);
}

void SurfaceRenderer::set_moved_box(GlProgram const& program) const
{
    gi::Bounds const& box = meshes_.moved_bounds();
    if (box.empty()) return;
    program.set("moved_low", box.low);
    program.set("moved_size", glm::max(box.high - box.low, glm::vec3(1e-30f)));
}

void SurfaceRenderer::draw_sky(Eye const& eye)
{
    gi::ShownScene const& scene = meshes_.scene();
    if ((scene.background.kind != gi::BackgroundKind::map && !eye.in_mirror) || meshes_.environment() == 0) return;
    float const c = scene.environment_cos, s = scene.environment_sin;
    glm::mat3 const map_from_world(glm::vec3(c, 0, s), glm::vec3(0, 1, 0), glm::vec3(-s, 0, c));
    sky_->use();
    sky_->set("map_from_pixel", map_from_world * eye.world_from_pixel);
    sky_->set("scale", scene.environment_scale);
    glBindTextureUnit(3, meshes_.environment());
    glBindVertexArray(no_vertices_.id());
    glDepthFunc(GL_EQUAL);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

SurfaceRenderer::Eye SurfaceRenderer::eye_of(int head, gi::Camera const& camera, glm::ivec2 size_px) const
{
    Eye eye;
    eye.head = head;
    eye.clip_from_world = clip_from_world(camera, size_px);
    eye.at = glm::vec3(gi::dvec3(camera.world_from_camera[3]) - meshes_.scene().world->origin);
    eye.world_from_pixel = glm::mat3(axes_of(camera) * frame_from_pixel(camera, size_px));
    return eye;
}

/// Behind a mirror, of which it keeps what is more than `apart` before it.
SurfaceRenderer::Eye SurfaceRenderer::mirrored(Eye const& eye, gi::PlanarMirror const& mirror, float apart)
{
    float const before = glm::dot(mirror.normal, eye.at) - mirror.distance_m, side = before < 0 ? -1.0f : 1.0f;
    glm::vec3 const n = mirror.normal;
    glm::mat3 const reflect = glm::mat3(1) - 2.0f * glm::outerProduct(n, n);
    Eye behind = eye;
    behind.clip_from_world = eye.clip_from_world * reflect;
    behind.at = eye.at - 2 * before * n;
    behind.world_from_pixel = reflect * eye.world_from_pixel;
    behind.kept = glm::vec4(side * n, side * mirror.distance_m + apart);
    behind.in_mirror = true;
    return behind;
}

void SurfaceRenderer::fit(Target& to, glm::ivec2 size_px)
{
    if (to.color && to.color->shown().size_px == size_px) return;
    to.described.emplace(TextureTarget::Format::words, size_px);
    to.found.emplace(TextureTarget::Format::words, (size_px + 1) / 2);
    to.color.emplace(TextureTarget::Format::linear, size_px);
    to.depth = texture_2d(GL_DEPTH_COMPONENT32F, size_px, GL_NEAREST);
    for (auto const* target : {&to.described, &to.color})
        glNamedFramebufferTexture((*target)->target().framebuffer, GL_DEPTH_ATTACHMENT, to.depth.id(), 0);
    to.lit_steps = texture_2d(GL_DEPTH_COMPONENT16, size_px, GL_NEAREST);
    to.found_steps = texture_2d(GL_DEPTH_COMPONENT16, (size_px + 1) / 2, GL_NEAREST);
    to.lighting = GlObject(GlObject::Kind::framebuffer);
    glNamedFramebufferTexture(to.lighting.id(), GL_COLOR_ATTACHMENT0, to.color->shown().texture, 0);
    glNamedFramebufferTexture(to.lighting.id(), GL_DEPTH_ATTACHMENT, to.lit_steps.id(), 0);
    glNamedFramebufferTexture(to.found->target().framebuffer, GL_DEPTH_ATTACHMENT, to.found_steps.id(), 0);
}

/// A pass over what the first one has described.
void SurfaceRenderer::light_up(GlProgram const& program, Eye const& eye, Target const& to) const
{
    program.use();
    program.set("eye", eye.at);
    program.set("world_from_pixel", eye.world_from_pixel);
    set_moved_box(program);
    program.set("nearest_m", nearest_m());
    glBindTextureUnit(4, to.described->shown().texture);
    glBindTextureUnit(12, to.depth.id());
    glBindVertexArray(no_vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Surfaces and what is behind them, without mirrors and blended surfaces. Leaves the target of colours bound.
void SurfaceRenderer::draw_lit(Eye const& eye, Target const& to, Part const& part)
{
    gi::ShownScene const& scene = meshes_.scene();
    float const far = 0;
    auto const begin = [](DrawTarget const& target, Part const& p) {
        bind(target);
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_SCISSOR_TEST);
        glScissor(p.low_px.x, p.low_px.y, p.size_px.x, p.size_px.y);
    };
    begin(to.described->target(), part);
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(to.described->target().framebuffer, GL_DEPTH, 0, &far);
    glDepthFunc(GL_GREATER);
    draw_batches(Pass::described, eye);

    glm::ivec2 const half_low = part.low_px / 2, half_size = (part.low_px + part.size_px) / 2 + 1 - half_low;
    begin(to.found->target(), {half_low, half_size});
    light_up_in_steps(found_[ring_.fades() ? 2 : 0], found_[1], eye, to);

    bool const colored = scene.background.kind == gi::BackgroundKind::color && !eye.in_mirror; // as the CPU form
    lit_[0].set("behind", colored ? scene.background.color : glm::vec3(0));
    for (std::size_t k = 0; k < 4; ++k) {
        bool const there = k < shadows_.lights().size();
        gi::Light const light = there ? shadows_.lights()[k] : gi::Light{};
        bool const parallel = light.type == gi::LightType::directional;
        glm::vec4 const towards = !there     ? glm::vec4(0)
                                  : parallel ? glm::vec4(-light.direction, 0)
                                             : glm::vec4(light.position, 1);
        lit_[0].set(fmt::format("towards[{}]", k).c_str(), towards);
    }
    glBindTextureUnit(15, to.found->shown().texture);
    begin({to.lighting.id(), {0, 0}, to.color->shown().size_px}, part);
    light_up_in_steps(lit_[0], lit_[1], eye, to);
    shadows_.bind();
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_ONE);
    for (std::size_t k = 0; k < shadows_.lights().size(); ++k) light_up(punctual(k), eye, to);
    glDisable(GL_BLEND);

    begin(to.color->target(), part);
    draw_sky(eye);
}

/// All pixels in the first step, those with a greater depth than 0.75 after it in the second.
void SurfaceRenderer::light_up_in_steps(GlProgram const& first, GlProgram const& second, Eye const& eye,
                                        Target const& to) const
{
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_ALWAYS);
    bind_light(first, eye);
    light_up(first, eye, to);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LESS);
    glDepthRangef(0.75f, 0.75f);
    bind_light(second, eye);
    light_up(second, eye, to);
    glDepthRangef(0, 1);
}

void SurfaceRenderer::draw_blended(Eye const& eye)
{
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthFunc(GL_GREATER);
    draw_batches(Pass::blended, eye);
    glDisable(GL_BLEND);
}

/// What flat mirrors show, from behind them; the largest ones of the picture.
void SurfaceRenderer::draw_mirrors(Eye const& eye, Target const& to, glm::ivec2 size_px)
{
    float const apart = kApart * std::max(meshes_.scene().radius_m, 1e-30f);
    struct InPicture {
        gi::PlanarMirror const* mirror;
        Part part;
    };
    std::vector<InPicture> seen;
    for (gi::PlanarMirror const& m : planar_.all()) {
        bool const is_seen =
            std::abs(glm::dot(m.normal, eye.at) - m.distance_m) > apart && seen_depths(m.bounds, eye).has_value();
        if (!is_seen && has_drawn_mirrors_) continue;
        glm::ivec2 low(0), high = is_seen ? size_px : glm::ivec2(1);
        if (auto const box = is_seen ? box_on(m.bounds, eye.at, eye.clip_from_world) : std::nullopt) {
            glm::vec2 const px = 0.5f * glm::vec2(size_px);
            low = glm::clamp(glm::ivec2(glm::floor((box->first + 1.0f) * px)), glm::ivec2(0), size_px);
            high = glm::clamp(glm::ivec2(glm::ceil((box->second + 1.0f) * px)), glm::ivec2(0), size_px);
        }
        if (high.x > low.x && high.y > low.y) seen.push_back({&m, {low, high - low}});
    }
    auto const pixels = [](InPicture const& s) { return std::int64_t(s.part.size_px.x) * s.part.size_px.y; };
    std::ranges::sort(seen, [&](InPicture const& a, InPicture const& b) { return pixels(a) > pixels(b); });
    if (seen.size() > gi::PlanarMirrors::kMostDrawn) seen.resize(gi::PlanarMirrors::kMostDrawn);
    has_drawn_mirrors_ = true;
    for (InPicture const& s : seen) {
        fit(mirror_image_, size_px);
        Eye behind = mirrored(eye, *s.mirror, apart);
        glm::vec2 const px(size_px);
        behind.low = 2.0f * glm::vec2(s.part.low_px) / px - 1.0f;
        behind.high = 2.0f * glm::vec2(s.part.low_px + s.part.size_px) / px - 1.0f;
        plane_ = glm::vec4(s.mirror->normal, s.mirror->distance_m);
        glEnable(GL_CLIP_DISTANCE0);
        glFrontFace(GL_CW);
        draw_lit(behind, mirror_image_, s.part);
        draw_blended(behind);
        glFrontFace(GL_CCW);
        glDisable(GL_CLIP_DISTANCE0);
        glBindFramebuffer(GL_FRAMEBUFFER, to.color->target().framebuffer);
        glBindTextureUnit(0, mirror_image_.color->shown().texture);
        glBindTextureUnit(15, mirror_image_.found->shown().texture);
        glDepthFunc(GL_EQUAL);
        draw_batches(Pass::planar, eye);
        glDisable(GL_SCISSOR_TEST);
    }
}

ShownPicture SurfaceRenderer::draw(int view, int head, gi::Camera const& camera, glm::ivec2 size_px,
                                   PictureTexture const& picture, gi::Camera const& of, ViewPart part)
{
    Target& to = targets_[{view, part}];
    fit(to, size_px);
    Eye const eye = eye_of(head, camera, size_px);
    eye_ = eye.at;
    shadows_.update(meshes_, eye_);
    maps_ = reprojection_maps(of, picture.shown().size_px, camera, size_px);
    bool const searches = picture.around() != 0 && std::isfinite(picture.nearest_m());
    if (!searches) maps_.b_in_a = glm::vec3(0);
    nearest_ = searches ? 1 / picture.nearest_m() : 0;
    ReversedDepth const state;
    draw_lit(eye, to, {glm::ivec2(0), size_px});
    glBindTextureUnit(0, picture.shown().texture);
    glBindTextureUnit(1, searches ? picture.around() : picture.shown().texture);
    glDepthFunc(GL_EQUAL);
    draw_batches(Pass::mirrors, eye);
    draw_mirrors(eye, to, size_px);
    draw_blended(eye);
    return to.color->shown();
}

ShownDepth SurfaceRenderer::depth(int view, ViewPart part) const
{
    auto const at = targets_.find({view, part});
    if (at == targets_.end()) return {};
    return {at->second.depth.id(), false, 1 / nearest_m()};
}

LightSources SurfaceRenderer::light_sources(int view) const
{
    auto const at = targets_.find({view, ViewPart::whole});
    if (at == targets_.end()) return {};
    ShownPicture const found = at->second.found->shown();
    LightSources s{found.size_px, std::vector<LightSource>(std::size_t(found.size_px.x * found.size_px.y))};
    std::vector<glm::uvec4> words(s.sources.size());
    glGetTextureImage(found.texture, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                      GLsizei(words.size() * sizeof(glm::uvec4)), words.data());
    glm::ivec2 const size = at->second.color->shown().size_px;
    std::vector<float> alphas(std::size_t(size.x * size.y));
    glGetTextureImage(at->second.color->shown().texture, 0, GL_ALPHA, GL_FLOAT,
                      GLsizei(alphas.size() * sizeof(float)), alphas.data());
    constexpr float kOfMirrors = 2; // surface_mirror.frag adds it
    for (std::size_t k = 0; k < words.size(); ++k) {
        std::size_t const width = std::size_t(found.size_px.x);
        float const alpha = alphas[2 * (k / width) * std::size_t(size.x) + 2 * (k % width)];
        glm::uvec4 const w = words[k];
        s.sources[k] = alpha >= kOfMirrors ? LightSource(int(alpha - kOfMirrors + 0.5f))
                       : (w.w & ~3u) == 0  ? LightSource::no_surface
                                           : LightSource(w.z >> 30); // as surface_found.frag
    }
    return s;
}

} // namespace viewer
