#include "viewer/experiment/lsl_library.h"

#include <chrono>
#include <cstdlib>
#include <dlfcn.h>
#include <fmt/format.h>

namespace viewer {

std::shared_ptr<LslLibrary const> LslLibrary::open()
{
    std::shared_ptr<LslLibrary> const lsl(new LslLibrary);
    return lsl->load() ? lsl : nullptr;
}

bool LslLibrary::load()
{
    char const* const named = std::getenv("PYLSL_LIB");
    for (char const* const name : {named, "liblsl.so.2", "liblsl.so", "liblsl64.so"})
        if (name != nullptr && *name != 0 && (library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL)) != nullptr) break;
    if (library_ == nullptr) return false;
    bool has_all = true;
    auto const find = [&](auto& function, char const* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library_, name));
        has_all = has_all && function != nullptr;
    };
    find(create_streaminfo, "lsl_create_streaminfo");
    find(destroy_streaminfo, "lsl_destroy_streaminfo");
    find(get_desc, "lsl_get_desc");
    find(append_child, "lsl_append_child");
    find(append_child_value, "lsl_append_child_value");
    find(child, "lsl_child");
    find(next_sibling_n, "lsl_next_sibling_n");
    find(empty, "lsl_empty");
    find(child_value_n, "lsl_child_value_n");
    find(get_name, "lsl_get_name");
    find(get_channel_count, "lsl_get_channel_count");
    find(get_nominal_srate, "lsl_get_nominal_srate");
    find(create_outlet, "lsl_create_outlet");
    find(destroy_outlet, "lsl_destroy_outlet");
    find(have_consumers, "lsl_have_consumers");
    find(push_sample_strt, "lsl_push_sample_strt");
    find(resolve_byprop, "lsl_resolve_byprop");
    find(create_inlet, "lsl_create_inlet");
    find(destroy_inlet, "lsl_destroy_inlet");
    find(get_fullinfo, "lsl_get_fullinfo");
    find(open_stream, "lsl_open_stream");
    find(time_correction, "lsl_time_correction");
    find(pull_sample_d, "lsl_pull_sample_d");
    find(local_clock, "lsl_local_clock");
    find(library_version, "lsl_library_version");
    return has_all;
}

LslLibrary::~LslLibrary()
{
    if (library_ != nullptr) dlclose(library_);
}

double LslLibrary::clock_offset_s() const
{
    auto const steady_s = [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    double best_s = 1e9, offset_s = 0;
    for (int i = 0; i < 20; ++i) { // the reading that was interrupted least
        double const before = steady_s(), there = local_clock(), after = steady_s();
        if (after - before >= best_s) continue;
        best_s = after - before;
        offset_s = there - 0.5 * (before + after);
    }
    return offset_s;
}

std::string LslLibrary::version() const
{
    int const v = library_version();
    return fmt::format("{}.{}", v / 100, v % 100);
}

} // namespace viewer
