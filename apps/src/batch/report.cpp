#include "batch/report.h"

#include "size_text.h"
#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hoist {
namespace {

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>hoist batch</title>
<style>
body{font:15px/1.45 system-ui,sans-serif;color:#1b1f24;background:#fff;margin:2rem auto;
max-width:75rem;padding:0 1rem}
h1{font-size:1.5rem;margin:0 0 .2rem}h2{font-size:1.15rem;margin:2rem 0 .6rem}
.facts{display:flex;flex-wrap:wrap;gap:.8rem;margin:1rem 0}
.facts div{background:#f2f4f7;border-radius:.4rem;padding:.5rem .9rem}
.facts b{display:block;font-size:1.4rem}
.bad b{color:#b3261e}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(16rem,1fr));gap:1rem}
svg{width:100%;height:auto;background:#f7f8fa;border-radius:.4rem}
svg rect{fill:#0072b2}svg line{stroke:#555}
svg .t{font:600 13px system-ui,sans-serif}svg .a{font:11px system-ui,sans-serif;fill:#444}
svg .m{text-anchor:middle}svg .e{text-anchor:end}
table{border-collapse:collapse;width:100%}
th,td{text-align:left;padding:.35rem .6rem;border-bottom:1px solid #e3e6ea;
vertical-align:top}
th{position:sticky;top:0;background:#fff;cursor:pointer;user-select:none}
td.n{text-align:right;font-variant-numeric:tabular-nums}
td.p{overflow-wrap:anywhere}
img{display:block;border-radius:.25rem}
.q{color:#b3261e}.s{color:#555}
input{font:inherit;padding:.3rem .6rem;width:22rem;max-width:100%;margin-bottom:.6rem}
pre{background:#f7f8fa;padding:.8rem;border-radius:.4rem;overflow:auto}
</style></head><body>
)";

// Sorts by the column that is clicked, shows the rows that hold the typed text.
constexpr const char* script = R"(<script>
const table=document.getElementById('files'),body=table.tBodies[0];
document.getElementById('filter').addEventListener('input',e=>{
const t=e.target.value.toLowerCase();
for(const r of body.rows)r.hidden=!r.textContent.toLowerCase().includes(t)});
let last=-1;
[...table.tHead.rows[0].cells].forEach((h,i)=>h.addEventListener('click',()=>{
const down=last===i;last=down?-1:i;
const key=r=>r.cells[i].dataset.k??r.cells[i].textContent;
[...body.rows].sort((a,b)=>{const x=key(a),y=key(b),d=x-y;
return (isNaN(d)?(x<y?-1:x>y?1:0):d)*(down?-1:1)}).forEach(r=>body.append(r))}));
</script>
</body></html>
)";

std::string
escaped(const std::string& text)
{
  std::string out;
  for (const char c : text)
    switch (c) {
    case '&':
      out += "&amp;";
      break;
    case '<':
      out += "&lt;";
      break;
    case '>':
      out += "&gt;";
      break;
    case '"':
      out += "&quot;";
      break;
    default:
      out += c;
    }
  return out;
}

// "12.0 × 8.1 × 5.0 cm, 0.93, brown"
std::string
cuboidLine(const RecognizedCuboid& item)
{
  std::string out;
  for (int i = 0; i < 3; ++i) {
    out += i > 0 ? " × " : "";
    out += escaped(sizeText(item.cuboid, i));
  }
  out += fmt::format(" cm, {:.2f}", item.cuboid.score);
  if (!item.features.color_name.empty())
    out += ", " + escaped(item.features.color_name);
  if (item.features.weight > 0)
    out += fmt::format(", {:.1f} kg", item.features.weight);
  return out;
}

std::string
fact(std::size_t number, const char* what, bool bad = false)
{
  return fmt::format("<div{}><b>{}</b>{}</div>\n",
                     bad && number > 0 ? " class=\"bad\"" : "",
                     number,
                     what);
}

std::string
leftOut(std::size_t listed, std::size_t all)
{
  if (listed == all)
    return "";
  return fmt::format("<p class=\"s\">The first {} of {}; all are in files.csv and "
                     "summary.sqlite.</p>\n",
                     listed,
                     all);
}

} // namespace

Report::Report(std::string version, std::string settings, std::size_t most_rows)
: version_(std::move(version))
, settings_(std::move(settings))
, most_rows_(most_rows)
, sizes_{Histogram(0.005, 50, false),
         Histogram(0.005, 50, false),
         Histogram(0.005, 50, false)}
, scores_(0.05, 1, true)
{
}

void
Report::add(const SummaryEntry& entry)
{
  const RecordHead& record = entry.head;
  const bool bad = record.verdict.cause != Cause::none;
  ++files_;
  ++causes_.at(static_cast<std::size_t>(record.verdict.cause));
  quarantined_ += bad;
  empty_ += !bad && entry.result.cuboids.empty();
  cuboids_ += entry.result.cuboids.size();
  double best = 0;
  std::string found;
  for (const RecognizedCuboid& item : entry.result.cuboids) {
    for (int i = 0; i < 3; ++i)
      if (item.cuboid.dimension_source[i] != DimensionSource::unknown)
        sizes_.at(i).add(item.cuboid.size[i]);
    scores_.add(item.cuboid.score);
    best = std::max(best, item.cuboid.score);
    if (rows_.size() < most_rows_)
      found += (found.empty() ? "" : "<br>") + cuboidLine(item);
  }
  if (bad && failures_.size() < most_rows_)
    failures_.push_back(fmt::format("<tr><td class=\"p\">{}</td><td>{}</td><td "
                                    "class=\"p\">{}</td></tr>\n",
                                    escaped(record.path),
                                    toString(record.verdict.cause),
                                    escaped(record.verdict.reason)));
  if (rows_.size() >= most_rows_)
    return;
  if (bad)
    found = "<span class=\"q\">" + escaped(record.verdict.reason) + "</span>";
  else if (found.empty())
    found = "<span class=\"s\">" +
            escaped(reasonsText(entry.result.diagnostics.rejected)) + "</span>";
  rows_.push_back(fmt::format(
      "<tr><td>{}</td><td class=\"p\">{}</td><td>{}</td><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td><td>{}</td></tr>\n",
      entry.thumbnail.empty()
          ? ""
          : "<img loading=\"lazy\" alt=\"\" src=\"" + entry.thumbnail + "\">",
      escaped(record.path),
      bad ? "<span class=\"q\">quarantined</span>" : "done",
      bad ? "" : std::to_string(entry.result.cuboids.size()),
      entry.result.cuboids.empty() ? "" : fmt::format("{:.3f}", best),
      found));
}

std::string
Report::facts() const
{
  return "<div class=\"facts\">\n" + fact(files_, "files") + fact(cuboids_, "cuboids") +
         fact(empty_, "files without a cuboid") +
         fact(quarantined_, "quarantined", true) + "</div>\n";
}

std::string
Report::failureTable() const
{
  if (quarantined_ == 0)
    return "";
  std::string out = "<h2>Quarantined</h2>\n<p>";
  std::string parts;
  for (std::size_t i = 1; i < causes_.size(); ++i)
    if (causes_[i] > 0)
      parts += fmt::format("{}{} {}",
                           parts.empty() ? "" : ", ",
                           causes_[i],
                           toString(static_cast<Cause>(i)));
  out += parts + "</p>\n" + leftOut(failures_.size(), quarantined_);
  out += "<table id=\"failures\"><thead><tr><th>file</th><th>cause</th><th>reason</th>"
         "</tr></thead><tbody>\n";
  for (const std::string& row : failures_)
    out += row;
  return out + "</tbody></table>\n";
}

std::string
Report::fileTable() const
{
  std::string out = "<h2>Files</h2>\n" + leftOut(rows_.size(), files_) +
                    "<input id=\"filter\" placeholder=\"Show rows with …\" "
                    "aria-label=\"Show rows with\">\n<table id=\"files\"><thead><tr>"
                    "<th></th><th>file</th><th>status</th><th>cuboids</th><th>best "
                    "score</th><th>length × width × height, score, colour</th></tr>"
                    "</thead><tbody>\n";
  for (const std::string& row : rows_)
    out += row;
  return out + "</tbody></table>\n";
}

std::string
Report::html() const
{
  std::string out = head;
  out += "<h1>hoist batch</h1>\n<p class=\"s\">version " + escaped(version_) +
         "</p>\n" + facts();
  if (cuboids_ > 0)
    out += "<h2>Cuboids</h2>\n<div class=\"charts\">" +
           sizes_[0].svg("Length", 100, "cm") + sizes_[1].svg("Width", 100, "cm") +
           sizes_[2].svg("Height", 100, "cm") + scores_.svg("Score", 1, "") +
           "</div>\n";
  out += failureTable() + fileTable();
  out += "<h2>Settings</h2>\n<details><summary>all, as they were</summary><pre>" +
         escaped(settings_) + "</pre></details>\n";
  return out + script;
}

} // namespace hoist
