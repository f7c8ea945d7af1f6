#include "ar/runtime/picture_folder.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer {

PictureFolder::PictureFolder(std::filesystem::path folder) : folder_(std::move(folder))
{
    std::error_code problem;
    std::filesystem::create_directories(folder_, problem);
    if (problem)
        throw gi::InputError("'" + folder_.string() + "' cannot be made", problem.message(),
                             "choose another folder");
}

void PictureFolder::add(std::uint64_t sequence, cv::Mat const& rgb) const
{
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    gi::write_text(folder_ / fmt::format("{:06}.png", sequence),
                   {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

} // namespace viewer
