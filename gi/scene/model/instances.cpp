#include "gi/scene/model/instances.h"

#include "gi/core/error.h"
#include "gi/core/huge_pages.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gi {
namespace {

bool usable(vec3 p)
{
    return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest; // false for NaN
}

bool has_area(vec3 a, vec3 b, vec3 c)
{
    dvec3 const p(a);
    return glm::cross(dvec3(b) - p, dvec3(c) - p) != dvec3{0};
}

std::uint32_t material_of(World const& world, Mesh const& mesh)
{
    return mesh.material >= 0 ? std::uint32_t(mesh.material) : std::uint32_t(world.scene->materials.size());
}

template <class T>
void copy_or_fill(std::vector<T> const& from, std::vector<T>& to, std::size_t first, std::size_t count, T fill)
{
    if (to.empty()) return;
    if (from.empty())
        std::fill_n(to.begin() + std::ptrdiff_t(first), count, fill);
    else
        std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(first));
}

template <class T>
View<T> part(std::vector<T>& v, std::size_t first, std::size_t count)
{
    return v.empty() ? View<T>{} : View<T>{v.data() + first, count};
}

void grow(Bounds& b, vec3 p)
{
    b.low = glm::min(b.low, p);
    b.high = glm::max(b.high, p);
}

} // namespace

std::vector<Instance> find_instances(Scene const& scene)
{
    Motion const motion = find_motion(scene);
    std::vector<Instance> instances;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::int32_t const m : scene.nodes[n].meshes) {
            Instance& i = instances.emplace_back();
            i.node = n;
            i.mesh = &scene.meshes[std::size_t(m)];
            i.center = center_of(*i.mesh);
            i.why_moving = why_moving(scene, motion, n, *i.mesh);
        }
    std::stable_partition(instances.begin(), instances.end(), [](Instance const& i) { return !i.moves(); });
    std::size_t vertices = 0, triangles = 0;
    for (Instance& i : instances) {
        i.first_vertex = vertices;
        vertices += i.mesh->positions.size();
        triangles += i.mesh->triangles.size();
    }
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (vertices >= kMost || triangles >= kMost)
        throw InputError(fmt::format("the scene has {} vertices and {} triangles", vertices, triangles),
                         "indices have 32 bits", "leave out some instances");
    return instances;
}

void prepare_vertices(World& world, std::vector<Instance> const& instances)
{
    std::size_t vertices = 0, triangles = 0;
    bool normals = false, tangents = false, uv0 = false, uv1 = false, colors = false, alphas = false;
    for (Instance const& i : instances) {
        Mesh const& mesh = *i.mesh;
        vertices += mesh.positions.size();
        triangles += mesh.triangles.size();
        normals |= !mesh.normals.empty();
        tangents |= !mesh.tangents.empty();
        uv0 |= !mesh.uv0.empty();
        uv1 |= !mesh.uv1.empty();
        colors |= !mesh.colors.empty();
        alphas |= !mesh.alphas.empty();
    }
    world.positions.resize(vertices);
    if (normals) resize_on_huge_pages(world.normals, vertices);
    if (tangents) resize_on_huge_pages(world.tangents, vertices);
    if (uv0) resize_on_huge_pages(world.uv0, vertices);
    if (uv1) resize_on_huge_pages(world.uv1, vertices);
    if (colors) resize_on_huge_pages(world.colors, vertices);
    if (alphas) resize_on_huge_pages(world.alphas, vertices);
    world.triangles.reserve(triangles);
    world.triangle_material.reserve(triangles);
    world.instances = std::uint32_t(instances.size());
    for (Instance const& i : instances) {
        Mesh const& mesh = *i.mesh;
        std::size_t const first = i.first_vertex, count = mesh.positions.size();
        copy_or_fill(mesh.normals, world.normals, first, count, vec3{0});
        copy_or_fill(mesh.tangents, world.tangents, first, count, vec4{0});
        copy_or_fill(mesh.uv0, world.uv0, first, count, vec2{0});
        copy_or_fill(mesh.uv1, world.uv1, first, count, vec2{0});
        copy_or_fill(mesh.colors, world.colors, first, count, vec3{1});
        copy_or_fill(mesh.alphas, world.alphas, first, count, 1.0f);
        if (i.moves()) continue;
        ++world.static_instances;
        world.static_vertices += std::uint32_t(count);
    }
}

