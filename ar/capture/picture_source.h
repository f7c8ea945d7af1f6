#pragma once
// Frames from picture files: a folder, or a pattern of numbered names.

#include "ar/capture/player.h"
#include "ar/capture/tally.h"

#include <filesystem>

namespace ar {

struct NumberedPicture {
    std::uint64_t number = 0;
    std::filesystem::path file;
};

struct FoundPictures {
    std::vector<NumberedPicture> pictures = {}; ///< by increasing number
    bool has_numbers = false;                   ///< of their names; false: their place in natural order, from 0
    /// Why not, where names have digits; empty else.
    std::string why_not = {};
    std::vector<std::filesystem::path> left_out = {}; ///< pictures without a number, beside others that have one
};

/// Pictures in a folder (.png .jpg .jpeg .bmp .tif .tiff .ppm .pgm .webp .exr) in natural order (2 before 10).
/// @throws gi::InputError no such folder
std::vector<std::filesystem::path> picture_files(std::filesystem::path const& folder);

/// For a pattern like "shots/frame_%04d.png" (one %d, optionally with zeros and width): the matching files, by their
/// numbers. For a folder: picture_files, by the one number in which their names differ ("12.png", "shot_0012.jpg");
/// where they have none, or it is no frame's (time stamps), by their natural order from 0.
/// @throws gi::InputError no such folder, an invalid pattern, a number that two pictures of a folder have
FoundPictures find_pictures(std::filesystem::path const& folder_or_pattern);

/// The numbers that are not there, "3, 5 to 7"; empty = none. @param pictures  by increasing number
/// @param first  the number that the first should have; nothing: that which it has
std::string missing_numbers(std::vector<NumberedPicture> const& pictures,
                            std::optional<std::uint64_t> first = std::nullopt);

/// Natural order: "a2" before "a10"; equal numbers are ordered by their text.
bool is_before_naturally(std::string const& a, std::string const& b);

struct PictureOptions {
    double frames_per_s = 30; ///< the files contain no rate
    Pace pace = Pace::own;
    /// Number of the picture at time 0; nothing: that of the first one.
    std::optional<std::uint64_t> first = {};
};

/// The first decodable picture sets size and kind. Files that are truncated, not pictures, missing or of another
/// size are refused; numbers that are missing count as dropped, and are named. Frames are bgr8 or (single-channel pictures)
/// gray8; of 16 bits (PNG, TIFF) rgb16; of OpenEXR (channels R, G, B without a layer, or Y) and float TIFF
/// rgb_linear; captured_s is the time when the frame is due, origin: file.
class PictureSource final : public FrameSource {
public:
    /// @throws gi::InputError no pictures, or none that can be decoded
    explicit PictureSource(std::filesystem::path const& folder_or_pattern, PictureOptions const& options = {});

    std::optional<Frame> next(std::chrono::milliseconds wait) override;
    SourceState state() const override;
    SourceDescription description() const override;
    SourceCounts counts() const override;
    std::vector<std::string> set(Controls const& controls) override;

private:
    cv::Mat decoded(NumberedPicture const& picture);

    std::string name_;
    PictureOptions options_;
    FoundPictures found_;
    std::vector<NumberedPicture> pictures_;
    std::size_t at_ = 0;
    cv::Mat ready_; ///< decoded, not yet due
    glm::ivec2 size_px_{0};
    PixelFormat format_ = PixelFormat::bgr8;
    Tally tally_;
    Player player_;
};

} // namespace ar
