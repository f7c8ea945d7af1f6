#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace viewer::batch {

/// A command line in which options are found and replaced.
class CommandWords {
public:
    explicit CommandWords(std::vector<std::string> words) : words_(std::move(words))
    {
        std::ranges::replace(words_, "-o", "--out");
    }

    /// The value of `--name value` or `--name=value`.
    std::optional<std::string> value(std::string const& option) const
    {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            if (words_[i] == option && i + 1 < words_.size()) return words_[i + 1];
            if (words_[i].starts_with(option + "=")) return words_[i].substr(option.size() + 1);
        }
        return std::nullopt;
    }
    bool has(std::string const& option) const
    {
        return std::ranges::any_of(
            words_, [&](std::string const& w) { return w == option || w.starts_with(option + "="); });
    }
    void set(std::string const& option, std::string const& to)
    {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            if (words_[i] == option && i + 1 < words_.size()) words_[i + 1] = to;
            if (words_[i].starts_with(option + "=")) words_[i] = option + "=" + to;
        }
    }
    std::vector<std::string>& all() { return words_; }

private:
    std::vector<std::string> words_;
};

} // namespace viewer::batch
