#include "viewer/devices/xr/runtime.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr char const* kEglExtension = "XR_MNDX_egl_enable"; // its macro needs EGL's headers

struct KnownExtension {
    char const* name;
    char const* without; ///< consequence if it is missing
    bool glx, egl, none; ///< required for this graphics path
};

constexpr KnownExtension kKnown[] = {
    {XR_KHR_OPENGL_ENABLE_EXTENSION_NAME, "no pictures", true, true, false},
    {kEglExtension, "no pictures without a window", false, true, false},
    {XR_MND_HEADLESS_EXTENSION_NAME, "no use as a tracker only", false, false, true},
    {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME, "its clock is taken to be the system's monotonic one", false,
     false, false},
    {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, "pixels that no eye sees are rendered too", false, false, false},
    {XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME, "it moves pictures to newer poses without their depths", false,
     false, false},
    {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, "the middle of the view has no finer pixels", false, false, false},
    {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME, "gaze cannot be recorded", false, false, false},
};

constexpr char const* kEyeGaze = XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME;
constexpr char const* kWithoutGaze =
    "use a headset with eye tracking, switch it on in its runtime, or go on without gaze";

bool needed(KnownExtension const& e, PicturePath path)
{
    return (path == PicturePath::glx && e.glx) || (path == PicturePath::egl && e.egl) ||
           (path == PicturePath::none && e.none);
}

/// Extensions that a path does not need stay disabled: headless sessions and pictures exclude each other. So does gaze
/// without a wish, for which runtimes may ask the user.
bool wanted(KnownExtension const& e, PicturePath path, HmdOptions const& options)
{
    if (path == PicturePath::ask || needed(e, path)) return true;
    std::string const name = e.name;
    if (name == kEyeGaze) return options.eye_tracking == HmdEyeTracking::on;
    if (name == XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME) return options.depths == HmdDepths::on;
    if (name == XR_VARJO_QUAD_VIEWS_EXTENSION_NAME) return options.insets == HmdInsets::on;
    return !e.glx && !e.egl && !e.none;
}

[[noreturn]] void throw_no_runtime(CallError const& e)
{
    throw gi::InputError(
        "there is no OpenXR runtime", e.what(),
        "start the headset's runtime; if it is not the system default, set XR_RUNTIME_JSON to its JSON file");
}

[[noreturn]] void throw_no_headset(CallError const& e)
{
    throw gi::InputError("the OpenXR runtime has no headset with two eyes", e.what(),
                         "connect it, switch it on and check the runtime's messages");
}

template <std::size_t N>
void copy_text(char (&to)[N], std::string const& from)
{
    std::snprintf(to, N, "%s", from.c_str());
}

char const* name(XrEnvironmentBlendMode mode)
{
    switch (mode) {
    case XR_ENVIRONMENT_BLEND_MODE_OPAQUE:
        return "opaque";
    case XR_ENVIRONMENT_BLEND_MODE_ADDITIVE:
        return "additive";
    case XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND:
        return "alpha blend";
    default:
        return "unknown";
    }
}

} // namespace

Runtime::Runtime(PicturePath path, HmdOptions const& options)
{
    // Silence the loader's own messages on stderr; the exception contains the error.
    setenv("XR_LOADER_DEBUG", "none", 0);
    connect(path, options);
    try {
        find_headset();
    } catch (...) {
        xrDestroyInstance(instance_);
        throw;
    }
}

Runtime::~Runtime() { xrDestroyInstance(instance_); }

void Runtime::connect(PicturePath path, HmdOptions const& options)
{
    try {
        XrExtensionProperties empty{};
        empty.type = XR_TYPE_EXTENSION_PROPERTIES;
        auto const offered =
            list_of(empty, "xrEnumerateInstanceExtensionProperties",
                    [](std::uint32_t capacity, std::uint32_t* count, XrExtensionProperties* items) {
                        return xrEnumerateInstanceExtensionProperties(nullptr, capacity, count, items);
                    });
        std::vector<char const*> names;
        for (KnownExtension const& e : kKnown) {
            bool const is_offered =
                std::any_of(offered.begin(), offered.end(), [&](XrExtensionProperties const& o) {
                    return std::strcmp(o.extensionName, e.name) == 0;
                });
            if (!is_offered && needed(e, path))
                throw gi::InputError(fmt::format("the OpenXR runtime does not offer {}", e.name), e.without,
                                     "use a runtime that has it (Monado does)");
            if (!is_offered && options.eye_tracking == HmdEyeTracking::on && std::strcmp(e.name, kEyeGaze) == 0)
                throw gi::InputError(fmt::format("the OpenXR runtime does not offer {}", e.name), e.without,
                                     kWithoutGaze);
            if (!is_offered) info.extensions_missing.push_back(fmt::format("{} ({})", e.name, e.without));
            if (!is_offered || !wanted(e, path, options)) continue;
            names.push_back(e.name);
            info.extensions_used.push_back(e.name);
        }
        XrInstanceCreateInfo create{};
        create.type = XR_TYPE_INSTANCE_CREATE_INFO;
        copy_text(create.applicationInfo.applicationName, "lightwell");
        copy_text(create.applicationInfo.engineName, "lightwell");
        create.applicationInfo.apiVersion =
            XR_MAKE_VERSION(1, 0, 0); // SteamVR refuses what a newer SDK would ask for
        create.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
        create.enabledExtensionNames = names.data();
        check(xrCreateInstance(&create, &instance_), "xrCreateInstance");
    } catch (CallError const& e) {
        throw_no_runtime(e);
    }
    info.graphics = path == PicturePath::glx ? "GLX" : path == PicturePath::egl ? "EGL" : "";
    if (uses(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME)) {
        to_time_ = function<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
        from_time_ = function<PFN_xrConvertTimeToTimespecTimeKHR>("xrConvertTimeToTimespecTimeKHR");
    }
}

