#include "viewer/devices/gl/scene_meshes.h"

#include "gi/scene/shading/seen_mirror.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <epoxy/gl.h>
#include <span>
#include <system_error>

namespace viewer {
namespace {

/// Of shaders/surface_material.glsl.
struct MaterialBlock {
    glm::vec4 base_color, emission, specular_color, phong_specular, factors, more;
    std::array<glm::vec4, 7> rows, places;
};

std::array<gi::TextureRef const*, 7> maps_of(gi::Material const& m)
{
    return {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map,      &m.emissive_map,
            &m.specular_map,   &m.specular_color_map,     &m.transmission_map};
}

MaterialBlock block_of(gi::Material const& m)
{
    float const r = gi::square((m.ior - 1) / (m.ior + 1));
    MaterialBlock b{{m.base_color, m.alpha},
                    {m.emission, m.double_sided ? 1.0f : 0.0f},
                    {m.specular_color, m.specular},
                    {m.phong_specular, m.model == gi::MaterialModel::phong ? 1.0f : 0.0f},
                    {m.metallic, m.roughness, m.transmission, m.normal_scale},
                    {r, m.alpha_cutoff, std::pow(2 / (m.phong_exponent + 2), 0.25f), 0},
                    {},
                    {}};
    std::array<gi::TextureRef const*, 7> const maps = maps_of(m);
    for (std::size_t k = 0; k < maps.size(); ++k) {
        b.rows[k] = {maps[k]->row_u, maps[k]->row_v};
        b.places[k] = {maps[k]->offset, maps[k]->uv_set, 0};
    }
    return b;
}

SurfaceKind kind_of(gi::Material const& m)
{
    SurfaceKind kind;
    std::array<gi::TextureRef const*, 7> const maps = maps_of(m);
    for (std::size_t k = 0; k < maps.size(); ++k)
        if (maps[k]->texture >= 0) kind.maps |= 1u << k;
    kind.alpha = m.alpha_mode;
    kind.emits = gi::emits(m);
    kind.mirror = gi::may_mirror(gi::make_bsdf(m));
    return kind;
}

gi::Bounds bounds_of(std::span<gi::vec3 const> positions)
{
    gi::Bounds b;
    for (gi::vec3 const& p : positions)
        if (gi::all_finite(p)) b = gi::joined(b, {p, p});
    return b;
}

template <class T>
GlObject buffer_of(T const* data, std::size_t count)
{
    GlObject buffer(GlObject::Kind::buffer);
    if (count > 0) glNamedBufferStorage(buffer.id(), GLsizeiptr(count * sizeof(T)), data, GL_DYNAMIC_STORAGE_BIT);
    return buffer;
}

template <class T>
void put(GlObject const& to, std::vector<T> const& from)
{
    if (!from.empty()) glNamedBufferSubData(to.id(), 0, GLsizeiptr(from.size() * sizeof(T)), from.data());
}

void set_attribute(GlObject const& array, unsigned index, GlObject const& buffer, int floats)
{
    if (buffer.id() == 0) return;
    glVertexArrayVertexBuffer(array.id(), index, buffer.id(), 0, GLsizei(std::size_t(floats) * sizeof(float)));
    glVertexArrayAttribFormat(array.id(), index, floats, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array.id(), index, index);
    glEnableVertexArrayAttrib(array.id(), index);
}

} // namespace

void SceneMeshes::take(std::shared_ptr<gi::ShownScene const> scene)
{
    bool const other = !scene_ || scene_->world != scene->world;
    bool const other_textures = !scene_ || scene_->world->scene != scene->world->scene;
    scene_ = std::move(scene);
    gi::World const& w = *scene_->world;
    if (other) {
        meshes_.clear();
        now_.clear();
        moving_bounds_ = {};
        still_bounds_ = bounds_of({w.positions.data(), w.static_vertices});
        made_ = 0;
        materials_ = nullptr;
        moved_ = nullptr;
        auto const vertices = std::uint32_t(w.positions.size()), triangles = std::uint32_t(w.triangles.size());
        auto const add = [&](std::uint32_t first_vertex, std::uint32_t end_vertex, std::uint32_t first,
                             std::uint32_t end) {
            if (first == end) return;
            Mesh& mesh = meshes_.emplace_back();
            mesh.first_vertex = first_vertex;
            mesh.vertices = end_vertex - first_vertex;
            mesh.moves = first >= w.static_triangles;
        };
        add(0, w.static_vertices, 0, w.static_triangles);
        add(w.static_vertices, vertices, w.static_triangles, triangles);
        order();
    }
    if (other_textures) textures_.begin(w.scene->textures.textures.size());
    if (is_made() && materials_ != scene_->materials) upload_materials();
    if (is_made()) upload_moved();
    if (map_ != scene_->environment) upload_environment();
}

bool SceneMeshes::upload(double most_s)
{
    using Clock = std::chrono::steady_clock;
    auto const begun = Clock::now();
    while (!is_made() || !missing_.empty()) {
        if (made_ < meshes_.size()) {
            make(meshes_[made_++]);
        } else if (orders_.valid()) {
            double const left_s = most_s - std::chrono::duration<double>(Clock::now() - begun).count();
            if (!upload_order(std::max(0.0, left_s))) return false;
            upload_materials();
            upload_moved();
        } else {
            textures_.upload(scene_->world->scene->textures, missing_.back());
            missing_.pop_back();
        }
        if (std::chrono::duration<double>(Clock::now() - begun).count() > most_s) break;
    }
    return is_made() && missing_.empty();
}

/// By a thread of its own, as it takes a second for some millions of triangles.
void SceneMeshes::order()
{
    std::vector<bool> moves;
    for (Mesh const& mesh : meshes_) moves.push_back(mesh.moves);
    std::packaged_task<std::vector<SurfaceOrder>(std::stop_token)> task(
        [scene = scene_, moves = std::move(moves)](std::stop_token const& stop) {
            std::vector<SurfaceOrder> orders;
            for (bool const m : moves) orders.push_back(order_surfaces(*scene, m, stop));
            return orders;
        });
    orders_ = task.get_future();
    auto const shared = std::make_shared<decltype(task)>(std::move(task));
    try {
        ordering_ = std::jthread([shared](std::stop_token const& stop) { (*shared)(stop); });
    } catch (std::system_error const&) { // no more threads
        (*shared)({});
    }
}

/// Returns false if it is still in the making after so long.
bool SceneMeshes::upload_order(double most_s)
{
    if (orders_.wait_for(std::chrono::duration<double>(most_s)) != std::future_status::ready) return false;
    std::vector<SurfaceOrder> orders = orders_.get();
    for (std::size_t k = 0; k < meshes_.size(); ++k) {
        Mesh& mesh = meshes_[k];
        mesh.order = std::move(orders[k]);
        for (gi::uvec3& t : mesh.order.triangles) t -= mesh.first_vertex;
        mesh.indices = buffer_of(mesh.order.triangles.data(), mesh.order.triangles.size());
        glVertexArrayElementBuffer(mesh.array.id(), mesh.indices.id());
        mesh.order.triangles = {};
    }
    return true;
}

void SceneMeshes::make(Mesh& mesh)
{
    gi::World const& w = *scene_->world;
    std::size_t const first = mesh.first_vertex, count = mesh.vertices;
    bool const moves = mesh.moves;
    auto const part = [&](auto const& still, auto const* moved) {
        using T = typename std::decay_t<decltype(still)>::value_type;
        if (still.empty()) return GlObject();
        return buffer_of<T>(moves && moved ? moved->data() : still.data() + first, count);
    };
    gi::ShownScene::Moved const* const m = scene_->moved.get();
    std::vector<gi::vec2> const* const no_uv = nullptr;
    std::vector<gi::vec3> const* const no_colors = nullptr;
    std::vector<float> const* const no_alphas = nullptr;
    mesh.positions = part(w.positions, m ? &m->positions : nullptr);
    mesh.normals = part(w.normals, m ? &m->normals : nullptr);
    mesh.tangents = part(w.tangents, m ? &m->tangents : nullptr);
    mesh.uv0 = part(w.uv0, no_uv);
    mesh.uv1 = part(w.uv1, no_uv);
    mesh.colors = part(w.colors, no_colors);
    mesh.alphas = part(w.alphas, no_alphas);
    mesh.array = GlObject(GlObject::Kind::vertex_array);
    set_attribute(mesh.array, 0, mesh.positions, 3);
    set_attribute(mesh.array, 1, mesh.normals, 3);
    set_attribute(mesh.array, 2, mesh.tangents, 4);
    set_attribute(mesh.array, 3, mesh.uv0, 2);
    set_attribute(mesh.array, 4, mesh.uv1, 2);
    set_attribute(mesh.array, 5, mesh.colors, 3);
    set_attribute(mesh.array, 8, mesh.alphas, 1);
    if (!moves) return;
    mesh.lit_positions = part(w.positions, m ? &m->positions : nullptr);
    mesh.lit_normals = part(w.normals, m ? &m->normals : nullptr);
    set_attribute(mesh.array, 6, mesh.lit_positions, 3);
    set_attribute(mesh.array, 7, mesh.lit_normals, 3);
}

/// Also the kinds of surfaces, which are those of their materials.
void SceneMeshes::upload_materials()
{
    materials_ = scene_->materials;
    gi::World const& w = *scene_->world;
    GLint align = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &align);
    block_step_ = (std::ptrdiff_t(sizeof(MaterialBlock)) + align - 1) / align * align;
    std::vector<std::byte> blocks(materials_->size() * std::size_t(block_step_));
    missing_.clear();
    std::vector<char> wanted(w.scene->textures.textures.size());
    for (std::size_t k = 0; k < materials_->size(); ++k) {
        MaterialBlock const b = block_of((*materials_)[k]);
        std::memcpy(blocks.data() + k * std::size_t(block_step_), &b, sizeof b);
        for (gi::TextureRef const* map : maps_of((*materials_)[k]))
            if (map->texture >= 0) wanted[std::size_t(map->texture)] = 1;
    }
    for (std::size_t k = 0; k < wanted.size(); ++k)
        if (wanted[k] != 0 && textures_.id(k) == 0) missing_.push_back(k);
    blocks_ = buffer_of(blocks.data(), blocks.size());
    for (Mesh& mesh : meshes_) {
        mesh.batches.clear();
        for (SurfacePart const& part : mesh.order.parts) {
            SurfaceKind kind = kind_of((*materials_)[part.material]);
            kind.moves = mesh.moves;
            mesh.batches.push_back({kind, &part});
        }
        std::ranges::stable_sort(mesh.batches, {}, &SurfaceBatch::kind);
    }
}

