// An OpenXR API layer that adds insets to a runtime without them (XR_VARJO_quad_views): the middle of each eye's view, at
// half of its tangents. The runtime gets them as a second layer before that of the eyes. For tests.

#include "tests/viewer_xr/layers/api_layer.h"

#include <cmath>

namespace {

constexpr XrViewConfigurationType kTwo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
                                  kFour = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;

bool has_insets = false; ///< in the session

XrViewConfigurationType behind(XrViewConfigurationType type) { return type == kFour ? kTwo : type; }

XRAPI_ATTR XrResult XRAPI_CALL configurations(XrInstance i, XrSystemId system, std::uint32_t capacity,
                                              std::uint32_t* count, XrViewConfigurationType* types)
{
    auto const ask = next<PFN_xrEnumerateViewConfigurations>("xrEnumerateViewConfigurations");
    XrResult const result = ask(i, system, capacity > 0 ? capacity - 1 : 0, count, types);
    if (XR_FAILED(result)) return result;
    if (capacity > 0) types[*count] = kFour;
    ++*count;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL configuration_views(XrInstance i, XrSystemId system, XrViewConfigurationType type,
                                                   std::uint32_t capacity, std::uint32_t* count,
                                                   XrViewConfigurationView* views)
{
    auto const ask = next<PFN_xrEnumerateViewConfigurationViews>("xrEnumerateViewConfigurationViews");
    if (type != kFour) return ask(i, system, type, capacity, count, views);
    if (capacity == 0) {
        *count = 4;
        return XR_SUCCESS;
    }
    XrResult const result = ask(i, system, kTwo, 2, count, views);
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
        views[2 + eye] = views[eye];
        views[2 + eye].recommendedImageRectWidth = views[eye].recommendedImageRectWidth / 4 * 3;
    }
    *count = 4;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL blend_modes(XrInstance i, XrSystemId system, XrViewConfigurationType type,
                                           std::uint32_t capacity, std::uint32_t* count,
                                           XrEnvironmentBlendMode* modes)
{
    return next<PFN_xrEnumerateEnvironmentBlendModes>("xrEnumerateEnvironmentBlendModes")(i, system, behind(type),
                                                                                          capacity, count, modes);
}

XRAPI_ATTR XrResult XRAPI_CALL begin_session(XrSession session, XrSessionBeginInfo const* info)
{
    has_insets = info->primaryViewConfigurationType == kFour;
    XrSessionBeginInfo two = *info;
    two.primaryViewConfigurationType = behind(two.primaryViewConfigurationType);
    return next<PFN_xrBeginSession>("xrBeginSession")(session, &two);
}

XRAPI_ATTR XrResult XRAPI_CALL locate_views(XrSession session, XrViewLocateInfo const* info, XrViewState* state,
                                            std::uint32_t capacity, std::uint32_t* count, XrView* views)
{
    auto const locate = next<PFN_xrLocateViews>("xrLocateViews");
    if (info->viewConfigurationType != kFour) return locate(session, info, state, capacity, count, views);
    XrViewLocateInfo two = *info;
    two.viewConfigurationType = kTwo;
    XrResult const result = locate(session, &two, state, 2, count, views);
    auto const half = [](float angle) { return std::atan(0.5f * std::tan(angle)); };
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
        views[2 + eye] = views[eye];
        auto const [left, right, up, down] = views[eye].fov;
        views[2 + eye].fov = {half(left), half(right), half(up), half(down)};
    }
    *count = 4;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL visibility_mask(XrSession session, XrViewConfigurationType type, std::uint32_t view,
                                               XrVisibilityMaskTypeKHR kind, XrVisibilityMaskKHR* mask)
{
    return next<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR")(session, behind(type), view % 2, kind, mask);
}

XRAPI_ATTR XrResult XRAPI_CALL end_frame(XrSession session, XrFrameEndInfo const* info)
{
    auto const end = next<PFN_xrEndFrame>("xrEndFrame");
    if (info->layerCount == 0) return end(session, info);
    auto const& all = *reinterpret_cast<XrCompositionLayerProjection const*>(info->layers[0]);
    if (all.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION || all.viewCount != (has_insets ? 4 : 2))
        return XR_ERROR_VALIDATION_FAILURE;
    if (!has_insets) return end(session, info);
    XrCompositionLayerProjection eyes = all, insets = all;
    eyes.viewCount = insets.viewCount = 2;
    insets.views = all.views + 2;
    XrCompositionLayerBaseHeader const* const layers[] = {
        reinterpret_cast<XrCompositionLayerBaseHeader const*>(&eyes),
        reinterpret_cast<XrCompositionLayerBaseHeader const*>(&insets)};
    XrFrameEndInfo both = *info;
    both.layerCount = 2;
    both.layers = layers;
    return end(session, &both);
}

XRAPI_ATTR XrResult XRAPI_CALL get(XrInstance i, char const* name, PFN_xrVoidFunction* function)
{
    static OwnFunctions const own{
        {"xrEnumerateViewConfigurations", reinterpret_cast<PFN_xrVoidFunction>(&configurations)},
        {"xrEnumerateViewConfigurationViews", reinterpret_cast<PFN_xrVoidFunction>(&configuration_views)},
        {"xrEnumerateEnvironmentBlendModes", reinterpret_cast<PFN_xrVoidFunction>(&blend_modes)},
        {"xrBeginSession", reinterpret_cast<PFN_xrVoidFunction>(&begin_session)},
        {"xrLocateViews", reinterpret_cast<PFN_xrVoidFunction>(&locate_views)},
        {"xrGetVisibilityMaskKHR", reinterpret_cast<PFN_xrVoidFunction>(&visibility_mask)},
        {"xrEndFrame", reinterpret_cast<PFN_xrVoidFunction>(&end_frame)}};
    return get_own_or_next(own, i, name, function);
}

XRAPI_ATTR XrResult XRAPI_CALL create(XrInstanceCreateInfo const* info, LayerCreateInfo const* layer,
                                      XrInstance* made)
{
    return create_next(info, layer, made, XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);
}

} // namespace

extern "C" __attribute__((visibility("default"))) XRAPI_ATTR XrResult XRAPI_CALL
xrNegotiateLoaderApiLayerInterface(NegotiateLoaderInfo const*, char const*, NegotiateLayerRequest* request)
{
    request->interface_version = 1;
    request->api_version = XR_CURRENT_API_VERSION;
    request->get = &get;
    request->create = &create;
    return XR_SUCCESS;
}
