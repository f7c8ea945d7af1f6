#pragma once
// The runtime's images for one eye: a ring of GL textures, of which one at a time is ours.

#include "viewer/devices/xr/eye_pass.h"
#include "viewer/devices/xr/openxr.h"

#include <vector>

namespace viewer {

/// The best of what a runtime offers for pictures of finished colours: sRGB code, then linear with more bits. 0
/// where there is none.
std::int64_t choose_format(std::vector<std::int64_t> const& offered);

class EyeImages {
public:
    /// Throws CallError.
    EyeImages(XrSession session, std::int64_t format, int width, int height);
    ~EyeImages();
    EyeImages(EyeImages const&) = delete;
    EyeImages& operator=(EyeImages const&) = delete;

    /// Takes an image and waits until the runtime has read it out, 0.5 s at most. False: not yet; call again.
    bool acquire();
    EyePass::Target target() const;
    /// Gives the image back: it is the one that is shown from now on.
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
