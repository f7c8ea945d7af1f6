// OpenCV's image codecs, loaded on first use: the module depends on 120 libraries (GDAL and its dependencies),
// which take 0.1 s to load. Programs link this file instead of the module; the declarations are OpenCV's own.

#include "gi/core/error.h"

#include <dlfcn.h>
#include <opencv2/imgcodecs.hpp>

namespace {

/// @param name mangled name that the module exports
template <typename Function>
Function* codec(char const* name)
{
    void* const module = dlopen(OPENCV_IMGCODECS, RTLD_NOW | RTLD_LOCAL); // loaded once, never unloaded
    void* const found = module != nullptr ? dlsym(module, name) : nullptr;
    if (found != nullptr) return reinterpret_cast<Function*>(found);
    char const* const why = dlerror();
    throw gi::InputError("image files cannot be read or written", why != nullptr ? why : "OpenCV lacks the codecs",
                         "install OpenCV's module imgcodecs in the version that this program was built with");
}

} // namespace

namespace cv {

Mat imread(String const& file, int flags)
{
    static auto* const function =
        codec<Mat(String const&, int)>("_ZN2cv6imreadERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi");
    return function(file, flags);
}

Mat imdecode(InputArray bytes, int flags)
{
    static auto* const function = codec<Mat(InputArray, int)>("_ZN2cv8imdecodeERKNS_11_InputArrayEi");
    return function(bytes, flags);
}

bool imwrite(String const& file, InputArray image, std::vector<int> const& parameters)
{
    static auto* const function = codec<bool(String const&, InputArray, std::vector<int> const&)>(
        "_ZN2cv7imwriteERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_"
        "InputArrayERKSt6vectorIiSaIiEE");
    return function(file, image, parameters);
}

bool imencode(String const& extension, InputArray image, std::vector<uchar>& bytes,
              std::vector<int> const& parameters)
{
    static auto* const function =
        codec<bool(String const&, InputArray, std::vector<uchar>&, std::vector<int> const&)>(
            "_ZN2cv8imencodeERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_"
            "InputArrayERSt6vectorIhSaIhEE"
            "RKSB_IiSaIiEE");
    return function(extension, image, bytes, parameters);
}

} // namespace cv
