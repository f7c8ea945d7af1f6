#include "gi/hit_buffers/directions/stored_axes.h"

#include "gi/hit_buffers/directions/grid_bounds.h"

#include <cmath>

namespace gi {
namespace {

/// Rows of the table of nearest axes: about 16 texels per direction.
std::uint32_t map_size(std::size_t directions)
{
    return std::uint32_t(std::ceil(4 * std::sqrt(double(directions))));
}

} // namespace

SlhbSettings with_stored_axes(SlhbSettings settings)
{
    if (settings.directions.empty()) settings.directions = "icosahedron:320";
    if (settings.resolution == 0) settings.resolution = 128;
    return settings;
}

StoredAxes::StoredAxes(World const& world, SlhbSettings const& settings, std::uint64_t seed,
                       std::size_t first_moving, StopRequest const* stop)
    : world_(world),
      settings_(settings),
      seed_(seed),
      first_moving_(first_moving),
      stop_(stop),
      soup_(make_soup(world)),
      cut_outs_(world)
{
    build(world.bounds);
}

void StoredAxes::build(Bounds const& bounds)
{
    bounds_ = bounds;
    axes_ = std::make_unique<AxisSet>(AxisSet::Source{.bounds = bounds_,
                                                      .soup = soup_,
                                                      .cut_outs = cut_outs_,
                                                      .resolution = std::uint32_t(settings_.resolution),
                                                      .most_layers = std::uint32_t(settings_.most_layers),
                                                      .packed = false,
                                                      .seed = seed_,
                                                      .stop = stop_,
                                                      .first_moving = first_moving_});
    DirectionSet set = make_directions(settings_.directions);
    axes_->store(set);
    axes_->update_axes();
    for (std::size_t a = 0; a < set.axes.size(); ++a) set.axes[a] = dvec3(axes_->axis(a)); // rotated by the seed
    nearest_ = make_direction_map(set, SphereMapping::octahedral, map_size(set.size()));
    directions_.clear();
    for (std::size_t k = 0; k < set.size(); ++k)
        directions_.push_back({vec3(set.direction(k)), axes_->pool().grids[k / 2].texel});
}

void StoredAxes::moved()
{
    update_soup(world_, first_moving_, soup_);
    if (grow(bounds_, world_.bounds)) return build(bounds_);
    axes_->moved();
    axes_->update_axes();
}

} // namespace gi
