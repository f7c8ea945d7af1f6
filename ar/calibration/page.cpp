#include "ar/calibration/page.h"

#include "gi/core/html.h"
#include <algorithm>
#include <fmt/format.h>

namespace ar {

std::string page_begin(std::string const& title)
{
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + gi::escaped(title) +
           "</title><style>\nbody{font:15px sans-serif;max-width:960px;margin:2em "
           "auto;color:#222}table{border-collapse:collapse;margin-bottom:1em}\n"
           "td,th{padding:2px 10px;text-align:left;border-bottom:1px solid "
           "#ddd}.picture{width:100%;max-width:800px;"
           "border:1px solid #ccc}\nsvg text{font:12px "
           "sans-serif;text-anchor:middle}.bar{height:10px;background:#1565c0}"
           ".out{background:#c62828}.warning{color:#b71c1c}\n</style></head><body>\n<h1>" +
           gi::escaped(title) + "</h1>\n";
}

std::string page_end() { return "</body></html>\n"; }

std::string plot(std::vector<cv::Point2d> const& points, std::vector<cv::Point2d> const& curve,
                 std::string const& across, std::string const& up)
{
    cv::Point2d most(1e-12, 1e-12);
    for (auto const* list : {&points, &curve})
        for (cv::Point2d const& p : *list) most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    auto const at = [&](cv::Point2d p) { return cv::Point2d(512 * p.x / most.x, 300 - 300 * p.y / most.y); };
    std::string s = "<svg viewBox=\"-60 -14 640 344\" class=\"picture\"><path d=\"M0 0V300H512\" stroke=\"#888\" "
                    "fill=\"none\"/>";
    for (cv::Point2d const& p : points)
        s += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\" fill=\"#1565c0\"/>", at(p).x, at(p).y);
    std::string path;
    for (cv::Point2d const& p : curve)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", at(p).x, at(p).y);
    s += "<path d=\"" + path + "\" stroke=\"#c62828\" stroke-width=\"2\" fill=\"none\"/>";
    return s + fmt::format("<text x=\"256\" y=\"322\">{}, 0 to {:.3g}</text><text x=\"2\" y=\"-3\" "
                           "style=\"text-anchor:start\">{}, 0 to {:.3g}</text></svg>\n",
                           gi::escaped(across), most.x, gi::escaped(up), most.y);
}

} // namespace ar
