#pragma once
// Copy of the arrays of a World in a memory space, for kernels that run there.

#include "gi/kernel/buffer.h"
#include "gi/scene/motion/moving_world.h"

#include <array>

namespace gi {

template <Space S>
class WorldOn {
public:
    explicit WorldOn(World const& world) { update(world, {}); }

    /// Copies what has changed; of vertices and triangles only those that can move.
    void update(World const& world, Changes const& changes)
    {
        WorldView now = gi::view(world);
        std::size_t k = 0;
        each(now, [&](Part part, auto& borrowed) {
            using T = std::remove_cvref_t<decltype(borrowed[0])>;
            static_assert(std::is_trivially_copyable_v<T>);
            Buffer<unsigned char, S>& there = arrays_[k++];
            std::size_t first = first_changed(part, world, changes);
            if (there.size() != borrowed.size() * sizeof(T)) {
                there = Buffer<unsigned char, S>(borrowed.size() * sizeof(T));
                first = 0;
            }
            if (first < borrowed.size())
                copy_bytes(S, there.view().data + first * sizeof(T), Space::host, borrowed.data + first,
                           (borrowed.size() - first) * sizeof(T));
            borrowed = {reinterpret_cast<T const*>(there.view().data), borrowed.size()};
        });
        view_ = now;
    }
    WorldView const& view() const { return view_; }

private:
    /// Kind of change that affects an array.
    enum class Part : std::uint8_t {
        nothing,
        vertices,
        triangles,
        surfaces,
        materials,
        lights,
        choice,
        environment
    };
    static constexpr std::size_t kNone = ~std::size_t(0);

    /// Returns the first item of an array to copy again; kNone = nothing.
    static std::size_t first_changed(Part part, World const& world, Changes const& c)
    {
        switch (part) {
        case Part::vertices:
            return c.geometry ? world.static_vertices : kNone;
        case Part::triangles: // mirroring an instance reverses their winding
            return c.geometry ? world.static_triangles : kNone;
        case Part::surfaces:
            return c.materials ? 0 : c.geometry ? world.static_triangles : kNone;
        case Part::materials:
            return c.materials ? 0 : kNone;
        case Part::lights:
            return c.lights ? 0 : kNone;
        case Part::choice:
            return c.lights || c.emitters || c.light_select || c.environment ? 0 : kNone;
        case Part::environment:
            return c.environment ? 0 : kNone;
        case Part::nothing:
            break;
        }
        return kNone;
    }

    template <class F>
    static void each(WorldView& v, F const& f)
    {
        f(Part::vertices, v.positions);
        f(Part::vertices, v.normals);
        f(Part::vertices, v.tangents);
        f(Part::nothing, v.uv0);
        f(Part::nothing, v.uv1);
        f(Part::nothing, v.colors);
        f(Part::nothing, v.alphas);
        f(Part::triangles, v.triangles);
        f(Part::nothing, v.triangle_material);
        f(Part::surfaces, v.surfaces);
        f(Part::materials, v.materials);
        f(Part::materials, v.bsdfs);
        f(Part::nothing, v.textures.texels);
        f(Part::nothing, v.textures.textures);
        f(Part::nothing, v.textures.linear_of_srgb);
        f(Part::lights, v.lights);
        f(Part::choice, v.emitters);
        f(Part::choice, v.emitter_pdf);
        f(Part::choice, v.light_select.entries);
        f(Part::environment, v.environment_select.entries);
        f(Part::environment, v.environment_radiance);
    }

    static constexpr std::size_t kArrays = 21;
    WorldView view_;
    std::array<Buffer<unsigned char, S>, kArrays> arrays_;
};

} // namespace gi
