#pragma once
// Reads the hidden-area meshes of both eyes from the runtime.

#include "viewer/devices/xr/frame.h"
#include "viewer/devices/xr/runtime.h"
#include "viewer/protocol/hidden_mask.h"

namespace viewer {

class MaskReader {
public:
    MaskReader(Runtime const& runtime, XrSession session);
    /// Reads them; call when the session begins and when the runtime reports a change. Throws CallError.
    void read();
    HiddenMask const& mask(HmdEye eye) const { return masks_[std::size_t(eye)]; }

private:
    XrSession session_;
    XrViewConfigurationType views_;
    PFN_xrGetVisibilityMaskKHR ask_ = nullptr; ///< null if the runtime does not support it
    std::array<HiddenMask, 2> masks_;
};

} // namespace viewer
