#include "gi/methods/sh_grid/explain.h"

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/focus.h"
#include "gi/methods/sh_grid/field.h"

#include <fmt/format.h>

namespace gi {
namespace {

PlanItem grid_item(char const* name, Bounds const& box, int voxels)
{
    GridFrame const frame = empty_voxel_grid(box, voxels).blocks.frame;
    double const index_mb = double(frame.cells()) * 4 * 6 * 1e-6; // dense ones, of all its parts
    return {
        name, true,
        fmt::format("{} x {} x {} cells of {:.3g} m, each of 4 x 4 x 4 voxels; indices {:.3g} MB, a cell of the "
                    "field {} bytes",
                    frame.size.x, frame.size.y, frame.size.z, double(frame.cell), index_mb, sizeof(FieldCell))};
}

} // namespace

std::vector<PlanItem> explain_sh_grid(World const& world, RenderSettings const& settings, Camera const& camera)
{
    ShGridSettings const& s = settings.sh_grid;
    if (world.bounds.empty()) return {{"grid", false, "there are no surfaces"}};
    if (world.light_select.empty()) return {{"grid", false, "there is no light"}};
    ExactVisibility const visibility(world, plan_scene(world).alpha_tests, settings.threads);
    FrameView const view{camera, 512, 512};
    Bounds const focus = focus_of(shown_points(world, visibility, {&view, 1}), s.voxels);
    std::vector<PlanItem> out{grid_item("grid of the scene", world.bounds, s.voxels)};
    std::string const extents = fmt::format("what the camera shows is {:.3g} of {:.3g} m long",
                                            double(longest_side(focus)), double(longest_side(world.bounds)));
    if (needs_fine_grid(focus, world.bounds)) {
        out.push_back(grid_item("fine grid of what is shown", focus, s.voxels));
        out.back().reason += "; " + extents;
    } else {
        out.push_back({"fine grid of what is shown", false, extents});
    }
    out.push_back(explain_caustics(world, settings.photons));
    bool const moves = world.static_triangles < world.triangles.size();
    out.push_back(
        {"photons", true,
         fmt::format("{} light paths per update{}", settings.photons.paths,
                     needs_fine_grid(focus, world.bounds) ? ", and as many that begin on surfaces of the fine grid"
                                                          : "")});
    out.push_back({"updates of moving parts", moves,
                   moves ? fmt::format("{} triangles can move; the field follows in {} frames",
                                       world.triangles.size() - world.static_triangles, s.field_passes)
                         : std::string("nothing can move")});
    return out;
}

} // namespace gi
