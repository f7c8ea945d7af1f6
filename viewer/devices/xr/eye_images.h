#pragma once
// The runtime's swapchains for one view, of colours and perhaps of depths: rings of GL textures, of which one at a
// time is acquired.

#include "viewer/devices/xr/eye_pass.h"
#include "viewer/devices/xr/openxr.h"

#include <optional>
#include <vector>

namespace viewer {

/// Best format offered by the runtime for display colours: sRGB-encoded, else linear
/// with more bits. 0 if there is none.
std::int64_t choose_format(std::vector<std::int64_t> const& offered);
/// Best format for depths: floats, else more bits. 0 if there is none.
std::int64_t choose_depth_format(std::vector<std::int64_t> const& offered);

class SwapImages {
public:
    /// Throws CallError. @param use  as what its images are drawn into
    SwapImages(XrSession session, std::int64_t format, XrSwapchainUsageFlags use, int width, int height);
    ~SwapImages();
    SwapImages(SwapImages const&) = delete;
    SwapImages& operator=(SwapImages const&) = delete;

    bool acquire();
    void release();
    unsigned texture() const { return images_.at(at_).image; }
    XrSwapchainSubImage shown() const { return {chain_, {{0, 0}, {width_, height_}}, 0}; }

private:
    XrSwapchain chain_ = XR_NULL_HANDLE;
    std::vector<XrSwapchainImageOpenGLKHR> images_;
    int width_ = 0, height_ = 0;
    bool is_acquired_ = false, is_ready_ = false;
    std::uint32_t at_ = 0;
};

class EyeImages {
public:
    /// Throws CallError. @param depth_format  0 = without depths
    EyeImages(XrSession session, std::int64_t format, std::int64_t depth_format, int width, int height);

    bool has_depths() const { return depths_.has_value(); }
    /// Acquires an image and waits until the runtime has finished reading it,
    /// at most 0.5 s. False: not yet; call again.
    bool acquire();
    EyePass::Target target() const;
    /// Releases the image, which is shown from now on.
    void release();
    XrSwapchainSubImage shown() const { return colors_.shown(); }
    XrSwapchainSubImage shown_depths() const { return depths_->shown(); }

private:
    int width_ = 0, height_ = 0;
    bool is_srgb_ = false;
    SwapImages colors_;
    std::optional<SwapImages> depths_;
};

} // namespace viewer
