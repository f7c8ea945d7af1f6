#pragma once
// Temporal reuse: averages the light of this frame with that on the same surface in earlier frames, which is
// found through each pixel's motion vector. Works with every method that provides the layer "motion".
//
// Two means are kept. While anything moves (camera, triangles), L1 and L2 over the albedo follow their surfaces:
// they are interpolated between pixels of the previous frame where all of these show the surface (depth and normal
// fit). At its borders those of the nearest such pixel are taken as they are, and where they come from is kept
// with them until they are interpolated: interpolated from one side, light of the inside would move to the border,
// frame by frame, and small shadows beside what throws them would vanish. This mean covers at most `most_frames`
// frames, and L1 is clamped to the range of its current neighbourhood, because shadows move faster than the mean
// adapts (Yang, Liu and Salvi 2020, sec. 4.2). Where the light has not changed, it covers up to `most_unchanged`
// frames: it is compared with a second mean of the latest `most_frames`, and where the two differ by more than
// their noise in the pixels around, the shorter one replaces it. Where the light of a frame alone differs from both
// by far more than its noise in the pixels around, as after a door has opened, it replaces them (`follow_sudden`).
// Where the image is static, albedo and L0 are averaged too, so that edges and textures are antialiased. While nothing moves at all, the pictures themselves
// are averaged over all frames since the last motion, so that a static picture converges to the method's result.
// After a change of lights, materials or environment, all earlier frames are discarded: the lag is zero frames.
//
// Where a second eye reuses the first one's light, it takes the first one's temporal mean with it instead of
// reading its own previous frame.

#include "gi/filter/reused_light.h"

namespace gi {

struct TemporalSettings {
    int most_frames = 16;   ///< >= 1; 1 = no reuse
    int most_unchanged = 0; ///< where the light has not changed; fewer than most_frames = that
    /// Earlier L1 is clamped to the mean +- `spread` standard deviations of a window of so many pixels. Small ones
    /// follow shadows, but where light is found by few paths, windows without any make pictures dark.
    int window = 5;
    float spread = 1;
    bool follow_sudden = false; ///< light that has suddenly become another forgets what it was
    bool keep_normals = false;  ///< adds the layer light_normal
    bool can_undo = false;     ///< keeps what undo() needs: 48 bytes a pixel more
};

/// What has changed since the previous frame.
enum class SceneChange : std::uint8_t {
    nothing,
    motion, ///< of the camera or of triangles
    light   ///< of lights, materials or the environment
};

struct TemporalCounts {
    std::size_t surfaces = 0; ///< pixels with a surface
    std::size_t started = 0;  ///< of these, pixels with no history to reuse
    std::size_t held = 0;     ///< of these, pixels whose earlier L1 was clamped to the neighbourhood
    double renewed = 0;       ///< of these, pixels whose light had changed: the weight of its shorter mean, summed
    double sudden = 0; ///< of these, pixels whose light had suddenly changed: the weight of this frame, summed
    double frames = 0;        ///< number of frames in a pixel's mean, averaged over pixels
    int still_frames = 0;     ///< frames since the last motion, including this one; 1 = something moved
};

/// Light of a pixel's surface: L1 and L2 over the albedo.
struct KnownLight {
    vec3 direct{0}, indirect{0};
    float frames = 0; ///< that it is worth; 0 = unknown
};

class TemporalReuse {
public:
    explicit TemporalReuse(TemporalSettings const& settings) : settings_(settings) {}

    /// What the next frame begins with, if it is the first: light of each pixel's surface, known from elsewhere,
    /// such as a picture of another size. Forgotten if the next frame's light has changed.
    void begin_with(std::vector<KnownLight> light) { known_ = std::move(light); }
    bool is_new() const { return frames_ == 0; } ///< no frame was added yet
    /// Replaces L0, L1, L2, color and albedo by means over frames, and adds the layers variance_direct
    /// and variance_indirect: variances of these means' luminance of L1 and of L2 over the albedo,
    /// measured over frames; negative if there was only one frame. With TemporalSettings::keep_normals,
    /// light_normal is the mean of the normals whose light is in the mean of L1 and L2, with the same
    /// weights (but L1 is also clamped), so that light which is linear in the normal stays so. Needs color,
    /// L0, L1, L2, albedo, normal, depth and motion (throws InputError if one is missing).
    /// "motion" is as in gi/render/motion.h: x, y: offset in pixels to the surface's previous position;
    /// z: its previous depth, m; NaN if there was none. All frames have one size.
    /// @param partner, from  the partner's reuse, to which this frame has already been added, and the partner's
    ///   source pixels (ReusedLight::from): these pixels take the partner's motion-following means
    TemporalCounts add(Picture& frame, SceneChange change, TemporalReuse const* partner = nullptr,
                       std::span<std::uint32_t const> from = {});
    /// Takes the last frame back. Only with TemporalSettings::can_undo, once after a frame that was not the first, and
    /// not after SceneChange::light.
    void undo();

private:
    struct Surface {
        vec3 normal;
        float depth; ///< m; 0 = no surface
    };
    /// Means over frames of L1 and L2 over the albedo, and of the normals of the surfaces whose light that is.
    struct Means {
        vec3 direct, indirect, normal;

        void add(float weight, Means const& other)
        {
            direct += weight * other.direct;
            indirect += weight * other.indirect;
            normal += weight * other.normal;
        }
        void approach(Means const& other, float share);
    };
    struct Light {
        Means all, recent; ///< recent: of the latest most_frames
        float frames;      ///< number of frames in `all`
        vec2 variance;     ///< of its luminances, over those frames
        vec2 place;        ///< where in the pixel its surface points lie, their mean, px from the middle
        vec3 l0, albedo;
        float still_frames; ///< number of frames in l0 and albedo
        bool still;         ///< true if its surface did not move in the image

        void add_to(Light const& before, TemporalSettings const& settings);
        void take(Light const& there); ///< instead of its own
    };
    void follow(Picture const& frame, TemporalReuse const* partner, std::span<std::uint32_t const> from,
                TemporalCounts& counts);
    template <class Shows>
    bool interpolate(vec2 at, int width, int height, Shows const& shows, Light& light) const;
    template <class Shows>
    bool take_nearest(vec2 at, int width, int height, Shows const& shows, Light& light) const;
    /// Where the light has changed, replaces means by means over the latest frames.
    void renew_changed(int width, int height, TemporalCounts& counts);
    /// Where it has changed by far more than its noise, replaces them by this frame's light.
    void follow_sudden(int width, int height, TemporalCounts& counts);
    void rest(Picture& frame, TemporalCounts& counts);

    TemporalSettings settings_;
    int frames_ = 0, still_ = 0, last_still_ = 0;
    std::vector<KnownLight> known_;
    std::vector<Surface> surfaces_, last_surfaces_;
    std::vector<Light> lights_, last_lights_;
    std::vector<Means> now_;                            ///< this frame's light alone; with follow_sudden
    std::vector<std::array<vec3, 4>> mean_, last_mean_; ///< of L0, L1, L2 and normals since the last motion
};

} // namespace gi
