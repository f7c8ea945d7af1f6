#pragma once
// A coarse environment map that is updated from the camera's own frames.
// Directions that the camera never saw use the map captured before (the prior), scaled by the ratio of current to
// captured brightness in the seen directions.
//
// Light is assumed to come from far away: only the camera's direction matters, not its position.
//
// Each frame's samples (every n-th pixel, with its solid angle) are summed per texel. If a share s of a texel's
// solid angle is seen, its value L, with confidence c that decays with memory_s, becomes
//   L' = (c L + s m) / (c + s),   c' = min(1, c + s),   m = the samples' mean.
// The map is c L + (1 - c) k prior, where c decays with forget_s since the texel was last seen, and k is, per
// channel, the median of L / prior over the seen texels, weighted by the prior's light.

#include "ar/camera/camera_model.h"
#include "ar/light/lat_long.h"

#include <cstdint>
#include <optional>

namespace ar {

enum class ExposureKnowledge {
    known,  ///< frames and prior share a unit of radiance
    unknown ///< not reported: frames are scaled to the known texels
};

struct LiveProbeSettings {
    cv::Size size{64, 32};
    int step_px = 4; ///< sample spacing in both directions
    ExposureKnowledge exposure = ExposureKnowledge::known;
    double memory_s = 0.5;    ///< decay time of a texel's older observations
    double forget_s = 120;    ///< decay time of unseen texels to the prior
    double changed = 0.5;     ///< a texel whose light differs by this share of the larger value has changed; it is
                              ///< reset if it also differs by 5 % of the mean radiance
    double lamp_share = 0.05; ///< changed texels with this share of the map's total light count as a lamp
};

struct ProbeUpdate {
    double seen_share = 0;  ///< of the sphere, in this frame
    double known_share = 0; ///< of the sphere, by confidence
    double change = 0;      ///< changed light relative to known light, over texels where both are available
    int changed_texels = 0;
    bool lamp_changed = false; ///< changed texels hold lamp_share of all light: shadows must be updated
    double gain = 1;           ///< scale applied to the frame; 1 if the exposure is known
    std::uint64_t samples = 0;
    std::uint64_t refused = 0; ///< samples not finite or negative
    std::uint64_t clipped = 0; ///< samples with a clipped channel
};

class LiveProbe {
public:
    /// @param prior a lat-long map of any size, resampled to settings.size;
    /// empty = grey with the mean of seen light
    /// @throws gi::InputError as check_map, or if settings are not positive
    explicit LiveProbe(cv::Mat const& prior = {}, LiveProbeSettings const& settings = {});

    /// @param radiance CV_32FC3 of the camera's size (ar::radiance_of with the frame's exposure)
    /// @param clipped CV_8UC1 of the same size, or empty: nonzero where a channel is clipped. A texel with clipped
    ///                samples does not fall below the scaled prior.
    /// @throws gi::InputError sizes that differ
    ProbeUpdate update(cv::Mat const& radiance, cv::Mat const& clipped, CameraModel const& camera,
                       glm::dquat const& world_from_camera, double time_s);
    /// CV_32FC3, settings.size.
    cv::Mat map() const;
    /// CV_32FC1: current confidence per texel, 0..1.
    cv::Mat confidence() const;
    /// CV_32FC1: time since each texel was last seen, s; infinite = never.
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
