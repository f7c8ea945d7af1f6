#pragma once
// Composites virtual objects into a camera frame on the GPU:
// ar/composite's equation with its tables (docs/methods/ar-light.md). Unchanged pixels keep the camera's bytes;
// others differ from the CPU result by at most one, due to rounding.

#include "ar/composite/composite.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

#include <cstdint>

namespace viewer {

/// Belongs to the context that was current at its creation.
class ArCompositePass {
public:
    explicit ArCompositePass(ar::Compositor const& compositor);

    /// Replaces the previous frame. @param rgb CV_8UC3. Throws gi::InputError on wrong types and sizes.
    void upload(cv::Mat const& rgb, ar::RenderedPair const& pair);
    /// Fills the target, which must have the frame's size (throws gi::InputError otherwise). Returns no counts;
    /// only the CPU version does.
    /// @param frame  frame number: seeds the noise
    void draw(DrawTarget const& target, ar::Exposure const& exposure, std::uint64_t frame = 0) const;

private:
    ar::Compositor compositor_;
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array};
    GlObject camera_, with_, without_, coverage_, response_, cells_, noise_, direct_;
    bool has_direct_ = false;
    glm::ivec2 size_px_{};
};

} // namespace viewer
