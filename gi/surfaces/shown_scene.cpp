#include "gi/surfaces/shown_scene.h"

#include "gi/surfaces/seen_surfaces.h"

namespace gi {
namespace {

template <class T>
std::vector<T> moving_part(World const& world, std::vector<T> const& all)
{
    if (all.empty()) return {};
    return {all.begin() + std::ptrdiff_t(world.static_vertices), all.end()};
}

} // namespace

std::shared_ptr<ShownScene const> shown_scene(std::shared_ptr<MovingWorld const> const& world,
                                              Changes const& changes, ShownScene const* last)
{
    World const& w = world->world();
    if (last != nullptr && last->world.get() != &w) last = nullptr;
    auto next = last ? std::make_shared<ShownScene>(*last) : std::make_shared<ShownScene>();
    next->world = {world, &w};
    if (!last) {
        auto parts = std::make_shared<ShownScene::MovingParts>();
        for (Instance const& i : world->moving())
            parts->instances.push_back({i.node, i.first_vertex - w.static_vertices, i.mesh, i.center});
        parts->triangles.assign(w.triangles.begin() + std::ptrdiff_t(w.static_triangles), w.triangles.end());
        next->moving = parts;
    }
    if (!last || changes.geometry)
        next->moved = std::make_shared<ShownScene::Moved const>(
            ShownScene::Moved{moving_part(w, w.positions), moving_part(w, w.normals), moving_part(w, w.tangents)});
    if (!last ||
        ((changes.materials || changes.coverage || changes.emitters) && !(*last->materials == w.materials)))
        next->materials = std::make_shared<std::vector<Material> const>(w.materials);
    WorldView const of = view(w);
    next->lights = SeenSurfaces::has_few_lights(w) ? w.lights : std::vector<Light>();
    next->authored_intensities.clear();
    for (std::size_t k = 0; k < next->lights.size(); ++k)
        next->authored_intensities.push_back(world->authored_intensity(k));
    next->environment = w.environment;
    next->environment_cos = of.environment_cos;
    next->environment_sin = of.environment_sin;
    next->environment_scale = w.environment_scale;
    next->background = of.background;
    next->radius_m = w.bounds.radius();
    return next;
}

std::shared_ptr<ShownScene::Moved const> moved_to(ShownScene const& scene, Pose const& pose)
{
    auto moved = std::make_shared<ShownScene::Moved>(*scene.moved);
    World const& w = *scene.world;
    InstancePlacement placement;
    for (ShownScene::Moving const& m : scene.moving->instances) {
        place_instance(*w.scene, pose, m.node, *m.mesh, m.center, w.origin, placement);
        auto const part = [&]<class T>(std::vector<T>& all) {
            return all.empty() ? View<T>() : View<T>(all.data() + m.first_vertex, m.mesh->positions.size());
        };
        deform(*m.mesh, m.center, placement,
               {part(moved->positions), part(moved->normals), part(moved->tangents)});
    }
    return moved;
}

} // namespace gi
