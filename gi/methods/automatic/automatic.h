#pragma once
// The method auto: the plan chooses one by what it costs in this scene, on this device, within this budget.
//
// On a CPU, exact rays: look-ups are cheaper than rays, but pixels share their error, so that at equal time rays leave
// less visible error, and far less after a filter (docs/performance.md). Look-ups are chosen for a single picture if
// building a BVH would take too much of the budget and they are accurate enough in what the camera sees. On a CUDA
// device, whose kernels have no radiance cache: the reference's exact rays, which took half of the time of look-ups.

#include "gi/methods/paths/choose.h"
#include "gi/render/method.h"

namespace gi {

struct AlgorithmChoice {
    PathAlgorithm algorithm;
    PlanText why;
};
/// @param use  structures for frames serve many pictures, so that their build time is ignored
AlgorithmChoice choose_algorithm(World const& world, RenderSettings const& asked, Camera const& camera,
                                 RenderUse use);

/// See Method.
MethodChoice choose_method(World const& world, RenderSettings const& asked, Camera const& camera, RenderUse use);
RenderResult render_auto(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_auto_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);
std::vector<PlanItem> explain_auto(World const& world, RenderSettings const& asked, Camera const& camera);
ExposurePlan auto_exposure(World const& world, RenderSettings const& asked, Camera const& camera, Triangles triangles);
void check_auto_options(std::vector<std::string> const& given, RenderSettings const& settings);

} // namespace gi
