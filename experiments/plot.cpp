#include "experiments/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gradslc {
namespace {

struct Colour {
  const char* light;
  const char* dark;
};
// Okabe and Ito 2008, "Color Universal Design", without yellow, which vanishes on white; the darker ones lightened for
// dark mode.
constexpr Colour k_palette[] = {{"#0072B2", "#56A8E0"}, {"#D55E00", "#F0803C"}, {"#009E73", "#2CC295"},
                                {"#B8588F", "#DE8FBD"}, {"#B37700", "#E69F00"}, {"#2A93C9", "#7CC7F0"},
                                {"#444444", "#BBBBBB"}};
constexpr std::size_t k_colours = std::size(k_palette);
constexpr std::size_t k_markers = 4;

constexpr double k_plot_right = 600, k_height = 460;
constexpr double k_left = 78, k_top = 46, k_bottom = 60;    // margins
constexpr double k_name_margin = 44, k_letter_width = 7.5;  // room for the curves' names, pixels
constexpr double k_label_distance = 16;                     // between names at the curves' ends
constexpr double k_longest_labelled_axis = 2.5;             // decades whose ticks at 2 and 5 are labelled

/// Positive part of the data on one axis.
struct LogAxis {
  double lower = 0, upper = 0;  // data
  double begin = 0, end = 0;    // where they are drawn

  double position(double value) const {
    return begin + (end - begin) * (std::log(value) - std::log(lower)) / (std::log(upper) - std::log(lower));
  }
};

bool is_drawable(const PlotPoint& p) { return p.x > 0 && p.y > 0 && std::isfinite(p.x) && std::isfinite(p.y); }

std::vector<PlotPoint> drawable_points(const PlotCurve& curve) {
  std::vector<PlotPoint> points;
  std::copy_if(curve.points.begin(), curve.points.end(), std::back_inserter(points), is_drawable);
  return points;
}

/// An axis over the values with a little room at both ends; nullopt without values.
std::optional<LogAxis> make_axis(const std::vector<double>& values, double begin, double end) {
  if (values.empty()) return std::nullopt;
  constexpr double k_room = 1.15;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  return LogAxis{*smallest / k_room, *largest * k_room, begin, end};
}

std::string tick_label(double value) {
  const double exponent = std::log10(value);
  return exponent < -3.5 || exponent > 4.5 ? fmt::format("{:.0e}", value) : fmt::format("{:g}", value);
}

std::string marker(std::size_t kind, double x, double y, const std::string& attributes) {
  switch (kind % k_markers) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\" {}/>\n", x, y, attributes);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"6.6\" height=\"6.6\" {}/>\n", x - 3.3, y - 3.3,
                         attributes);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l4.2 7.4h-8.4z\" {}/>\n", x, y - 4.6, attributes);
    default:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l4.6 4.6l-4.6 4.6l-4.6 -4.6z\" {}/>\n", x, y - 4.6, attributes);
  }
}

/// Draws one plot; its parts append to one document.
class SvgPlot {
 public:
  SvgPlot(const LogPlot& plot, std::string id) : plot_(plot), id_(std::move(id)) {
    std::size_t longest = 0;
    for (const PlotCurve& curve : plot.curves) longest = std::max(longest, curve.name.size());
    width_ = k_plot_right + k_name_margin + k_letter_width * static_cast<double>(longest);
  }

  std::string draw() {
    begin_document();
    if (make_axes()) {
      draw_grid();
      draw_level();
      for (std::size_t c = 0; c < plot_.curves.size(); ++c) draw_curve(c);
      draw_names();
    } else {
      text(width_ / 2, k_height / 2, "middle", "no positive values to show");
    }
    return svg_ + "</svg>\n";
  }

