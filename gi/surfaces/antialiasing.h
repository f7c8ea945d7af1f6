#pragma once
// Temporal antialiasing and upsampling: pictures whose rays pass another place of their pixels in each frame are
// averaged along the motion of what they show, at the size of the screen, which may be larger than theirs. So
// outlines and textures are smooth, and finer than one picture's (Yang, Liu and Salvi 2020). Earlier colours are
// held within the range of the pixels around, so that what has changed does not stay.

#include "gi/image_io/picture.h"

#include <cstdint>
#include <vector>

namespace gi {

class Antialiasing {
public:
    /// Where the rays of the next picture pass its pixels, 0..1 from their top left corner.
    vec2 sample() const;
    /// Returns the mean with earlier pictures: layers "color" and "depth",
    /// of a size that is at least the picture's.
    /// @param picture  with the layer "motion" as in gi/render/motion.h, except that pixels without a surface may
    ///   have a motion, with depth 0. Sizes may change from frame to frame.
    Picture add(Picture const& picture, int width, int height);

private:
    struct Texel {
        vec3 color{0};
        float weight = 0; ///< of the samples that it is the mean of; one at its middle has 1
    };
    Texel earlier(vec2 place, float depth) const;

    std::uint32_t frame_ = 0;
    int width_ = 0, height_ = 0; ///< of the last mean; 0 = none
    std::vector<Texel> texels_, last_;
    std::vector<float> last_depths_; ///< of the last mean
};

} // namespace gi
