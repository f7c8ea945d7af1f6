#include "viewer/displays/calibration_files.h"

#include "gi/core/file.h"

#include <fmt/format.h>
#include <zip.h>

namespace viewer {
namespace {

constexpr zip_uint64_t kMostUnpacked = zip_uint64_t(4) << 30;
constexpr zip_uint64_t kMostRatio = 1032; ///< of deflate

std::string text_of(zip_error_t* error)
{
    std::string const text = zip_error_strerror(error);
    zip_error_fini(error);
    return text;
}

bool stays_within(std::string const& name)
{
    if (name.empty() || name.size() > 255 || name.find_first_of("\\:") != std::string::npos) return false;
    std::filesystem::path const path(name);
    if (path.is_absolute()) return false;
    for (auto const& part : path)
        if (part == "..") return false;
    return true;
}

} // namespace

struct CalibrationFiles::Archive {
    zip_t* zip = nullptr;
    zip_uint64_t unpacked = 0; ///< so far

    Archive() = default;
    Archive(Archive const&) = delete;
    Archive& operator=(Archive const&) = delete;
    ~Archive()
    {
        if (zip) zip_discard(zip);
    }
};

CalibrationFiles::CalibrationFiles(std::filesystem::path place, std::shared_ptr<Archive> archive)
    : place_(std::move(place)), archive_(std::move(archive))
{
}

CalibrationFiles CalibrationFiles::of_archive(std::filesystem::path const& file)
{
    gi::regular_file_bytes(file);
    auto archive = std::make_shared<Archive>();
    int code = 0;
    archive->zip = zip_open(file.c_str(), ZIP_RDONLY, &code);
    if (!archive->zip) {
        zip_error_t error;
        zip_error_init_with_code(&error, code);
        throw gi::InputError({file.string(), 0, 0}, "this is no zip archive, or it is damaged", text_of(&error),
                             "copy it again; it may have been cut off");
    }
    return {file, std::move(archive)};
}

CalibrationFiles CalibrationFiles::of_folder(std::filesystem::path const& folder) { return {folder, nullptr}; }

std::string CalibrationFiles::full_name(std::string const& name) const { return (place_ / name).string(); }

std::vector<unsigned char> CalibrationFiles::read(std::string const& name, std::size_t most_bytes,
                                                  gi::TextLocation const& at) const
{
    auto const bad = [&](std::string const& problem, std::string const& why, std::string const& suggestion) {
        return gi::InputError(at, "'" + name.substr(0, 128) + "' " + problem, why, suggestion);
    };
    if (!stays_within(name))
        throw bad("leaves the calibration's folder", "only files beside it are read",
                  "name a file without .., \\, : or a leading /");
    if (!archive_) {
        std::error_code failure;
        if (!std::filesystem::is_regular_file(place_ / name, failure))
            throw bad("is missing",
                      "there is no such file in " + (place_.empty() ? "this folder" : place_.string()),
                      "copy it beside the calibration");
        return gi::read_bytes(place_ / name, most_bytes);
    }
    zip_int64_t index = zip_name_locate(archive_->zip, name.c_str(), 0);
    if (index < 0) index = zip_name_locate(archive_->zip, name.c_str(), ZIP_FL_NOCASE);
    zip_stat_t about;
    zip_stat_init(&about);
    if (index < 0 || zip_stat_index(archive_->zip, zip_uint64_t(index), 0, &about) != 0)
        throw bad("is missing", "the archive has no such file", "export the calibration again");
    constexpr auto kNeeded = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE;
    if ((about.valid & kNeeded) != kNeeded || about.size > most_bytes ||
        about.size / kMostRatio > about.comp_size || about.size > kMostUnpacked - archive_->unpacked)
        throw bad(fmt::format("states {} bytes", about.size), "it is too large for what it is",
                  "export the calibration again");
    std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> const file(
        zip_fopen_index(archive_->zip, zip_uint64_t(index), 0), &zip_fclose);
    if (!file) throw bad("cannot be unpacked", zip_strerror(archive_->zip), "export the calibration again");
    std::vector<unsigned char> bytes(about.size);
    zip_int64_t const count = zip_fread(file.get(), bytes.data(), bytes.size());
    unsigned char beyond = 0;
    if (count != zip_int64_t(bytes.size()) || zip_fread(file.get(), &beyond, 1) != 0)
        throw bad("is damaged", zip_file_strerror(file.get()), "copy the archive again");
    archive_->unpacked += about.size;
    return bytes;
}

} // namespace viewer
