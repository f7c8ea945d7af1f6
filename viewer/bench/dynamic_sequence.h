#pragma once
// Frames of one scene with one structure and one seed, and the times of their parts.

#include "gi/filter/denoise.h"
#include "gi/filter/temporal.h"
#include "gi/hit_buffers/settings.h"
#include "gi/render/frame_renderer.h"
#include "viewer/bench/dynamic.h"
#include "viewer/engine/flat_triangles.h"

namespace viewer {

/// How method slhb handles moving geometry.
struct Structure {
    std::string_view name;
    gi::Schedule schedule;
    bool moves, anew; ///< moves: the animation runs; anew: everything is rebuilt in every frame
};

/// Throws InputError listing the known structures.
Structure const& find_structure(std::string const& name);

struct FrameSeconds {
    double world = 0, structures = 0, shadow_maps = 0, g_buffer = 0, direct = 0, indirect = 0, reuse = 0,
           filter = 0, whole = 0;
};

class DynamicSequence {
public:
    DynamicSequence(DynamicOptions const& options, std::shared_ptr<gi::Scene const> const& scene,
                    Structure const& structure, gi::RenderSettings const& settings, gi::Report& report);

    struct Frame {
        gi::Picture picture, alone; ///< filtered, with and without reuse; `alone` only with reuse
        FrameSeconds seconds;
        std::uint32_t paths = 0;
    };
    /// Renders the next frame. @param wants_alone  also without reuse; not included in the times
    Frame next(gi::DenoiseSettings const& filter, bool wants_alone);

    gi::World const& world() const { return world_.world(); }

private:
    gi::Camera eye() const;
    std::unique_ptr<gi::FrameRenderer> start();

    DynamicOptions const& o_;
    Structure const& structure_;
    gi::RenderSettings settings_;
    gi::Report& report_;
    gi::MovingWorld world_;
    FlatTriangles flat_;
    std::unique_ptr<gi::FrameRenderer> renderer_;
    gi::TemporalReuse reuse_;
    gi::ReportReader stages_;
    gi::Camera last_eye_;
    int frame_ = 0;
};

} // namespace viewer
