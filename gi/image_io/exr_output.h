#pragma once
// The file that OpenEXR writes to. Its own stream makes a system call for each block of a layer, which takes
// longer than the writing itself.

#include <ImfIO.h>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace gi {

class ExrOutput : public Imf::OStream {
public:
    /// Throws std::system_error, as all that write.
    explicit ExrOutput(std::filesystem::path const& file);
    ~ExrOutput() override;
    ExrOutput(ExrOutput const&) = delete;
    ExrOutput& operator=(ExrOutput const&) = delete;

    void write(char const bytes[], int n) override;
    std::uint64_t tellp() override { return at_ + waiting_.size(); }
    void seekp(std::uint64_t to) override;
    /// Writes what is left and closes the file; call it last. Throws the first error of all that were written, as
    /// OpenEXR's destructors keep theirs to themselves.
    void finish();

private:
    void flush();
    [[noreturn]] void fail(int error);

    int fd_;
    int error_ = 0;        ///< the first one
    std::uint64_t at_ = 0; ///< place of the first byte that waits
    std::vector<char> waiting_;
};

} // namespace gi
