#pragma once
// Connection to an OpenXR runtime and its headset: instance and system, extensions, clock.

#include "viewer/devices/xr/info.h"
#include "viewer/devices/xr/openxr.h"
#include "viewer/devices/xr/session.h"

#include <string>
#include <vector>

namespace viewer {

/// Graphics path to the runtime; `ask` uses no session and enables every extension known to lightwell.
enum class PicturePath { glx, egl, none, ask };

class Runtime {
public:
    /// Throws InputError if there is no runtime, no headset, or a required extension is missing.
    /// Eye tracking, if it is on, is required.
    explicit Runtime(PicturePath path, HmdOptions const& options = {});
    ~Runtime();
    Runtime(Runtime const&) = delete;
    Runtime& operator=(Runtime const&) = delete;

    XrInstance instance() const { return instance_; }
    XrSystemId system() const { return system_; }
    bool uses(char const* extension) const;
    XrEnvironmentBlendMode blend_mode() const { return blend_mode_; }
    /// Two views, or with insets four.
    XrViewConfigurationType views() const { return views_; }

    /// Conversion between the runtime's clock and seconds of steady_clock.
    double steady_s(XrTime time) const;
    XrTime xr_time(double steady_s) const;

    /// A function of an enabled extension. Throws CallError if it does not exist.
    template <class Function>
    Function function(char const* name) const
    {
        return reinterpret_cast<Function>(pointer(name));
    }

    HmdInfo info;

private:
    PFN_xrVoidFunction pointer(char const* name) const;
    void connect(PicturePath path, HmdOptions const& options);
    void find_headset();

    XrInstance instance_ = XR_NULL_HANDLE;
    XrSystemId system_ = XR_NULL_SYSTEM_ID;
    XrViewConfigurationType views_ = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    XrEnvironmentBlendMode blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    PFN_xrConvertTimespecTimeToTimeKHR to_time_ = nullptr;
    PFN_xrConvertTimeToTimespecTimeKHR from_time_ = nullptr;
};

} // namespace viewer
