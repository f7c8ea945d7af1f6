#pragma once
// Paths of one pass that end on the same side of the same layer share the light from there: it is computed once,
// by continuing one of them, and added to all. The expectation of each pixel is unchanged, but pixels share noise.

#include "gi/methods/paths/tracer.h"

namespace gi {

class SharedVertices {
public:
    /// @param paths  of the pass  @param layers  number of layers on which they may end;
    ///   0 = no sharing in this pass
    void start(std::size_t paths, std::size_t layers, std::uint32_t pass);
    /// Registers the end of a path; called once per path, from several threads.
    void note(std::uint32_t path, SharedVertex const& shared);
    /// Registers a path without a shared vertex.
    void note_none(std::uint32_t path) { start_of_[path] = kNone; }
    /// Call after all paths are registered: makes the starts of the continuing paths,
    /// in an order independent of threads.
    /// @param shared_vertices  one per path; ignored for paths registered without one
    void collect(std::vector<SharedVertex> const& shared_vertices);

    std::vector<PathStart> const& starts() const { return starts_; }
    /// Stores the light found by the starts from index `first` on.
    void keep(std::size_t first, std::span<PathSample const> samples);
    bool has(std::size_t path) const { return start_of_[path] != kNone; }
    /// Returns the radiance arriving from the shared vertex of a path.
    vec3 radiance(std::size_t path) const { return radiance_[start_of_[path]]; }
    std::uint64_t shaded() const { return shaded_; }

private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::uint32_t order_key_ = 0;
    std::vector<std::uint32_t> slots_;    ///< per layer side: the first path that ends there, in the pass's order
    std::vector<std::uint32_t> start_of_; ///< per path: its slot, later its start
    std::vector<PathStart> starts_;
    std::vector<vec3> radiance_;
    std::uint64_t shaded_ = 0;
};

} // namespace gi
