#pragma once
// Finds the depth picture and the matte of each frame, and hides virtual objects behind what they show.

#include "ar/camera/camera_model.h"
#include "ar/scene/occlusion.h"
#include "gi/core/report.h"

#include <map>

namespace ar {

struct LiveOccluderCounts {
    OcclusionCounts pixels;          ///< of all frames
    std::uint64_t frames = 0;        ///< with a depth picture or a matte
    std::uint64_t without_depth = 0; ///< frames without a depth picture of their number
    std::uint64_t without_matte = 0; ///< the same of mattes
    std::uint64_t unusable = 0;      ///< pictures: damaged, of another size
    std::string last_problem;        ///< of a picture that could not be used
};

class LiveOccluders {
public:
    /// @param camera  of the frames  @param report  where depth maps are cut or unknown; outlives this
    /// @throws gi::InputError no pictures, a first picture that cannot be used (another size, no depths)
    LiveOccluders(OcclusionPictures const& settings, CameraModel const& camera, gi::Report& report);

    /// @param modelled_m  CV_32FC1 in the camera's lens: virtual objects and the model of the place; 0 = none
    void hide(RenderedPair& pair, cv::Mat const& modelled_m, std::uint64_t frame, double time_s);
    LiveOccluderCounts const& counts() const { return counts_; }

private:
    using Files = std::map<std::int64_t, std::filesystem::path>;
    cv::Mat depth(std::filesystem::path const& file, gi::Report* report) const;
    cv::Mat matte(std::filesystem::path const& file) const;
    template <typename Read>
    cv::Mat of_frame(std::optional<FramePictures> const& which, Files const& files, std::uint64_t frame,
                     double time_s, std::uint64_t& missing, Read const& read);

    OcclusionPictures settings_;
    CameraModel camera_;
    gi::Report* report_;
    std::optional<CameraModel> depth_camera_; ///< nothing = registered
    Files depths_, mattes_;
    LiveOccluderCounts counts_;
};

} // namespace ar
