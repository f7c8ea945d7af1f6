#include "gi/registry/registry.h"

#include "gi/base/error.h"
#include "gi/reference/reference.h"
#include "gi/slhb/frames.h"
#include "gi/slhb/slhb.h"

#include <array>
#include <string>

namespace gi {
namespace {

constexpr std::array kMethods{
    Method{"reference", "path tracing with exact rays (Embree): slow, unbiased, judges the others",
           render_reference, start_reference_frames},
    Method{"slhb", "path tracing through spherical layered hit buffers: look-ups instead of rays", render_slhb,
           start_slhb_frames},
};

} // namespace

std::span<Method const> methods() { return kMethods; }

Method const& find_method(std::string_view name)
{
    std::string known;
    for (Method const& m : kMethods) {
        if (m.name == name) return m;
        known += (known.empty() ? "" : ", ") + std::string(m.name);
    }
    throw InputError("there is no method '" + std::string(name) + "'", "it is not in the registry",
                     "choose one of: " + known);
}

} // namespace gi