 private:
  void add(const std::string& element) { svg_ += element; }
  std::string colour_class(std::size_t curve) const { return fmt::format("{}-{}", id_, curve % k_colours); }
  void text(double x, double y, const char* anchor, const std::string& content, const char* extra = "") {
    add(fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, extra,
                    xml_text(content)));
  }
  void line(double x1, double y1, double x2, double y2, const std::string& css_class) {
    add(fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", x1, y1, x2, y2,
                    css_class));
  }

  std::string style(bool dark) const {
    std::string css = fmt::format(
        "#{0} text{{fill:{1}}} #{0} .paper{{fill:{2}}} #{0} .grid{{stroke:{3}}} #{0} .axis{{stroke:{1}}} "
        "#{0} .level{{stroke:{1}}}",
        id_, dark ? "#dddddd" : "#222222", dark ? "#16181c" : "#ffffff", dark ? "#33373e" : "#e4e4e4");
    for (std::size_t c = 0; c < k_colours; ++c) {
      const char* colour = dark ? k_palette[c].dark : k_palette[c].light;
      css += fmt::format(" #{0} .{0}-{1}{{stroke:{2};fill:{2}}}", id_, c, colour);
    }
    return css;
  }

  void begin_document() {
    add(
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"{}\" viewBox=\"0 0 {} {}\" width=\"{}\" "
                    "height=\"{}\" role=\"img\" font-family=\"Helvetica, Arial, DejaVu Sans, sans-serif\" "
                    "font-size=\"13\">\n",
                    id_, width_, k_height, width_, k_height));
    add(fmt::format("<title>{}</title>\n", xml_text(plot_.title)));
    // Last come the rules that hold in both modes, so that they win over the colours.
    add(
        fmt::format("<style>{1}\n@media (prefers-color-scheme: dark){{{2}}}\n"
                    "#{0} .curve{{fill:none;stroke-width:2;stroke-linejoin:round}} #{0} .more{{stroke-dasharray:7 3}} "
                    "#{0} .band{{stroke:none;fill-opacity:0.16}} #{0} .leader{{stroke-width:0.8}} "
                    "#{0} .level{{stroke-width:1.2;stroke-dasharray:2 4}}</style>\n",
                    id_, style(false), style(true)));
    add(fmt::format("<rect class=\"paper\" width=\"{}\" height=\"{}\"/>\n", width_, k_height));
    text(k_left, 26, "start", plot_.title, "font-size=\"16\" font-weight=\"600\"");
  }

  bool make_axes() {
    std::vector<double> xs, ys;
    for (const PlotCurve& curve : plot_.curves) {
      for (const PlotPoint& point : drawable_points(curve)) {
        xs.push_back(point.x);
        ys.insert(ys.end(), {point.y, point.y_upper});
        if (point.y_lower > 0) ys.push_back(point.y_lower);
      }
    }
    if (xs.empty()) return false;
    if (plot_.level && plot_.level->y > 0 && plot_.level->y > *std::min_element(ys.begin(), ys.end()) / 10) {
      ys.push_back(plot_.level->y);
    }
    x_ = *make_axis(xs, k_left, k_plot_right);
    y_ = *make_axis(ys, k_height - k_bottom, k_top);
    return true;
  }

  void draw_grid() {
    const double bottom = k_height - k_bottom, right = k_plot_right;
    for (const LogTick& tick : log_ticks(x_.lower, x_.upper)) {
      const double x = x_.position(tick.value);
      line(x, k_top, x, bottom, "grid");
      if (tick.labelled) text(x, bottom + 19, "middle", tick_label(tick.value));
    }
    for (const LogTick& tick : log_ticks(y_.lower, y_.upper)) {
      const double y = y_.position(tick.value);
      line(k_left, y, right, y, "grid");
      if (tick.labelled) text(k_left - 8, y + 4.5, "end", tick_label(tick.value));
    }
    line(k_left, bottom, right, bottom, "axis");
    line(k_left, k_top, k_left, bottom, "axis");
    text((k_left + right) / 2, k_height - 16, "middle", plot_.x_label);
    const double middle = (k_top + bottom) / 2;
    text(18, middle, "middle", plot_.y_label, fmt::format("transform=\"rotate(-90 18 {:.1f})\"", middle).c_str());
  }

  void draw_level() {
    if (!plot_.level || !(plot_.level->y >= y_.lower && plot_.level->y <= y_.upper)) return;
    const double y = y_.position(plot_.level->y);
    line(k_left, y, k_plot_right, y, "level");
    text(k_left + 6, y - 5, "start", plot_.level->name, "font-size=\"11\"");
  }

  void draw_curve(std::size_t c) {
    const std::vector<PlotPoint> points = drawable_points(plot_.curves[c]);
    if (points.empty()) return;
    const auto place = [&](double x, double y) {
      return fmt::format("{:.1f},{:.1f} ", x_.position(x), y_.position(std::max(y, y_.lower)));
    };
    std::string curve, band;
    for (const PlotPoint& p : points) curve += place(p.x, p.y), band += place(p.x, p.y_upper);
    for (auto p = points.rbegin(); p != points.rend(); ++p) band += place(p->x, p->y_lower);
    add(fmt::format("<polygon class=\"band {}\" points=\"{}\"/>\n", colour_class(c), band));
    add(fmt::format("<polyline class=\"{} curve{}\" points=\"{}\"/>\n", colour_class(c), c < k_colours ? "" : " more",
                    curve));
    for (const PlotPoint& p : points) {
      add(marker(c, x_.position(p.x), y_.position(p.y), fmt::format("class=\"{}\"", colour_class(c))));
    }
  }

  /// Names at the curves' ends, moved apart where they would overlap, with a line to the end that each belongs to.
  void draw_names() {
    struct Name {
      std::size_t curve;
      double x, y_end, y;
    };
    std::vector<Name> names;
    for (std::size_t c = 0; c < plot_.curves.size(); ++c) {
      const std::vector<PlotPoint> points = drawable_points(plot_.curves[c]);
      if (points.empty()) continue;
      const double y = y_.position(points.back().y);
      names.push_back({c, x_.position(points.back().x), y, y});
    }
    std::stable_sort(names.begin(), names.end(), [](const Name& a, const Name& b) { return a.y < b.y; });
    for (std::size_t i = 1; i < names.size(); ++i) names[i].y = std::max(names[i].y, names[i - 1].y + k_label_distance);
    const double overflow = names.empty() ? 0 : std::max(0.0, names.back().y - (k_height - k_bottom));
    const double x = k_plot_right + 20;
    for (Name& name : names) {
      name.y -= overflow;
      line(name.x + 6, name.y_end, x - 6, name.y, "leader " + colour_class(name.curve));
      add(marker(name.curve, x, name.y, fmt::format("class=\"{}\"", colour_class(name.curve))));
      text(x + 10, name.y + 4.5, "start", plot_.curves[name.curve].name);
    }
  }

  const LogPlot& plot_;
  std::string id_, svg_;
  double width_;
  LogAxis x_, y_;
};

}  // namespace

std::vector<LogTick> log_ticks(double lower, double upper) {
  std::vector<LogTick> ticks;
  const bool label_all = std::log10(upper / lower) <= k_longest_labelled_axis;
  for (int exponent = static_cast<int>(std::floor(std::log10(lower))); exponent <= std::log10(upper); ++exponent) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, exponent);
      if (value >= lower && value <= upper) ticks.push_back({value, label_all || digit == 1});
    }
  }
  return ticks;
}

std::string to_svg(const LogPlot& plot, const std::string& id) { return SvgPlot(plot, id).draw(); }

std::string xml_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace gradslc
