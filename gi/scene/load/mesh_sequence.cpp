// Loads a folder of OBJ or PLY files as one scene with animated meshes: the first file gives the mesh, each
// further file a morph target (the difference from the first), and one channel of frame numbers steps through
// them. Memory: 24 bytes per vertex and frame.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/assimp_convert.h"
#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/assimp_trial.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/mesh_frames.h"
#include "gi/scene/load/sequence_timing.h"
#include "gi/scene/motion/vertex_normals.h"

#include <algorithm>
#include <cstring>

namespace gi {
namespace {

namespace fs = std::filesystem;

/// Returns the frame files sorted by name, with numbers in names compared by value.
std::vector<fs::path> frame_files(fs::path const& folder)
{
    std::vector<fs::path> obj, ply;
    for (fs::directory_entry const& entry : fs::directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().filename().string().starts_with('.')) continue;
        std::string const extension = lower_extension(entry.path());
        if (extension == ".obj") obj.push_back(entry.path());
        if (extension == ".ply") ply.push_back(entry.path());
    }
    if (obj.empty() && ply.empty())
        throw InputError("'" + folder.string() + "' is a folder", "it holds no OBJ or PLY files as frames",
                         "name a scene file, or a folder of frames");
    if (!obj.empty() && !ply.empty())
        throw InputError("'" + folder.string() + "' holds OBJ and PLY files", "it is unclear which are the frames",
                         "move the others away");
    std::vector<fs::path> files = obj.empty() ? std::move(ply) : std::move(obj);
    std::sort(files.begin(), files.end(), [](fs::path const& a, fs::path const& b) {
        return strverscmp(a.filename().c_str(), b.filename().c_str()) < 0;
    });
    return files;
}

template <class T>
VertexBytes bytes_of(std::vector<T> const& attribute)
{
    return {reinterpret_cast<unsigned char const*>(attribute.data()), sizeof(T)};
}

template <class T>
void keep(std::vector<T>& attribute, std::vector<std::uint32_t> const& kept)
{
    if (attribute.empty()) return;
    std::vector<T> out;
    for (std::uint32_t const v : kept) out.push_back(attribute[v]);
    attribute = std::move(out);
}

class Sequence {
public:
    Sequence(fs::path const& folder, Report& report)
        : folder_(folder),
          report_(report),
          files_(frame_files(folder)),
          timing_(read_sequence_timing(folder, files_.size(), report))
    {
    }

    Scene load()
    {
        AssimpTrials const trials(files_, AssimpFaces::polygons);
        ImportedFiles const first_files =
            import_assimp(files_[0], AssimpFaces::triangles,
                          [&](aiScene const& source) { scene_ = convert_assimp(source, files_[0], report_); });
        first_files.pass_on_losses(report_);
        for (Mesh& mesh : scene_.meshes)
            for (vec3& p : mesh.positions) p = vec3(dvec3(p) + first_files.origin_m);
        scene_.name = folder_.string();
        SequenceFrame first = read_sequence_frame(files_[0]);
        bool same = first.meshes.size() == scene_.meshes.size();
        for (std::size_t m = 0; same && m < scene_.meshes.size(); ++m)
            same = first.meshes[m].positions.size() == scene_.meshes[m].positions.size();
        if (!same)
            throw InputError("'" + files_[0].string() + "' has points or lines", "frames must consist of faces",
                             "export its surfaces alone");
        frames_.resize(scene_.meshes.size());
        for (std::size_t i = 0; i < files_.size(); ++i) {
            SequenceFrame frame = i > 0 ? read_sequence_frame(files_[i]) : first;
            check_topology(first, files_[0], frame, files_[i]);
            scene_.files.insert(scene_.files.end(), frame.files.begin(), frame.files.end());
            for (std::size_t m = 0; m < frames_.size(); ++m) frames_[m].push_back(std::move(frame.meshes[m]));
        }
        for (std::size_t m = 0; m < frames_.size(); ++m)
            if (!scene_.meshes[m].positions.empty()) make_morphing(scene_.meshes[m], frames_[m]);
        play();
        if (!timing_.file.empty()) scene_.files.push_back(timing_.file);
        return std::move(scene_);
    }

private:
    void make_morphing(Mesh& mesh, std::vector<MeshFrame>& frames)
    {
        // The reader of OBJ creates a vertex for every corner, that of PLY if faces have texture coordinates.
        bool const expanded = lower_extension(files_[0]) == ".obj" || !mesh.uv0.empty();
        std::vector<VertexBytes> attributes;
        if (expanded)
            for (MeshFrame const& f : frames) attributes.push_back(bytes_of(f.positions));
        find_normals(mesh, frames, attributes);
        if (expanded) {
            for (MeshFrame const& f : frames) attributes.push_back(bytes_of(f.normals));
            if (!mesh.uv0.empty()) attributes.push_back(bytes_of(mesh.uv0));
            if (!mesh.uv1.empty()) attributes.push_back(bytes_of(mesh.uv1));
            if (!mesh.colors.empty()) attributes.push_back(bytes_of(mesh.colors));
            if (!mesh.alphas.empty()) attributes.push_back(bytes_of(mesh.alphas));
            join_equal(mesh, frames, attributes);
        }
        mesh.positions = frames[0].positions;
        mesh.normals = frames[0].normals;
        mesh.morph_targets.reserve(frames.size() - 1);
        for (std::size_t i = 1; i < frames.size(); ++i) {
            for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
                frames[i].positions[v] -= mesh.positions[v];
                frames[i].normals[v] -= mesh.normals[v];
            }
            mesh.morph_targets.push_back({std::move(frames[i].positions), std::move(frames[i].normals), {}});
        }
    }

