#pragma once
// Embree 4, or 3 where that is not installed: the only place that knows how they differ.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace gi::embree {

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;

inline void begin(Context& context) { rtcInitRayQueryContext(&context); }

inline RTCIntersectArguments for_hits(Context& context)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    return arguments;
}

inline RTCOccludedArguments for_blocks(Context& context)
{
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    return arguments;
}

inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray)
{
    RTCIntersectArguments arguments = for_hits(context);
    rtcIntersect1(scene, &ray, &arguments);
}

inline void intersect(int const* valid, RTCScene scene, Context& context, RTCRayHit16& rays)
{
    RTCIntersectArguments arguments = for_hits(context);
    rtcIntersect16(valid, scene, &rays, &arguments);
}

inline void occluded(RTCScene scene, Context& context, RTCRay& ray)
{
    RTCOccludedArguments arguments = for_blocks(context);
    rtcOccluded1(scene, &ray, &arguments);
}

inline void occluded(int const* valid, RTCScene scene, Context& context, RTCRay16& rays)
{
    RTCOccludedArguments arguments = for_blocks(context);
    rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
using Context = RTCIntersectContext;

inline void begin(Context& context) { rtcInitIntersectContext(&context); }
inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
inline void intersect(int const* valid, RTCScene scene, Context& context, RTCRayHit16& rays)
{
    rtcIntersect16(valid, scene, &context, &rays);
}
inline void occluded(RTCScene scene, Context& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
inline void occluded(int const* valid, RTCScene scene, Context& context, RTCRay16& rays)
{
    rtcOccluded16(valid, scene, &context, &rays);
}
#endif

} // namespace gi::embree
