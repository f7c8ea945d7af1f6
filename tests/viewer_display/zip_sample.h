#pragma once
// Zip archives.

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <zip.h>

namespace viewer::test {

/// Members by name, in a zip archive.
inline void write_zip(std::filesystem::path const& file, std::map<std::string, std::string> const& members)
{
    std::filesystem::remove(file);
    zip_t* const zip = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    for (auto const& [name, text] : members)
        zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), ZIP_FL_ENC_UTF_8);
    if (zip_close(zip) != 0) throw std::runtime_error("cannot write " + file.string());
}

} // namespace viewer::test
