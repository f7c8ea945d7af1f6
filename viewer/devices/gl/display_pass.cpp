#include "viewer/devices/gl/display_pass.h"

#include "gi/core/error.h"
#include "viewer/displays/compose.h"

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>

namespace viewer {
namespace {

std::string define(std::string const& name, int value)
{
    return "#define " + name + " " + std::to_string(value) + "\n";
}

std::string enums()
{
    std::string text;
    for (StereoMode const mode : kStereoModes) {
        std::string name = std::string("STEREO_") + name_of(mode);
        for (char& c : name) c = c == '-' ? '_' : c;
        text += define(name, int(mode));
    }
    return text + define("COMPARE_OFF", int(Comparison::off)) + define("COMPARE_SPLIT", int(Comparison::split)) +
           define("COMPARE_OTHER", int(Comparison::other)) +
           define("COMPARE_DIFFERENCE", int(Comparison::difference)) +
           define("CURVE_FILMIC", int(gi::ToneCurve::filmic)) + "#define TABLE_EXPONENT " +
           std::to_string(study::kInverseTableExponent) + "\n";
}

glm::mat3 matrix_of(float const (&rows)[3][3])
{
    glm::mat3 m;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) m[c][r] = rows[r][c];
    return m;
}

bool reads_right(StereoMode mode) { return mode != StereoMode::off && mode != StereoMode::two_windows; }

void check(EyeView const& view, Comparison comparison)
{
    bool const needs_first = comparison != Comparison::other, needs_other = comparison != Comparison::off;
    if ((!needs_first || view.picture.texture != 0) && (!needs_other || view.other.texture != 0)) return;
    throw gi::InputError("an eye has no picture", "this mode of display or comparison shows one",
                         "upload a picture for every eye, and one to compare with");
}

} // namespace

void DisplayPass::draw(DrawTarget const& target, EyeView const& left, EyeView const& right,
                       DisplaySettings const& settings)
{
    check(left, settings.comparison);
    if (reads_right(settings.stereo)) check(right, settings.comparison);
    bind(target);
    if (settings.stereo != StereoMode::quad_buffer) {
        fill(target, left, right, settings.stereo, settings);
        return;
    }
    if (target.left_buffer == 0 || target.right_buffer == 0)
        throw gi::InputError("quad-buffer stereo in a window without it", "the driver gave no buffer for each eye",
                             "choose another stereo mode");
    GLint before = 0;
    glGetIntegerv(GL_DRAW_BUFFER, &before);
    glDrawBuffer(target.left_buffer);
    fill(target, left, {}, StereoMode::off, settings);
    glDrawBuffer(target.right_buffer);
    fill(target, right, {}, StereoMode::off, settings);
    glDrawBuffer(GLenum(before));
}

void DisplayPass::fill(DrawTarget const& target, EyeView const& left, EyeView const& right, StereoMode mode,
                       DisplaySettings const& settings)
{
    glm::ivec2 const eye = eye_size(mode, target.size_px);
    // Bind unused samplers too, to an existing picture.
    ShownPicture const l = left.picture.texture != 0 ? left.picture : left.other;
    EyeView const& second = reads_right(mode) ? right : left;
    ShownPicture const shown[4] = {l, second.picture.texture != 0 ? second.picture : l,
                                   left.other.texture != 0 ? left.other : l,
                                   second.other.texture != 0 ? second.other : l};
    bool stretched = false;
    for (GLuint unit = 0; unit < 4; ++unit) {
        glBindTextureUnit(unit, shown[unit].texture);
        stretched = stretched || shown[unit].size_px != eye;
    }
    bool const is_calibrated = settings.light.table != nullptr && settings.values == PictureValues::radiance;
    if (is_calibrated) bind_table(settings.light.table);
    GlProgram const& p = program(define("MODE", int(mode)) + define("COMPARISON", int(settings.comparison)) +
                                 define("STRETCHED", int(stretched)) + define("CURVE", int(settings.tone.curve)) +
                                 define("ENCODED", int(settings.values == PictureValues::encoded)) +
                                 define("CALIBRATED", int(is_calibrated)));
    p.set("corner", target.corner_px);
    p.set("target_size", target.size_px);
    p.set("top_last", int(target.rows == RowOrder::top_last));
    p.set("eye_size", eye);
    p.set("on_screen", settings.on_screen_px);
    p.set("scale", std::exp2(settings.tone.exposure_ev));
    p.set("split", settings.split);
    p.set("difference_gain", settings.difference_gain);
    p.set("light_gain", settings.light.gain);
    p.set("light_black", settings.light.black);
    p.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// As the fifth texture.
void DisplayPass::bind_table(std::shared_ptr<InverseTable const> const& table)
{
    if (uploaded_ != table) {
        int const steps = int(table->size());
        table_ = texture_2d(GL_RGB32F, {steps, 1}, GL_NEAREST);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTextureSubImage2D(table_.id(), 0, 0, 0, steps, 1, GL_RGB, GL_FLOAT, table->data());
        uploaded_ = table;
    }
    glBindTextureUnit(4, table_.id());
}

GlProgram const& DisplayPass::program(std::string const& kind)
{
    auto const found = std::ranges::find(programs_, kind, &Made::defines);
    if (found != programs_.end()) {
        programs_.splice(programs_.begin(), programs_, found);
        return found->program;
    }
    GlProgram made({"full_screen.vert"}, {"tone_map.glsl", "stereo.glsl", "display.frag"}, enums() + kind);
    DuboisMatrices const dubois;
    made.set("dubois_left", matrix_of(dubois.left));
    made.set("dubois_right", matrix_of(dubois.right));
    programs_.push_front({kind, std::move(made)});
    if (programs_.size() > kPrograms) programs_.pop_back();
    return programs_.front().program;
}

StereoMode mode_on(DrawTarget const& target, StereoMode wanted)
{
    bool const missing = wanted == StereoMode::quad_buffer && target.right_buffer == 0;
    return missing ? StereoMode::side_by_side : wanted;
}

} // namespace viewer
