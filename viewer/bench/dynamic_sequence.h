#pragma once
// The frames of one scene with one structure and one seed, and what each part of them takes.

#include "gi/filter/denoise.h"
#include "gi/filter/temporal.h"
#include "gi/render/frame_renderer.h"
#include "viewer/bench/dynamic.h"
#include "viewer/engine/flat_triangles.h"

namespace viewer {

/// What the slhb method does about what moves.
struct Structure {
    std::string_view name;
    gi::Schedule schedule;
    bool moves, anew; ///< time passes; everything is built anew for every frame
};

/// Throws InputError naming those that there are.
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
        gi::Picture picture, alone; ///< filtered; the second without reuse, where there is reuse
        FrameSeconds seconds;
        std::uint32_t paths = 0;
    };
    /// The next one. @param wants_alone  which costs time of nobody's frame
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
