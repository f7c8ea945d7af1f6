#pragma once
// A synthetic session as files: what a camera would have seen, what is true, and the session that composites it.
//   frames/000000.png ...  the camera's frames      truth/000000.png ...  with the virtual things really there
//   camera.yaml  markers.yaml  poses.csv (true)     probe.exr   near.glb   statue.glb   session.yaml

#include "ar/pipeline/synthetic.h"

#include <filesystem>

namespace viewer {

struct SynthesizeOptions {
    std::filesystem::path folder;
    glm::ivec2 size_px{640, 480};
    int frames = 300;
    double rate_hz = 30;
    SyntheticQuality quality;
    bool truth = true; ///< also the pictures with the virtual things
};

/// Frames that are there already are kept, so that it can be interrupted and go on.
/// @return frames that are there now. @throws gi::InputError the folder cannot be written, or holds a session of
/// other options
int synthesize(SynthesizeOptions const& options, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
