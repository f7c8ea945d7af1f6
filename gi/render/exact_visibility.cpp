#include "gi/render/exact_visibility.h"

#include "gi/core/processor_level.h"
#include "gi/scene/model/used_materials.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

/// Rays per packet. On processors without 16-wide float vectors, Embree splits packets by itself.
constexpr std::size_t kPacket = 16;

struct alignas(64) PacketMask {
    int valid[kPacket];
};

/// Fills a packet with up to kPacket queries.
PacketMask fill(RTCRay16& packet, std::span<RayQuery const> queries)
{
    PacketMask mask;
    for (std::size_t k = 0; k < kPacket; ++k) {
        RayQuery const& q = queries[std::min(k, queries.size() - 1)];
        mask.valid[k] = k < queries.size() ? -1 : 0;
        packet.org_x[k] = q.ray.origin.x;
        packet.org_y[k] = q.ray.origin.y;
        packet.org_z[k] = q.ray.origin.z;
        packet.dir_x[k] = q.ray.direction.x;
        packet.dir_y[k] = q.ray.direction.y;
        packet.dir_z[k] = q.ray.direction.z;
        packet.tnear[k] = q.start;
        packet.tfar[k] = q.reach;
        packet.time[k] = 0;
        packet.mask[k] = 0xffffffffu;
        packet.id[k] = q.seed;
        packet.flags[k] = 0;
    }
    return mask;
}

/// Embree omits triangles that are not finite or too far away, and refitting would not bring them back.
bool usable(vec3 p) { return all_finite(p) && max_component(glm::abs(p)) < 1e18f; }
bool usable(std::span<vec3 const> positions)
{
    return std::ranges::all_of(positions, [](vec3 p) { return usable(p); });
}

/// True if the usable triangles span more than a single point. Embree 3.13 cannot build a scene from two
/// geometries without extent.
bool has_extent(World const& world, std::uint32_t first, std::uint32_t last)
{
    Bounds bounds;
    for (std::uint32_t t = first; t < last; ++t) {
        uvec3 const v = world.triangles[t];
        vec3 const corners[3] = {world.positions[v.x], world.positions[v.y], world.positions[v.z]};
        if (!usable(corners)) continue;
        for (vec3 const p : corners) bounds = joined(bounds, {p, p});
    }
    return !bounds.empty() && bounds.low != bounds.high;
}

} // namespace

void ExactVisibility::nearest(std::span<RayQuery const> queries, std::span<Hit> hits, RayWorld met) const
{
    RTCScene const scene = met == RayWorld::what_stays && still_ ? still_.get() : scene_.get();
    Context context(*this);
    for (std::size_t first = 0; first < queries.size(); first += kPacket) {
        auto const some = queries.subspan(first, std::min(kPacket, queries.size() - first));
        RTCRayHit16 packet;
        PacketMask const mask = fill(packet.ray, some);
        std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
        embree::intersect(mask.valid, scene, context.rtc, packet);
        for (std::size_t k = 0; k < some.size(); ++k)
            hits[first + k] = packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                                  ? Hit{}
                                  : Hit{part_of(packet.hit.instID[0][k])
                                            .world_triangle(packet.hit.geomID[k], packet.hit.primID[k]),
                                        {packet.hit.u[k], packet.hit.v[k]},
                                        packet.ray.tfar[k]};
    }
}

void ExactVisibility::occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked,
                               RayWorld met) const
{
    RTCScene const scene = met == RayWorld::what_stays && still_ ? still_.get() : scene_.get();
    Context context(*this);
    for (std::size_t first = 0; first < queries.size(); first += kPacket) {
        auto const some = queries.subspan(first, std::min(kPacket, queries.size() - first));
        RTCRay16 packet;
        PacketMask const mask = fill(packet, some);
        embree::occluded(mask.valid, scene, context.rtc, packet);
        for (std::size_t k = 0; k < some.size(); ++k) blocked[first + k] = packet.tfar[k] < 0;
    }
}

void ExactVisibility::transmittance(std::span<RayQuery const> queries, std::span<vec3> left, RayWorld met) const
{
    RTCScene const scene = met == RayWorld::what_stays && still_ ? still_.get() : scene_.get();
    for (std::size_t first = 0; first < queries.size(); first += kPacket) {
        auto const some = queries.subspan(first, std::min(kPacket, queries.size() - first));
        Context context(*this);
        RTCRay16 packet;
        PacketMask const mask = fill(packet, some);
        if (panes_)
            for (std::size_t k = 0; k < some.size(); ++k) packet.flags[k] = some[k].to_lamp;
        embree::occluded(mask.valid, scene, context.rtc, packet);
        for (std::size_t k = 0; k < some.size(); ++k) {
            bool const blocked = packet.tfar[k] < 0;
            left[first + k] = vec3{blocked ? 0.0f : 1.0f};
            if (blocked || !context.met_pane || some[k].to_lamp == 0) continue;
            Context alone(*this);
            alone.crossing = &some[k];
            RTCRay16 one;
            PacketMask const only = fill(one, some.subspan(k, 1));
            one.flags[0] = 1;
            embree::occluded(only.valid, scene, alone.rtc, one);
            left[first + k] = alone.crossings.left;
        }
    }
}

