#pragma once
// Samples that all pixels of a pass share: independent randomised low-discrepancy sequences over the passes, so
// that the mean of the passes contains the pixel filter, depth of field and motion blur (Yu 2012, sec. 7.2;
// distributed over the paths by Cook, Porter and Carpenter 1984, over passes by Haeberli and Akeley 1990).

#include "gi/core/rqmc.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/shading/warp.h"

namespace gi {

namespace pass_samples_detail {

/// @param what  identifies the sequence
inline vec4 sample(std::uint64_t seed, std::uint64_t what, std::uint32_t pass)
{
    return RqmcStream(std::uint32_t(mix_bits(seed ^ what)), pass).sample_together(0);
}

} // namespace pass_samples_detail

/// Sample in [0, 1)^2, to be warped by the pixel filter.
inline vec2 sample_in_pixel(std::uint64_t seed, std::uint32_t pass)
{
    return vec2(pass_samples_detail::sample(seed, 0xca3e7a, pass));
}
/// Returns the camera at the lens point sampled for a pass; a pinhole camera unchanged.
inline CameraRays eye_of_pass(CameraRays const& camera, std::uint64_t seed, std::uint32_t pass)
{
    if (!camera.has_lens()) return camera;
    return camera.at_lens(square_to_disk(vec2(pass_samples_detail::sample(seed, 0x1e45, pass))));
}

/// Moment of a pass in [0, 1), as a fraction of the time that the shutter is open.
inline double moment_of_pass(std::uint64_t seed, std::uint32_t pass)
{
    return double(pass_samples_detail::sample(seed, 0x54f7e4, pass).x);
}
/// Further moments of a pass, in [0, 1): one in each of `parts` equal parts of that time, all at the same place in
/// their parts. @param part  < parts
inline double moment_in_part(std::uint64_t seed, std::uint32_t pass, std::uint32_t part, std::uint32_t parts)
{
    return (double(part) + double(pass_samples_detail::sample(seed, 0x9a475, pass).x)) / double(parts);
}

} // namespace gi
