#include "gi/scene/load/scene_file_keys.h"
#include "gi/scene/load/scene_file_parts.h"

namespace gi {
namespace {

std::int32_t find_clip(Yaml const& at, std::string const& name, Scene const& part)
{
    std::int32_t found = -1;
    std::string known;
    for (std::size_t i = 0; i < part.animations.size(); ++i) {
        if (part.animations[i].name == name) found = std::int32_t(i);
        known += (known.empty() ? "" : ", ") + part.animations[i].name;
    }
    if (found < 0)
        throw at.error("there is no clip '" + name.substr(0, 64) + "'", "the model has no clip of that name",
                       known.empty() ? "the model has no clips" : "choose one of: " + known);
    return found;
}

Playback read_playback(Yaml const& a, Scene const& part)
{
    Playback playback;
    if (a.is_text()) {
        playback.animation = find_clip(a, a.text(), part);
    } else {
        check_keys(a, "animation");
        if (a.has("clip"))
            playback.animation = find_clip(a.at("clip"), a.at("clip").text(), part);
        else if (part.animations.size() == 1)
            playback.animation = 0;
        else
            throw a.error("an animation needs a clip", "the model has none or several", "clip: Walk");
    }
    for (Playback const& own : part.playbacks)
        if (own.animation == playback.animation) playback.loop = own.loop;
    if (a.is_text()) return playback;
    if (a.has("offset")) playback.offset_s = a.at("offset").number(-1e6, 1e6);
    if (a.has("speed")) playback.speed = a.at("speed").number(-1e3, 1e3);
    if (a.has("loop")) playback.loop = a.at("loop").boolean();
    if (a.has("weight")) playback.weight = a.at("weight").number(0, 1e6);
    return playback;
}

} // namespace

void choose_animation(Yaml const& animation, Scene& part)
{
    std::vector<Playback> playbacks;
    if (animation.is_list()) {
        for (Yaml const& item : animation.items()) playbacks.push_back(read_playback(item, part));
    } else if (!animation.is_text() || animation.text() != "none") {
        playbacks.push_back(read_playback(animation, part));
    }
    part.playbacks = std::move(playbacks);
}

} // namespace gi