ExactVisibility::FilteredHit ExactVisibility::filtered(RTCFilterFunctionNArguments const* a, unsigned i) const
{
    return {part_of(RTCHitN_instID(a->hit, a->N, i, 0))
                .world_triangle(RTCHitN_geomID(a->hit, a->N, i), RTCHitN_primID(a->hit, a->N, i)),
            {RTCHitN_u(a->hit, a->N, i), RTCHitN_v(a->hit, a->N, i)}};
}

void ExactVisibility::coverage_filter(RTCFilterFunctionNArguments const* a)
{
    ExactVisibility const& self = *reinterpret_cast<Context const*>(a->context)->owner;
    for (unsigned i = 0; i < a->N; ++i) {
        if (a->valid[i] == 0) continue;
        FilteredHit const hit = self.filtered(a, i);
        if (!covers(self.world_, hit.triangle, hit.barycentric, RTCRayN_id(a->ray, a->N, i))) a->valid[i] = 0;
    }
}

void ExactVisibility::pane_filter(RTCFilterFunctionNArguments const* a)
{
    coverage_filter(a);
    Context& context = *reinterpret_cast<Context*>(a->context);
    for (unsigned i = 0; i < a->N; ++i) {
        if (a->valid[i] == 0 || RTCRayN_flags(a->ray, a->N, i) == 0) continue;
        a->valid[i] = 0;
        context.met_pane = true;
        if (context.crossing == nullptr) continue;
        FilteredHit const hit = context.owner->filtered(a, i);
        context.crossings.pass(context.owner->world_, *context.crossing, hit.triangle, hit.barycentric);
    }
}

unsigned ExactVisibility::geometry_of(Material const& m) const
{
    if (panes_ && is_pane(m)) return kPane;
    return alpha_tests_ && m.alpha_mode != AlphaMode::opaque ? kCutOut : kOpaque;
}

void ExactVisibility::add_triangles(World const& world, RTCBuffer positions, unsigned geometry_id, bool moves,
                                    Part& part)
{
    std::size_t const count =
        part.triangles[geometry_id].empty() ? part.last - part.first : part.triangles[geometry_id].size();
    RTCGeometry const geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    if (moves) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0, sizeof(vec3),
                         world.positions.size() - part.first_vertex);
    auto* const triangles = static_cast<uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), count));
    if (triangles == nullptr) throw std::bad_alloc();
    for (std::size_t i = 0; i < count; ++i)
        triangles[i] = world.triangles[part.world_triangle(geometry_id, std::uint32_t(i))] - part.first_vertex;
    if (geometry_id != kOpaque && alpha_tests_) rtcSetGeometryIntersectFilterFunction(geometry, coverage_filter);
    if (geometry_id != kOpaque)
        rtcSetGeometryOccludedFilterFunction(geometry, geometry_id == kPane ? pane_filter : coverage_filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(part.scene.get(), geometry, geometry_id);
    rtcReleaseGeometry(geometry);
    part.geometries[geometry_id] = geometry;
}

