#include "gi/hit_buffers/directions/cosine_tables.h"

#include "gi/hit_buffers/directions/direction_quality.h"

#include <tbb/parallel_for.h>

namespace gi {

CosineTables make_cosine_tables(DirectionSet const& directions, std::uint32_t bins_across)
{
    constexpr std::size_t kSamples = std::size_t(1) << 20;
    constexpr int kNormals = 4; // per side of a bin
    CosineTables t;
    t.bins_across = bins_across;
    std::size_t const n = directions.axes.size();
    for (dvec3 const a : directions.axes) t.axes.push_back(vec3(a));
    for (double const s : solid_angles(directions, kSamples)) t.solid_angles.push_back(float(s));
    std::size_t const bins = std::size_t(bins_across) * bins_across;
    t.entries.resize(bins * n);
    tbb::parallel_for(std::size_t(0), bins, [&](std::size_t bin) {
        std::vector<float> weights(n, 0.0f);
        // Mean over the normals of the bin, so that every axis with a positive cosine to one
        // of them has a positive probability.
        for (int k = 0; k < kNormals * kNormals; ++k) {
            vec2 const within{(float(k % kNormals) + 0.5f) / kNormals, (float(k / kNormals) + 0.5f) / kNormals};
            vec2 const corner{float(bin % bins_across), float(bin / bins_across)};
            vec3 const normal = direction_from_octahedral((corner + within) / float(bins_across));
            for (std::size_t a = 0; a < n; ++a)
                weights[a] += t.solid_angles[a] * std::abs(glm::dot(t.axes[a], normal));
        }
        AliasTable const table = make_alias_table(weights);
        std::copy(table.entries.begin(), table.entries.end(), t.entries.begin() + std::ptrdiff_t(bin * n));
    });
    return t;
}

} // namespace gi
