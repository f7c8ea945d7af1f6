#include "gi/image_io/exr_layers.h"

#include "gi/image_io/exr.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>

namespace gi {
namespace {

/// "R" of "R", "r" and "red".
std::string known_name(std::string const& channel)
{
    std::string upper;
    for (char const c : channel) upper += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    for (std::string_view const word : {"RED", "GREEN", "BLUE", "ALPHA"})
        if (upper == word) return upper.substr(0, 1);
    return upper;
}

/// The channels of one layer, which are taken out as their meaning is found.
class Unsorted {
public:
    void add(std::string const& suffix, ExrChannel channel)
    {
        channels_.push_back({known_name(suffix), suffix, std::move(channel)});
    }
    bool empty() const { return channels_.empty(); }
    bool has(std::initializer_list<char const*> names) const
    {
        return std::all_of(names.begin(), names.end(), [&](char const* n) { return find(n) != channels_.end(); });
    }
    /// Takes those of the channels that are here, in this order.
    std::vector<ExrChannel> take(std::initializer_list<char const*> names)
    {
        std::vector<ExrChannel> taken;
        for (char const* const name : names)
            if (auto const it = find(name); it != channels_.end()) {
                taken.push_back(it->channel);
                channels_.erase(it);
            }
        return taken;
    }
    /// All that are left, in the order of R G B A, X Y Z W, U V, then of the file.
    std::vector<ExrChannel> take_rest()
    {
        static constexpr std::string_view kOrder = "RXUGYVBZAW";
        std::stable_sort(channels_.begin(), channels_.end(), [](Channel const& a, Channel const& b) {
            auto const place = [](std::string const& n) {
                return n.size() == 1 ? kOrder.find(n[0]) : kOrder.npos;
            };
            return place(a.known) < place(b.known);
        });
        std::vector<ExrChannel> taken;
        for (Channel const& c : channels_) taken.push_back(c.channel);
        channels_.clear();
        return taken;
    }
    /// @return its suffix and the channel
    std::pair<std::string, ExrChannel> take_first()
    {
        std::pair first{channels_.front().suffix, channels_.front().channel};
        channels_.erase(channels_.begin());
        return first;
    }

private:
    struct Channel {
        std::string known, suffix;
        ExrChannel channel;
    };
    std::vector<Channel>::const_iterator find(std::string_view name) const
    {
        return std::find_if(channels_.begin(), channels_.end(), [&](Channel const& c) { return c.known == name; });
    }
    std::vector<Channel> channels_;
};

/// Appends the layers of the channels that share a name.
void sort_out(std::string const& name, Unsorted from, std::vector<ExrLayer>& layers)
{
    auto const add = [&](ExrKind kind, std::initializer_list<char const*> names) {
        layers.push_back({name, kind, from.take(names)});
    };
    if (name.empty() && from.has({"R", "G"}) && !from.has({"B"})) // no colours, but s and t of STMaps
        layers.push_back({"RG", ExrKind::values, from.take({"R", "G"})});
    if (from.has({"R", "G", "B"}))
        add(ExrKind::rgb, {"R", "G", "B", "A"});
    else if (from.has({"Y", "RY", "BY"}))
        add(ExrKind::luminance_chroma, {"Y", "RY", "BY", "A"});
    else if (from.has({"X", "Y", "Z"}))
        layers.push_back({name.empty() ? "XYZ" : name, ExrKind::values, from.take({"X", "Y", "Z", "W"})});
    else if (from.has({"Y", "A"}))
        add(ExrKind::luminance_alpha, {"Y", "A"});
    else if (from.has({"Y"}) && !from.has({"X"}))
        add(ExrKind::luminance, {"Y"});
    else if (!name.empty())
        layers.push_back({name, ExrKind::values, from.take_rest()});
    else if (from.has({"U", "V"})) {
        std::vector<ExrChannel> uv = from.take({"U", "V"});
        layers.push_back({uv[0].name + uv[1].name, ExrKind::values, std::move(uv)});
    }
    while (!from.empty()) {
        auto const [suffix, channel] = from.take_first();
        layers.push_back({name.empty() ? suffix : name + "." + suffix, ExrKind::values, {channel}});
    }
}

void check_sampling(ExrLayer const& layer, std::string const& file)
{
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
        ExrChannel const& channel = layer.channels[c];
        int const most = layer.kind == ExrKind::luminance_chroma && (c == 1 || c == 2) ? 2 : 1;
        if (channel.step_x <= most && channel.step_y <= most) continue;
        throw bad_exr(file, fmt::format("channel '{}' is sub-sampled {} x {}: only the chroma RY and BY beside a "
                                        "luminance Y may be, by 2 x 2",
                                        channel.name, channel.step_x, channel.step_y));
    }
}

} // namespace

std::vector<ExrLayer> exr_layers(Imf::ChannelList const& channels, std::string const& file)
{
    std::map<std::string, Unsorted> by_name;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        std::string const full = it.name();
        auto const dot = full.rfind('.');
        bool const is_bare = dot == std::string::npos;
        by_name[is_bare ? "" : full.substr(0, dot)].add(is_bare ? full : full.substr(dot + 1),
                                                        {full, it.channel().xSampling, it.channel().ySampling});
    }
    std::vector<ExrLayer> layers;
    for (auto& [name, of_name] : by_name) sort_out(name, std::move(of_name), layers);
    for (ExrLayer const& layer : layers) check_sampling(layer, file);
    return layers;
}

} // namespace gi
