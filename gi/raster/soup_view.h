#pragma once
// View of a TriangleSoup for kernels, and a copy of one in device memory.

#include "gi/kernel/buffer.h"
#include "gi/raster/triangle_soup.h"

namespace gi {

struct SoupView {
    float const* corner[9]; ///< as in TriangleSoup
    std::size_t count = 0;

    GI_FN vec3 vertex(std::size_t triangle, std::size_t k) const
    {
        return {corner[3 * k][triangle], corner[3 * k + 1][triangle], corner[3 * k + 2][triangle]};
    }
};

inline SoupView view(TriangleSoup const& soup)
{
    SoupView v;
    for (std::size_t k = 0; k < 9; ++k) v.corner[k] = soup.corner[k].data();
    v.count = soup.count;
    return v;
}

/// Copy of a soup in a memory space.
template <Space S>
class SoupOn {
public:
    explicit SoupOn(TriangleSoup const& soup)
    {
        for (std::size_t k = 0; k < 9; ++k) corner_[k] = upload<S>(soup.corner[k]);
        count_ = soup.count;
    }
    /// Copies again the triangles from `first` on, which have moved.
    void update(TriangleSoup const& soup, std::size_t first)
    {
        for (std::size_t k = 0; k < 9; ++k)
            copy_bytes(S, corner_[k].view().data + first, Space::host, soup.corner[k].data() + first,
                       (soup.corner[k].size() - first) * sizeof(float));
    }
    SoupView view() const
    {
        SoupView v;
        for (std::size_t k = 0; k < 9; ++k) v.corner[k] = corner_[k].view().data;
        v.count = count_;
        return v;
    }

private:
    std::array<Buffer<float, S>, 9> corner_;
    std::size_t count_ = 0;
};

} // namespace gi
