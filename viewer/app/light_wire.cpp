#include "viewer/app/light_wire.h"

#include "viewer/protocol/cluster/wire.h"

#include <algorithm>

namespace viewer {
namespace {

struct LightHeader {
    std::uint32_t view = 0;
    std::int32_t width = 0, height = 0, camera_width = 0, camera_height = 0;
    float texels_per_pixel = 1;
    gi::vec2 at{0};
    gi::vec3 mean{0};
    std::uint64_t lamps = 0;
    std::uint8_t without_punctual = 0, has_slopes = 0, mirrors = 0;
};

struct CellsHeader {
    float narrowest_m = 0;
    std::uint8_t without_punctual = 0;
    std::uint32_t buckets = 0; ///< that are not empty
};

template <class T>
void put(Writer& out, std::vector<T> const& all)
{
    auto const bytes = std::as_bytes(std::span(all));
    out.append({reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size()});
}

template <class T>
void get(Reader& in, std::vector<T>& all)
{
    auto const bytes = in.part(all.size() * sizeof(T));
    std::memcpy(all.data(), bytes.data(), bytes.size());
}

bool is_empty(gi::LightCellTable::Bucket const& bucket) { return bucket[0].key == 0 && bucket[1].key == 0; }

} // namespace

std::vector<std::uint8_t> to_bytes(FrameLight const& light)
{
    Writer out;
    out.put(std::uint32_t(light.views.size() - std::size_t(std::ranges::count(light.views, nullptr))));
    for (std::size_t k = 0; k < light.views.size(); ++k) {
        if (!light.views[k]) continue;
        gi::LightPicture const& l = *light.views[k];
        out.put(LightHeader{std::uint32_t(k), l.width, l.height, l.camera_width, l.camera_height,
                            l.texels_per_pixel, l.at, l.mean, l.lamps, std::uint8_t(l.without_punctual),
                            std::uint8_t(!l.slopes.empty()), std::uint8_t(l.mirrors.size())});
        put(out, l.texels);
        put(out, l.slopes);
        put(out, l.mirrors);
    }
    out.put(std::uint8_t(light.cells != nullptr));
    if (!light.cells) return out.take();
    gi::LightCellTable const& cells = *light.cells;
    auto const count = cells.buckets.size() - std::size_t(std::ranges::count_if(cells.buckets, is_empty));
    out.put(CellsHeader{cells.narrowest_m, std::uint8_t(cells.without_punctual), std::uint32_t(count)});
    for (std::uint32_t k = 0; k < cells.buckets.size(); ++k)
        if (!is_empty(cells.buckets[k])) out.put(k).put(cells.buckets[k]);
    return out.take();
}

void add_light(std::span<std::uint8_t const> bytes, FrameCommand const& command, FrameLight& to)
{
    Reader in(bytes);
    to.views.resize(command.views.size());
    for (auto n = in.get<std::uint32_t>(); n > 0; --n) {
        auto const h = in.get<LightHeader>();
        constexpr std::int64_t kMostTexels = 1 << 22;
        std::int64_t const texels = std::int64_t(h.width) * h.height;
        if (h.view >= to.views.size() || h.width < 0 || h.height < 0 || texels > kMostTexels)
            throw std::runtime_error("light of another rank has no such view or size");
        auto light = std::make_shared<gi::LightPicture>();
        light->width = h.width;
        light->height = h.height;
        light->camera = command.views[h.view].camera;
        light->camera_width = h.camera_width;
        light->camera_height = h.camera_height;
        light->texels_per_pixel = h.texels_per_pixel;
        light->at = h.at;
        light->mean = h.mean;
        light->lamps = h.lamps;
        light->without_punctual = h.without_punctual != 0;
        light->texels.resize(std::size_t(texels));
        get(in, light->texels);
        if (h.has_slopes != 0) light->slopes.resize(std::size_t(texels));
        get(in, light->slopes);
        light->mirrors.resize(h.mirrors);
        get(in, light->mirrors);
        to.views[h.view] = std::move(light);
    }
    if (in.get<std::uint8_t>() == 0) return;
    auto const h = in.get<CellsHeader>();
    auto cells = std::make_shared<gi::LightCellTable>();
    cells->narrowest_m = h.narrowest_m;
    cells->without_punctual = h.without_punctual != 0;
    for (std::uint32_t n = 0; n < h.buckets; ++n) {
        auto const k = in.get<std::uint32_t>();
        cells->buckets.at(k) = in.get<gi::LightCellTable::Bucket>();
    }
    to.cells = std::move(cells);
}

} // namespace viewer
