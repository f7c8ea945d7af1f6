#include "ar/runtime/picture_folder.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {

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
    if (rgb.depth() == CV_32F) {
        gi::Picture picture{rgb.cols, rgb.rows, {}, {}};
        gi::Layer& color = picture.add("color", 3);
        cv::Mat const all = rgb.isContinuous() ? rgb : rgb.clone();
        std::copy_n(all.ptr<float>(), color.data.size(), color.data.begin());
        gi::Report none_lost; // single precision keeps all values
        gi::write_exr(folder_ / fmt::format("{:06}.exr", sequence), picture, gi::PixelType::single, none_lost);
        return;
    }
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    gi::write_text(folder_ / fmt::format("{:06}.png", sequence),
                   {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

} // namespace ar
