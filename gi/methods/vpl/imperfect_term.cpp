#include "gi/methods/vpl/imperfect_term.h"

#include "gi/core/error.h"
#include "gi/core/rqmc.h"

#include <bit>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Tolerated distance of a receiver behind the stored surface, relative to a disk's radius.
constexpr float kSlack = 0.5f;

std::uint32_t checked(VirtualLightSettings const& s)
{
    if (s.point_map < 8 || s.point_map > 1024 || !std::has_single_bit(unsigned(s.point_map)))
        throw InputError(fmt::format("--point-map {}", s.point_map),
                         "maps are a power of two on a side, 8 to 1024", "choose 64, 128 or 256");
    if (s.points < 1 || s.points > int(PointCloud::kCount))
        throw InputError(fmt::format("--points {}", s.points),
                         fmt::format("a map takes 1 to {} points", PointCloud::kCount), "choose fewer or more");
    return std::uint32_t(s.point_map);
}

} // namespace

ImperfectTerm::ImperfectTerm(TermSource const& source)
    : world_(source.world),
      vpl_(source.settings.of<VirtualLightSettings>()),
      seed_(source.settings.seed),
      cloud_(make_point_cloud(source.world, seed_)),
      grid_{checked(vpl_)}
{
}

void ImperfectTerm::world_changed() { cloud_ = make_point_cloud(world_, seed_); }

void ImperfectTerm::prepare(std::span<LightVertex const> lights, std::uint32_t pass, PassStop const& stop)
{
    lights_.resize(lights.size());
    std::size_t const texels = std::size_t(grid_.size) * grid_.size;
    maps_.resize(lights.size() * texels);
    auto const count = std::uint32_t(vpl_.points);
    // Subsets start at multiples of a power of two, so that each is evenly distributed.
    std::uint32_t const step = std::bit_ceil(count), subsets = std::max(1u, PointCloud::kCount / step);
    tbb::parallel_for(std::size_t(0), lights.size(), [&](std::size_t k) {
        stop.check();
        thread_local std::vector<float> scratch;
        std::uint32_t const first = hash_words(std::uint32_t(k), pass) % subsets * step;
        lights_[k] = {lights[k].position, Frame::about(lights[k].normal), maps_.data() + k * texels};
        draw_imperfect_map(cloud_, {first, count}, lights[k], grid_, std::span(maps_).subspan(k * texels, texels),
                           scratch);
    });
    drawn_ += lights.size();
}

void ImperfectTerm::of_connections(ReceiverTile const& tile, std::span<Connection const> connections,
                                   std::span<float> shares, PathCounts&) const
{
    float const slack = kSlack * cloud_.disk_radius(std::uint32_t(vpl_.points));
    for (std::size_t k = 0; k < connections.size(); ++k) {
        Connection const& c = connections[k];
        Receiver const& r = tile.receivers[c.receiver];
        shares[k] = is_lit(lights_[c.light], grid_, r.position, r.geometric_normal, slack) ? 1.0f : 0.0f;
    }
}

void ImperfectTerm::report_work(Report& report)
{
    report.count("imperfect shadow maps", double(drawn_));
    report.count("points per imperfect shadow map", double(vpl_.points));
}

} // namespace gi
