#include "viewer/app/user_avatars.h"

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/avatar_map.h"
#include "viewer/devices/tracking/own_avatar.h"
#include "viewer/displays/views.h"
#include "viewer/offline/load_world.h"

#include <algorithm>

namespace viewer {

namespace {

/// True if the height of the resting head is a plausible eye height, so that the room's origin is on the floor.
bool rests_above_floor(User const& user)
{
    double const y = resting_head(user).position.y;
    return y >= 0.3 && y <= 3;
}

AvatarChoice choice_of(std::size_t user, std::string file, std::string joints,
                       std::optional<Display> const& display, double otherwise_m)
{
    bool const in_display = display && user < display->users.size();
    return {user, std::move(file), standing_eye_height_m(display, user, otherwise_m),
            !in_display || rests_above_floor(display->users[user]), std::move(joints)};
}

} // namespace

double standing_eye_height_m(std::optional<Display> const& display, std::size_t user, double otherwise_m)
{
    if (!display || user >= display->users.size()) return otherwise_m;
    User const& u = display->users[user];
    if (u.eye_height_m) return *u.eye_height_m;
    return rests_above_floor(u) ? resting_head(u).position.y : otherwise_m;
}

double resting_eye_height_m(std::optional<Display> const& display, double otherwise_m)
{
    bool const tells = display && !display->users.empty() && rests_above_floor(display->users[0]);
    return tells ? resting_head(display->users[0]).position.y : otherwise_m;
}

std::vector<AvatarChoice> avatar_choices(std::string const& avatar, double eye_height_m,
                                         std::optional<Display> const& display,
                                         std::filesystem::path const& folder, std::string const& joints)
{
    std::vector<AvatarChoice> choices;
    if (!avatar.empty()) choices.push_back(choice_of(0, avatar, joints, display, eye_height_m));
    for (std::size_t u = 0; display && u < display->users.size(); ++u) {
        std::string const& stated = display->users[u].avatar;
        if (stated.empty() || (u == 0 && !avatar.empty())) continue;
        std::filesystem::path const file = folder / stated;
        std::error_code error;
        bool const is_file = std::filesystem::is_regular_file(file, error);
        std::string const& map = display->users[u].avatar_joints;
        choices.push_back(choice_of(u, is_file ? file.string() : stated,
                                    map.empty() ? "" : (folder / map).string(), display, eye_height_m));
    }
    return choices;
}

// The first user's avatar has its own keys, compatible with recordings from before other users could have one.
void put_avatars(nlohmann::json& load, std::vector<AvatarChoice> const& avatars)
{
    for (AvatarChoice const& a : avatars) {
        nlohmann::json kept{{"avatar", a.file}, {"eye_height_m", a.eye_height_m}};
        if (!a.joints.empty()) kept["avatar_joints"] = a.joints;
        if (a.user == 0) {
            load.update(kept);
        } else {
            kept["user"] = a.user;
            load["avatars"].push_back(kept);
        }
    }
}

std::vector<AvatarChoice> avatars_of(nlohmann::json const& load)
{
    constexpr std::size_t kMost = CommandLimits::users + 1;
    auto const refuse = [](std::string const& why) {
        throw gi::InputError("the avatars of the recording cannot be read", why, "record the walk again");
    };
    std::vector<AvatarChoice> avatars;
    auto const read = [&](nlohmann::json const& j, std::size_t user) {
        std::string const file = j.value("avatar", "");
        if (file.empty()) return;
        if (std::ranges::find(avatars, user, &AvatarChoice::user) != avatars.end())
            refuse("user " + std::to_string(user) + " has two avatars");
        avatars.push_back({user, file, j.value("eye_height_m", 1.6), true, j.value("avatar_joints", "")});
    };
    try {
        read(load, 0);
        nlohmann::json const others = load.value("avatars", nlohmann::json::array());
        if (!others.is_array() || others.size() > kMost)
            refuse("they are not a list of at most " + std::to_string(kMost));
        for (nlohmann::json const& j : others) {
            auto const user = j.value("user", std::size_t(0));
            if (user >= kMost) refuse("one is of user " + std::to_string(user));
            read(j, user);
        }
    } catch (nlohmann::json::exception const& e) {
        refuse(e.what());
    }
    return avatars;
}

RecordedScenes scenes_with(RenderOptions const& options, std::vector<AvatarChoice> const& avatars,
                           gi::Report& report)
{
    std::vector<std::shared_ptr<OwnAvatar const>> all;
    RecordedScenes s;
    for (AvatarChoice const& a : avatars) {
        if (a.file != "avatar" && !std::filesystem::exists(a.file))
            throw gi::InputError("there is no avatar '" + a.file + "'", "no such file",
                                 "give a skinned model, or avatar (built in)");
        gi::Scene model = gi::load_scene(a.file, report);
        std::optional<gi::AvatarJoints> joints;
        if (!a.joints.empty()) joints = gi::read_avatar_map(a.joints, model);
        all.push_back(std::make_shared<OwnAvatar const>(std::move(model), a.eye_height_m, a.user, joints));
        s.avatars.push_back({a.user, a.on_floor ? all.back()->stance() : std::nullopt});
    }
    s.load = [options, all](std::string const& name, gi::Report& r) {
        RenderOptions named = options;
        named.scene = name;
        std::shared_ptr<gi::Scene const> scene = load_lit_scene(named, r);
        for (auto const& avatar : all) scene = std::make_shared<gi::Scene const>(avatar->joined(*scene));
        return scene;
    };
    if (!all.empty())
        s.drive = [all](gi::Scene const& scene, FrameCommand const& command, gi::Pose& pose) {
            for (auto const& avatar : all) avatar->drive(scene, command, pose);
        };
    return s;
}

} // namespace viewer
