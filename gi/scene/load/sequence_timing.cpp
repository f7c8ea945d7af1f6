#include "gi/scene/load/sequence_timing.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace gi {
namespace {

using nlohmann::json;

constexpr double kFramesPerSecond = 24;
constexpr double kLongestSequence = 1e6; ///< s

class TimingReader {
public:
    TimingReader(std::filesystem::path const& file, std::size_t frames, Report& report)
        : file_(file.string()), frames_(frames), report_(report)
    {
    }

    SequenceTiming read()
    {
        parse();
        SequenceTiming t;
        t.file = file_;
        if (root_.contains("loop")) {
            if (!root_["loop"].is_boolean())
                throw wrong("'loop' is neither true nor false", "write true or false");
            t.loop = root_["loop"].get<bool>();
        }
        std::vector<double> times = times_s();
        double const step = frames_ > 1 ? (times.back() - times.front()) / double(frames_ - 1) : 0;
        t.period_s =
            root_.contains("duration_s") ? number("duration_s", 0, kLongestSequence) : times.back() + step;
        for (double const time : times) t.times_s.push_back(float(time));
        for (std::size_t i = 1; i < t.times_s.size(); ++i)
            if (!(t.times_s[i] > t.times_s[i - 1]))
                throw wrong(fmt::format("the time of frame {} is not after that of the previous frame", i),
                            "use increasing times");
        if (t.period_s < double(t.times_s.back()) - 1e-6 * std::max(1.0, t.period_s))
            throw wrong("'duration_s' is smaller than the last time", "give the period of the loop");
        t.period_s = std::max(t.period_s, double(t.times_s.back()));
        return t;
    }

private:
    InputError wrong(std::string const& problem, std::string const& suggestion) const
    {
        return {problem, "in '" + file_ + "'", suggestion};
    }

    void parse()
    {
        std::vector<unsigned char> const text = read_bytes(file_, std::size_t(16) << 20);
        try {
            root_ = json::parse(text.begin(), text.end());
        } catch (json::parse_error const& e) {
            TextLocation at{file_, 1, 1};
            for (std::size_t i = 0; i + 1 < e.byte && i < text.size(); ++i) {
                at.column = text[i] == '\n' ? 1 : at.column + 1;
                at.line += text[i] == '\n';
            }
            throw InputError(at, "this is not JSON", "it cannot be parsed from here on",
                             "correct it, or remove the file");
        }
        if (!root_.is_object()) throw wrong("there are no keys", "write {\"fps\": 24}");
        static std::set<std::string> const known{"times_s", "t0_s",      "fps",      "duration_s", "loop",
                                                 "source",  "animation", "vertices", "triangles",  "note"};
        for (auto const& [key, value] : root_.items())
            if (!known.contains(key))
                report_.lose("unknown keys of a sequence.json ignored", 1,
                             "'" + key.substr(0, 64) + "' in " + file_);
    }

    double number(char const* key, double low, double high) const
    {
        json const& value = root_[key];
        if (!value.is_number() || !(value.get<double>() >= low) || !(value.get<double>() <= high))
            throw wrong(fmt::format("'{}' is not a number between {:g} and {:g}", key, low, high), "change it");
        return value.get<double>();
    }

    std::vector<double> times_s() const
    {
        std::vector<double> times;
        if (!root_.contains("times_s")) {
            double const fps = root_.contains("fps") ? number("fps", 1e-3, 1e5) : kFramesPerSecond;
            for (std::size_t i = 0; i < frames_; ++i) times.push_back(double(i) / fps);
            return times;
        }
        if (root_.contains("fps")) throw wrong("both 'fps' and 'times_s' are given", "keep one of them");
        json const& list = root_["times_s"];
        if (!list.is_array() || list.size() != frames_)
            throw wrong(fmt::format("'times_s' is not a list of {} numbers", frames_),
                        fmt::format("give one for each of the {} frames in its folder", frames_));
        double const start = root_.contains("t0_s") ? number("t0_s", -kLongestSequence, kLongestSequence) : 0;
        for (json const& value : list) {
            double const t = value.is_number() ? value.get<double>() - start : -1;
            if (!(t >= 0) || !(t <= kLongestSequence))
                throw wrong(fmt::format("time {} is not a number from t0_s up to {:g} s after it", times.size(),
                                        kLongestSequence),
                            "give times in seconds");
            times.push_back(t);
        }
        return times;
    }

    std::string file_;
    std::size_t frames_;
    Report& report_;
    json root_ = json::object();
};

} // namespace

SequenceTiming read_sequence_timing(std::filesystem::path const& folder, std::size_t frames, Report& report)
{
    std::filesystem::path const file = folder / "sequence.json";
    if (std::filesystem::exists(file)) return TimingReader(file, frames, report).read();
    SequenceTiming t;
    for (std::size_t i = 0; i < frames; ++i) t.times_s.push_back(float(double(i) / kFramesPerSecond));
    t.period_s = frames > 1 ? double(frames) / kFramesPerSecond : 0;
    return t;
}

} // namespace gi
