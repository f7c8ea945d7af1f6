#pragma once
// OpenXR's headers as this module uses them, and errors of failed calls. Include it only in the .cpp files of this
// module: its public headers do not depend on OpenXR.

#include <ctime>
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace viewer {

/// A failed call, with its name and result.
class CallError : public std::runtime_error {
public:
    CallError(char const* call, XrResult code);
    XrResult const result;
};

/// E.g. "XR_ERROR_INSTANCE_LOST"; the number if unknown.
std::string name(XrResult result);
/// Throws CallError on errors; returns all success codes.
XrResult check(XrResult result, char const* call);

/// Items from `enumerate(capacity, &count, items)`, called twice as in OpenXR's two-call idiom.
template <class Item, class Enumerate>
std::vector<Item> list_of(Item const& empty, char const* call, Enumerate const& enumerate)
{
    std::uint32_t count = 0;
    check(enumerate(count, &count, static_cast<Item*>(nullptr)), call);
    std::vector<Item> items(count, empty);
    if (count > 0) check(enumerate(count, &count, items.data()), call);
    items.resize(count, empty);
    return items;
}

} // namespace viewer
