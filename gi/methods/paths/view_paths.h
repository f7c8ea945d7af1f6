#pragma once
// Traces the paths of a pass for all views of a moment: decides which pixels start a path, which reuse light from
// a partner view, and which paths share vertices; adds the results to the sums.

#include "gi/core/report.h"
#include "gi/methods/paths/bias_control.h"
#include "gi/methods/paths/layered_lens.h"
#include "gi/methods/paths/partner_light.h"
#include "gi/methods/paths/primary_map.h"
#include "gi/methods/paths/shared_vertices.h"
#include "gi/methods/paths/traced_world.h"
#include "gi/methods/paths/tracer.h"
#include "gi/render/accumulator.h"
#include "gi/render/pair_sums.h"

#include <deque>
#include <functional>
#include <optional>

namespace gi {

/// A view as used by passes, and its state kept between frames.
struct SeenView : TracedView {
    int partner = -1;
    std::span<std::uint8_t const> hidden; ///< as in FrameView
    std::optional<PrimaryMap> primary;    ///< none for orthographic cameras
    /// If paths find surfaces there: of the view, and of what stays in it, for pairs.
    std::optional<ScreenLayers> screen, screen_behind;
    std::vector<CameraRays> during;       ///< FrameView::during
    std::optional<LayeredLens> lens;      ///< if it is gathered from layers
    std::size_t first = 0;                ///< index of its first pixel among the pixels of all views
};

/// What its LayeredLens needs in a pass.
LayeredLens::View lens_view(SeenView const& view, std::uint64_t seed, std::uint32_t pass);

/// Views of one moment; a partner precedes the views that reuse its light.
using SeenViews = std::deque<SeenView>;

/// Callback that includes dynamic geometry in, or excludes it from, the structures that a pass uses.
using ShowMoving = std::function<void(bool)>;

class ViewPaths {
public:
    /// All arguments must outlive this object.
    ViewPaths(World const& world, RenderSettings const& settings, Report& report);

    /// Traces one more path for every pixel; the pass's G-buffers must be ready. @param sums  one per view;
    ///   unchanged if Pass::stop makes this throw Interrupted
    void trace(PathsTracer::Pass const& pass, SeenViews const& views, VertexSharing sharing,
               std::span<Accumulator> sums);

    /// Traces a pass of the first view with and without dynamic geometry, with the same random numbers; without
    /// it, only paths that dynamic geometry may affect (Pass::first_watched).
    void trace_pair(PathsTracer::Pass const& pass, SeenViews const& views, ShowMoving const& show_moving,
                    PairSums& sums, PathCounts& counts);

    /// The same for views through a layered lens, which has looked.
    void trace_lenses(PathsTracer::Pass const& pass, SeenViews const& views, std::span<Accumulator> sums);
    /// Traces some paths of a view by look-ups and again by exact rays; adds nothing once Pass::stop is given up.
    void control(PathsTracer::Pass const& pass, SeenView const& view, BiasControl& sums);

    /// Samples of the last pass's paths, one per pixel of a view.
    std::span<PathSample const> samples(SeenView const& view) const
    {
        return std::span(samples_).subspan(view.first, view.pixels());
    }
    /// RenderResult::light_from over the passes since the sums were empty, for a view with a partner.
    std::span<std::uint32_t const> light_from(SeenView const& view) const
    {
        return std::span(light_from_).subspan(view.first, view.pixels());
    }
    /// Fraction of the last pass's time spent after first surfaces.
    double indirect_share() const { return indirect_share_; }
    double rays() const; ///< number of look-ups and exact rays so far
    /// Reports the work done so far.
    void report_work() const;

private:
    struct Counts;
    struct Work;
    void choose_block();
    PathsTracer tracer_of(SeenView const& view) const;
    bool start_sharing(PathsTracer::Pass const& pass, VertexSharing sharing);
    void trace_view(PathsTracer::Pass const& pass, SeenViews const& views, SeenView const& view, bool sharing,
                    Work& work);
    void trace_all(PathsTracer::Pass const& pass, PathsTracer const& tracer, std::size_t first, bool sharing,
                   std::span<PathStart const> starts, std::vector<CacheNote>& notes, Counts& counts);
    void trace_some(PathsTracer::Pass const& pass, PathsTracer const& tracer, SeenView const& view,
                    PartnerLight const* partner, bool sharing, std::vector<PathStart>& starts,
                    std::vector<CacheNote>& notes, Counts& counts);
    template <class Trace>
    void in_turns(PathsTracer::Pass const& pass, std::size_t paths, Trace const& trace_block, Work& work);
    void send_on(PathsTracer::Pass const& pass, SeenView const& view, Work& work);
    void add(SeenViews const& views, std::size_t index, bool sharing, std::span<Accumulator> sums, Work& work);
    void add_work(Work& work, PathCounts& counts);

    World const& world_;
    RenderSettings const& settings_;
    Report& report_;
    std::size_t block_ = 0; ///< number of pixels whose paths advance together on one thread
    SharedVertices shared_;
    std::vector<std::vector<CacheNote>> notes_;           ///< per block of pixels of a view
    std::vector<PathSample> samples_;                     ///< of the pixels of all views
    std::vector<SharedVertex> shared_vertices_;           ///< per pixel of all views
    std::vector<std::uint32_t> taken_from_;               ///< per pixel of all views: pixel of the partner's view
    std::vector<std::uint32_t> light_from_;               ///< per pixel of all views, for all passes of a frame
    std::vector<std::vector<std::uint32_t>> near_moving_; ///< per block: pixels that dynamic geometry may affect
    std::vector<std::uint32_t> without_pixels_;           ///< all of these pixels
    std::vector<PathSample> of_layers_;                   ///< that lens rays met
    std::vector<PathSample> without_;                     ///< their paths without dynamic geometry
    PathsWork done_;
    double indirect_share_ = 0;
    std::uint64_t taken_ = 0, taking_ = 0; ///< pixels that reused a partner's light; pixels that could
    /// Pixels not traced because they are hidden; all pixels; over all passes.
    std::uint64_t hidden_ = 0, pixels_ = 0;
    std::uint64_t lens_rays_ = 0, lens_paths_ = 0, lens_alone_ = 0;
    /// Paths of pairs with dynamic geometry; of these, traced again without it.
    std::uint64_t pair_paths_ = 0, without_paths_ = 0;
};

} // namespace gi
