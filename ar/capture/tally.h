#pragma once
// Counts a source's frames by their sequence numbers; gaps count as dropped.

#include "ar/capture/frame_source.h"

namespace ar {

class Tally {
public:
    void deliver(std::uint64_t sequence)
    {
        see(sequence);
        ++counts_.delivered;
    }
    void refuse(std::uint64_t sequence, std::string reason)
    {
        see(sequence);
        ++counts_.refused;
        counts_.last_refusal = std::move(reason);
    }
    /// The next frame to be delivered differs from its file.
    void change(std::string what)
    {
        ++counts_.changed;
        counts_.last_change = std::move(what);
    }
    /// The frame arrived and is discarded.
    void drop(std::uint64_t sequence)
    {
        see(sequence);
        ++counts_.dropped;
    }
    /// The number that the first frame should have.
    void expect(std::uint64_t sequence) { next_ = sequence; }
    SourceCounts const& counts() const { return counts_; }

private:
    void see(std::uint64_t sequence)
    {
        if (next_ && sequence > *next_) counts_.dropped += sequence - *next_;
        next_ = sequence + 1;
    }

    SourceCounts counts_;
    std::optional<std::uint64_t> next_;
};

} // namespace ar
