#include "gi/reference/exact_visibility.h"

#include "gi/base/error.h"
#include "gi/base/rng.h"
#include "gi/scene/shading_point.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {

void ExactVisibility::coverage_filter(RTCFilterFunctionNArguments const* a)
{
    auto const& world = *reinterpret_cast<Context const*>(a->context)->world;
    for (unsigned i = 0; i < a->N; ++i) {
        if (a->valid[i] == 0) continue;
        std::uint32_t const triangle = RTCHitN_primID(a->hit, a->N, i);
        vec2 const uv{RTCHitN_u(a->hit, a->N, i), RTCHitN_v(a->hit, a->N, i)};
        float const covered = coverage(world, triangle, uv);
        if (covered >= 1) continue;
        std::uint64_t const key = (std::uint64_t(RTCRayN_id(a->ray, a->N, i)) << 32) | triangle;
        float const u = float(mix_bits(key) >> 40) * 0x1p-24f;
        if (u >= covered) a->valid[i] = 0;
    }
}

ExactVisibility::ExactVisibility(World const& world, bool alpha_tests, int threads)
    : device_(rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr)),
      world_(view(world))
{
    if (!device_) throw std::runtime_error("Embree could not be started");
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    if (!world.triangles.empty()) {
        RTCGeometry const geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* const positions = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), world.positions.size()));
        auto* const triangles = static_cast<uvec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), world.triangles.size()));
        if (positions == nullptr || triangles == nullptr) throw std::bad_alloc();
        std::copy(world.positions.begin(), world.positions.end(), positions);
        std::copy(world.triangles.begin(), world.triangles.end(), triangles);
        if (alpha_tests) {
            rtcSetGeometryIntersectFilterFunction(geometry, coverage_filter);
            rtcSetGeometryOccludedFilterFunction(geometry, coverage_filter);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_.get(), geometry, 0);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_.get());
    if (RTCError const e = rtcGetDeviceError(device_.get()); e != RTC_ERROR_NONE)
        throw std::runtime_error(fmt::format("Embree could not build the scene (error {})", int(e)));
}

} // namespace gi
