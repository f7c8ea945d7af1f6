#include "viewer/devices/xr/eye_images.h"

#include <algorithm>
#include <epoxy/gl.h>

namespace viewer {
namespace {

bool stores_srgb(std::int64_t format) { return format == GL_SRGB8_ALPHA8 || format == GL_SRGB8; }

std::int64_t first_of(std::initializer_list<std::int64_t> formats, std::vector<std::int64_t> const& offered)
{
    for (std::int64_t const format : formats)
        if (std::find(offered.begin(), offered.end(), format) != offered.end()) return format;
    return 0;
}

} // namespace

std::int64_t choose_format(std::vector<std::int64_t> const& offered)
{
    return first_of({GL_SRGB8_ALPHA8, GL_SRGB8, GL_RGBA16F, GL_RGB10_A2, GL_RGBA8}, offered);
}

std::int64_t choose_depth_format(std::vector<std::int64_t> const& offered)
{
    return first_of({GL_DEPTH_COMPONENT32F, GL_DEPTH32F_STENCIL8, GL_DEPTH_COMPONENT32, GL_DEPTH_COMPONENT24,
                     GL_DEPTH24_STENCIL8, GL_DEPTH_COMPONENT16},
                    offered);
}

SwapImages::SwapImages(XrSession session, std::int64_t format, XrSwapchainUsageFlags use, int width, int height)
    : width_(width), height_(height)
{
    XrSwapchainCreateInfo create{};
    create.type = XR_TYPE_SWAPCHAIN_CREATE_INFO;
    create.usageFlags = use | XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
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

SwapImages::~SwapImages() { xrDestroySwapchain(chain_); }

bool SwapImages::acquire()
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

void SwapImages::release()
{
    check(xrReleaseSwapchainImage(chain_, nullptr), "xrReleaseSwapchainImage");
    is_acquired_ = is_ready_ = false;
}

EyeImages::EyeImages(XrSession session, std::int64_t format, std::int64_t depth_format, int width, int height)
    : width_(width),
      height_(height),
      is_srgb_(stores_srgb(format)),
      colors_(session, format, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT, width, height)
{
    if (depth_format != 0)
        depths_.emplace(session, depth_format, XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, width, height);
}

bool EyeImages::acquire() { return colors_.acquire() && (!depths_ || depths_->acquire()); }

EyePass::Target EyeImages::target() const
{
    return {colors_.texture(), depths_ ? depths_->texture() : 0, width_, height_, is_srgb_};
}

void EyeImages::release()
{
    colors_.release();
    if (depths_) depths_->release();
}

} // namespace viewer
