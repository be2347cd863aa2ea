#include <fmt/format.h>

#include "experiments/metrics.h"
#include "experiments/report_data.h"
#include "experiments/report_images.h"
#include "experiments/tables.h"

namespace gradslc {
namespace {

/// How to read the tables, in sentences: the same in every format.
std::vector<std::string> explanations() {
  std::vector<std::string> sentences = {
      "Means over repeats ± 95 % confidence intervals (Student's t over repeats; none with one repeat).",
      "seconds = prepare + render + the last reconstruction, wall clock. Methods of a scene take turns in slices, and "
      "a "
      "method's clock runs only in its own.",
      "factor = (relmse x seconds of the first method) / (the method's): above 1 is better; n.s.: the intervals "
      "overlap, no "
      "significant difference.",
      "r is the mean of the reference's two halves a and b; mse, relmse and relmse_trimmed multiply (x - a)(x - b), "
      "which does "
      "not carry the reference's noise and may be negative near it."};
  for (const MetricEntry& metric : metric_registry())
    sentences.push_back(fmt::format("{}: {}.", metric.name, metric.meaning));
  return sentences;
}

constexpr const char* k_plot_caption =
    "Mean over repeats; the band goes from the smallest to the largest. Values that are not positive are not shown.";
constexpr const char* k_image_caption = "First repeat, all at the same exposure.";
constexpr const char* k_error_caption =
    "Relative error of luminance, (x - r) / (|r| + 0.1 mean(r)): white none, red +100 % or more, blue -100 %.";

std::string html_table(const TextTable& table) {
  std::string html = "<div class=\"wide\"><table>\n<tr>";
  for (const std::string& cell : table.header) html += "<th>" + xml_text(cell) + "</th>";
  html += "</tr>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + xml_text(cell) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string html_paragraph(const std::string& text, const char* css_class = "") {
  return fmt::format("<p class=\"{}\">{}</p>\n", css_class, xml_text(text));
}

std::string html_list(const std::vector<std::string>& items) {
  std::string html = "<ul>\n";
  for (const std::string& item : items) html += "<li>" + xml_text(item) + "</li>\n";
  return html + "</ul>\n";
}

std::string html_images(const std::vector<ReportImage>& images, const char* caption) {
  if (images.empty()) return "";
  std::string html = html_paragraph(caption, "note") + "<div class=\"images\">\n";
  for (const ReportImage& image : images) {
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        xml_text(image.caption), base64(image.png));
  }
  return html + "</div>\n";
}

constexpr const char* k_html_style = R"(
:root { color-scheme: light dark; --paper: #fff; --ink: #1c1c1e; --dim: #5c5f66; --rule: #d9dbe0; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181c; --ink: #e6e6e8; --dim: #9ea2aa; --rule: #363a42; } }
body { background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, Helvetica, Arial, sans-serif;
  max-width: 72rem; margin: 0 auto; padding: 1rem; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2.5rem; border-top: 1px solid var(--rule); padding-top: 1.5rem; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.9rem; }
th, td { padding: 0.35rem 0.7rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--rule); }
th { color: var(--dim); font-weight: 600; } th:first-child, td:first-child, th:last-child, td:last-child { text-align: left; }
th:first-child, td:first-child { position: sticky; left: 0; background: var(--paper); }
.note { color: var(--dim); font-size: 0.9rem; } svg { max-width: 100%; min-width: 36rem; height: auto; }
.images { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 0.8rem; }
figure { margin: 0; } img { width: 100%; height: auto; display: block; image-rendering: pixelated; }
figcaption { color: var(--dim); font-size: 0.9rem; }
)";

std::string html_scene(const SceneReport& scene) {
  std::string html = "<section>\n<h2>" + xml_text(scene.summary.scene) + "</h2>\n";
  html += html_paragraph(scene.conditions, "note");
  html += html_list(scene.verdict) + html_table(result_table(scene.summary, Markup::text));
  if (scene.plot) {
    html += fmt::format("<div class=\"wide\">{}</div>\n", to_svg(*scene.plot, scene.plot_id));
    html += html_paragraph(k_plot_caption, "note");
  }
  html += html_images(scene.images, k_image_caption) + html_images(scene.error_images, k_error_caption);
  return html + "</section>\n";
}

std::string markdown_list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += "- " + item + "\n";
  return text + "\n";
}

std::string markdown_images(const std::vector<ReportImage>& images, const char* caption) {
  if (images.empty()) return "";
  std::string text = fmt::format("{}\n\n", caption);
  for (const ReportImage& image : images)
    text += fmt::format("![{}]({})\n", image.caption, image.file.generic_string());
  return text + "\n";
}

}  // namespace

std::string report_markdown(const ReportData& data) {
  std::string text = fmt::format("# {}\n\n", data.name);
  for (const SceneReport& scene : data.scenes) {
    text += fmt::format("## {}\n\n{}\n\n", scene.summary.scene, scene.conditions);
    text += markdown_list(scene.verdict) + markdown_table(result_table(scene.summary, Markup::text)) + "\n";
    if (scene.plot) {
      text += fmt::format("![relmse over seconds]({})\n\n{}\n\n", scene.plot_file.generic_string(), k_plot_caption);
    }
    text += markdown_images(scene.images, k_image_caption) + markdown_images(scene.error_images, k_error_caption);
  }
  return text + "## How to read this\n\n" + markdown_list(explanations()) + "## Conditions\n\n" +
         markdown_list(data.conditions);
}

std::string report_html(const ReportData& data) {
  std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += fmt::format("<title>{}</title>\n<style>{}</style></head><body>\n", xml_text(data.name), k_html_style);
  html += "<h1>" + xml_text(data.name) + "</h1>\n";
  for (const SceneReport& scene : data.scenes) html += html_scene(scene);
  html += "<h2>How to read this</h2>\n" + html_list(explanations());
  html += "<h2>Conditions</h2>\n" + html_list(data.conditions);
  return html + "</body></html>\n";
}

}  // namespace gradslc
