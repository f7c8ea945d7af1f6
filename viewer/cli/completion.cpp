#include "viewer/cli/completion.h"

#include "viewer/base/choices.h"
#include "viewer/cli/command_tree.h"

#include <CLI/CLI.hpp>
#include <stdexcept>

namespace viewer {
namespace {

constexpr char const* kBash = R"(# lightwell completion bash
_lightwell() {
  local line
  COMPREPLY=()
  while IFS= read -r line; do
    if [ "$line" = ":files" ]; then compopt -o default; else COMPREPLY+=("$line"); fi
  done < <(LIGHTWELL_COMPLETE=1 "$1" "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _lightwell lightwell
)";

constexpr char const* kZsh = R"(#compdef lightwell
# lightwell completion zsh
_lightwell() {
  local -a found
  local line files=0
  for line in "${(@f)$(LIGHTWELL_COMPLETE=1 "${words[1]}" "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    if [[ $line == :files ]]; then files=1; elif [[ -n $line ]]; then found+=("$line"); fi
  done
  (( ${#found} )) && compadd -a found
  (( files )) && _files
}
if [[ $funcstack[1] == _lightwell ]]; then _lightwell "$@"; else compdef _lightwell lightwell; fi
)";

constexpr char const* kFish = R"(# lightwell completion fish
function __lightwell_complete
  set -l given (commandline -opc)
  for line in (LIGHTWELL_COMPLETE=1 $given[1] $given[2..-1] (commandline -ct) 2>/dev/null)
    if test "$line" = ":files"
      __fish_complete_path (commandline -ct)
    else
      echo $line
    end
  end
end
complete -c lightwell -f -a '(__lightwell_complete)'
)";

void offer_values(CLI::Option const& option, std::string const& begun, std::string const& before,
                  std::vector<std::string>& out)
{
    std::vector<std::string> const choices = choices_of(option);
    // The last one of several values separated by commas.
    std::size_t const comma = option.get_delimiter() == ',' ? begun.rfind(',') : std::string::npos;
    std::string const kept = comma == begun.npos ? "" : begun.substr(0, comma + 1);
    for (std::string const& c : choices)
        if ((kept + c).starts_with(begun)) out.push_back(before + kept + c);
    if (choices.empty() || option.get_positional()) out.emplace_back(kFilesLine);
}

} // namespace

std::vector<std::string> complete(CLI::App const& app, std::span<std::string const> words)
{
    CLI::App const* at = &app;
    CLI::Option const* awaits_value = nullptr;
    std::size_t positional = 0;
    std::vector<CLI::Option const*> given;
    std::string const begun = words.empty() ? "" : words.back();
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        std::string const& word = words[i];
        if (awaits_value != nullptr) {
            awaits_value = nullptr;
        } else if (word.starts_with('-') && word.size() > 1) {
            CLI::Option const* const o = find_option(*at, word);
            given.push_back(o);
            if (o != nullptr && o->get_items_expected_max() > 0 && word.find('=') == word.npos) awaits_value = o;
        } else if (CLI::App const* const next = find_subcommand(*at, word)) {
            at = next;
            positional = 0;
        } else {
            ++positional;
        }
    }
    std::vector<std::string> out;
    if (awaits_value != nullptr) {
        offer_values(*awaits_value, begun, "", out);
        return out;
    }
    if (begun.starts_with('-')) {
        std::size_t const equals = begun.find('=');
        if (equals != begun.npos) {
            if (CLI::Option const* const o = find_option(*at, begun))
                offer_values(*o, begun.substr(equals + 1), begun.substr(0, equals + 1), out);
            return out;
        }
        for (CLI::Option const* const o : at->get_options()) {
            if (o->get_positional() || o->get_group().empty()) continue;
            bool const again = o->get_items_expected_max() > 1;
            std::string const name = longest_name(*o);
            if (name.starts_with(begun) && (again || std::ranges::find(given, o) == given.end()))
                out.push_back(name);
        }
        return out;
    }
    for (CLI::App const* const s : subcommands(*at))
        if (!s->get_group().empty() && s->get_name().starts_with(begun)) out.push_back(s->get_name());
    for (CLI::Option const* const o : at->get_options()) {
        if (!o->get_positional()) continue;
        if (positional > 0 && o->get_items_expected_max() == 1) {
            --positional;
            continue;
        }
        offer_values(*o, begun, "", out);
        break;
    }
    return out;
}

std::string completion_script(std::string const& shell)
{
    if (shell == "bash") return kBash;
    if (shell == "zsh") return kZsh;
    if (shell == "fish") return kFish;
    throw std::logic_error("no completion for the shell " + shell);
}

} // namespace viewer
