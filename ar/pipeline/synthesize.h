#pragma once
// Writes a synthetic session: the camera's frames, the ground truth, and the session file that composites them.
//   frames/000000.png ...  the camera's frames      truth/000000.png ...  with the virtual objects really there
//   camera.yaml  markers.yaml  poses.csv (true)     probe.exr   near.glb   statue.glb   session.yaml

#include "ar/markers/marker_map.h"
#include "ar/pipeline/synthetic.h"

#include <filesystem>

namespace ar {

/// What is printed and lies on the table.
enum class DeskMarkers { board, one, none };

/// Markers of a synthetic session, as they lie on the table: of the board, squares are 25 pixels wide at 1 m in
/// pictures of 640 x 480.
MarkerMap synthetic_markers(DeskMarkers which);
/// Their print.
PaperOnTable synthetic_paper(DeskMarkers which);

struct SynthesizeOptions {
    std::filesystem::path folder;
    glm::ivec2 size_px{640, 480};
    int frames = 30;
    double rate_hz = 30;
    SyntheticQuality quality;
    /// Rasterised with a sky as the only light, without shadows, and with a printed
    /// cloth on the table: for tracking. Not with `truth`.
    bool quick = false;
    DeskMarkers markers = DeskMarkers::board; ///< others only with `quick`
    bool apart = false;                       ///< the camera goes another way (synthetic_pose_apart)
    bool truth = true;                        ///< also write the pictures with the virtual objects
};

/// Existing frames are kept, so an interrupted run can be continued. Says on stderr how long it will take, as
/// measured on the first frame.
/// @return number of frames now in the folder. @throws gi::InputError the folder cannot be written, or contains a
/// session with other options
int synthesize(SynthesizeOptions const& options, gi::StopRequest const& stop, gi::Report& report);

} // namespace ar