void deform_into(World& world, Instance const& instance)
{
    std::size_t const first = instance.first_vertex, count = instance.mesh->positions.size();
    deform(*instance.mesh, instance.center, instance.placement,
           {part(world.positions, first, count), part(world.normals, first, count),
            part(world.tangents, first, count)});
}

void append_static_triangles(World& world, Instance& instance, Report& report)
{
    instance.first_triangle = world.triangles.size();
    std::uint64_t not_finite = 0, no_area = 0;
    for (uvec3 const t : instance.mesh->triangles) {
        uvec3 corner = t + std::uint32_t(instance.first_vertex);
        vec3 const a = world.positions[corner.x], b = world.positions[corner.y], c = world.positions[corner.z];
        if (!usable(a) || !usable(b) || !usable(c)) {
            ++not_finite;
        } else if (!has_area(a, b, c)) {
            ++no_area;
        } else {
            if (instance.placement.mirrored) std::swap(corner.y, corner.z);
            world.triangles.push_back(corner);
        }
    }
    world.triangle_material.resize(world.triangles.size(), material_of(world, *instance.mesh));
    world.static_triangles = std::uint32_t(world.triangles.size());
    std::string const where = "mesh '" + instance.mesh->name + "'";
    report.lose("triangles not finite or beyond 1e18 m, skipped", not_finite, where);
    report.lose("triangles without area, skipped", no_area, where);
}

void append_moving_triangles(World& world, Instance& instance)
{
    instance.first_triangle = world.triangles.size();
    world.triangles.resize(world.triangles.size() + instance.mesh->triangles.size());
    world.triangle_material.resize(world.triangles.size(), material_of(world, *instance.mesh));
}

void write_moving_triangles(World& world, Instance& instance)
{
    Mesh const& mesh = *instance.mesh;
    auto const first = std::uint32_t(instance.first_vertex);
    std::vector<bool> bad;
    instance.unusable_vertices = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        vec3& p = world.positions[first + v];
        if (usable(p)) continue;
        if (bad.empty()) bad.resize(mesh.positions.size());
        bad[v] = true;
        p = vec3{0};
        ++instance.unusable_vertices;
    }
    if (bad.empty() && instance.corners_mirrored == instance.placement.mirrored) return;
    instance.corners_mirrored.reset();
    if (bad.empty()) instance.corners_mirrored = instance.placement.mirrored;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        uvec3 corner = mesh.triangles[t];
        if (instance.placement.mirrored) std::swap(corner.y, corner.z);
        if (!bad.empty() && (bad[corner.x] || bad[corner.y] || bad[corner.z])) corner = uvec3{corner.x};
        world.triangles[instance.first_triangle + t] = corner + first;
    }
}

TriangleExtent measure_triangles(World const& world, std::size_t first, std::size_t end)
{
    auto const add = [&](tbb::blocked_range<std::size_t> const& range, TriangleExtent extent) {
        for (std::size_t t = range.begin(); t < range.end(); ++t) {
            uvec3 const corner = world.triangles[t];
            vec3 const a = world.positions[corner.x], b = world.positions[corner.y], c = world.positions[corner.z];
            if (has_area(a, b, c)) {
                for (vec3 const p : {a, b, c}) grow(extent.bounds, p);
            } else {
                ++extent.flat;
            }
        }
        return extent;
    };
    auto const join = [](TriangleExtent a, TriangleExtent const& b) {
        a.bounds = joined(a.bounds, b.bounds);
        a.flat += b.flat;
        return a;
    };
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(first, end, 4096), TriangleExtent{}, add, join);
}

} // namespace gi
