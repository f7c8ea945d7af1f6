// An OpenXR API layer that keeps what a program submits, of every twentieth frame with a picture, for tests: in the
// folder of the variable LIGHTWELL_TEST_FRAMES, N.json (poses, fields of view, depth infos) and, for view V, N_V.color
// (RGBA, bytes) and N_V.depth (floats), rows from the bottom. The JSON file comes last.

#define XR_USE_GRAPHICS_API_OPENGL
#include "tests/viewer_xr/layers/api_layer.h"
#include <epoxy/gl.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <openxr/openxr_platform.h>

namespace {

struct Chain {
    std::vector<unsigned> textures;
    std::uint32_t acquired = 0, shown = 0;
};

std::map<XrSwapchain, Chain> chains;
int frames = 0;

XRAPI_ATTR XrResult XRAPI_CALL images(XrSwapchain chain, std::uint32_t capacity, std::uint32_t* count,
                                      XrSwapchainImageBaseHeader* to)
{
    XrResult const result =
        next<PFN_xrEnumerateSwapchainImages>("xrEnumerateSwapchainImages")(chain, capacity, count, to);
    if (capacity == 0 || XR_FAILED(result)) return result;
    auto const* const gl = reinterpret_cast<XrSwapchainImageOpenGLKHR const*>(to);
    for (std::uint32_t k = 0; k < *count; ++k) chains[chain].textures.push_back(gl[k].image);
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL acquire(XrSwapchain chain, XrSwapchainImageAcquireInfo const* info,
                                       std::uint32_t* index)
{
    XrResult const result = next<PFN_xrAcquireSwapchainImage>("xrAcquireSwapchainImage")(chain, info, index);
    chains[chain].acquired = *index;
    return result;
}

XRAPI_ATTR XrResult XRAPI_CALL release(XrSwapchain chain, XrSwapchainImageReleaseInfo const* info)
{
    chains[chain].shown = chains[chain].acquired;
    return next<PFN_xrReleaseSwapchainImage>("xrReleaseSwapchainImage")(chain, info);
}

template <class Value>
void keep(XrSwapchainSubImage const& image, GLenum format, GLenum type, std::size_t channels,
          std::filesystem::path const& file)
{
    Chain const& chain = chains[image.swapchain];
    auto const [w, h] = image.imageRect.extent;
    std::vector<Value> values(channels * std::size_t(w) * std::size_t(h));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(chain.textures.at(chain.shown), 0, format, type, GLsizei(values.size() * sizeof(Value)),
                      values.data());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(values.data()), std::streamsize(values.size() * sizeof(Value)));
}

/// As a number that JSON has.
nlohmann::json number(float v) { return std::isfinite(v) ? nlohmann::json(v) : nlohmann::json("infinite"); }

void keep(XrCompositionLayerProjection const& layer, std::filesystem::path const& folder, std::string const& name)
{
    nlohmann::json all = nlohmann::json::array();
    for (std::uint32_t v = 0; v < layer.viewCount; ++v) {
        XrCompositionLayerProjectionView const& view = layer.views[v];
        auto const& [q, p] = view.pose;
        nlohmann::json one{
            {"rotation", {q.x, q.y, q.z, q.w}},
            {"position", {p.x, p.y, p.z}},
            {"fov_rad", {view.fov.angleLeft, view.fov.angleRight, view.fov.angleUp, view.fov.angleDown}},
            {"width", view.subImage.imageRect.extent.width},
            {"height", view.subImage.imageRect.extent.height}};
        std::string const file = name + "_" + std::to_string(v);
        keep<unsigned char>(view.subImage, GL_RGBA, GL_UNSIGNED_BYTE, 4, folder / (file + ".color"));
        for (auto const* at = static_cast<XrBaseInStructure const*>(view.next); at != nullptr; at = at->next) {
            if (at->type != XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR) continue;
            auto const& depth = *reinterpret_cast<XrCompositionLayerDepthInfoKHR const*>(at);
            one["depth"] = {{"least", depth.minDepth},
                            {"most", depth.maxDepth},
                            {"m_at_least", number(depth.nearZ)},
                            {"m_at_most", number(depth.farZ)},
                            {"width", depth.subImage.imageRect.extent.width},
                            {"height", depth.subImage.imageRect.extent.height}};
            keep<float>(depth.subImage, GL_DEPTH_COMPONENT, GL_FLOAT, 1, folder / (file + ".depth"));
        }
        all.push_back(one);
    }
    std::ofstream(folder / (name + ".part")) << all;
    std::filesystem::rename(folder / (name + ".part"), folder / (name + ".json"));
}

XRAPI_ATTR XrResult XRAPI_CALL end_frame(XrSession session, XrFrameEndInfo const* info)
{
    char const* const folder = std::getenv("LIGHTWELL_TEST_FRAMES");
    if (folder != nullptr && info->layerCount > 0 && ++frames % 20 == 0) {
        auto const& layer = *reinterpret_cast<XrCompositionLayerProjection const*>(info->layers[0]);
        if (layer.type == XR_TYPE_COMPOSITION_LAYER_PROJECTION) keep(layer, folder, std::to_string(frames));
    }
    return next<PFN_xrEndFrame>("xrEndFrame")(session, info);
}

XRAPI_ATTR XrResult XRAPI_CALL get(XrInstance i, char const* name, PFN_xrVoidFunction* function)
{
    static OwnFunctions const own{{"xrEnumerateSwapchainImages", reinterpret_cast<PFN_xrVoidFunction>(&images)},
                                  {"xrAcquireSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(&acquire)},
                                  {"xrReleaseSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(&release)},
                                  {"xrEndFrame", reinterpret_cast<PFN_xrVoidFunction>(&end_frame)}};
    return get_own_or_next(own, i, name, function);
}

XRAPI_ATTR XrResult XRAPI_CALL create(XrInstanceCreateInfo const* info, LayerCreateInfo const* layer,
                                      XrInstance* made)
{
    return create_next(info, layer, made, nullptr);
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
