#include "experiments/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <pugixml.hpp>

#include "core/error.h"
#include "core/file.h"
#include "experiments/plot.h"
#include "experiments/report_images.h"
#include "experiments/results.h"
#include "experiments/runner.h"
#include "fakes.h"

namespace gradslc {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Width and height that the header of a PNG file names.
Resolution png_size(const std::string& png) {
  if (png.size() < 24 || png.substr(1, 3) != "PNG" || png.substr(12, 4) != "IHDR") return {};
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(png[at + i]);
    return value;
  };
  return {number(16), number(20)};
}

std::vector<double> labelled(const std::vector<LogTick>& ticks) {
  std::vector<double> values;
  for (const LogTick& tick : ticks) {
    if (tick.labelled) values.push_back(tick.value);
  }
  return values;
}

TEST(LogTicks, StandAtOneTwoAndFive) {
  EXPECT_EQ(labelled(log_ticks(0.9, 25)), (std::vector<double>{1, 2, 5, 10, 20}));
  EXPECT_EQ(labelled(log_ticks(3, 4)), (std::vector<double>{}));
  const std::vector<LogTick> long_axis = log_ticks(1, 1e4);
  EXPECT_EQ(labelled(long_axis), (std::vector<double>{1, 10, 100, 1000, 10000}));
  EXPECT_EQ(long_axis.size(), 13u);
}

LogPlot sample_plot() {
  LogPlot plot{"cornell <box> & co", "seconds", "relmse", {}, LogPlot::Level{2e-4, "the reference's own relmse"}};
  for (int m = 0; m < 4; ++m) {
    PlotCurve& curve = plot.curves.emplace_back();
    curve.name = m == 0 ? "SPT" : "method " + std::to_string(m);
    for (int k = 0; k < 8; ++k) {
      const double x = 0.16 * std::exp2(k), y = 0.2 / (x * (1 + 0.4 * m)) + 0.002 * m;
      curve.points.push_back({x, y, 0.8 * y, 1.2 * y});
    }
  }
  return plot;
}

TEST(Plot, IsWellFormedAndShowsEveryCurveWithItsName) {
  const std::string svg = to_svg(sample_plot(), "p");
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(document.select_nodes("//polyline").size(), 4u);
  EXPECT_EQ(document.select_nodes("//polygon").size(), 4u);
  for (const char* name : {"SPT", "method 1", "method 2", "method 3", "cornell <box> & co"}) {
    EXPECT_EQ(document.select_nodes(("//text[.='" + std::string(name) + "']").c_str()).size(), 1u) << name;
  }
}

TEST(Plot, MoreSecondsLieFurtherRightAndSmallerErrorsFurtherDown) {
  LogPlot plot{"t", "x", "y", {{"a", {{1, 1, 1, 1}, {10, 0.1, 0.1, 0.1}, {100, 0.01, 0.01, 0.01}}}}, std::nullopt};
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_svg(plot, "p").c_str()));
  double x[3], y[3];
  const std::string points = document.select_node("//polyline").node().attribute("points").value();
  ASSERT_EQ(std::sscanf(points.c_str(), "%lf,%lf %lf,%lf %lf,%lf", x, y, x + 1, y + 1, x + 2, y + 2), 6);
  EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.11) << "equal factors, equal distances";
  EXPECT_NEAR(y[1] - y[0], y[2] - y[1], 0.11);
  EXPECT_GT(x[1], x[0]);
  EXPECT_GT(y[1], y[0]) << "SVG counts downwards";
}

TEST(Plot, LeavesOutWhatHasNoPlaceOnALogarithmicAxis) {
  LogPlot plot{"t", "x", "y", {{"a", {{1, -1, -2, 1}, {2, 0.5, -0.1, 1}, {4, 0.25, 0.1, 0.5}}}}, std::nullopt};
  const std::string svg = to_svg(plot, "p");
  EXPECT_FALSE(contains(svg, "nan"));
  EXPECT_FALSE(contains(svg, "inf"));
  plot.curves[0].points = {{1, -1, -1, -1}};
  EXPECT_TRUE(contains(to_svg(plot, "p"), "no positive values"));
}

