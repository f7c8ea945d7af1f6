#include "viewer/devices/gl/light_ring.h"

#include "viewer/devices/gl/view_matrices.h"

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <iterator>
#include <string>
#include <tuple>

namespace viewer {

namespace {

/// A bucket of LightCellTable each; of surface_light.glsl.
constexpr glm::ivec2 kCells_px{256, int(gi::LightCellTable::kBuckets) / 256};

} // namespace

/// Makes room for a frame's pictures, for those before, and for some of other places.
void LightRing::fit(std::vector<LightOfView> const& frame)
{
    constexpr int kOfPlaces = 4;
    int layers = layers_;
    glm::ivec2 size(width_, height_);
    for (LightOfView const& of : frame) {
        layers = std::max(layers, kNewest * (of.view + 1) + kOfPlaces);
        size = glm::max(size, glm::ivec2(of.light->width, of.light->height));
    }
    if (size == glm::ivec2(width_, height_) && layers == layers_) return;
    entries_.clear();
    width_ = size.x;
    height_ = size.y;
    layers_ = layers;
    for (GlObject* const to : {&texels_, &slopes_}) {
        *to = GlObject(GlObject::Kind::texture, GL_TEXTURE_2D_ARRAY);
        glTextureStorage3D(to->id(), 1, to == &texels_ ? GL_RGBA32UI : GL_RG32UI, width_, height_, layers_);
        glTextureParameteri(to->id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(to->id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
}

void LightRing::add(std::vector<LightOfView> const& frame, gi::dvec3 origin)
{
    static_assert(sizeof(gi::LightTexel) == 4 * sizeof(std::uint32_t));
    std::vector<LightOfView> known;
    std::ranges::copy_if(frame, std::back_inserter(known),
                         [](LightOfView const& of) { return !of.light->texels.empty(); });
    if (known.empty()) return;
    make_cells();
    gi::LightPicture const& first = *known.front().light;
    if (std::exchange(lamps_, first.lamps) != first.lamps) entries_.clear();
    fit(known);
    glm::vec3 mean(0);
    for (LightOfView const& of : known) mean += of.light->mean / float(known.size());
    constexpr float kOlder = 0.85f;
    bool const begins = entries_.empty() || entries_.back().without_punctual != first.without_punctual;
    mean_ = begins ? mean : glm::mix(mean, mean_, std::pow(kOlder, float(known.size())));
    is_new_ = !begins;
    for (LightOfView const& of : known) add(of, origin);
}

void LightRing::add(LightOfView const& of, gi::dvec3 origin)
{
    gi::LightPicture const& light = *of.light;
    for (Entry& e : entries_) e.age += e.view == of.view;
    Entry next;
    next.view = of.view;
    next.head = of.head;
    if (int(entries_.size()) < layers_) {
        next.layer = int(entries_.size());
    } else {
        auto const least = std::ranges::min_element(entries_, {}, [&](Entry const& e) { return gap_without(e); });
        next.layer = least->layer;
        entries_.erase(least);
    }
    next.eye = glm::vec3(gi::dvec3(light.camera.world_from_camera[3]) - origin);
    glm::dmat3 m = pixel_from_world(light.camera, {light.camera_width, light.camera_height});
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 2; ++r) m[c][r] *= double(light.texels_per_pixel);
    next.texel_from_world = glm::mat3(m);
    next.at = light.at;
    next.size = {light.width, light.height};
    next.without_punctual = light.without_punctual;
    next.mirrors = light.mirrors;
    entries_.push_back(next);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage3D(texels_.id(), 0, 0, 0, next.layer, light.width, light.height, 1, GL_RGBA_INTEGER,
                        GL_UNSIGNED_INT, light.texels.data());
    constexpr gi::LightSlope not_known{};
    if (light.slopes.empty())
        glClearTexSubImage(slopes_.id(), 0, 0, 0, next.layer, light.width, light.height, 1, GL_RG_INTEGER,
                           GL_UNSIGNED_INT, &not_known);
    else
        glTextureSubImage3D(slopes_.id(), 0, 0, 0, next.layer, light.width, light.height, 1, GL_RG_INTEGER,
                            GL_UNSIGNED_INT, light.slopes.data());
}

void LightRing::show_at(double pose_s)
{
    // Where nothing was drawn for long, the last light is not older for that.
    if (std::exchange(is_new_, false)) {
        double const begun_s = std::max(shown_s_, pose_s - kFade_s / 3);
        fade_s_ = std::clamp(begun_s - begun_s_, 1e-6, kFade_s); // the last light has its full share by then
        begun_s_ = begun_s;
    }
    shown_s_ = pose_s;
    share_ = std::clamp(float((pose_s - begun_s_) / fade_s_), 0.0f, 1.0f);
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
    share_ = 1;
}

/// How wide the gap of places and directions would be that its view's pictures leave without this one. The newest and the
/// oldest are kept above all, but no light that is too old.
float LightRing::gap_without(Entry const& picture) const
{
    constexpr int kTooOld = 24;
    constexpr float kKept = 1e6f, kPer_m = 1, kPerTurn = 3; // of axes
    if (picture.age < kNewest) return 2 * kKept / float(1 + picture.age);
    if (picture.age > kTooOld) return -float(picture.age);
    Entry const *newer = nullptr, *older = nullptr;
    for (Entry const& e : entries_) {
        if (e.view != picture.view) continue;
        if (e.age < picture.age && (newer == nullptr || e.age > newer->age)) newer = &e;
        if (e.age > picture.age && (older == nullptr || e.age < older->age)) older = &e;
    }
    if (newer == nullptr || older == nullptr) return kKept / 2;
    return kPer_m * glm::distance(older->eye, newer->eye) + kPerTurn * glm::distance(axis(*older), axis(*newer));
}

/// What a picture shows in a mirror, as a picture from behind it.
LightRing::Entry LightRing::from_behind(Entry const& picture, std::uint32_t mirror)
{
    gi::MirrorPlane const& plane = picture.mirrors[mirror - 1];
    Entry behind = picture;
    behind.mirror = mirror;
    behind.eye = gi::reflected(plane, picture.eye);
    behind.texel_from_world = picture.texel_from_world * gi::reflection(plane);
    return behind;
}

/// False if nothing that is seen can lie in the picture: all of it is beyond one of the picture's edges.
bool LightRing::may_show(Entry const& picture, SeenPart const& seen)
{
    glm::mat3 const rows = glm::transpose(picture.texel_from_world);
    glm::vec2 const low = picture.at - 1.0f, high = picture.at + glm::vec2(picture.size);
    glm::vec3 const apart = seen.eye - picture.eye;
    for (glm::vec3 const inwards : {rows[2], rows[0] - low.x * rows[2], high.x * rows[2] - rows[0],
                                    rows[1] - low.y * rows[2], high.y * rows[2] - rows[1]}) {
        auto const is_beyond = [&](glm::vec3 to) { return glm::dot(inwards, to) <= 0; };
        auto const is_beyond_from_eye = [&](glm::vec3 place) { return is_beyond(place - picture.eye); };
        if (is_beyond(apart) && std::ranges::all_of(seen.edges, is_beyond) &&
            (seen.moved.empty() || std::ranges::all_of(corners_of(seen.moved), is_beyond_from_eye)))
            return false;
    }
    return true;
}

glm::vec3 LightRing::axis(Entry const& picture)
{
    glm::vec3 const middle(picture.at + 0.5f * glm::vec2(picture.size), 1);
    return glm::normalize(glm::inverse(picture.texel_from_world) * middle);
}

/// The newest of all views, those of the same head first, then older ones. For what a mirror shows, first those from behind
/// the same one.
std::vector<LightRing::Entry> LightRing::asked_by(int head, SeenPart const& seen) const
{
    std::vector<Entry> asked;
    for (Entry const& e : entries_) {
        if (may_show(e, seen)) asked.push_back(e);
        for (std::uint32_t m = 1; m <= e.mirrors.size() && e.age < kNewest; ++m)
            if (Entry behind = from_behind(e, m); may_show(behind, seen)) asked.push_back(std::move(behind));
    }
    if (asked.size() > std::size_t(kPictures)) { // those that look the same way
        glm::vec3 middle(0);
        for (glm::vec3 const edge : seen.edges) middle += glm::normalize(edge);
        std::ranges::sort(asked, {}, [&](Entry const& e) { return std::pair(e.age, -glm::dot(axis(e), middle)); });
        asked.resize(std::size_t(kPictures));
    }
    std::ranges::sort(asked, {}, [&](Entry const& e) {
        float const apart = e.mirror > 0 ? glm::distance(e.eye, seen.eye) : 0;
        return std::tuple(e.age, e.head != head, (e.mirror > 0) != seen.in_mirror, apart, e.view);
    });
    return asked;
}

void LightRing::bind(GlProgram const& program, int head, SeenPart const& seen) const
{
    std::vector<Entry> const asked = asked_by(head, seen);
    Entry first; // of all, also of those that show nothing of it
    if (!entries_.empty())
        first = *std::ranges::min_element(
            entries_, {}, [&](Entry const& e) { return std::tuple(e.age, e.head != head, e.view); });
    glBindTextureUnit(2, texels_.id());
    glBindTextureUnit(3, slopes_.id());
    program.set("pictures", int(asked.size()));
    program.set("newest_pictures", int(std::ranges::count(asked, 0, &Entry::age)));
    program.set("narrowest_cell", known_ ? known_->narrowest_m : 0.0f);
    program.set("cells_lack_punctual", known_ && known_->without_punctual ? 1.0f : 0.0f);
    glBindTextureUnit(14, cells_.id());
    auto const before = std::ranges::find_if(asked, [&](Entry const& e) {
        return e.age == 1 && e.view == asked.front().view && e.mirror == asked.front().mirror;
    });
    program.set("light_before", before == asked.end() ? -1 : int(before - asked.begin()));
    program.set("share", share_);
    program.set("mean_light", mean_);
    program.set("mean_lacks_punctual", first.without_punctual ? 1.0f : 0.0f);
    program.set("head", first.eye);
    for (std::size_t k = 0; k < asked.size(); ++k) {
        std::string const of = "[" + std::to_string(k) + "]";
        program.set(("light_layers" + of).c_str(), asked[k].layer);
        program.set(("light_mirrors" + of).c_str(), int(asked[k].mirror));
        program.set(("light_eye" + of).c_str(), asked[k].eye);
        program.set(("texel_from_world" + of).c_str(), asked[k].texel_from_world);
        program.set(("light_size" + of).c_str(), asked[k].size);
        program.set(("texel_at" + of).c_str(), asked[k].at);
        program.set(("lacks_punctual" + of).c_str(), asked[k].without_punctual ? 1.0f : 0.0f);
    }
}

} // namespace viewer
