// OpenCV's image codecs, loaded on first use: the module depends on 120 libraries (GDAL and its dependencies),
// which take 0.1 s to load. Programs link this file instead of the module; the declarations are OpenCV's own.
// Where the module is not installed, small_codecs.h has what most files need.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/small_codecs.h"

#include <algorithm>
#include <dlfcn.h>
#include <fstream>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string_view>

namespace {

/// True if this program brings its own OpenCV, renamed, as a Python wheel does: the system's module would load a second one.
bool has_own_opencv()
{
    Dl_info about{};
    return dladdr(reinterpret_cast<void const*>(&cv::getVersionString), &about) != 0 &&
           about.dli_fname != nullptr &&
           std::string_view(about.dli_fname).find("libopencv_core-") != std::string_view::npos;
}

struct Module {
    void* handle = nullptr;
    std::string why; ///< why there is none
};

/// OpenCV's module, loaded once and never unloaded.
Module const& module()
{
    static Module const loaded = [] {
        if (has_own_opencv()) return Module{nullptr, "this program brings its own OpenCV, without codecs"};
        void* const handle = dlopen(OPENCV_IMGCODECS, RTLD_NOW | RTLD_LOCAL);
        char const* const why = handle == nullptr ? dlerror() : nullptr;
        return Module{handle, why != nullptr ? why : ""};
    }();
    return loaded;
}

/// @param name mangled name that the module exports
/// @return none without the module
template <typename Function>
Function* codec(char const* name)
{
    return module().handle != nullptr ? reinterpret_cast<Function*>(dlsym(module().handle, name)) : nullptr;
}

/// For formats that only the module reads or writes.
[[noreturn]] void refuse(char const* formats)
{
    throw gi::InputError(std::string("pictures other than ") + formats + " need OpenCV's codecs", module().why,
                         "install " OPENCV_IMGCODECS);
}

/// Empty if the file is damaged.
cv::Mat decoded_small(std::span<unsigned char const> bytes, int flags)
{
    auto const begins = [&](std::string_view start) {
        return bytes.size() >= start.size() &&
               std::equal(start.begin(), start.end(), bytes.begin(),
                          [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
    };
    if (!begins("\x89PNG") && !begins("\xff\xd8") && !begins("BM")) refuse("PNG, JPEG and BMP");
    return gi::decode_small(bytes, flags);
}

int jpeg_quality_of(std::vector<int> const& parameters)
{
    for (std::size_t k = 0; k + 1 < parameters.size(); k += 2)
        if (parameters[k] == cv::IMWRITE_JPEG_QUALITY) return parameters[k + 1];
    return 95; // as OpenCV
}

std::vector<uchar> encoded_small(cv::String const& extension, cv::InputArray image,
                                 std::vector<int> const& parameters)
{
    std::vector<uchar> bytes = gi::encode_small(extension, image.getMat(), jpeg_quality_of(parameters));
    if (bytes.empty()) refuse("PNG, JPEG and BMP with 8 bits");
    return bytes;
}

} // namespace

namespace cv {

Mat imread(String const& file, int flags)
{
    static auto* const function =
        codec<Mat(String const&, int)>("_ZN2cv6imreadERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi");
    if (function != nullptr) return function(file, flags);
    return decoded_small(gi::read_bytes(file), flags);
}

Mat imdecode(InputArray bytes, int flags)
{
    static auto* const function = codec<Mat(InputArray, int)>("_ZN2cv8imdecodeERKNS_11_InputArrayEi");
    if (function != nullptr) return function(bytes, flags);
    Mat const raw = bytes.getMat();
    return decoded_small({raw.data, raw.total()}, flags);
}

bool imwrite(String const& file, InputArray image, std::vector<int> const& parameters)
{
    static auto* const function = codec<bool(String const&, InputArray, std::vector<int> const&)>(
        "_ZN2cv7imwriteERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_"
        "InputArrayERKSt6vectorIiSaIiEE");
    if (function != nullptr) return function(file, image, parameters);
    std::vector<uchar> const bytes =
        encoded_small(std::filesystem::path(file).extension().string(), image, parameters);
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<char const*>(bytes.data()), std::streamsize(bytes.size()));
    return bool(out.flush());
}

bool imencode(String const& extension, InputArray image, std::vector<uchar>& bytes,
              std::vector<int> const& parameters)
{
    static auto* const function =
        codec<bool(String const&, InputArray, std::vector<uchar>&, std::vector<int> const&)>(
            "_ZN2cv8imencodeERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_"
            "InputArrayERSt6vectorIhSaIhEE"
            "RKSB_IiSaIiEE");
    if (function != nullptr) return function(extension, image, bytes, parameters);
    bytes = encoded_small(extension, image, parameters);
    return true;
}

} // namespace cv
