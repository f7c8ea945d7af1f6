#include "gi/scene/motion/avatar_map.h"

#include "gi/core/file.h"
#include "gi/core/text.h"
#include "gi/core/yaml.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>

namespace gi {
namespace {

constexpr std::size_t kLargestMap = 1 << 20; ///< bytes

/// Node numbers of a map; names of files may hold a node twice under one name.
class Reader {
public:
    explicit Reader(Scene const& scene) : scene_(scene) {}

    std::int32_t node(Yaml const& y)
    {
        std::int32_t const found = find(y);
        auto const [first, is_new] = used_.emplace(found, y.path());
        if (!is_new)
            throw y.error(fmt::format("node '{}' twice", y.text().substr(0, 64)),
                          "it is " + first->second + " already", "give each part its own");
        return found;
    }

private:
    std::int32_t find(Yaml const& y) const
    {
        std::string const text = y.text();
        std::vector<std::int32_t> named;
        for (std::size_t n = 0; n < scene_.nodes.size(); ++n)
            if (scene_.nodes[n].name == text) named.push_back(std::int32_t(n));
        // Joints come before other nodes of the same name, such as meshes.
        if (named.size() > 1) {
            std::vector<std::int32_t> joints;
            for (std::int32_t const n : named)
                if (is_joint(n)) joints.push_back(n);
            if (!joints.empty()) named = joints;
        }
        if (named.size() == 1) return named.front();
        if (named.size() > 1)
            throw y.error(fmt::format("{} nodes are called '{}'", named.size(), text.substr(0, 64)),
                          "one of them is meant", fmt::format("write \"#{}\" or another number", named.front()));
        if (text.starts_with('#')) {
            auto const number = parse_number<std::uint64_t>(std::string_view(text).substr(1));
            if (number && *number < scene_.nodes.size()) return std::int32_t(*number);
            throw y.error("there is no node " + text.substr(0, 32),
                          fmt::format("the model has {} nodes, from #0", scene_.nodes.size()),
                          "correct the number");
        }
        throw y.error("there is no node '" + text.substr(0, 64) + "'", "no node of the model has this name",
                      "lightwell avatar map lists the joints");
    }
    bool is_joint(std::int32_t node) const
    {
        return std::any_of(scene_.skins.begin(), scene_.skins.end(), [node](Skin const& s) {
            return std::find(s.joints.begin(), s.joints.end(), node) != s.joints.end();
        });
    }

    Scene const& scene_;
    std::map<std::int32_t, std::string> used_; ///< and where
};

/// Three joints of a limb, or an empty value if the map leaves it out.
std::optional<std::array<std::int32_t, 3>> limb(Yaml const& root, char const* key, char const* end, Reader& reader)
{
    if (!root.has(key)) return {};
    Yaml const y = root.at(key);
    y.only_keys({"upper", "lower", end});
    return std::array{reader.node(y.needed("upper", "Bone_7")), reader.node(y.needed("lower", "Bone_8")),
                      reader.node(y.needed(end, "Bone_9"))};
}

bool is_below(Scene const& scene, std::int32_t node, std::int32_t ancestor)
{
    for (std::int32_t n = scene.nodes[std::size_t(node)].parent; n >= 0; n = scene.nodes[std::size_t(n)].parent)
        if (n == ancestor) return true;
    return false;
}

void check_chain(Scene const& scene, Yaml const& y, std::int32_t upper, std::int32_t lower, std::int32_t end,
                 bool end_is_below)
{
    if (!is_below(scene, lower, upper) || (end_is_below && !is_below(scene, end, lower)))
        throw y.error("the joints form no chain",
                      end_is_below ? "the lower one is below the upper one, and the hand below that"
                                   : "the shin is below the thigh",
                      "name them from the trunk outwards");
}

} // namespace

AvatarJoints parse_avatar_map(std::string const& text, std::string const& file, Scene const& scene)
{
    Yaml const root = Yaml::parse(text, file, "joints");
    root.only_keys({"head", "left_arm", "right_arm", "left_leg", "right_leg"});
    Reader reader(scene);
    AvatarJoints given;
    if (root.has("head")) given.head = reader.node(root.at("head"));
    for (auto const& [key, to] : {std::pair{"left_arm", &given.left}, {"right_arm", &given.right}})
        if (auto const l = limb(root, key, "hand", reader)) {
            *to = {(*l)[0], (*l)[1], (*l)[2]};
            check_chain(scene, root.at(key), to->upper, to->lower, to->hand, true);
        }
    for (auto const& [key, to] : {std::pair{"left_leg", &given.left_leg}, {"right_leg", &given.right_leg}})
        if (auto const l = limb(root, key, "foot", reader)) {
            *to = {(*l)[0], (*l)[1], (*l)[2]};
            check_chain(scene, root.at(key), to->upper, to->lower, to->foot, false); // feet may be controls
        }
    if ((given.left_leg.foot >= 0) != (given.right_leg.foot >= 0))
        throw root.error("only one leg", "an avatar has two legs or none",
                         given.left_leg.foot >= 0 ? "add right_leg" : "add left_leg");
    if (given.head >= 0 && given.left.hand >= 0 && given.right.hand >= 0) return given;
    AvatarJoints found;
    try {
        found = find_avatar_joints(scene);
    } catch (InputError const& e) {
        throw root.error("the map is not complete: " + e.problem(), e.why(), "name head, left_arm and right_arm");
    }
    if (given.head >= 0) found.head = given.head;
    if (given.left.hand >= 0) found.left = given.left;
    if (given.right.hand >= 0) found.right = given.right;
    if (given.left_leg.foot >= 0) found.left_leg = given.left_leg, found.right_leg = given.right_leg;
    return found;
}

AvatarJoints read_avatar_map(std::filesystem::path const& file, Scene const& scene)
{
    auto const bytes = read_bytes(file, kLargestMap);
    return parse_avatar_map({bytes.begin(), bytes.end()}, file.string(), scene);
}

std::string node_reference(Scene const& scene, std::int32_t node)
{
    std::string const& name = scene.nodes[std::size_t(node)].name;
    auto const count =
        std::count_if(scene.nodes.begin(), scene.nodes.end(), [&name](Node const& n) { return n.name == name; });
    return name.empty() || name.starts_with('#') || count > 1 ? fmt::format("#{}", node) : name;
}

} // namespace gi
