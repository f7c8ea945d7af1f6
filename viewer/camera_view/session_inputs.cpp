#include "viewer/camera_view/session_inputs.h"

#include "ar/capture/picture_source.h"
#include "ar/capture/session_format.h"
#include "ar/scene/albedo_file.h"
#include "ar/scene/read_values.h"

#include <algorithm>

namespace viewer {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of_folder(fs::path const& folder)
{
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->is_regular_file(error)) files.push_back(at->path());
    std::sort(files.begin(), files.end());
    return files;
}

bool is_folder(fs::path const& path)
{
    std::error_code error;
    return fs::is_directory(path, error);
}

bool is_pattern(fs::path const& path)
{
    std::error_code error;
    return path.filename().string().find('%') != std::string::npos && !fs::exists(path, error);
}

class Files {
public:
    void add(fs::path const& file)
    {
        if (file.empty()) return;
        if (is_folder(file))
            add(files_of_folder(file));
        else if (std::find(files_.begin(), files_.end(), file) == files_.end())
            files_.push_back(file);
    }
    void add(std::vector<fs::path> const& files)
    {
        for (fs::path const& file : files) add(file);
    }
    void add(ar::Proxy const& p)
    {
        if (p.surface.from == ar::AlbedoFrom::texture) add(p.surface.texture);
        if (auto const* const mesh = std::get_if<ar::ProxyMesh>(&p.shape)) add(mesh->placed.scene);
        if (auto const* const depth = std::get_if<ar::ProxyDepth>(&p.shape)) {
            add(depth->file);
            add(depth->camera);
        }
    }
    void add_estimates(ar::RealPlace const& real)
    {
        bool const is_estimated =
            real.estimate_scene || std::any_of(real.proxies.begin(), real.proxies.end(), [](ar::Proxy const& p) {
                return p.surface.from == ar::AlbedoFrom::estimate ||
                       p.surface.from == ar::AlbedoFrom::estimate_texture;
            });
        if (!is_estimated || real.estimates.empty()) return;
        add(real.estimates);
        std::error_code error;
        if (!fs::is_regular_file(real.estimates, error)) return;
        for (ar::AlbedoEntry const& e : ar::read_albedos(real.estimates)) add(e.texture);
    }
    std::vector<fs::path> take() { return std::move(files_); }

private:
    std::vector<fs::path> files_;
};

} // namespace

fs::path folder_of_source(std::string const& source)
{
    if (source.empty() || ar::is_device(source)) return {};
    if (is_folder(source)) return source;
    if (!is_pattern(source)) return {};
    fs::path const folder = fs::path(source).parent_path();
    return folder.empty() ? "." : folder;
}

std::vector<fs::path> files_of_source(std::string const& source)
{
    if (source.empty() || ar::is_device(source)) return {};
    fs::path const path = source;
    if (is_folder(path) && fs::exists(path / ar::kSessionFile)) return files_of_folder(path);
    if (!is_folder(path) && !is_pattern(path)) return {path};
    if (is_folder(path)) return ar::picture_files(path);
    std::vector<fs::path> files;
    for (auto const& picture : ar::find_pictures(path).pictures) files.push_back(picture.file);
    return files;
}

std::vector<fs::path> files_read_by(ar::Session const& s)
{
    Files files;
    files.add(s.file);
    files.add(files_of_source(s.frames.source));
    files.add(s.camera);
    files.add(s.markers);
    files.add(s.pose.features);
    files.add(s.light);
    files.add(s.real.scene);
    for (ar::Proxy const& p : s.real.proxies) files.add(p);
    files.add_estimates(s.real);
    files.add(s.virtual_things.scene);
    if (s.tracked) files.add(files_read_by(*s.tracked));
    if (s.occlusion) {
        for (auto const* pictures : {&s.occlusion->depth, &s.occlusion->matte})
            if (*pictures) files.add(files_of_source((*pictures)->source.string()));
        files.add(s.occlusion->camera);
    }
    if (s.hmd && s.hmd->right) {
        files.add(files_of_source(s.hmd->right->source));
        files.add(s.hmd->right->calibration);
    }
    return files.take();
}

} // namespace viewer
