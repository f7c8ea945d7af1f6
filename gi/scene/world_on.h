#pragma once
// The arrays of a World in a space, for kernels that run there.

#include "gi/base/buffer.h"
#include "gi/scene/world.h"

namespace gi {

template <Space S>
class WorldOn {
public:
    explicit WorldOn(World const& world) : view_(gi::view(world))
    {
        auto const move = [this](auto& borrowed) {
            using T = std::remove_cvref_t<decltype(borrowed[0])>;
            static_assert(std::is_trivially_copyable_v<T>);
            Buffer<unsigned char, S> bytes(borrowed.size() * sizeof(T));
            copy_bytes(S, bytes.view().data, Space::host, borrowed.data, bytes.size());
            borrowed = {reinterpret_cast<T const*>(bytes.view().data), borrowed.size()};
            arrays_.push_back(std::move(bytes));
        };
        move(view_.positions);
        move(view_.normals);
        move(view_.tangents);
        move(view_.uv0);
        move(view_.uv1);
        move(view_.colors);
        move(view_.triangles);
        move(view_.triangle_material);
        move(view_.surfaces);
        move(view_.materials);
        move(view_.bsdfs);
        move(view_.textures.texels);
        move(view_.textures.textures);
        move(view_.textures.linear_of_srgb);
        move(view_.lights);
        move(view_.emitters);
        move(view_.emitter_pdf);
        move(view_.light_select.entries);
        move(view_.environment_select.entries);
        move(view_.environment_radiance);
    }
    WorldView const& view() const { return view_; }

private:
    WorldView view_;
    std::vector<Buffer<unsigned char, S>> arrays_;
};

} // namespace gi
