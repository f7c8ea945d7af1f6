#include "study/script/read.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

SequenceItem read_name(gi::Yaml const& y, Script const& s)
{
    SequenceItem item;
    item.place = y.place();
    std::vector<std::string> names;
    for (Block const& b : s.blocks) names.push_back(b.name);
    for (Counterbalance const& c : s.counterbalances)
        if (c.factor < 0) names.push_back(c.name);
    int const i = y.one_of(names, "block or group of blocks");
    item.kind = i < int(s.blocks.size()) ? SequenceKind::block : SequenceKind::group;
    item.index = i;
    if (item.kind == SequenceKind::group)
        for (std::size_t c = 0; c < s.counterbalances.size(); ++c)
            if (s.counterbalances[c].factor < 0 && s.counterbalances[c].name == y.text()) item.index = int(c);
    return item;
}

void read_free_walk(gi::Yaml const& y, Script const& s, SequenceItem& item, Mistakes& m)
{
    m.check_keys(y, "free_walk");
    item.kind = SequenceKind::free_walk;
    m.need(y, "duration_s", "60", [&](gi::Yaml const& v) { item.seconds = v.number(1, 36000); });
    m.take(y, "prompt", [&](gi::Yaml const& v) { item.text = v.text(); });
    m.take(y, "condition", [&](gi::Yaml const& v) { item.choice = read_choice(v, s, m); });
}

void read_rest(gi::Yaml const& y, SequenceItem& item, Mistakes& m)
{
    item.kind = SequenceKind::rest;
    if (!y.is_map()) {
        item.seconds = y.number(0, 3600);
        return;
    }
    m.check_keys(y, "break");
    m.need(y, "min_s", "60", [&](gi::Yaml const& v) { item.seconds = v.number(0, 3600); });
    m.take(y, "prompt", [&](gi::Yaml const& v) { item.text = v.text(); });
}

SequenceItem read_item(gi::Yaml const& y, Script const& s, Mistakes& m, int depth)
{
    if (y.is_text()) return read_name(y, s);
    check_keys(y, "sequence_item");
    SequenceItem item;
    item.place = y.place();
    bool const is_per = y.has("per") && y.has("do");
    if (y.entries().size() != (is_per ? 2u : 1u) || y.has("per") != y.has("do"))
        throw y.error(
            "this is no step of a sequence", "a step has one key",
            "write BLOCK, {instructions: intro.md}, {questionnaire: ssq}, {break: 60}, {free_walk: {...}} or "
            "{per: FACTOR, do: [...]}");
    if (y.has("instructions")) {
        item.kind = SequenceKind::instructions;
        item.text = y.at("instructions").text();
        if (item.text.empty()) throw y.error("empty instructions", "there is nothing to read", "remove them");
    } else if (y.has("questionnaire")) {
        item.kind = SequenceKind::questionnaire;
        item.index = read_questionnaire_name(y.at("questionnaire"), s);
    } else if (y.has("free_walk")) {
        read_free_walk(y.at("free_walk"), s, item, m);
    } else if (y.has("break")) {
        read_rest(y.at("break"), item, m);
    } else {
        item.kind = SequenceKind::per;
        m.take(y, "do", [&](gi::Yaml const& v) { item.items = read_sequence(v, s, m, depth + 1); });
        m.take(y, "per", [&](gi::Yaml const& v) { item.index = read_factor(v, s); });
    }
    return item;
}

} // namespace

std::vector<SequenceItem> read_sequence(gi::Yaml const& y, Script const& s, Mistakes& m, int depth)
{
    if (depth > 8) throw y.error("'per' within 'per' more than 8 deep", "that is too complex", "nest less");
    std::vector<SequenceItem> items;
    auto const written = y.items();
    for (gi::Yaml const& item : written) m.attempt([&] { items.push_back(read_item(item, s, m, depth)); });
    if (written.empty()) throw y.error("an empty sequence", "there is nothing to do", "name blocks");
    if (written.size() > 1000) throw y.error("more than 1000 steps", "a session has fewer", "use per and blocks");
    return items;
}

} // namespace study
