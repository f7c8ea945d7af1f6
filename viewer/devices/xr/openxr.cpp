#include "viewer/devices/xr/openxr.h"

#include <openxr/openxr_reflection.h>

namespace viewer {

CallError::CallError(char const* call, XrResult code)
    : std::runtime_error(std::string(call) + ": " + name(code)), result(code)
{
}

std::string name(XrResult result)
{
    switch (result) {
#define LIGHTWELL_CASE(label, value)                                                                              \
    case label:                                                                                                   \
        return #label;
        XR_LIST_ENUM_XrResult(LIGHTWELL_CASE)
#undef LIGHTWELL_CASE
                default : return "result " +
                          std::to_string(static_cast<int>(result));
    }
}

XrResult check(XrResult result, char const* call)
{
    if (XR_FAILED(result)) throw CallError(call, result);
    return result;
}

} // namespace viewer
