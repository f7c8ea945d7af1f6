#include "viewer/devices/xr/eye_images.h"

#include <algorithm>
#include <epoxy/gl.h>

namespace viewer {
namespace {

bool stores_srgb(std::int64_t format) { return format == GL_SRGB8_ALPHA8 || format == GL_SRGB8; }

} // namespace

std::int64_t choose_format(std::vector<std::int64_t> const& offered)
{
    for (std::int64_t const format : {GL_SRGB8_ALPHA8, GL_SRGB8, GL_RGBA16F, GL_RGB10_A2, GL_RGBA8})
        if (std::find(offered.begin(), offered.end(), format) != offered.end()) return format;
    return 0;
}

EyeImages::EyeImages(XrSession session, std::int64_t format, int width, int height)
    : width_(width), height_(height), is_srgb_(stores_srgb(format))
{
    XrSwapchainCreateInfo create{};
    create.type = XR_TYPE_SWAPCHAIN_CREATE_INFO;
    create.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
    create.format = format;
    create.sampleCount = 1;
    create.width = static_cast<std::uint32_t>(width);
    create.height = static_cast<std::uint32_t>(height);
    create.faceCount = 1;
    create.arraySize = 1;
    create.mipCount = 1;
    check(xrCreateSwapchain(session, &create, &chain_), "xrCreateSwapchain");
    try {
        XrSwapchainImageOpenGLKHR empty{};
        empty.type = XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR;
        images_ = list_of(empty, "xrEnumerateSwapchainImages", [&](auto capacity, auto* count, auto* items) {
            return xrEnumerateSwapchainImages(chain_, capacity, count,
                                              reinterpret_cast<XrSwapchainImageBaseHeader*>(items));
        });
    } catch (...) {
        xrDestroySwapchain(chain_);
        throw;
    }
}

EyeImages::~EyeImages() { xrDestroySwapchain(chain_); }

bool EyeImages::acquire()
{
    if (!is_acquired_) check(xrAcquireSwapchainImage(chain_, nullptr, &at_), "xrAcquireSwapchainImage");
    is_acquired_ = true;
    if (is_ready_) return true;
    XrSwapchainImageWaitInfo wait{};
    wait.type = XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO;
    wait.timeout = 500'000'000; // ns
    is_ready_ = check(xrWaitSwapchainImage(chain_, &wait), "xrWaitSwapchainImage") != XR_TIMEOUT_EXPIRED;
    return is_ready_;
}

EyePass::Target EyeImages::target() const { return {images_.at(at_).image, width_, height_, is_srgb_}; }

void EyeImages::release()
{
    check(xrReleaseSwapchainImage(chain_, nullptr), "xrReleaseSwapchainImage");
    is_acquired_ = is_ready_ = false;
}

XrSwapchainSubImage EyeImages::shown() const { return {chain_, {{0, 0}, {width_, height_}}, 0}; }

} // namespace viewer