TEST(Base64, AgreesWithRfc4648) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
}

TEST(DisplayExposure, PutsTheBrightPixelsAtFourFifths) {
  RgbImage image({100, 1}, Rgb(2));
  image(99, 0) = Rgb(1000);  // a firefly
  EXPECT_NEAR(display_exposure(image) * 2, 0.8, 1e-5);
  EXPECT_EQ(display_exposure(RgbImage({4, 4}, Rgb(0))), 1);
}

TEST(ErrorImage, IsRedWhereTooBrightBlueWhereTooDarkWhiteWhereRight) {
  const RgbImage reference({3, 1}, Rgb(1));
  RgbImage image = reference;
  image(1, 0) = Rgb(10);
  image(2, 0) = Rgb(0);
  const RgbImage shown = error_image(image, reference);
  EXPECT_EQ(shown(0, 0), Rgb(1, 1, 1));
  EXPECT_EQ(shown(1, 0), Rgb(1, 0, 0));
  EXPECT_GT(shown(2, 0).b, shown(2, 0).r);
  EXPECT_NEAR(shown(2, 0).r, 1 - 1 / 1.1, 1e-5);
}

struct ReportTest : testing::Test {
  fakes::World world;
  fakes::TemporaryFolder folder{"report"};
  std::filesystem::path out = folder.path() / "results";

  ReportTest() {
    write_file_atomically(folder.path() / "scene.xml", "<scene/>");
    Experiment e;
    e.name = "a <name>";
    e.repeats = 2;
    e.budget = {Budget::Kind::seconds, 4};
    e.scenes = {{"one scene", folder.path() / "scene.xml", 12, 8, {}}};
    e.methods = {fakes::method("A"), fakes::method("B")};
    e.reference = {ReferencePlan::Kind::render, 64, {}};
    e.resolved = {{"name", e.name}};
    RunOptions options;
    options.out = out;
    run_experiment(e, options,
                   fakes::makers(world, {{"reference", {.noise = 0.1}},
                                         {"A", {.pass_seconds = 0.1, .noise = 1}},
                                         {"B", {.pass_seconds = 0.2, .noise = 1}}}));
  }
};

TEST_F(ReportTest, HasImagesOfAllMethodsAndTheirErrors) {
  const std::string html = read_file(out / "report.html"), markdown = read_file(out / "report.md");
  for (const std::string& text : {html, markdown}) {
    EXPECT_TRUE(contains(text, "A is best"));
    EXPECT_TRUE(contains(text, "one scene"));
  }
  EXPECT_TRUE(contains(html, "a &lt;name&gt;"));
  std::size_t images = 0;
  for (std::size_t i = html.find("<img"); i != std::string::npos; i = html.find("<img", i + 1)) ++images;
  EXPECT_EQ(images, 5u) << "reference, two methods, two errors";
  EXPECT_FALSE(contains(html, "src=\"http")) << "self-contained";
  std::size_t pngs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out / "images")) {
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(png_size(read_file(entry.path())), (Resolution{12, 8}));
    ++pngs;
  }
  EXPECT_EQ(pngs, 5u);
}

TEST_F(ReportTest, IsMadeAgainFromTheFilesAlone) {
  const std::vector<const char*> files = {"report.md", "report.html", "table.tex"};
  std::vector<std::string> before;
  for (const char* file : files) {
    before.push_back(read_file(out / file));
    std::filesystem::remove(out / file);
  }
  const std::filesystem::path moved = folder.path() / "moved";
  std::filesystem::rename(out, moved);
  write_report(moved);
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(read_file(moved / files[i]), before[i]) << files[i];
}

TEST_F(ReportTest, DoesWithoutImagesAndManifests) {
  std::filesystem::remove_all(out / "runs");
  EXPECT_NO_THROW(write_report(out));
  EXPECT_TRUE(contains(read_file(out / "report.md"), "A is best"));
  std::filesystem::remove(out / "results.csv");
  EXPECT_THROW(write_report(out), Error);
}

}  // namespace
}  // namespace gradslc
