#pragma once
// What an OpenXR API layer of the tests needs: the loader's interface (version 1, openxr_loader_negotiation.h, which
// Debian's package does not have), and calls to the runtime behind it.

#include <cstdint>
#include <cstring>
#include <map>
#include <openxr/openxr.h>
#include <string>
#include <vector>

struct LayerNextInfo {
    int type; ///< 5
    std::uint32_t version;
    std::size_t size;
    char name[XR_MAX_API_LAYER_NAME_SIZE];
    PFN_xrGetInstanceProcAddr next_get;
    XrResult(XRAPI_PTR* next_create)(XrInstanceCreateInfo const*, struct LayerCreateInfo const*, XrInstance*);
    LayerNextInfo* next;
};
struct LayerCreateInfo {
    int type; ///< 4
    std::uint32_t version;
    std::size_t size;
    void* loader_instance;
    char settings_file[512];
    LayerNextInfo* next_info;
};
struct NegotiateLoaderInfo {
    int type;
    std::uint32_t version;
    std::size_t size;
    std::uint32_t least_interface, most_interface;
    XrVersion least_api, most_api;
};
struct NegotiateLayerRequest {
    int type;
    std::uint32_t version;
    std::size_t size;
    std::uint32_t interface_version;
    XrVersion api_version;
    PFN_xrGetInstanceProcAddr get;
    XrResult(XRAPI_PTR* create)(XrInstanceCreateInfo const*, LayerCreateInfo const*, XrInstance*);
};

// Static: each layer has its own.
static PFN_xrGetInstanceProcAddr next_get;
static XrInstance instance;

/// A function of the runtime, or of the next layer.
template <class Function>
static Function next(char const* name)
{
    PFN_xrVoidFunction f = nullptr;
    next_get(instance, name, &f);
    return reinterpret_cast<Function>(f);
}

/// Creates the instance behind the layer, without the extension that it adds itself (null: none).
static XrResult create_next(XrInstanceCreateInfo const* info, LayerCreateInfo const* layer, XrInstance* made,
                            char const* own_extension)
{
    LayerNextInfo const& after = *layer->next_info;
    next_get = after.next_get;
    std::vector<char const*> extensions;
    for (std::uint32_t k = 0; k < info->enabledExtensionCount; ++k)
        if (own_extension == nullptr || std::strcmp(info->enabledExtensionNames[k], own_extension) != 0)
            extensions.push_back(info->enabledExtensionNames[k]);
    XrInstanceCreateInfo less = *info;
    less.enabledExtensionCount = std::uint32_t(extensions.size());
    less.enabledExtensionNames = extensions.data();
    LayerCreateInfo further = *layer;
    further.next_info = after.next;
    XrResult const result = after.next_create(&less, &further, made);
    instance = *made;
    return result;
}

using OwnFunctions = std::map<std::string, PFN_xrVoidFunction>;

static XrResult get_own_or_next(OwnFunctions const& own, XrInstance i, char const* name,
                                PFN_xrVoidFunction* function)
{
    if (auto const found = own.find(name); found != own.end()) {
        *function = found->second;
        return XR_SUCCESS;
    }
    return next_get(i, name, function);
}