void SceneMeshes::upload_moved()
{
    if (moved_ == scene_->moved) return;
    moved_ = scene_->moved;
    for (Mesh const& mesh : meshes_) {
        if (!mesh.moves) continue;
        put(mesh.lit_positions, moved_->positions);
        put(mesh.lit_normals, moved_->normals);
    }
    moved_bounds_ = bounds_of(moved_->positions);
    move(*moved_);
}

void SceneMeshes::move(gi::ShownScene::Moved const& now)
{
    for (Mesh const& mesh : meshes_) {
        if (!mesh.moves || mesh.array.id() == 0) continue;
        put(mesh.positions, now.positions);
        put(mesh.normals, now.normals);
        put(mesh.tangents, now.tangents);
    }
    if (now_ == now.positions) return;
    now_ = now.positions;
    moving_bounds_ = bounds_of(now_);
    ++moves_so_far_;
}

void SceneMeshes::upload_environment()
{
    map_ = scene_->environment;
    environment_ = {};
    if (!map_ || map_->radiance.empty()) return;
    glm::ivec2 const size(map_->width, map_->height);
    environment_ = texture_2d(GL_RGB32F, size, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(environment_.id(), 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT, map_->radiance.data());
}

void SceneMeshes::bind_mesh(std::size_t mesh) const { glBindVertexArray(meshes_[mesh].array.id()); }

void SceneMeshes::draw(SurfaceRange range)
{
    glDrawElements(GL_TRIANGLES, GLsizei(3 * range.count), GL_UNSIGNED_INT,
                   reinterpret_cast<void const*>(std::uintptr_t(range.first) * sizeof(gi::uvec3)));
}

void SceneMeshes::bind_material(std::uint32_t material) const
{
    constexpr unsigned kFirstUnit = 5;
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, blocks_.id(), GLintptr(material) * block_step_,
                      GLsizeiptr(sizeof(MaterialBlock)));
    std::array<gi::TextureRef const*, 7> const maps = maps_of((*materials_)[material]);
    for (std::size_t k = 0; k < maps.size(); ++k)
        if (maps[k]->texture >= 0)
            glBindTextureUnit(kFirstUnit + unsigned(k), textures_.id(std::size_t(maps[k]->texture)));
}

} // namespace viewer
