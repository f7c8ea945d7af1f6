#pragma once
// Paths of one pass whose rest is computed once, by one of them that goes on, and added to all: those that end on
// the same side of the same layer. Each pixel's estimate is what it would be alone, but pixels share noise.

#include "gi/methods/slhb/tracer/tracer.h"

namespace gi {

class SharedVertices {
public:
    /// @param paths  of the pass  @param layers  that they may end on; 0 = nothing is shared in this pass
    void start(std::size_t paths, std::size_t layers, std::uint32_t pass);
    /// From several threads, once for every path.
    void note(std::uint32_t path, SharedVertex const& shared);
    /// For paths that have no ending to share.
    void note_none(std::uint32_t path) { start_of_[path] = kNone; }
    /// After all are noted: makes the starts, in an order that does not depend on threads.
    /// @param endings  of all paths; those of paths without one are not looked at
    void collect(std::vector<SharedVertex> const& shared_vertices);

    std::vector<PathStart> const& starts() const { return starts_; }
    /// What starts first.. have brought.
    void keep(std::size_t first, std::span<PathSample const> samples);
    bool has(std::size_t path) const { return start_of_[path] != kNone; }
    /// What arrives from where a path that has an ending ended.
    vec3 radiance(std::size_t path) const { return radiance_[start_of_[path]]; }
    std::uint64_t shaded() const { return shaded_; }

private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::uint32_t order_key_ = 0;
    std::vector<std::uint32_t> slots_;    ///< the first path that ends there, in an order of the pass
    std::vector<std::uint32_t> start_of_; ///< of each path: its slot, later its start
    std::vector<PathStart> starts_;
    std::vector<vec3> radiance_;
    std::uint64_t shaded_ = 0;
};

} // namespace gi
