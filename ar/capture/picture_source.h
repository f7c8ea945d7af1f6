#pragma once
// Frames from pictures on disk, one file each: a folder, or names with a number in them.

#include "ar/capture/player.h"
#include "ar/capture/tally.h"

#include <filesystem>

namespace ar {

struct NumberedPicture {
    std::uint64_t number = 0;
    std::filesystem::path file;
};

/// Of a folder: its pictures (.png .jpg .jpeg .bmp .tif .tiff .ppm .pgm .webp) in natural order (2 before 10),
/// numbered from 0. Of a pattern like "shots/frame_%04d.png" (one %d, also with zeros and width): the files that
/// have such a name, by their numbers.
/// @throws gi::InputError no such folder, a pattern that is none
std::vector<NumberedPicture> find_pictures(std::filesystem::path const& folder_or_pattern);

/// "a2" before "a10"; equal numbers by their text.
bool is_before_naturally(std::string const& a, std::string const& b);

struct PictureOptions {
    double frames_per_s = 30; ///< what the files do not say
    Pace pace = Pace::own;
};

/// The size of all is the size of the first that can be decoded. Pictures that are truncated, no pictures, gone,
/// or of another size are refused; numbers that a pattern leaves out are dropped. Frames are bgr8 or (pictures of
/// one channel) gray8; captured_s is when it is due, origin: file.
class PictureSource final : public FrameSource {
public:
    /// @throws gi::InputError there are no pictures, or none can be decoded
    explicit PictureSource(std::filesystem::path const& folder_or_pattern, PictureOptions const& options = {});

    std::optional<Frame> next(std::chrono::milliseconds wait) override;
    SourceState state() const override;
    SourceDescription description() const override;
    SourceCounts counts() const override { return tally_.counts(); }
    std::vector<std::string> set(Controls const& controls) override;

private:
    cv::Mat decoded(NumberedPicture const& picture);

    std::string name_;
    PictureOptions options_;
    std::vector<NumberedPicture> pictures_;
    std::size_t at_ = 0;
    cv::Mat ready_; ///< decoded, not yet due
    glm::ivec2 size_px_{0};
    int type_ = 0;
    Tally tally_;
    Player player_;
};

} // namespace ar
