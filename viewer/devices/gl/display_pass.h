#pragma once
// Shows finished pictures on a display in one pass: applies exposure and tone curve (as gi/filter/tone_map.h),
// compares two pictures, and composes two eyes (as viewer/displays/compose.h).

#include "gi/filter/tone_map.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"
#include "viewer/displays/display_light.h"
#include "viewer/displays/stereo_mode.h"

#include <list>

namespace viewer {

enum class Comparison {
    off,       ///< the picture
    split,     ///< the picture left of the split, the other right of it
    other,     ///< only the other picture; alternating with off gives flicker
    difference ///< |picture - other| of display-encoded values, times the gain
};

/// Pictures for one eye.
struct EyeView {
    ShownPicture picture;
    ShownPicture other; ///< to compare with; not read if comparison is off
    bool is_drawn = false; ///< surfaces, not a rendered picture
};

/// Content of the textures.
enum class PictureValues {
    radiance, ///< linear: exposure and curve are applied
    encoded   ///< display-encoded: they are not applied
};

struct DisplaySettings {
    gi::ToneMapSettings tone;
    DisplayLight light; ///< with a table: radiance is shown as luminance, instead of sRGB
    PictureValues values = PictureValues::radiance;
    StereoMode stereo = StereoMode::off;
    Comparison comparison = Comparison::off;
    float split = 0.5f;        ///< share of the eye's width
    float difference_gain = 1; ///< > 0
    glm::ivec2 on_screen_px{}; ///< of the target's top left corner on the screen: parity of interlaced modes
};

/// Belongs to the context that was current at its creation. Each display mode has its own program, compiled at
/// first use, because software drivers execute both sides of every branch. Programs used least recently are
/// dropped, as a driver may need a MiB for each.
class DisplayPass {
public:
    static constexpr std::size_t kPrograms = 12; ///< that are kept: more than the modes of a display need together

    /// Fills the target. Pictures of size eye_size() keep their pixels, others are stretched to it (bilinear).
    /// Modes off and two_windows show only `left`: for the second window pass the right eye's view as `left`.
    /// Throws InputError on quad_buffer with a target without left and right buffers,
    /// and on views without pictures.
    void draw(DrawTarget const& target, EyeView const& left, EyeView const& right,
              DisplaySettings const& settings);

private:
    void fill(DrawTarget const& target, EyeView const& left, EyeView const& right, StereoMode mode,
              DisplaySettings const& settings);
    GlProgram const& program(std::string const& kind);
    void bind_table(std::shared_ptr<InverseTable const> const& table);
    struct Made {
        std::string defines;
        GlProgram program;
    };
    std::list<Made> programs_; ///< the one used last first
    std::shared_ptr<InverseTable const> uploaded_;
    GlObject table_;
    GlObject vertices_{GlObject::Kind::vertex_array};
};

/// The mode itself, or side by side if a window lacks quad buffers, so that both eyes stay visible.
StereoMode mode_on(DrawTarget const& target, StereoMode wanted);

} // namespace viewer