void Runtime::find_headset()
try {
    XrInstanceProperties runtime{};
    runtime.type = XR_TYPE_INSTANCE_PROPERTIES;
    check(xrGetInstanceProperties(instance_, &runtime), "xrGetInstanceProperties");
    info.runtime = fmt::format("{} {}.{}.{}", runtime.runtimeName, XR_VERSION_MAJOR(runtime.runtimeVersion),
                               XR_VERSION_MINOR(runtime.runtimeVersion), XR_VERSION_PATCH(runtime.runtimeVersion));

    XrSystemGetInfo get{};
    get.type = XR_TYPE_SYSTEM_GET_INFO;
    get.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    check(xrGetSystem(instance_, &get, &system_), "xrGetSystem");
    XrSystemProperties properties{};
    properties.type = XR_TYPE_SYSTEM_PROPERTIES;
    XrSystemEyeGazeInteractionPropertiesEXT gaze{};
    gaze.type = XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT;
    if (uses(kEyeGaze)) properties.next = &gaze;
    check(xrGetSystemProperties(instance_, system_, &properties), "xrGetSystemProperties");
    info.system = properties.systemName;
    info.tracks_position = properties.trackingProperties.positionTracking;
    info.tracks_gaze = gaze.supportsEyeGazeInteraction;
    info.tracks_rotation = properties.trackingProperties.orientationTracking;

    if (uses(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME)) {
        auto const offered =
            list_of(views_, "xrEnumerateViewConfigurations", [&](auto capacity, auto* count, auto* items) {
                return xrEnumerateViewConfigurations(instance_, system_, capacity, count, items);
            });
        constexpr auto kQuad = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;
        if (std::find(offered.begin(), offered.end(), kQuad) != offered.end()) views_ = kQuad;
    }
    XrViewConfigurationView empty{};
    empty.type = XR_TYPE_VIEW_CONFIGURATION_VIEW;
    auto const views =
        list_of(empty, "xrEnumerateViewConfigurationViews", [&](auto capacity, auto* count, auto* items) {
            return xrEnumerateViewConfigurationViews(instance_, system_, views_, capacity, count, items);
        });
    bool const has_insets = views_ != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    if (views.size() != (has_insets ? 4 : 2))
        throw CallError("two views of each eye", XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    info.width =
        static_cast<int>(std::max(views[0].recommendedImageRectWidth, views[1].recommendedImageRectWidth));
    info.height =
        static_cast<int>(std::max(views[0].recommendedImageRectHeight, views[1].recommendedImageRectHeight));
    info.widest = static_cast<int>(std::min(views[0].maxImageRectWidth, views[1].maxImageRectWidth));
    info.highest = static_cast<int>(std::min(views[0].maxImageRectHeight, views[1].maxImageRectHeight));
    if (has_insets) {
        info.inset_width =
            static_cast<int>(std::max(views[2].recommendedImageRectWidth, views[3].recommendedImageRectWidth));
        info.inset_height =
            static_cast<int>(std::max(views[2].recommendedImageRectHeight, views[3].recommendedImageRectHeight));
    }

    auto const modes =
        list_of(XR_ENVIRONMENT_BLEND_MODE_OPAQUE, "xrEnumerateEnvironmentBlendModes",
                [&](auto capacity, auto* count, auto* items) {
                    return xrEnumerateEnvironmentBlendModes(instance_, system_, views_, capacity, count, items);
                });
    for (XrEnvironmentBlendMode const mode : modes) info.blend_modes.push_back(name(mode));
    if (!modes.empty()) blend_mode_ = modes.front();
} catch (CallError const& e) {
    throw_no_headset(e);
}

bool Runtime::uses(char const* extension) const
{
    return std::find(info.extensions_used.begin(), info.extensions_used.end(), extension) !=
           info.extensions_used.end();
}

PFN_xrVoidFunction Runtime::pointer(char const* function_name) const
{
    PFN_xrVoidFunction found = nullptr;
    check(xrGetInstanceProcAddr(instance_, function_name, &found), function_name);
    return found;
}

double Runtime::steady_s(XrTime time) const
{
    if (!from_time_) return double(time) * 1e-9;
    timespec t{};
    check(from_time_(instance_, time, &t), "xrConvertTimeToTimespecTimeKHR");
    return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

XrTime Runtime::xr_time(double steady) const
{
    double const whole = std::floor(steady);
    timespec const t{static_cast<std::time_t>(whole), static_cast<long>((steady - whole) * 1e9)};
    if (!to_time_) return XrTime(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
    XrTime time = 0;
    check(to_time_(instance_, &t, &time), "xrConvertTimespecTimeToTimeKHR");
    return time;
}

HmdInfo ask_runtime() { return Runtime(PicturePath::ask).info; }

} // namespace viewer
