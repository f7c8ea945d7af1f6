#pragma once
// The runtime's swapchain for one eye: a ring of GL textures, of which one at a time is acquired.

#include "viewer/devices/xr/eye_pass.h"
#include "viewer/devices/xr/openxr.h"

#include <vector>

namespace viewer {

/// Best format offered by the runtime for display colours: sRGB-encoded, else linear
/// with more bits. 0 if there is none.
std::int64_t choose_format(std::vector<std::int64_t> const& offered);

class EyeImages {
public:
    /// Throws CallError.
    EyeImages(XrSession session, std::int64_t format, int width, int height);
    ~EyeImages();
    EyeImages(EyeImages const&) = delete;
    EyeImages& operator=(EyeImages const&) = delete;

    /// Acquires an image and waits until the runtime has finished reading it,
    /// at most 0.5 s. False: not yet; call again.
    bool acquire();
    EyePass::Target target() const;
    /// Releases the image, which is shown from now on.
    void release();
    XrSwapchainSubImage shown() const;

private:
    XrSwapchain chain_ = XR_NULL_HANDLE;
    std::vector<XrSwapchainImageOpenGLKHR> images_;
    int width_ = 0, height_ = 0;
    bool is_srgb_ = false, is_acquired_ = false, is_ready_ = false;
    std::uint32_t at_ = 0;
};

} // namespace viewer
