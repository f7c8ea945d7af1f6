#pragma once
// When a pass of a render is abandoned.

#include "gi/core/progress.h"

#include <cstdint>

namespace gi {

/// Once given up, it remains so.
class PassStop {
public:
    enum class Pass : std::uint8_t {
        first, ///< after a stop request it continues as BuildStop says, so that there is a picture to keep
        later  ///< ends at once
    };
    static Pass of(std::uint32_t paths) { return paths > 0 ? Pass::later : Pass::first; }
    /// @param stop  must outlive this object; null = never abandon
    explicit PassStop(StopRequest const* stop, Pass pass = Pass::first) : stop_(stop), first_(stop), pass_(pass) {}
    bool given_up() const
    {
        return pass_ == Pass::first ? first_.given_up() : stop_ != nullptr && stop_->requested();
    }
    void check() const
    {
        if (given_up()) throw Interrupted();
    }

private:
    StopRequest const* stop_;
    BuildStop first_;
    Pass pass_;
};

} // namespace gi
