#pragma once
// Virtual objects in a camera's frame on the GPU: ar/composite's equation with its tables (docs/methods.md). Bytes
// of pixels that nothing changes are the camera's; others differ from the CPU's by one at most, where the two
// round differently.

#include "ar/composite/composite.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

#include <cstdint>

namespace viewer {

/// Belongs to the context that was current when it was made.
class ArCompositePass {
public:
    explicit ArCompositePass(ar::Compositor const& compositor);

    /// Takes the place of the frame before. @param rgb CV_8UC3. Throws gi::InputError on types and sizes.
    void upload(cv::Mat const& rgb, ar::RenderedPair const& pair);
    /// Fills the target, which has the frame's size (throws gi::InputError otherwise). No counts: those are the
    /// CPU's.
    /// @param frame number of the frame: chooses the noise
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
