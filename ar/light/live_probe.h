#pragma once
// A coarse environment map that is kept up to date by what the camera itself sees. Where it never looked, the map
// captured before stands in, brightened as much as what is seen now is brighter than it was then.
//
// Light is taken to come from far away: where the camera stands is not regarded, only which way it looks.
//
// Each frame's samples (every n-th pixel, with its solid angle) are summed by texel. A texel that is seen by the
// share s of its solid angle goes from its value L, of confidence c that has faded with memory_s, to
//   L' = (c L + s m) / (c + s),   c' = min(1, c + s),   m = the samples' mean.
// The map: c L + (1 - c) k prior, with c fading with forget_s since the texel was seen, and k, channel by channel,
// the median of L / prior over what was seen, by the prior's light.

#include "ar/camera/camera_model.h"
#include "ar/light/lat_long.h"

#include <cstdint>
#include <optional>

namespace ar {

enum class ExposureKnowledge {
    known,  ///< the radiance of frames is in the unit of the prior's up to what the scene itself does
    unknown ///< the camera does not say its exposure: each frame is scaled by the median ratio to what was seen
};

struct LiveProbeSettings {
    cv::Size size{64, 32};
    int step_px = 4; ///< samples: every so many pixels each way
    ExposureKnowledge exposure = ExposureKnowledge::known;
    double memory_s = 0.5; ///< over which a texel's older sights count less
    double forget_s = 120; ///< over which a texel that is no longer seen goes back to the scaled prior
    double changed = 0.5; ///< a texel whose light differs by this share of the larger value has changed: it begins
                          ///< anew if it also differs by 5 % of the mean radiance
    double lamp_share = 0.05; ///< of the whole map's light: so much of it in changed texels is a lamp
};

struct ProbeUpdate {
    double seen_share = 0;  ///< of the sphere, in this frame
    double known_share = 0; ///< of the sphere, by confidence
    double change = 0;      ///< light that differs from what was known, over what was known, where both are
    int changed_texels = 0;
    bool lamp_changed = false; ///< changed texels hold lamp_share of all light: shadows must be made anew
    double gain = 1;           ///< by which the frame was scaled; 1 where the exposure is known
    std::uint64_t samples = 0;
    std::uint64_t refused = 0; ///< samples not finite or negative
    std::uint64_t clipped = 0; ///< samples where the picture is at an end of its range
};

class LiveProbe {
public:
    /// @param prior a lat-long map of any size, brought to settings.size; empty = grey of the mean of what is seen
    /// @throws gi::InputError as check_map, and settings that are not positive
    explicit LiveProbe(cv::Mat const& prior = {}, LiveProbeSettings const& settings = {});

    /// @param radiance CV_32FC3 of the camera's size (ar::radiance_of with the frame's exposure)
    /// @param clipped CV_8UC1 of the same size, or empty: not 0 where a channel is clipped. A texel with clipped
    /// samples
    ///                does not fall below the scaled prior.
    /// @throws gi::InputError sizes that differ
    ProbeUpdate update(cv::Mat const& radiance, cv::Mat const& clipped, CameraModel const& camera,
                       glm::dquat const& world_from_camera, double time_s);
    /// CV_32FC3, settings.size.
    cv::Mat map() const;
    /// CV_32FC1: 0..1, as it is used now.
    cv::Mat confidence() const;
    /// CV_32FC1: since each texel was seen, s; infinite = never.
    cv::Mat age_s() const;
    cv::Vec3d prior_scale() const { return scale_; }

private:
    struct Texel {
        cv::Vec3f value{0, 0, 0};
        float confidence = 0;
        double seen_s = 0;
        bool clipped = false;
    };
    struct Sum {
        cv::Vec3f light{0, 0, 0};
        float sr = 0, clipped_sr = 0;
    };
    struct Sample {
        int index; ///< of the pixel
        cv::Vec3f direction;
        float sr;
    };

    void set_camera(CameraModel const& camera);
    void gather(cv::Mat const& radiance, cv::Mat const& clipped, glm::dquat const& world_from_camera,
                ProbeUpdate& update);
    double frame_gain() const;
    double confidence_of(Texel const& t) const;
    void follow(ProbeUpdate& update, double time_s);
    void scale_prior();

    LiveProbeSettings settings_;
    cv::Mat prior_;
    bool has_prior_;
    std::vector<float> texel_sr_; ///< by row
    std::vector<Texel> texels_;
    std::vector<Sum> sums_;
    std::vector<Sample> samples_;
    std::optional<CameraModel> camera_;
    double now_s_ = 0;
    bool begun_ = false;
    double gain_ = 1; ///< of the newest frame
    cv::Vec3d scale_{1, 1, 1};
};

} // namespace ar
