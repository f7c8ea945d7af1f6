#include "viewer/experiment/stimuli/prepared_files.h"

#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"

#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExr = "\x76\x2f\x31\x01", kPng = "\x89PNG";

/// After a crash of the machine, files may have the right length but no content.
bool begins_as_picture(fs::path const& file)
{
    std::string begin(4, '\0');
    std::ifstream(file, std::ios::binary).read(begin.data(), std::streamsize(begin.size()));
    return begin == kExr || begin == kPng;
}

nlohmann::json lengths_in(fs::path const& folder)
{
    nlohmann::json files = nlohmann::json::object();
    for (auto const& entry : fs::directory_iterator(folder))
        files[entry.path().filename().string()] = entry.file_size();
    return files;
}

/// Not a JSON object if it cannot be read.
nlohmann::json about_of(fs::path const& folder)
{
    fs::path const file = folder / "stimulus.json";
    std::error_code none;
    if (!fs::is_regular_file(file, none)) return {};
    auto const bytes = gi::read_bytes(file);
    return nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
}

std::string flaw_of(nlohmann::json const& about, fs::path const& folder)
{
    if (!about.is_object() || !about.contains("files") || !about["files"].is_object() || about["files"].empty())
        return "its stimulus.json is missing or damaged";
    std::error_code none;
    for (auto const& [name, length] : about["files"].items())
        if (fs::file_size(folder / name, none) != length || !begins_as_picture(folder / name))
            return fmt::format("its {} is missing or damaged", name);
    return "";
}

} // namespace

std::string prepared_flaw(fs::path const& folder) { return flaw_of(about_of(folder), folder); }

nlohmann::json read_prepared(fs::path const& folder)
{
    nlohmann::json about = about_of(folder);
    if (std::string const flaw = flaw_of(about, folder); !flaw.empty())
        throw gi::InputError(fmt::format("the prepared stimulus '{}' is not whole", folder.string()), flaw,
                             "run lightwell study prepare again, which replaces it");
    return about;
}

void write_prepared(fs::path const& folder, std::function<nlohmann::json(fs::path const& into)> const& write)
{
    fs::path const making = fmt::format("{}.{}", folder.string(), getpid());
    gi::make_folder(making);
    try {
        nlohmann::json about = write(making);
        about["files"] = lengths_in(making);
        gi::write_text(making / "stimulus.json", about.dump(1) + "\n");
        if (!prepared_flaw(folder).empty()) fs::remove_all(folder);
        fs::rename(making, folder);
    } catch (...) {
        std::error_code none;
        fs::remove_all(making, none);
        // Another process may have finished first.
        if (!prepared_flaw(folder).empty()) throw;
    }
}

} // namespace viewer
