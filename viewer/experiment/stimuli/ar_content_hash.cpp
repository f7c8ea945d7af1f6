#include "viewer/experiment/stimuli/ar_content_hash.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "viewer/camera_view/session_inputs.h"

#include <algorithm>
#include <map>

namespace viewer {
namespace {

namespace fs = std::filesystem;

std::string hash_of_file(fs::path const& file)
{
    static std::map<std::pair<std::string, fs::file_time_type>, std::string> known;
    auto& hash = known[{file.string(), fs::last_write_time(file)}];
    if (hash.empty()) {
        auto const bytes = gi::read_bytes(file);
        hash = gi::sha256({reinterpret_cast<char const*>(bytes.data()), bytes.size()});
    }
    return hash;
}

/// Hash of a file, or of the files of a folder; for a numbered pattern, of the files of its folder.
void add_hash(fs::path const& what, std::string& all)
{
    std::error_code none;
    if (fs::is_regular_file(what, none)) {
        all += what.filename().string() + " " + hash_of_file(what) + "\n";
        return;
    }
    bool const is_pattern = what.filename().string().find('%') != std::string::npos;
    fs::path const folder = is_pattern ? what.parent_path() : what;
    if (!fs::is_directory(folder, none)) return;
    std::vector<fs::path> files;
    for (auto const& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (fs::path const& file : files) all += file.filename().string() + " " + hash_of_file(file) + "\n";
}

} // namespace

std::string content_hash(ArStimulus const& s)
{
    std::string all = s.text + "\n";
    for (fs::path const& file : files_read_by(session_of(s))) add_hash(file, all);
    if (!s.poses.empty()) add_hash(s.poses, all);
    if (s.show == ArShow::truth) add_hash(s.truth, all);
    return gi::sha256(all);
}

} // namespace viewer
