#pragma once
// Temporary folders and noise pictures for tests.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <opencv2/core.hpp>
#include <string>
#include <unistd.h>

namespace ar::test {

/// A new folder, deleted with all that is in it at the end.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "lightwell_test_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::filesystem::path const& path() const { return path_; }
    std::string operator/(std::string const& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

inline std::string file_text(std::filesystem::path const& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_file(std::filesystem::path const& file, std::string const& text)
{
    std::ofstream(file, std::ios::binary) << text;
}

inline bool equal(cv::Mat const& a, cv::Mat const& b)
{
    return a.size() == b.size() && a.type() == b.type() && (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0);
}

/// Bytes that are all unlike their neighbours, the same for the same seed.
inline cv::Mat noise(int rows, int cols, int type, int seed)
{
    cv::Mat m(rows, cols, type);
    cv::RNG rng(std::uint64_t(seed) + 1);
    rng.fill(m, cv::RNG::UNIFORM, 0, 256);
    return m;
}

} // namespace ar::test
