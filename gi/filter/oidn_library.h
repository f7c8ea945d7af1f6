#pragma once
// Intel Open Image Denoise 2, loaded at run time if installed: the few functions of its C API that the filter
// calls. Names, types and values follow the library's public header.
//
// Search order:
//   1. $LIGHTWELL_OIDN, a library or its folder; if set, the only place searched
//   2. beside the program or the Python module
//   3. in the folders above those: python/lib/python3*/site-packages/pyoidn/oidn/lib (scripts/setup --oidn) and
//      pyoidn/oidn/lib (pip install pyoidn beside the Python module)
//   4. libOpenImageDenoise.so.2 of the system

#include <cstddef>

namespace gi {

struct OidnLibrary {
    enum : int { device_cpu = 1, quality_fast = 4, quality_high = 6, format_float3 = 3 };

    void* (*new_device)(int type);
    void (*set_device_int)(void* device, char const* name, int value);
    void (*set_device_bool)(void* device, char const* name, bool value);
    void (*commit_device)(void* device);
    int (*device_error)(void* device, char const** message); ///< 0 = none
    void (*release_device)(void* device);
    void* (*new_filter)(void* device, char const* type);
    void (*set_filter_image)(void* filter, char const* name, void* values, int format, std::size_t width,
                             std::size_t height, std::size_t offset, std::size_t pixel_stride,
                             std::size_t row_stride); ///< strides of 0: densely packed
    void (*set_filter_bool)(void* filter, char const* name, bool value);
    void (*set_filter_int)(void* filter, char const* name, int value);
    /// @param goes_on  called again and again while the filter runs; false cancels it
    void (*set_filter_progress_monitor)(void* filter, bool (*goes_on)(void* user, double done), void* user);
    void (*commit_filter)(void* filter);
    void (*execute_filter)(void* filter);
    void (*release_filter)(void* filter);
};

/// Loads the library at the first call; it stays loaded. Throws InputError at every call if it cannot be used.
OidnLibrary const& oidn_library();

} // namespace gi
