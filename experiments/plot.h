#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gradslc {

/// A point of a curve with the smallest and largest value of the repeats.
struct PlotPoint {
  double x = 0, y = 0, y_lower = 0, y_upper = 0;
};

struct PlotCurve {
  std::string name;
  std::vector<PlotPoint> points;
};

/// A chart with logarithmic axes. Values that are not positive have no place on them and are left out.
struct LogPlot {
  std::string title, x_label, y_label;
  std::vector<PlotCurve> curves;
  struct Level {
    double y;
    std::string name;
  };
  std::optional<Level> level;  ///< a horizontal line
};

/// An SVG document: ticks at 1, 2 and 5, a band over the repeats, each curve named at its end in a colour and with a
/// marker of its own (Okabe and Ito's palette, distinct for colour-blind readers; dashed where it begins again);
/// follows the reader's light or dark mode. `id` is a prefix of the class names, so that several plots can stand in one
/// HTML page.
std::string to_svg(const LogPlot& plot, const std::string& id);

/// Ticks of a logarithmic axis from `lower` to `upper` > `lower` > 0.
struct LogTick {
  double value;
  bool labelled;  ///< all of them on short axes, else only powers of ten
};
std::vector<LogTick> log_ticks(double lower, double upper);

/// Text with the special characters of XML and HTML escaped.
std::string xml_text(const std::string& text);

}  // namespace gradslc
