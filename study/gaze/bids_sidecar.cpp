#include "study/gaze/bids_sidecar.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <algorithm>

namespace study {
namespace {

namespace fs = std::filesystem;

nlohmann::json object_of(fs::path const& file)
{
    try {
        auto json = nlohmann::json::parse(gi::read_text(file, std::size_t(64) << 20));
        if (json.is_object()) return json;
        throw gi::InputError("'" + file.string() + "' is no JSON object", "it describes columns and recording",
                             "write an object: {\"SamplingFrequency\": 500}");
    } catch (nlohmann::json::parse_error const& e) {
        throw gi::InputError("'" + file.string() + "' is no JSON", e.what(), "correct the file");
    }
}

} // namespace

std::string BidsName::entity(std::string_view key) const
{
    for (std::string const& e : entities)
        if (e.starts_with(std::string(key) + "-")) return e.substr(key.size() + 1);
    return {};
}

BidsName bids_name(fs::path const& file)
{
    std::string const name = file.filename().string();
    std::string rest = name.substr(0, name.find('.'));
    BidsName parts;
    for (auto end = rest.find('_'); end != std::string::npos; end = rest.find('_')) {
        parts.entities.push_back(rest.substr(0, end));
        rest.erase(0, end + 1);
    }
    parts.suffix = rest;
    return parts;
}

nlohmann::json bids_facts(fs::path const& file, std::string const& suffix)
{
    BidsName const own = bids_name(file);
    std::vector<fs::path> folders{fs::absolute(file).parent_path()};
    std::error_code none;
    for (int up = 0; up < 4 && !fs::exists(folders.back() / "dataset_description.json", none); ++up)
        folders.push_back(folders.back().parent_path());
    if (!fs::exists(folders.back() / "dataset_description.json", none)) folders.resize(1); // no data set
    nlohmann::json facts = nlohmann::json::object();
    for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) {
        std::vector<std::pair<std::size_t, fs::path>> found; // by number of entities
        for (auto const& entry : fs::directory_iterator(*folder, none)) {
            if (entry.path().extension() != ".json") continue;
            BidsName const other = bids_name(entry.path());
            bool const applies =
                other.suffix == suffix && std::ranges::all_of(other.entities, [&](std::string const& e) {
                    return std::ranges::find(own.entities, e) != own.entities.end();
                });
            if (applies) found.emplace_back(other.entities.size(), entry.path());
        }
        std::sort(found.begin(), found.end());
        for (auto const& [n, path] : found) facts.merge_patch(object_of(path));
    }
    return facts;
}

} // namespace study
