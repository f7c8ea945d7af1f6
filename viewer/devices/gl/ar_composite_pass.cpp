#include "viewer/devices/gl/ar_composite_pass.h"

#include "gi/core/error.h"
#include "viewer/devices/gl/fill_texture.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace viewer {
namespace {

std::string defines(ar::CompositeSettings const& settings)
{
    return fmt::format("#define RATIO {}\n#define CLIPPED {}\n#define NOISE {}\n#define CLIPPED_AS_MEASURED {}\n"
                       "#define CLIPPED_MODEL {}\n",
                       int(settings.blend == ar::Blend::ratio), int(settings.clipped), int(settings.noise.any()),
                       int(ar::ClippedBytes::as_measured), int(ar::ClippedBytes::model));
}

glm::vec3 vector_of(std::array<float, 3> const& v) { return {v[0], v[1], v[2]}; }

} // namespace

ArCompositePass::ArCompositePass(ar::Compositor const& compositor)
    : compositor_(compositor),
      program_({"full_screen.vert"}, {"ar_composite.frag"}, defines(compositor.settings())),
      response_(texture_2d(GL_RGBA32F, {256, 3}, GL_NEAREST)),
      cells_(texture_2d(GL_R8UI, {int(ar::ResponseTable::kCells) + 1, 3}, GL_NEAREST))
{
    cv::Mat table(3, 256, CV_32FC4), cells(3, int(ar::ResponseTable::kCells) + 1, CV_8UC1);
    glm::vec3 cells_per_unit;
    for (int c = 0; c < 3; ++c) {
        ar::ResponseTable const& r = compositor_.response(c);
        for (int b = 0; b < 256; ++b) {
            auto const i = std::size_t(b);
            table.at<cv::Vec4f>(c, b) = {r.units()[i], r.borders()[i], r.least()[i], r.most()[i]};
        }
        std::copy(r.cells().begin(), r.cells().end(), cells.ptr(c));
        cells_per_unit[c] = r.cells_per_unit();
    }
    fill_texture(response_, table, GL_RGBA, GL_FLOAT);
    fill_texture(cells_, cells, GL_RED_INTEGER, GL_UNSIGNED_BYTE);
    program_.set("cells_per_unit", cells_per_unit);
    ar::SensorNoise const& noise = compositor_.settings().noise;
    if (noise.any()) {
        noise_ = texture_2d(GL_RGB32F, {ar::NoiseField::kSize, ar::NoiseField::kSize}, GL_NEAREST);
        fill_texture(noise_, compositor_.noise().tile(), GL_RGB, GL_FLOAT);
    }
    auto const& v = compositor_.photometry().vignetting;
    program_.set("vignetting", glm::vec3(v[0], v[1], v[2]));
    program_.set("noise_constant", vector_of(noise.constant));
    program_.set("noise_per_unit", vector_of(noise.per_unit));
    program_.set("largest_ratio", compositor_.settings().largest_ratio);
}

void ArCompositePass::upload(cv::Mat const& rgb, ar::RenderedPair const& pair)
{
    if (rgb.type() != CV_8UC3 || rgb.empty())
        throw gi::InputError("the camera's frame is not RGB of 8 bits", "other formats are not supported",
                             "convert it with rgb_of()");
    ar::check(pair, rgb.size());
    if (glm::ivec2 const size(rgb.cols, rgb.rows); size != size_px_) {
        size_px_ = size;
        camera_ = texture_2d(GL_RGB8, size, GL_NEAREST);
        with_ = texture_2d(GL_RGB32F, size, GL_NEAREST);
        without_ = texture_2d(GL_RGB32F, size, GL_NEAREST);
        coverage_ = texture_2d(GL_R32F, size, GL_NEAREST);
        direct_ = {};
    }
    fill_texture(camera_, rgb, GL_RGB, GL_UNSIGNED_BYTE);
    fill_texture(with_, pair.with, GL_RGB, GL_FLOAT);
    fill_texture(without_, pair.without, GL_RGB, GL_FLOAT);
    fill_texture(coverage_, pair.coverage, GL_RED, GL_FLOAT);
    has_direct_ = !pair.direct.empty();
    if (!has_direct_) return;
    if (direct_.id() == 0) direct_ = texture_2d(GL_RGB32F, size_px_, GL_NEAREST);
    fill_texture(direct_, pair.direct, GL_RGB, GL_FLOAT);
}

void ArCompositePass::draw(DrawTarget const& target, ar::Exposure const& exposure, std::uint64_t frame) const
{
    if (size_px_.x == 0 || target.size_px != size_px_)
        throw gi::InputError(fmt::format("a composite of {} x {} pixels for a target of {} x {}", size_px_.x,
                                         size_px_.y, target.size_px.x, target.size_px.y),
                             "the camera's pixels are not resampled",
                             "upload first, draw into a texture of the frame's size, and show that");
    bind(target);
    GlObject const& noise = noise_.id() != 0 ? noise_ : response_;
    GLuint unit = 0;
    for (GlObject const* t :
         {&camera_, &with_, &without_, &coverage_, &response_, &cells_, &noise, has_direct_ ? &direct_ : &with_})
        glBindTextureUnit(unit++, t->id());
    cv::Matx33f const m = compositor_.unit_of_radiance(exposure);
    glm::mat3 to_unit;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) to_unit[c][r] = m(r, c);
    cv::Point const offset = compositor_.noise().offset(frame);
    program_.set("corner", target.corner_px);
    program_.set("target_size", target.size_px);
    program_.set("top_last", int(target.rows == RowOrder::top_last));
    program_.set("has_direct", int(has_direct_));
    program_.set("to_unit", to_unit);
    program_.set("noise_offset", glm::ivec2(offset.x, offset.y));
    program_.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace viewer
