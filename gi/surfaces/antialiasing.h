#pragma once
// Temporal antialiasing: pictures whose rays pass another place of their pixels in each frame are averaged along
// the motion of what they show, so that outlines and textures are smooth (Yang, Liu and Salvi 2020). Earlier
// colours are held within the range of the pixels around, so that what has changed does not stay.

#include "gi/image_io/picture.h"

#include <cstdint>
#include <vector>

namespace gi {

class Antialiasing {
public:
    /// Where the rays of the next picture pass its pixels, 0..1 from their top left corner.
    vec2 sample() const;
    /// Replaces "color" by its mean with earlier pictures, and takes the layer "motion" away, which must be as in
    /// gi/render/motion.h, except that pixels without a surface may have a motion, with depth 0. Sizes may change.
    void add(Picture& picture);

private:
    struct Texel {
        vec3 color{0};
        float frames = 0; ///< that it is the mean of
    };
    Texel earlier(vec2 place, float depth) const;

    std::uint32_t frame_ = 0;
    int width_ = 0, height_ = 0; ///< of the last picture; 0 = none
    std::vector<Texel> texels_, last_;
    std::vector<float> depths_, last_depths_;
};

} // namespace gi
