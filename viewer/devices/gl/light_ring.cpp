#include "viewer/devices/gl/light_ring.h"

#include "viewer/devices/gl/view_matrices.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <string>

namespace viewer {

void LightRing::add(int view, gi::LightPicture const& light, gi::dvec3 origin)
{
    constexpr int kOfAView = 2;
    static_assert(sizeof(gi::LightTexel) == 4 * sizeof(std::uint32_t));
    if (light.texels.empty()) return;
    int const layers = kOfAView * (view + 1);
    if (light.width != width_ || light.height != height_ || layers > layers_) {
        entries_.clear();
        width_ = light.width;
        height_ = light.height;
        layers_ = std::max({layers, layers_, kPictures});
        texels_ = GlObject(GlObject::Kind::texture, GL_TEXTURE_2D_ARRAY);
        glTextureStorage3D(texels_.id(), 1, GL_RGBA32UI, width_, height_, layers_);
        glTextureParameteri(texels_.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(texels_.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
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
    constexpr float kNewest = 0.15f;
    mean_ = entries_.empty() ? light.mean : glm::mix(mean_, light.mean, kNewest);
    entries_.push_back(next);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage3D(texels_.id(), 0, 0, 0, next.layer, width_, height_, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        light.texels.data());
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
    program.set("pictures", int(asked.size()));
    program.set("mean_light", mean_);
    for (std::size_t k = 0; k < asked.size(); ++k) {
        std::string const of = "[" + std::to_string(k) + "]";
        program.set(("light_layers" + of).c_str(), asked[k].layer);
        program.set(("light_eye" + of).c_str(), asked[k].eye);
        program.set(("texel_from_world" + of).c_str(), asked[k].texel_from_world);
        program.set(("texel_at" + of).c_str(), asked[k].at);
    }
}

} // namespace viewer