    /// Keeps the normals of the files if all files have them, else computes smooth normals; vertices that are
    /// equal in `attributes` are treated as one vertex.
    void find_normals(Mesh const& mesh, std::vector<MeshFrame>& frames, std::vector<VertexBytes> const& attributes)
    {
        auto const without =
            std::count_if(frames.begin(), frames.end(), [](MeshFrame const& f) { return f.normals.empty(); });
        if (without == 0) return;
        if (std::size_t(without) < frames.size())
            report_.lose("normals of frames replaced, for not all frames have them",
                         frames.size() - std::size_t(without), folder_.string());
        std::vector<uvec3> triangles = mesh.triangles;
        std::vector<std::uint32_t> first;
        if (!attributes.empty()) {
            first = first_equal_vertices(mesh.positions.size(), attributes);
            for (uvec3& t : triangles) t = {first[t.x], first[t.y], first[t.z]};
        }
        for (MeshFrame& f : frames) {
            f.normals = vertex_normals(f.positions, triangles);
            for (std::size_t v = 0; v < first.size(); ++v) f.normals[v] = f.normals[first[v]];
        }
    }

    static void join_equal(Mesh& mesh, std::vector<MeshFrame>& frames, std::vector<VertexBytes> const& attributes)
    {
        std::vector<std::uint32_t> const first = first_equal_vertices(mesh.positions.size(), attributes);
        std::vector<std::uint32_t> kept, place(first.size());
        for (std::uint32_t v = 0; v < first.size(); ++v) {
            if (first[v] == v) kept.push_back(v);
            place[v] = first[v] == v ? std::uint32_t(kept.size() - 1) : place[first[v]];
        }
        for (uvec3& t : mesh.triangles) t = {place[t.x], place[t.y], place[t.z]};
        keep(mesh.uv0, kept);
        keep(mesh.uv1, kept);
        keep(mesh.colors, kept);
        keep(mesh.alphas, kept);
        for (MeshFrame& f : frames) {
            keep(f.positions, kept);
            keep(f.normals, kept);
        }
    }

    /// Adds the clip that plays the frames; an extra key after the last leads back to the first frame.
    void play()
    {
        if (files_.size() < 2) return;
        AnimationChannel channel;
        channel.path = ChannelPath::morph_frame;
        channel.times_s = timing_.times_s;
        for (std::size_t i = 0; i < files_.size(); ++i) channel.values.push_back(float(i));
        Animation clip;
        clip.name = folder_.filename().string();
        clip.duration_s = timing_.period_s;
        if (float(timing_.period_s) > channel.times_s.back()) {
            clip.closing_s = timing_.period_s - double(channel.times_s.back());
            channel.times_s.push_back(float(timing_.period_s));
            channel.values.push_back(float(files_.size()));
        }
        for (std::size_t n = 0; n < scene_.nodes.size(); ++n) {
            if (scene_.nodes[n].meshes.empty()) continue;
            scene_.nodes[n].morph_weights.assign(files_.size() - 1, 0.0f);
            channel.node = std::int32_t(n);
            clip.channels.push_back(channel);
        }
        scene_.animations = {std::move(clip)};
        scene_.playbacks = {{0, 0, 1, timing_.loop}};
    }

    fs::path const& folder_;
    Report& report_;
    std::vector<fs::path> files_;
    SequenceTiming timing_;
    Scene scene_;
    std::vector<std::vector<MeshFrame>> frames_; ///< by mesh, then by file
};

} // namespace

Scene load_mesh_sequence(fs::path const& folder, Report& report)
{
    fs::path const tidy = fs::absolute(folder).lexically_normal(); // because "a/b/" and "." have no file name
    return Sequence(tidy.has_filename() ? tidy : tidy.parent_path(), report).load();
}

} // namespace gi
