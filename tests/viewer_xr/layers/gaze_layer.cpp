// An OpenXR API layer that adds eye tracking to a runtime without it (XR_EXT_eye_gaze_interaction): whoever wears
// the headset looks 10 degrees to the right and 5 degrees up, and blinks for 0.2 s of each second. For tests.

#include "tests/viewer_xr/layers/api_layer.h"

#include <cmath>
#include <numbers>

namespace {

constexpr float kRight_rad = 10 * std::numbers::pi_v<float> / 180, kUp_rad = 5 * std::numbers::pi_v<float> / 180;

XrPath gaze_path = XR_NULL_PATH, gaze_profile = XR_NULL_PATH;
XrAction gaze_action = XR_NULL_HANDLE;
XrSpace gaze_space = XR_NULL_HANDLE;

bool blinks(XrTime time) { return time % 1'000'000'000 < 200'000'000; }

XRAPI_ATTR XrResult XRAPI_CALL get_system_properties(XrInstance i, XrSystemId system, XrSystemProperties* p)
{
    // The runtime does not know the structure of the extension, and passes it over.
    XrResult const result = next<PFN_xrGetSystemProperties>("xrGetSystemProperties")(i, system, p);
    for (auto* at = static_cast<XrBaseOutStructure*>(p->next); at != nullptr; at = at->next)
        if (at->type == XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT)
            reinterpret_cast<XrSystemEyeGazeInteractionPropertiesEXT*>(at)->supportsEyeGazeInteraction = XR_TRUE;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL suggest(XrInstance i, XrInteractionProfileSuggestedBinding const* s)
{
    auto const to_path = next<PFN_xrStringToPath>("xrStringToPath");
    to_path(i, "/interaction_profiles/ext/eye_gaze_interaction", &gaze_profile);
    to_path(i, "/user/eyes_ext/input/gaze_ext/pose", &gaze_path);
    if (s->interactionProfile != gaze_profile)
        return next<PFN_xrSuggestInteractionProfileBindings>("xrSuggestInteractionProfileBindings")(i, s);
    for (std::uint32_t k = 0; k < s->countSuggestedBindings; ++k) {
        if (s->suggestedBindings[k].binding != gaze_path) return XR_ERROR_PATH_UNSUPPORTED;
        gaze_action = s->suggestedBindings[k].action;
    }
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL create_action_space(XrSession session, XrActionSpaceCreateInfo const* info,
                                                   XrSpace* space)
{
    if (gaze_action == XR_NULL_HANDLE || info->action != gaze_action)
        return next<PFN_xrCreateActionSpace>("xrCreateActionSpace")(session, info, space);
    XrReferenceSpaceCreateInfo view{};
    view.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    view.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_VIEW;
    // About y to the left is positive: to the right -10 degrees, then up about x.
    float const y = -0.5f * kRight_rad, x = 0.5f * kUp_rad;
    view.poseInReferenceSpace.orientation = {std::cos(y) * std::sin(x), std::sin(y) * std::cos(x),
                                             -std::sin(y) * std::sin(x), std::cos(y) * std::cos(x)};
    XrResult const result = next<PFN_xrCreateReferenceSpace>("xrCreateReferenceSpace")(session, &view, space);
    gaze_space = *space;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL get_pose_state(XrSession session, XrActionStateGetInfo const* get,
                                              XrActionStatePose* state)
{
    if (gaze_action == XR_NULL_HANDLE || get->action != gaze_action)
        return next<PFN_xrGetActionStatePose>("xrGetActionStatePose")(session, get, state);
    state->isActive = XR_TRUE;
    return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL locate_space(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* location)
{
    auto const locate = next<PFN_xrLocateSpace>("xrLocateSpace");
    if (gaze_space == XR_NULL_HANDLE || space != gaze_space) return locate(space, base, time, location);
    void* const chain = location->next;
    location->next = nullptr;
    XrResult const result = locate(space, base, time, location);
    location->next = chain;
    if (blinks(time)) location->locationFlags = 0;
    for (auto* at = static_cast<XrBaseOutStructure*>(chain); at != nullptr; at = at->next)
        if (at->type == XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT) // a tracker of 120 Hz
            reinterpret_cast<XrEyeGazeSampleTimeEXT*>(at)->time = blinks(time) ? 0 : time - time % 8'333'333;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL get(XrInstance i, char const* name, PFN_xrVoidFunction* function)
{
    static OwnFunctions const own{
        {"xrGetSystemProperties", reinterpret_cast<PFN_xrVoidFunction>(&get_system_properties)},
        {"xrSuggestInteractionProfileBindings", reinterpret_cast<PFN_xrVoidFunction>(&suggest)},
        {"xrCreateActionSpace", reinterpret_cast<PFN_xrVoidFunction>(&create_action_space)},
        {"xrGetActionStatePose", reinterpret_cast<PFN_xrVoidFunction>(&get_pose_state)},
        {"xrLocateSpace", reinterpret_cast<PFN_xrVoidFunction>(&locate_space)}};
    return get_own_or_next(own, i, name, function);
}

XRAPI_ATTR XrResult XRAPI_CALL create(XrInstanceCreateInfo const* info, LayerCreateInfo const* layer,
                                      XrInstance* made)
{
    return create_next(info, layer, made, XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);
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
