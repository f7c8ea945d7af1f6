#pragma once
// OpenXR's headers as this room uses them, and what becomes of a call that fails. Only for the .cpp files of this
// room: the headers that others include know nothing of OpenXR.

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

/// A call that did not succeed, by name and result.
class CallError : public std::runtime_error {
public:
    CallError(char const* call, XrResult code);
    XrResult const result;
};

/// "XR_ERROR_INSTANCE_LOST"; the number where this program does not know it.
std::string name(XrResult result);
/// Throws CallError on errors; other successes than XR_SUCCESS are returned.
XrResult check(XrResult result, char const* call);

/// What `enumerate(capacity, &count, items)` lists, asked twice as OpenXR wants it.
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
