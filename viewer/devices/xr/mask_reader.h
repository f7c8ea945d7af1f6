#pragma once
// Asks the runtime for the hidden triangles of both eyes.

#include "viewer/devices/xr/frame.h"
#include "viewer/devices/xr/runtime.h"
#include "viewer/protocol/hidden_mask.h"

namespace viewer {

class MaskReader {
public:
    MaskReader(Runtime const& runtime, XrSession session);
    /// Again, when the session begins and when the runtime says that they changed. Throws CallError.
    void read();
    HiddenMask const& mask(HmdEye eye) const { return masks_[std::size_t(eye)]; }

private:
    XrSession session_;
    PFN_xrGetVisibilityMaskKHR ask_ = nullptr; ///< null where the runtime does not have it
    std::array<HiddenMask, 2> masks_;
};

} // namespace viewer
