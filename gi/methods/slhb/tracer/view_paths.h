#pragma once
// The paths of a pass through all views of a moment: which pixels start one, which take their light from a partner
// view, which paths share what is sent on where they end, and the sums that all of it goes to.

#include "gi/core/report.h"
#include "gi/methods/slhb/tracer/partner_light.h"
#include "gi/methods/slhb/tracer/seen_view.h"
#include "gi/methods/slhb/tracer/shared_vertices.h"
#include "gi/methods/slhb/tracer/tracer.h"
#include "gi/render/accumulator.h"
#include "gi/render/pair_sums.h"

#include <functional>

namespace gi {

/// Whether what the pass looks at has what moves in it.
using ShowMoving = std::function<void(bool)>;

class ViewPaths {
public:
    /// All outlive this.
    ViewPaths(World const& world, RenderSettings const& settings, Report& report);

    /// One more path for every pixel; G-buffers of the pass are there already. @param sums  one per view
    void trace(SlhbTracer::Pass const& pass, SeenViews const& views, VertexSharing sharing,
               std::span<Accumulator> sums);

    /// A pass of the first view, with what moves and without it, by the same random numbers: of the latter only
    /// the paths that what moves may count in (Pass::first_watched).
    void trace_pair(SlhbTracer::Pass const& pass, SeenViews const& views, ShowMoving const& show_moving,
                    PairSums& sums, PathCounts& counts);

    /// What the paths of the last pass brought; one per pixel of a view.
    std::span<PathSample const> samples(SeenView const& view) const
    {
        return std::span(samples_).subspan(view.first, view.pixels());
    }
    /// RenderResult::light_from of the passes since the sums were empty; of a view with a partner.
    std::span<std::uint32_t const> light_from(SeenView const& view) const
    {
        return std::span(light_from_).subspan(view.first, view.pixels());
    }
    /// Of the time of the last pass, what follows first surfaces.
    double indirect_share() const { return indirect_share_; }
    double rays() const; ///< look-ups and exact rays, so far
    /// What has been done so far.
    void report_work() const;

private:
    struct Counts;
    struct Work;
    void choose_block();
    SlhbTracer tracer_of(SeenView const& view) const;
    bool start_sharing(SlhbTracer::Pass const& pass, VertexSharing sharing);
    void trace_view(SlhbTracer::Pass const& pass, SeenViews const& views, SeenView const& view, bool sharing,
                    Work& work);
    void trace_all(SlhbTracer::Pass const& pass, SlhbTracer const& tracer, std::size_t first, bool sharing,
                   std::span<PathStart const> starts, std::vector<CacheNote>& notes, Counts& counts);
    void trace_some(SlhbTracer::Pass const& pass, SlhbTracer const& tracer, SeenView const& view,
                    PartnerLight const* partner, bool sharing, std::vector<PathStart>& starts,
                    std::vector<CacheNote>& notes, Counts& counts);
    void send_on(SlhbTracer::Pass const& pass, SeenView const& view, Work& work);
    void add(SeenViews const& views, std::size_t index, bool sharing, std::span<Accumulator> sums, Work& work);
    void add_work(Work& work, PathCounts& counts);

    World const& world_;
    RenderSettings const& settings_;
    Report& report_;
    std::size_t block_ = 0; ///< pixels whose paths advance together on one thread
    SharedVertices shared_;
    std::vector<std::vector<CacheNote>> notes_; ///< per block of pixels of a view
    std::vector<PathSample> samples_;           ///< of the pixels of all views
    std::vector<SharedVertex> shared_vertices_; ///< the same
    std::vector<std::uint32_t> taken_from_;     ///< the same: pixel of the partner's view
    std::vector<std::uint32_t> light_from_;     ///< the same, of all passes of a frame
    std::vector<std::vector<std::uint32_t>>
        near_moving_;                           ///< per block of pixels: those that what moves may count in
    std::vector<std::uint32_t> without_pixels_; ///< all of those
    std::vector<PathSample> without_;           ///< and their paths without it
    SlhbCounts done_;
    double indirect_share_ = 0;
    std::uint64_t taken_ = 0, taking_ = 0;  ///< pixels that took light from a partner; of those that could
    std::uint64_t hidden_ = 0, pixels_ = 0; ///< not traced, as nobody sees them; all, in all passes
    std::uint64_t pair_paths_ = 0, without_paths_ = 0; ///< of pairs with what moves; of these, traced again
};

} // namespace gi
