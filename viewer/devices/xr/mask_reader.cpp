#include "viewer/devices/xr/mask_reader.h"

namespace viewer {

MaskReader::MaskReader(Runtime const& runtime, XrSession session) : session_(session), views_(runtime.views())
{
    if (runtime.uses(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME))
        ask_ = runtime.function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
}

void MaskReader::read()
{
    if (!ask_) return;
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
        XrVisibilityMaskKHR mask{};
        mask.type = XR_TYPE_VISIBILITY_MASK_KHR;
        auto const ask = [&] {
            check(ask_(session_, views_, eye, XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask),
                  "xrGetVisibilityMaskKHR");
        };
        ask();
        std::vector<XrVector2f> points(mask.vertexCountOutput);
        std::vector<std::uint32_t> triangles(mask.indexCountOutput);
        if (!points.empty() && !triangles.empty()) {
            mask.vertexCapacityInput = mask.vertexCountOutput;
            mask.indexCapacityInput = mask.indexCountOutput;
            mask.vertices = points.data();
            mask.indices = triangles.data();
            ask();
        }
        HiddenMask& to = masks_[eye];
        to.points.clear();
        for (XrVector2f const p : points) to.points.push_back({p.x, p.y});
        to.triangles = triangles;
    }
}

} // namespace viewer
