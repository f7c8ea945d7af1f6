#pragma once
// Brings finished pictures to a display in one pass: exposure and tone curve (those of gi/filter/tone_map.h), two
// pictures compared, two eyes composed (as viewer/displays/compose.h does).

#include "gi/filter/tone_map.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"
#include "viewer/displays/stereo_mode.h"

#include <map>

namespace viewer {

enum class Comparison {
    off,       ///< the picture
    split,     ///< the picture left of the split, the other one right of it
    other,     ///< the other one: who shows them in turn makes them flicker
    difference ///< |picture - other| of display-encoded values, times the gain
};

/// What an eye sees.
struct EyeView {
    ShownPicture picture;
    ShownPicture other; ///< to compare with; not read where comparison is off
};

/// What the textures hold.
enum class PictureValues {
    radiance, ///< linear: exposure and curve apply
    encoded   ///< display-encoded already: they do not
};

struct DisplaySettings {
    gi::ToneMapSettings tone;
    PictureValues values = PictureValues::radiance;
    StereoMode stereo = StereoMode::off;
    Comparison comparison = Comparison::off;
    float split = 0.5f;        ///< of the eye's width
    float difference_gain = 1; ///< > 0
    glm::ivec2 on_screen_px{}; ///< of the target's top left corner on the screen: parity of interlaced modes
};

/// Belongs to the context that was current when it was made. Each kind of display is a program of its own,
/// compiled when it is first drawn: software drivers run both sides of every branch.
class DisplayPass {
public:
    /// Fills the target. Pictures of the size of eye_size() keep their pixels, others are stretched to it
    /// (bilinear). Mode off and two_windows show `left` alone: for the second window give the right eye's view as
    /// `left`. Throws InputError where quad_buffer meets a target without buffers of the eyes, and on views
    /// without their pictures.
    void draw(DrawTarget const& target, EyeView const& left, EyeView const& right,
              DisplaySettings const& settings);

private:
    void fill(DrawTarget const& target, EyeView const& left, EyeView const& right, StereoMode mode,
              DisplaySettings const& settings);
    GlProgram const& program(std::string const& kind);
    std::map<std::string, GlProgram> programs_; ///< by their defines
    GlObject vertices_{GlObject::Kind::vertex_array};
};

/// The mode itself, or where a window has no quad buffers, side by side: both eyes stay to be seen.
StereoMode mode_on(DrawTarget const& target, StereoMode wanted);

} // namespace viewer
