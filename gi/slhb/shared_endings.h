#pragma once
// Paths of one pass that end on the same side of the same layer: what it sends back is computed once, by one path
// that goes on from there, and added to all of them. Each pixel's estimate is what it would be alone; neighbours
// share noise.

#include "gi/slhb/tracer.h"

namespace gi {

class SharedEndings {
public:
    /// @param layers  that paths may end on; 0 = nothing is shared in this pass
    void start(std::size_t layers);
    /// From several threads. @param first_pixel of the endings
    void note(std::span<Ending const> endings, std::uint32_t first_pixel);
    /// After all are noted: makes the starts, in an order that does not depend on threads.
    void collect(std::vector<Ending> const& endings, AxisPool const& pool);

    std::vector<PathStart> const& starts() const { return starts_; }
    /// What starts first.. have brought.
    void keep(std::size_t first, std::span<PathSample const> samples);
    vec3 radiance(Ending const& e) const { return radiance_[slots_[key(e)]]; }
    std::uint64_t shaded() const { return shaded_; }

private:
    static std::size_t key(Ending const& e) { return 2 * std::size_t(e.layer) + (e.up ? 1 : 0); }

    std::vector<std::uint32_t>
        slots_; ///< per layer and side: the first pixel that ends there; then the index of its start
    std::vector<PathStart> starts_;
    std::vector<vec3> radiance_;
    std::uint64_t shaded_ = 0;
};

} // namespace gi
