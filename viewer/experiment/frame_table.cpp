#include "viewer/experiment/frame_table.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <zlib.h>

namespace viewer {
namespace {

void append(std::filesystem::path const& file, std::string const& header, std::string const& rows)
{
    if (rows.empty()) return;
    bool const is_new = !std::filesystem::exists(file) && !std::filesystem::exists(file.string() + ".gz");
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "ab"), std::fclose);
    std::string const text = (is_new ? header : "") + rows;
    if (!out || std::fwrite(text.data(), 1, text.size(), out.get()) != text.size() || std::fflush(out.get()) != 0)
        throw gi::InputError("cannot write '" + file.string() + "'", std::strerror(errno),
                             "make room, or choose another record.dir");
}

void compress_one(std::filesystem::path const& file)
{
    if (!std::filesystem::exists(file)) return;
    std::vector<unsigned char> const bytes = gi::read_bytes(file);
    // Gzip members can be concatenated, so existing data stays unchanged.
    std::filesystem::path const packed = file.string() + ".gz";
    gzFile const out = gzopen(packed.c_str(), "ab");
    bool const written = out != nullptr && gzwrite(out, bytes.data(), unsigned(bytes.size())) == int(bytes.size());
    bool const closed = out != nullptr && gzclose(out) == Z_OK;
    if (!written || !closed)
        throw gi::InputError("cannot write '" + packed.string() + "'", std::strerror(errno),
                             "the frames are in '" + file.string() + "'");
    std::filesystem::remove(file);
}

} // namespace

void FrameTable::flush()
{
    std::string frames, poses;
    for (FrameRow const& f : frames_)
        frames += fmt::format("{},{},{},{:.6f},{:.3f},{},{:.3f},{}\n", f.step, f.attempt, f.shown, f.swap_s,
                              f.uncertainty_ms, f.method, f.render_ms, f.dropped);
    for (PoseRow const& p : poses_)
        poses += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}\n", p.time_s, p.position.x,
                             p.position.y, p.position.z, p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w);
    append(folder_ / (stem_ + "_frames.csv"),
           "step,attempt,shown,t_swap_s,uncertainty_ms,onset_method,render_ms,dropped\n", frames);
    frames_.clear();
    append(folder_ / (stem_ + "_poses.csv"), "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n", poses);
    poses_.clear();
}

void FrameTable::compress()
{
    flush();
    compress_one(folder_ / (stem_ + "_frames.csv"));
    compress_one(folder_ / (stem_ + "_poses.csv"));
}

} // namespace viewer