void ExactVisibility::build(World const& world, bool moves, Part& part)
{
    part.scene.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(part.scene.get(),
                     RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | (moves ? RTC_SCENE_FLAG_DYNAMIC : 0)));
    // Low quality builds one tree per geometry and a tree over those. Each is built well (by surface area), and
    // only the dynamic one is refitted later.
    rtcSetSceneBuildQuality(part.scene.get(), moves ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
    part.first_vertex = std::uint32_t(world.positions.size());
    for (std::vector<std::uint32_t>& t : part.triangles) t.clear();
    for (RTCGeometry& geometry : part.geometries) geometry = nullptr;
    for (std::uint32_t t = part.first; t < part.last; ++t) {
        part.first_vertex =
            std::min({part.first_vertex, world.triangles[t].x, world.triangles[t].y, world.triangles[t].z});
        if (alpha_tests_ || panes_)
            part.triangles[geometry_of(world.materials[world.triangle_material[t]])].push_back(t);
    }
    std::span const positions_now = std::span(world.positions).subspan(part.first_vertex);
    auto const is_used = [](std::vector<std::uint32_t> const& t) { return !t.empty(); };
    bool const several = std::ranges::count_if(part.triangles, is_used) > 1;
    bool const empty = part.first == part.last || (several && !has_extent(world, part.first, part.last));
    part.usable = !empty && usable(positions_now);
    if (!empty) {
        // Embree reads 16 bytes from every vertex, so the last one needs padding.
        RTCBuffer const positions = rtcNewBuffer(device_.get(), (positions_now.size() + 1) * sizeof(vec3));
        if (positions == nullptr) throw std::bad_alloc();
        part.positions = static_cast<vec3*>(rtcGetBufferData(positions));
        std::ranges::copy(positions_now, part.positions);
        bool const all_opaque = std::ranges::none_of(part.triangles, is_used);
        for (unsigned g = kOpaque; g < kGeometries; ++g)
            if (is_used(part.triangles[g]) || (g == kOpaque && all_opaque))
                add_triangles(world, positions, g, moves, part);
        rtcReleaseBuffer(positions);
    }
    BuildStop building(stop_);
    rtcSetSceneProgressMonitorFunction(
        part.scene.get(), [](void* b, double) { return !static_cast<BuildStop*>(b)->given_up(); }, &building);
    rtcCommitScene(part.scene.get());
    rtcSetSceneProgressMonitorFunction(part.scene.get(), nullptr, nullptr);
}

void ExactVisibility::check() const
{
    RTCError const e = rtcGetDeviceError(device_.get());
    if (e == RTC_ERROR_CANCELLED) throw Interrupted();
    if (e != RTC_ERROR_NONE)
        throw std::runtime_error(fmt::format("Embree could not build the scene (error {})", int(e)));
}

namespace {

/// Embree chooses its instructions by the processor; here at most those of this program's level. So processors of that
/// level find the same bits, as far as their approximate reciprocals (RCPPS), from which Embree starts, agree.
std::string embree_settings(int threads)
{
    std::string_view const level = kCompiledLevel;
    std::string settings = fmt::format("threads={}", threads);
    if (level == "x86-64-v4") settings += ",max_isa=avx512";
    if (level == "x86-64-v3") settings += ",max_isa=avx2";
    if (level == "x86-64-v2") settings += ",max_isa=sse4.2";
    return settings;
}

} // namespace

ExactVisibility::ExactVisibility(World const& world, bool alpha_tests, int threads, std::size_t first_moving,
                                 StopRequest const* stop)
    : device_(rtcNewDevice(embree_settings(threads).c_str())),
      stop_(stop),
      world_(view(world)),
      alpha_tests_(alpha_tests),
      panes_(has_panes(world))
{
    if (!device_) throw std::runtime_error("Embree could not be started");
    auto const triangles = std::uint32_t(world.triangles.size());
    parts_[0].last = parts_[1].first = std::uint32_t(std::min<std::size_t>(first_moving, triangles));
    parts_[1].last = triangles;
    build(world, false, parts_[0]);
    check();
    if (parts_[1].first == triangles)
        scene_ = std::move(parts_[0].scene);
    else
        build_moving(world);
    if (parts_[0].scene) still_ = scene_of_parts(1);
    check();
}

ExactVisibility::ScenePointer ExactVisibility::scene_of_parts(unsigned count) const
{
    ScenePointer scene(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    for (unsigned k = 0; k < count; ++k) {
        RTCGeometry const instance = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, parts_[k].scene.get());
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(scene.get(), instance, k);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(scene.get());
    return scene;
}

void ExactVisibility::build_moving(World const& world)
{
    build(world, true, parts_[1]);
    scene_ = scene_of_parts(2);
}

void ExactVisibility::moved(World const& world)
{
    Part& part = parts_[1];
    if (part.first == part.last) return;
    std::span const positions = std::span(world.positions).subspan(part.first_vertex);
    bool const several = std::ranges::count_if(part.geometries, [](RTCGeometry g) { return g != nullptr; }) > 1;
    if (part.usable && usable(positions) && (!several || has_extent(world, part.first, part.last))) {
        std::ranges::copy(positions, part.positions);
        for (RTCGeometry const geometry : part.geometries) {
            if (geometry == nullptr) continue;
            rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
            rtcCommitGeometry(geometry);
        }
        rtcCommitScene(part.scene.get());
        rtcCommitGeometry(rtcGetGeometry(scene_.get(), 1)); // updates the instance's bounds
        rtcCommitScene(scene_.get());
    } else {
        build_moving(world);
    }
    check();
}

} // namespace gi
