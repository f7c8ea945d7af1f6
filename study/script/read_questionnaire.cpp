#include "study/script/read.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

QuestionnaireItem read_item(gi::Yaml const& y, RatingScale const* usual)
{
    check_keys(y, "item");
    QuestionnaireItem item;
    item.id = y.needed("id", "q1").name();
    item.text = y.needed("text", "\"How real did it look?\"").text();
    if (usual != nullptr) {
        item.low = usual->low;
        item.high = usual->high;
        item.step = usual->step;
        for (auto const& [unused, label] : usual->labels) item.labels.push_back(label);
    }
    if (y.has("min")) item.low = y.at("min").number(-1e6, 1e6);
    if (y.has("max")) item.high = y.at("max").number(-1e6, 1e6);
    if (y.has("step")) item.step = y.at("step").number(1e-6, 1e6);
    double const steps = (item.high - item.low) / item.step;
    if (!(steps >= 1 && steps <= 1e5) || std::abs(steps - std::round(steps)) > 1e-6)
        throw y.error(
            fmt::format("item '{}' goes from {:g} to {:g} by {:g}", item.id, item.low, item.high, item.step),
            "it needs at least two values, the last of them max", "change max or step");
    if (y.has("labels")) {
        item.labels.clear();
        for (gi::Yaml const& label : y.at("labels").items()) item.labels.push_back(label.text());
    }
    bool const fits =
        item.labels.empty() || item.labels.size() == 2 || double(item.labels.size()) == std::round(steps) + 1;
    if (!fits && y.has("labels"))
        throw y.at("labels").error(fmt::format("{} labels", item.labels.size()),
                                   "labels are for the two ends, or for every step", "change their number");
    if (y.has("reverse")) item.is_reversed = y.at("reverse").boolean();
    return item;
}

Subscale read_subscale(gi::Yaml const& name, gi::Yaml const& y, Questionnaire const& q)
{
    check_keys(y, "subscale");
    Subscale s;
    s.name = name.name();
    std::vector<std::string> ids;
    for (QuestionnaireItem const& item : q.items) ids.push_back(item.id);
    for (gi::Yaml const& id : y.needed("items", "[q1, q2]").one_or_more())
        s.items.push_back(id.one_of(ids, "item"));
    if (s.items.empty()) throw y.error("scale '" + s.name + "' has no items", "it has no score", "name some");
    if (y.has("score")) s.combine = Combine(y.at("score").one_of({"sum", "mean", "count"}, "way to score"));
    if (y.has("weight")) s.weight = y.at("weight").number(-1e6, 1e6);
    if (y.has("offset")) s.offset = y.at("offset").number(-1e6, 1e6);
    if ((s.combine == Combine::count) != y.has("at_least"))
        throw y.error("'at_least' and 'score: count' belong together", "at_least defines what is counted",
                      "give both or none");
    if (y.has("at_least")) s.at_least = y.at("at_least").number(-1e6, 1e6);
    return s;
}

} // namespace

std::vector<Questionnaire> read_questionnaires(gi::Yaml const& y)
{
    std::vector<Questionnaire> all;
    for (auto const& [key, value] : y.entries()) {
        check_keys(value, "questionnaire");
        Questionnaire q;
        q.name = key.name();
        q.place = key.place();
        for (Questionnaire const& known : known_questionnaires())
            if (known.name == q.name)
                throw key.error("questionnaire '" + q.name + "' is known already", "the name is taken",
                                "choose another name");
        if (value.has("title")) q.title = value.at("title").text();
        if (value.has("instructions")) q.instructions = value.at("instructions").text();
        std::optional<RatingScale> usual;
        if (value.has("scale")) usual = read_scale(value.at("scale"));
        std::set<std::string> ids;
        for (gi::Yaml const& item : value.needed("items", "[{id: q1, text: \"...\"}]").items()) {
            q.items.push_back(read_item(item, usual ? &*usual : nullptr));
            if (!ids.insert(q.items.back().id).second)
                throw item.error("item '" + q.items.back().id + "' twice", "tables could not distinguish them",
                                 "rename one");
        }
        if (q.items.empty() || q.items.size() > 1000)
            throw value.error(fmt::format("questionnaire '{}' has {} items", q.name, q.items.size()),
                              "1 to 1000 are allowed", "change it");
        if (value.has("scales"))
            for (auto const& [name, scale] : value.at("scales").entries())
                q.subscales.push_back(read_subscale(name, scale, q));
        all.push_back(std::move(q));
    }
    return all;
}

} // namespace study
