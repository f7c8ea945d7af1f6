#include "gi/methods/sh_grid/explain.h"

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/focus.h"
#include "gi/methods/sh_grid/field.h"

namespace gi {
namespace {

PlanText cells_of(Bounds const& box, int voxels)
{
    GridFrame const frame = empty_voxel_grid(box, voxels).blocks.frame;
    std::uint64_t const index_bytes = std::uint64_t(frame.cells()) * 4 * 6; // dense ones, of all its parts
    return {"{} x {} x {} cells of {} m, each of 4 x 4 x 4 voxels; indices {}, a cell of the field {} bytes",
            {figure("cells_x", frame.size.x), figure("cells_y", frame.size.y), figure("cells_z", frame.size.z),
             figure("cell_m", double(frame.cell), 3), figure_of_bytes("index_bytes", index_bytes),
             figure("field_cell_bytes", sizeof(FieldCell))}};
}

} // namespace

std::vector<PlanItem> explain_sh_grid(World const& world, RenderSettings const& settings, Camera const& camera)
{
    ShGridSettings const& s = settings.of<ShGridSettings>();
    if (world.bounds.empty()) return {{"grid", "grid", false, "there are no surfaces"}};
    if (world.light_select.empty()) return {{"grid", "grid", false, "there is no light"}};
    ExactVisibility const visibility(world, plan_scene(world).alpha_tests, settings.threads);
    FrameView const view{camera, 512, 512};
    Bounds const focus = focus_of(shown_points(world, visibility, {&view, 1}), s.voxels);
    std::vector<PlanItem> out;
    out.push_back({"grid", "grid of the scene", true, cells_of(world.bounds, s.voxels)});
    PlanText const extents("what the camera shows is {} of {} m long",
                           {figure("shown_length_m", double(longest_side(focus)), 3),
                            figure("scene_length_m", double(longest_side(world.bounds)), 3)});
    bool const has_fine = needs_fine_grid(focus, world.bounds);
    out.push_back({"fine_grid", "fine grid of what is shown", has_fine,
                   has_fine ? cells_of(focus, s.voxels) + "; " + extents : extents});
    out.push_back(explain_caustics(world, settings.of<PhotonSettings>()));
    out.push_back({"photons", "photons", true,
                   PlanText("{} light paths per update", {figure("paths", settings.of<PhotonSettings>().paths)}) +
                       (has_fine ? ", and as many that begin on surfaces of the fine grid" : "")});
    std::size_t const moving = world.triangles.size() - world.static_triangles;
    out.push_back({"moving_parts", "updates of moving parts", moving > 0,
                   moving > 0 ? PlanText("{} triangles can move; the field follows in {} frames",
                                         {figure("moving_triangles", moving), figure("frames", s.field_passes)})
                              : "nothing can move"});
    return out;
}

} // namespace gi
