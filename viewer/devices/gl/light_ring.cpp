#include "viewer/devices/gl/light_ring.h"

#include "viewer/devices/gl/view_matrices.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <string>

namespace viewer {

namespace {

/// A bucket of LightCellTable each; of surface_light.glsl.
constexpr glm::ivec2 kCells_px{256, int(gi::LightCellTable::kBuckets) / 256};

} // namespace

void LightRing::add(int view, gi::LightPicture const& light, gi::dvec3 origin)
{
    constexpr int kOfAView = 2;
    static_assert(sizeof(gi::LightTexel) == 4 * sizeof(std::uint32_t));
    if (light.texels.empty()) return;
    make_cells();
    if (std::exchange(lamps_, light.lamps) != light.lamps) entries_.clear();
    int const layers = kOfAView * (view + 1);
    if (light.width > width_ || light.height > height_ || layers > layers_) {
        entries_.clear();
        width_ = std::max(width_, light.width);
        height_ = std::max(height_, light.height);
        layers_ = std::max({layers, layers_, kPictures});
        for (GlObject* const to : {&texels_, &slopes_}) {
            *to = GlObject(GlObject::Kind::texture, GL_TEXTURE_2D_ARRAY);
            glTextureStorage3D(to->id(), 1, to == &texels_ ? GL_RGBA32UI : GL_RG32UI, width_, height_, layers_);
            glTextureParameteri(to->id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
            glTextureParameteri(to->id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        }
    }
    Entry next;
    next.view = view;
    next.number = ++count_;
    if (int(entries_.size()) < layers_) {
        next.layer = int(entries_.size());
    } else { // the oldest of the view with the most pictures
        auto const of = [&](int v) { return std::ranges::count(entries_, v, &Entry::view); };
        auto const oldest = std::ranges::min_element(entries_, [&](Entry const& a, Entry const& b) {
            return of(a.view) != of(b.view) ? of(a.view) > of(b.view) : a.number < b.number;
        });
        next.layer = oldest->layer;
        entries_.erase(oldest);
    }
    next.eye = glm::vec3(gi::dvec3(light.camera.world_from_camera[3]) - origin);
    glm::dmat3 m = pixel_from_world(light.camera, {light.camera_width, light.camera_height});
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 2; ++r) m[c][r] *= double(light.texels_per_pixel);
    next.texel_from_world = glm::mat3(m);
    next.at = light.at;
    next.size = {light.width, light.height};
    next.without_punctual = light.without_punctual;
    constexpr float kNewest = 0.15f;
    mean_ = entries_.empty() || entries_.back().without_punctual != light.without_punctual
                ? light.mean
                : glm::mix(mean_, light.mean, kNewest);
    entries_.push_back(next);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage3D(texels_.id(), 0, 0, 0, next.layer, light.width, light.height, 1, GL_RGBA_INTEGER,
                        GL_UNSIGNED_INT, light.texels.data());
    gi::LightSlope const none = gi::light_slope(gi::vec3{0, 0, 1}, gi::vec3{0});
    if (light.slopes.empty())
        glClearTexSubImage(slopes_.id(), 0, 0, 0, next.layer, light.width, light.height, 1, GL_RG_INTEGER,
                           GL_UNSIGNED_INT, &none);
    else
        glTextureSubImage3D(slopes_.id(), 0, 0, 0, next.layer, light.width, light.height, 1, GL_RG_INTEGER,
                            GL_UNSIGNED_INT, light.slopes.data());
}

void LightRing::take(std::shared_ptr<gi::LightCellTable const> cells)
{
    if (known_ == cells) return;
    known_ = std::move(cells);
    if (!known_) return;
    make_cells();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(cells_.id(), 0, 0, 0, kCells_px.x, kCells_px.y, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        known_->buckets.data());
}

/// Also while there are none: a driver may compile shaders once more for a texture that was missing.
void LightRing::make_cells()
{
    if (cells_.id() == 0) cells_ = texture_2d(GL_RGBA32UI, kCells_px, GL_NEAREST);
}

void LightRing::clear()
{
    entries_.clear();
    known_ = nullptr;
}

std::vector<LightRing::Entry> LightRing::sorted_for(int view) const
{
    std::vector<Entry> sorted = entries_;
    std::ranges::sort(sorted, std::greater<>(), &Entry::number);
    std::ranges::stable_partition(sorted, [&](Entry const& e) { return e.view == view; });
    // The other eye's newest before an older one of this view.
    auto const other = std::ranges::find_if(sorted, [&](Entry const& e) { return e.view != view; });
    if (other != sorted.end() && other > sorted.begin() + 1) std::rotate(sorted.begin() + 1, other, other + 1);
    if (sorted.size() > std::size_t(kPictures)) sorted.resize(std::size_t(kPictures));
    return sorted;
}

void LightRing::bind(GlProgram const& program, int view) const
{
    std::vector<Entry> const asked = sorted_for(view);
    glBindTextureUnit(2, texels_.id());
    glBindTextureUnit(3, slopes_.id());
    program.set("pictures", int(asked.size()));
    program.set("narrowest_cell", known_ ? known_->narrowest_m : 0.0f);
    program.set("cells_lack_punctual", known_ && known_->without_punctual ? 1.0f : 0.0f);
    glBindTextureUnit(14, cells_.id());
    program.set("mean_light", mean_);
    for (std::size_t k = 0; k < asked.size(); ++k) {
        std::string const of = "[" + std::to_string(k) + "]";
        program.set(("light_layers" + of).c_str(), asked[k].layer);
        program.set(("light_eye" + of).c_str(), asked[k].eye);
        program.set(("texel_from_world" + of).c_str(), asked[k].texel_from_world);
        program.set(("light_size" + of).c_str(), asked[k].size);
        program.set(("texel_at" + of).c_str(), asked[k].at);
        program.set(("lacks_punctual" + of).c_str(), asked[k].without_punctual ? 1.0f : 0.0f);
    }
}

} // namespace viewer
