// Any bytes as what a camera wrote into its buffer, of any format it has, of a size and a stride that the first
// bytes say: planes that lie within the buffer, or a reason why not.

#include "ar/capture/camera_pixels.h"
#include "ar/capture/whole_picture.h"
#include "gi/core/error.h"

#include <cstdlib>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    if (size < 6) return 0;
    std::vector<std::uint8_t> const bytes(data + 6,
                                          data + size); // of its own, so that reading past its end is seen
    auto const formats = ar::camera_pixels();
    std::uint32_t const code = formats[data[0] % formats.size()].fourcc;
    glm::ivec2 const size_px(data[1] + 1, data[2] + 1);
    std::size_t const stride = data[3], parts = data[4] % 4;
    std::vector<std::span<std::uint8_t const>> memory;
    std::span<std::uint8_t const> rest(bytes);
    for (std::size_t i = 0; i < parts; ++i) {
        memory.push_back(rest.first(rest.size() * data[5] / 256));
        rest = rest.subspan(memory.back().size());
    }
    memory.push_back(rest);
    ar::Frame f;
    if (ar::set_planes(f, code, size_px, stride, memory).empty()) {
        for (cv::Mat const& m : f.planes)
            if (!m.empty() && cv::sum(m)[0] < 0) std::abort();
        try {
            if (rgb_of(f).size() != cv::Size(size_px.x, size_px.y)) std::abort();
        } catch (gi::InputError const&) { // a JPEG
        } catch (cv::Exception const&) {
            if (f.format != ar::PixelFormat::mjpeg) throw;
        }
    }
    (void)ar::what_is_missing(bytes);
    return 0;
}
