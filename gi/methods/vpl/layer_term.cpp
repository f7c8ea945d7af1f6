#include "gi/methods/vpl/layer_term.h"

#include "gi/hit_buffers/query_batch.h"

#include <cmath>

namespace gi {

/// One end of a connection.
struct LayerTerm::End {
    vec3 position, normal; ///< geometric, towards the other end
    std::uint32_t triangle;
    bool front; ///< the normal is on the counter-clockwise side
};

/// Walks that are looked up together, and the distances within which their hits block.
struct LayerTerm::Walks {
    struct Far {
        vec3 from, along; ///< m; unit
        float reach;      ///< largest distance of a blocking hit, m
        std::uint32_t triangle, connection;
    };
    QueryBatch batch;
    std::vector<Far> ends;
    std::size_t count = 0;

    void start(std::size_t most)
    {
        batch.resize(most);
        ends.resize(most);
        count = 0;
    }
};

LayerTerm::LayerTerm(TermSource const& source)
    : world_(source.world),
      axes_(source.world, source.settings.of<SlhbSettings>(), source.settings.seed, source.first_moving, source.stop)
{
}

/// Adds the walk; returns false if its axis does not leave `from`.
bool LayerTerm::leave(End const& from, End const& to, std::uint32_t direction, std::uint32_t connection,
                      Walks& walks) const
{
    bool const up = direction % 2 == 0;
    StoredAxes::Direction const& d = axes_.direction(direction);
    float const cos_from = glm::dot(from.normal, d.along);
    constexpr float kGrazing = 0.02f;
    if (!(cos_from > kGrazing)) return false;
    vec3 const way = to.position - from.position;
    float const length = glm::dot(way, d.along);
    float const beside = std::sqrt(std::max(0.0f, glm::dot(way, way) - square(length)));
    float const cos_to = std::abs(glm::dot(to.normal, d.along));
    float const own = d.texel + (d.texel + beside) * slope_of(cos_to);
    std::size_t const k = walks.count++;
    walks.batch.set(k,
                    {.position = from.position,
                     .triangle = from.triangle,
                     .along = from.front == up, // the axis leaves on that side
                     .up = up,
                     .slope = slope_of(cos_from)},
                    direction / 2);
    walks.ends[k] = {from.position, d.along, length - std::min(0.5f * length, own), to.triangle, connection};
    return true;
}

void LayerTerm::of_connections(ReceiverTile const& tile, std::span<Connection const> connections,
                               std::span<float> shares, PathCounts&) const
{
    thread_local Walks walks;
    walks.start(connections.size());
    for (std::uint32_t k = 0; k < connections.size(); ++k) {
        shares[k] = 1;
        Connection const& c = connections[k];
        Receiver const& r = tile.receivers[c.receiver];
        LightVertex const& light = lights_[c.light];
        End const here{r.position, r.geometric_normal, r.triangle, r.front},
            there{light.position, light.normal, light.triangle, light.front};
        std::uint32_t const direction = axes_.nearest(c.direction);
        if (!leave(here, there, direction, k, walks) && !leave(there, here, direction ^ 1, k, walks))
            unanswered_.fetch_add(1, std::memory_order_relaxed);
    }
    QueryBatch& batch = walks.batch;
    batch.resize(walks.count);
    nearest_layers(axes_.pool(), world_.surfaces, batch);
    queries_.fetch_add(walks.count, std::memory_order_relaxed);
    for (std::size_t k = 0; k < walks.count; ++k) {
        Walks::Far const& far = walks.ends[k];
        if (batch.hit[k] == kNoLayerHit || (batch.hit[k] & kPrimitiveMask) == far.triangle) continue;
        vec3 const hit{batch.hit_x[k], batch.hit_y[k], batch.hit_z[k]};
        if (glm::dot(hit - far.from, far.along) < far.reach) shares[far.connection] = 0;
    }
}

void LayerTerm::report_work(Report& report)
{
    report.count("look-ups in hit buffers", double(queries_));
    report.lose("connections without a suitable axis, taken as unoccluded", unanswered_.exchange(0));
    report.lose("layers beyond the limit of a texel", axes_.lost() - lost_);
    lost_ = axes_.lost();
}

} // namespace gi
